/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files of a command: the program, and the files that its words name, also behind a "=". What
 * these read or start is not known. */
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/statement.h"
#include "orders/request.h"

enum { LARGEST = 1 << 26 }; /* bytes; of a larger one the contents are not read */

/* The i-th regular file; "": none; NULL: there are no more. */
static const char *named(const struct br_command_words *c, size_t i, struct stat *info)
{
    const char *path = i ? c->word[(i - 1) / 2] : c->program;
    if (path && i && i % 2 == 0)
        path = strchr(path, '=') ? strchr(path, '=') + 1 : "";
    /* what is relative is no file where the program runs */
    const bool is = path && *path == '/' && stat(path, info) == 0 && S_ISREG(info->st_mode);
    return path && !is ? "" : path;
}

static bool sum_of(const char *path, char text[BR_SHA256_TEXT])
{
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    const bool read = file >= 0 && br_sha256_file(file, text);
    if (file >= 0)
        close(file);
    return read;
}

enum br_status br_command_state(struct br_statement *s, const struct br_command_words *c,
                                struct br_error *err)
{
    struct stat info;
    char text[BR_SHA256_TEXT];
    const char *path;
    br_state(s, "program", "%s", c->program);
    for (char **word = c->word; *word; word++)
        br_state(s, "word", "%s", *word);
    for (size_t i = 0; (path = named(c, i, &info)); i++)
        if (*path && i && info.st_size > LARGEST)
            br_state(s, "file", "%lld bytes of %lld.%09ld", (long long)info.st_size,
                     (long long)info.st_mtim.tv_sec, info.st_mtim.tv_nsec);
        else if (*path && !sum_of(path, text))
            return br_fail(err, BR_IO, "%.800s cannot be read: %s", path, strerror(errno));
        else if (*path)
            br_state(s, "file", "%s", text);
    return BR_OK;
}

uint64_t br_command_stamp(const struct br_command_words *c)
{
    struct stat info = {0};
    uint64_t stamp = 14695981039346656037u; /* FNV-1a, by numbers */
    const char *path;
    for (size_t i = 0; (path = named(c, i, &info)); i++) {
        const uint64_t part[] = {(uint64_t)info.st_dev, (uint64_t)info.st_ino,
                                 (uint64_t)info.st_size, (uint64_t)info.st_mtim.tv_sec,
                                 (uint64_t)info.st_mtim.tv_nsec};
        for (size_t j = 0; j < sizeof part / sizeof *part; j++)
            stamp = (stamp ^ (*path ? part[j] : 0)) * 1099511628211u;
    }
    return stamp;
}
