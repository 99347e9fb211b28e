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

/* Describes a file for the list of a set; with `wait`, after it is on the disk. NULL with errno;
 * ELOOP: it is no plain file but, for example, a symbolic link. */
static json_t *describe(int folder, const char *name, bool wait)
{
    char sum[BR_SHA256_TEXT];
    long long size;
    struct stat info;
    const int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    const bool known = file >= 0 && fstat(file, &info) == 0, plain = known && S_ISREG(info.st_mode);
    const bool read = plain && (!wait || fsync(file) == 0) && br_sha256_file(file, &size, sum);
    br_close(file);
    errno = known && !plain ? ELOOP : errno;
    return read
               ? json_pack("{s:s, s:I, s:s}", "name", name, "size", (json_int_t)size, "sha256", sum)
               : NULL;
}

enum br_status br_listed_compare(int folder, const json_t *listed, bool *same, struct br_error *err)
{
    const char *name = br_listed_name(listed);
    errno = 0;
    json_t *now = describe(folder, name, false);
    const bool read = now || errno == ELOOP;
    *same = now && json_equal(now, listed);
    json_decref(now);
    return read ? BR_OK : br_fail(err, BR_IO, "%s: %s", name, strerror(errno));
}

/* ---- reading and writing ---- */

enum br_status br_sets_write(int folder, const char *name, json_t *sets, struct br_error *err)
{
    json_t *json = json_pack("{s:s, s:O}", "format", format, "sets", sets);
    char *text = json ? json_dumps(json, JSON_INDENT(2)) : NULL;
    json_decref(json);
    if (!text || br_json_lacked_memory()) {
        free(text);
        return br_no_memory(err, "the manifest");
    }
    const bool written = br_put_whole(folder, name, br_new_permissions(0666), text, strlen(text)) &&
                         fsync(folder) == 0;
    free(text);
    return written ? BR_OK
                   : br_fail(err, BR_IO, "the manifest could not be written: %s", strerror(errno));
}

/* No set lists a name with a folder, or a hidden one. */
static bool is_listed(const json_t *file)
{
    const char *name = br_listed_name(file);
    const char *sum = json_string_value(json_object_get(file, "sha256"));
    return json_is_integer(json_object_get(file, "size")) && sum &&
           strlen(sum) == BR_SHA256_TEXT - 1 && name && *name && *name != '.' && !strchr(name, '/');
}

static bool are_sets(const json_t *sets)
{
    size_t i, j;
    json_t *set, *file;
    bool ours = json_is_array(sets);
    json_array_foreach(sets, i, set)
    {
        ours = ours && json_is_array(json_object_get(set, "files"));
        json_array_foreach(json_object_get(set, "files"), j, file) ours = ours && is_listed(file);
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

json_t *br_sets_find(const json_t *sets, const char *name)
{
    size_t s, i;
    json_t *set, *file;
    json_array_foreach(sets, s, set) json_array_foreach(json_object_get(set, "files"), i, file)
    {
        if (strcmp(br_listed_name(file), name) == 0)
            return file;
    }
    return NULL;
}

/* ---- a new set ---- */

static int is_visible(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

static enum br_status list_files(int folder, json_t *files, struct br_error *err)
{
    struct dirent **entry;
    const int found = scandirat(folder, ".", &entry, is_visible, alphasort);
    if (found < 0)
        return errno == ENOMEM ? br_no_memory(err, "the list of files")
                               : br_fail(err, BR_IO, "the results: %s", strerror(errno));
    enum br_status status = BR_OK;
    for (int i = 0; i < found; i++) {
        errno = ENOMEM;
        if (!status && json_array_append_new(files, describe(folder, entry[i]->d_name, true)) != 0)
            status =
                br_fail(err, errno == ENOMEM ? BR_NO_MEMORY : BR_IO,
                        "%s could not be written whole: %s", entry[i]->d_name, strerror(errno));
        free(entry[i]);
    }
    free(entry);
    return status;
}

bool br_same_stem(const char *a, const char *b)
{
    const char *end = strrchr(a, '.'), *other = strrchr(b, '.');
    const size_t length = end ? (size_t)(end - a) : strlen(a);
    return length == (other ? (size_t)(other - b) : strlen(b)) && strncmp(a, b, length) == 0;
}

/* Whether a file of the old set has the name of a new one, whatever their formats are. */
static bool is_superseded(const json_t *old, const json_t *new)
{
    size_t i, j;
    json_t *was, *is;
    json_array_foreach(old, i, was) json_array_foreach(new, j, is)
    {
        const char *a = br_listed_name(was), *b = br_listed_name(is);
        if (strcmp(a, BR_PAGE) != 0 && strcmp(b, BR_PAGE) != 0 && br_same_stem(a, b))
            return true;
    }
    return false;
}

/* Copies an old set, if it shares no name with the new files. If the new files have the page, the
 * copy loses its page, and is dropped if it has no other file. */
static void keep(json_t *sets, const json_t *set, const json_t *new, bool page)
{
    size_t i;
    json_t *file, *copy = json_deep_copy(set), *files = json_object_get(copy, "files");
    json_array_foreach(files, i, file)
    {
        if (page && strcmp(br_listed_name(file), BR_PAGE) == 0)
            json_array_remove(files, i--);
    }
    if (json_array_size(files) && !is_superseded(files, new))
        json_array_append(sets, copy);
    json_decref(copy);
}

enum br_status br_sets_add(int folder, const char *run, const json_t *old, json_t **sets,
                           struct br_error *err)
{
    size_t i;
    json_t *set, *files = json_array();
    json_t *new =
        json_pack("{s:s, s:s, s:s, s:o, s:O}", "run", run, "version", br_version(), "commit",
                  br_commit(), "command", br_json_string(br_command_line()), "files", files);
    *sets = json_pack("[O]", new);
    const enum br_status status = list_files(folder, files, err);
    const bool page = br_sets_find(*sets, BR_PAGE);
    json_array_clear(*sets);
    json_array_foreach(old, i, set) keep(*sets, set, files, page);
    json_array_append_new(*sets, new);
    json_decref(files);
    return !status && br_json_lacked_memory() ? br_no_memory(err, "the manifest") : status;
}
