/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/output.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "cli/provenance.h"
#include "study/orders/sha256.h"
#include "tables/json_value.h"

static const char format[] = "beamrate-set 1";

enum { LARGEST = 1 << 24 }; /* bytes of a manifest */

enum br_status br_run_id_make(char run[BR_RUN_ID], struct br_error *err)
{
    const time_t now = time(NULL);
    struct tm utc;
    unsigned long long random;
    if (getrandom(&random, sizeof random, 0) != sizeof random)
        return br_fail(err, BR_IO, "no random bits for the run's name: %s", strerror(errno));
    gmtime_r(&now, &utc);
    const size_t used = strftime(run, BR_RUN_ID, "%Y%m%dT%H%M%SZ", &utc);
    snprintf(run + used, BR_RUN_ID - used, "-%016llx", random);
    return BR_OK;
}

/* ---- files ---- */

const char *br_listed_name(const json_t *file)
{
    return json_string_value(json_object_get(file, "name"));
}

static const char *sum_of(const json_t *file)
{
    return json_string_value(json_object_get(file, "sha256"));
}

enum br_status br_listed_compare(int folder, const json_t *listed, bool *same, struct br_error *err)
{
    const char *name = br_listed_name(listed);
    char sum[BR_SHA256_TEXT];
    long long size;
    struct stat info;
    const int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    *same = false;
    if (file < 0 && errno == ELOOP)
        return BR_OK; /* a symbolic link now */
    const bool known = file >= 0 && fstat(file, &info) == 0;
    const bool read = known && (!S_ISREG(info.st_mode) || br_sha256_file(file, &size, sum));
    br_close(file);
    if (!read)
        return br_fail(err, BR_IO, "%s: %s", name, strerror(errno));
    *same = S_ISREG(info.st_mode) && size == json_integer_value(json_object_get(listed, "size")) &&
            strcmp(sum, sum_of(listed)) == 0;
    return BR_OK;
}

bool br_write_whole(int file, const char *text, size_t length)
{
    while (length) {
        const ssize_t put = write(file, text, length);
        if (put < 0 && errno != EINTR)
            return false;
        text += put > 0 ? put : 0;
        length -= put > 0 ? (size_t)put : 0;
    }
    return fsync(file) == 0;
}

/* ---- reading and writing ---- */

static enum br_status write_text(int folder, const char *name, const char *text,
                                 struct br_error *err)
{
    static const char unfinished[] = ".unfinished";
    const int file = openat(folder, unfinished, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    const bool written = file >= 0 && br_write_whole(file, text, strlen(text));
    br_close(file);
    if (!written)
        return br_fail(err, BR_IO, "the manifest could not be written: %s", strerror(errno));
    if (renameat(folder, unfinished, folder, name) != 0 || fsync(folder) != 0)
        return br_fail(err, BR_IO, "the manifest: %s", strerror(errno));
    return BR_OK;
}

enum br_status br_sets_write(int folder, const char *name, json_t *sets, struct br_error *err)
{
    json_t *json = json_pack("{s:s, s:O}", "format", format, "sets", sets);
    char *text = json ? json_dumps(json, JSON_INDENT(2)) : NULL;
    json_decref(json);
    const enum br_status status = text && !br_json_lacked_memory()
                                      ? write_text(folder, name, text, err)
                                      : br_no_memory(err, "the manifest");
    free(text);
    return status;
}

/* A name that leads elsewhere, or to what is hidden, is none of ours. */
static bool are_sets(const json_t *sets)
{
    bool ours = json_is_array(sets);
    for (size_t i = 0; i < json_array_size(sets) && ours; i++) {
        const json_t *files = json_object_get(json_array_get(sets, i), "files");
        ours = json_is_array(files);
        for (size_t j = 0; j < json_array_size(files) && ours; j++) {
            const json_t *file = json_array_get(files, j);
            const char *name = br_listed_name(file), *sum = sum_of(file);
            ours = json_is_integer(json_object_get(file, "size")) && sum &&
                   strlen(sum) == BR_SHA256_TEXT - 1 && name && *name && *name != '.' &&
                   !strchr(name, '/');
        }
    }
    return ours;
}

enum br_status br_sets_read(int folder, const char *name, json_t **sets, struct br_error *err)
{
    const int file = openat(folder, name, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    *sets = NULL;
    if (file < 0)
        return errno == ENOENT ? BR_OK : br_fail(err, BR_IO, "%s: %s", name, strerror(errno));
    struct stat info;
    const bool plain = fstat(file, &info) == 0 && S_ISREG(info.st_mode) && info.st_size < LARGEST;
    json_error_t why;
    json_t *json = plain ? br_json_read(file, &why) : NULL;
    close(file);
    const char *tag = json_string_value(json_object_get(json, "format"));
    if (tag && strcmp(tag, format) == 0 && are_sets(json_object_get(json, "sets")))
        *sets = json_incref(json_object_get(json, "sets"));
    json_decref(json);
    return *sets ? BR_OK
                 : br_fail(err, BR_BAD_INPUT, "%s is not a manifest of this program (\"%s\")", name,
                           format);
}

json_t *br_sets_newest(const json_t *sets)
{
    return json_object_get(json_array_get(sets, json_array_size(sets) - 1), "files");
}

static json_t *find(const json_t *files, const char *name)
{
    for (size_t i = 0; i < json_array_size(files); i++)
        if (strcmp(br_listed_name(json_array_get(files, i)), name) == 0)
            return json_array_get(files, i);
    return NULL;
}

json_t *br_sets_find(const json_t *sets, const char *name)
{
    json_t *found = NULL;
    for (size_t i = 0; i < json_array_size(sets) && !found; i++)
        found = find(json_object_get(json_array_get(sets, i), "files"), name);
    return found;
}

/* ---- a new set ---- */

static int is_listed(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

static enum br_status list_one(int folder, const char *name, json_t *files, struct br_error *err)
{
    char sum[BR_SHA256_TEXT];
    long long size;
    const int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    const bool read = file >= 0 && fsync(file) == 0 && br_sha256_file(file, &size, sum);
    br_close(file);
    if (!read)
        return br_fail(err, BR_IO, "%s could not be written whole: %s", name, strerror(errno));
    json_t *listed =
        json_pack("{s:s, s:I, s:s}", "name", name, "size", (json_int_t)size, "sha256", sum);
    if (json_array_append_new(files, listed) != 0)
        return br_no_memory(err, "the list of files");
    return BR_OK;
}

static enum br_status list_files(int folder, json_t *files, struct br_error *err)
{
    struct dirent **entry;
    const int found = scandirat(folder, ".", &entry, is_listed, alphasort);
    if (found < 0)
        return errno == ENOMEM ? br_no_memory(err, "the list of files")
                               : br_fail(err, BR_IO, "the results: %s", strerror(errno));
    enum br_status status = BR_OK;
    for (int i = 0; i < found; i++) {
        if (!status)
            status = list_one(folder, entry[i]->d_name, files, err);
        free(entry[i]);
    }
    free(entry);
    return status;
}

static size_t stem_of(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot ? (size_t)(dot - name) : strlen(name);
}

/* Whether a file of the old set has the name of a new one, whatever their formats are. */
static bool is_superseded(const json_t *old, const json_t *new)
{
    for (size_t i = 0; i < json_array_size(old); i++)
        for (size_t j = 0; j < json_array_size(new); j++) {
            const char *a = br_listed_name(json_array_get(old, i));
            const char *b = br_listed_name(json_array_get(new, j));
            const bool page = strcmp(a, BR_PAGE) == 0 || strcmp(b, BR_PAGE) == 0;
            if (!page && stem_of(a) == stem_of(b) && strncmp(a, b, stem_of(a)) == 0)
                return true;
        }
    return false;
}

/* Copies an old set, if it shares no name with the new files; where these have the page, the copy
 * loses its own, and is no set if it has nothing else. */
static void keep(json_t *sets, const json_t *set, const json_t *new)
{
    if (is_superseded(json_object_get(set, "files"), new))
        return;
    json_t *copy = json_deep_copy(set), *files = json_object_get(copy, "files");
    for (size_t i = json_array_size(files); i > 0 && find(new, BR_PAGE); i--)
        if (strcmp(br_listed_name(json_array_get(files, i - 1)), BR_PAGE) == 0)
            json_array_remove(files, i - 1);
    if (json_array_size(files))
        json_array_append(sets, copy);
    json_decref(copy);
}

enum br_status br_sets_add(int folder, const char *run, const json_t *old, json_t **sets,
                           struct br_error *err)
{
    json_t *files = json_array();
    *sets = json_array();
    enum br_status status = list_files(folder, files, err);
    for (size_t i = 0; i < json_array_size(old); i++)
        keep(*sets, json_array_get(old, i), files);
    json_array_append_new(*sets, json_pack("{s:s, s:s, s:s, s:o, s:O}", "run", run, "version",
                                           br_version(), "commit", br_commit(), "command",
                                           br_json_string(br_command_line()), "files", files));
    json_decref(files);
    return !status && br_json_lacked_memory() ? br_no_memory(err, "the manifest") : status;
}
