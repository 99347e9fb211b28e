/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files of a command, for hashes: the program, and the files that its words name. What these
 * read or start is not known. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/statement.h"
#include "orders/request.h"

enum { LARGEST_WORD_FILE = 1 << 26 }; /* bytes; of a larger one the contents are not read */

/* The contents of a regular file, or, where it is larger, its size and times. Of any other file,
 * only the name counts. place: the real path, too. */
static enum br_status add_file(struct br_statement *command, const char *path, long long largest,
                               bool place, struct br_error *err)
{
    struct stat info;
    char text[2 * BR_SHA256_TEXT];
    long long size;
    if (*path != '/' || stat(path, &info) != 0 || !S_ISREG(info.st_mode))
        return BR_OK; /* what is relative is no file where the program runs */
    snprintf(text, sizeof text, "%lld bytes of %lld.%09ld", (long long)info.st_size,
             (long long)info.st_mtim.tv_sec, info.st_mtim.tv_nsec);
    if (place) /* a person can set the other time */
        snprintf(text + strlen(text), sizeof text - strlen(text), ", %lld.%09ld",
                 (long long)info.st_ctim.tv_sec, info.st_ctim.tv_nsec);
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    const bool read = file >= 0 && (info.st_size > largest || br_sha256_file(file, &size, text));
    char *real = place && read ? realpath(path, NULL) : NULL;
    const int reason = errno;
    if (file >= 0)
        close(file);
    if (!read || (place && !real))
        return br_fail(err, BR_IO, "%.800s cannot be read: %s", path, strerror(reason));
    br_state(command, "file", "%s", text);
    if (place)
        br_state(command, "place", "%s", real);
    free(real);
    return BR_OK;
}

enum br_status br_command_state(struct br_statement *command, const struct br_command_words *c,
                                const struct br_command_words *before, struct br_error *err)
{
    const bool place = before;
    char **same = before ? before->word : NULL;
    enum br_status status = BR_OK;
    br_state(command, "program", "%s", c->program);
    if (!place || !before->program || strcmp(before->program, c->program) != 0)
        status = add_file(command, c->program, INT64_MAX, place, err);
    for (char **word = c->word; *word && !status; word++) {
        const char *behind = strchr(*word, '='), *old = same && *same ? *same++ : NULL;
        br_state(command, "word", "%s", *word);
        if (old && strcmp(*word, old) == 0)
            continue;
        status = add_file(command, *word, LARGEST_WORD_FILE, place, err);
        if (behind && !status)
            status = add_file(command, behind + 1, LARGEST_WORD_FILE, place, err);
    }
    return status;
}

enum br_status br_command_identify(const struct br_orders_request *r, const char *text,
                                   char sum[BR_SHA256_TEXT], struct br_error *err)
{
    struct br_statement s;
    struct br_command_words before = {NULL};
    struct br_numbers numbers = {0};
    char *real = realpath(r->path, NULL); /* NULL: a pipe, for example */
    br_statement_begin(&s);
    br_state(&s, "beamrate-trust", "%s", "3");
    br_state(&s, "place", "%s", real ? real : r->path);
    br_state(&s, "study", "%s", text);
    free(real);
    enum br_status status = br_program_rows(r, &numbers, err);
    for (size_t i = 0; i < numbers.rows && !status; i++) {
        struct br_command_words words = {NULL};
        status = br_command_split(r, &numbers.row[i], &words, err);
        if (!status)
            status = br_command_state(&s, &words, &before, err);
        br_command_clear(&before);
        before = words;
    }
    br_numbers_clear(&numbers);
    br_command_clear(&before);
    char *all = br_statement_end(&s);
    if (all)
        br_sha256_of(all, strlen(all), sum);
    else if (!status)
        status = br_no_memory(err, "a command");
    free(all);
    return status;
}
