/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "study/orders/request.h"
#include "study/orders/sha256.h"
#include "study/scene/quote.h"

static const char format[] = "beamrate-cell 1";

enum { LARGEST_WORD_FILE = 1 << 26 }; /* bytes that are read for a word */

/* With what it is and its end, so that no two lists of texts are the same bytes. */
static void add_text(struct br_sha256 *sum, char kind, const char *text)
{
    br_sha256_add(sum, &kind, 1);
    br_sha256_add(sum, text, strlen(text) + 1);
}

/* What is no regular file counts by its name alone. */
static enum br_status add_file(struct br_sha256 *sum, const char *path, long long largest,
                               struct br_error *err)
{
    struct stat info;
    char text[BR_SHA256_TEXT];
    long long size;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode))
        return BR_OK;
    snprintf(text, sizeof text, "%lld bytes of %lld.%09ld", (long long)info.st_size,
             (long long)info.st_mtim.tv_sec, info.st_mtim.tv_nsec);
    if (info.st_size <= largest) {
        const int file = open(path, O_RDONLY | O_CLOEXEC);
        const bool read = file >= 0 && br_sha256_file(file, &size, text);
        const int reason = errno;
        if (file >= 0)
            close(file);
        if (!read)
            return br_fail(err, BR_IO,
                           "%.800s cannot be read, so that finished cells cannot be kept: %s", path,
                           strerror(reason));
    }
    add_text(sum, 'f', text);
    return BR_OK;
}

enum br_status br_cell_key(const struct br_orders_request *request, const char *program,
                           char *const *words, char key[BR_CELL_KEY], struct br_error *err)
{
    struct br_sha256 sum;
    br_sha256_start(&sum);
    add_text(&sum, 'v', format);
    add_text(&sum, 'p', program);
    enum br_status status = add_file(&sum, program, INT64_MAX, err);
    for (; *words && !status; words++) {
        const char *behind = strchr(*words, '=');
        add_text(&sum, 'w', *words);
        status = add_file(&sum, *words, LARGEST_WORD_FILE, err);
        if (behind && !status)
            status = add_file(&sum, behind + 1, LARGEST_WORD_FILE, err);
    }
    for (size_t i = 0; i < request->readings; i++) {
        add_text(&sum, 'n', request->reading[i].name);
        add_text(&sum, "rjc"[request->reading[i].kind], request -> reading[i].what);
    }
    br_sha256_end(&sum, key);
    return status;
}

static double number_or_nan(const json_t *value)
{
    return json_is_number(value) ? json_number_value(value) : (double)NAN;
}

bool br_cell_find(const struct br_orders_request *request, const char *key,
                  struct br_numbers_row *row)
{
    char path[PATH_MAX];
    const size_t readings = request->readings;
    if ((size_t)snprintf(path, sizeof path, "%s/%s.json", request->kept, key) >= sizeof path)
        return false;
    json_t *cell = json_load_file(path, JSON_REJECT_DUPLICATES, NULL);
    const char *tag = json_string_value(json_object_get(cell, "format"));
    const json_t *numbers = json_object_get(cell, "numbers");
    bool found = tag && strcmp(tag, format) == 0 && json_array_size(numbers) == readings;
    for (size_t i = 0; i < readings && found; i++) {
        row->number[i] = number_or_nan(json_array_get(numbers, i));
        found = isfinite(row->number[i]);
    }
    if (found) {
        row->seconds = number_or_nan(json_object_get(cell, "seconds"));
        row->bytes = number_or_nan(json_object_get(cell, "bytes"));
        row->kept = true;
    }
    json_decref(cell);
    return found;
}

static json_t *json_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

/* NULL: out of memory. The command is there for people. */
static json_t *cell_of(char *const *words, size_t readings, const struct br_numbers_row *row)
{
    json_t *command = json_array(), *numbers = json_array();
    bool whole = command && numbers;
    for (; *words && whole; words++) {
        char text[512];
        br_quoted(text, sizeof text, &br_for_text, *words);
        whole = json_array_append_new(command, json_string(text)) == 0;
    }
    for (size_t i = 0; i < readings && whole; i++)
        whole = json_array_append_new(numbers, json_number(row->number[i])) == 0;
    json_t *cell = whole ? json_pack("{s:s, s:O, s:O, s:o, s:o}", "format", format, "command",
                                     command, "numbers", numbers, "seconds",
                                     json_number(row->seconds), "bytes", json_number(row->bytes))
                         : NULL;
    json_decref(command);
    json_decref(numbers);
    return cell;
}

/* By rename: another study finds it whole, or not at all. */
static bool write_cell(char *unfinished, const char *finished, const json_t *cell)
{
    const int file = mkostemp(unfinished, O_CLOEXEC);
    if (file < 0)
        return false;
    const bool written = json_dumpfd(cell, file, JSON_INDENT(1)) == 0 && fsync(file) == 0;
    int reason = errno;
    close(file);
    if (written && rename(unfinished, finished) == 0)
        return true;
    reason = written ? errno : reason;
    unlink(unfinished);
    errno = reason;
    return false;
}

enum br_status br_cell_keep(const struct br_orders_request *request, const char *key,
                            char *const *words, const struct br_numbers_row *row,
                            struct br_error *err)
{
    char unfinished[PATH_MAX], finished[PATH_MAX];
    json_t *cell = cell_of(words, request->readings, row);
    if (!cell)
        return br_no_memory(err, "a finished cell");
    snprintf(unfinished, sizeof unfinished, "%s/.unfinished-XXXXXX", request->kept);
    const int length = snprintf(finished, sizeof finished, "%s/%s.json", request->kept, key);
    errno = ENAMETOOLONG;
    const bool kept = (size_t)length < sizeof finished && write_cell(unfinished, finished, cell);
    const int reason = errno;
    json_decref(cell);
    return kept ? BR_OK
                : br_fail(err, BR_IO, "%.800s: a finished cell could not be kept: %s",
                          request->kept, strerror(reason));
}
