/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/manifest.h"

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

void br_manifest_clear(struct br_manifest *m)
{
    for (size_t i = 0; i < m->count; i++)
        free(m->file[i].name);
    free(m->file);
    json_decref(m->sets);
    *m = (struct br_manifest){.sets = NULL};
}

bool br_manifest_newest(const struct br_manifest *m, const struct br_manifest_file *f)
{
    return f->set + 1 == json_array_size(m->sets);
}

const struct br_manifest_file *br_manifest_find(const struct br_manifest *m, const char *name)
{
    for (size_t i = 0; i < m->count; i++)
        if (strcmp(m->file[i].name, name) == 0)
            return &m->file[i];
    return NULL;
}

/* ---- listing ---- */

/* Size and sum of an open file. */
static bool measure(int file, struct br_manifest_file *f)
{
    struct br_sha256 sum;
    char piece[1 << 15];
    ssize_t got;
    f->size = 0;
    br_sha256_start(&sum);
    while ((got = read(file, piece, sizeof piece)) != 0) {
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return false;
        br_sha256_add(&sum, piece, (size_t)got);
        f->size += got;
    }
    br_sha256_end(&sum, f->sha256);
    return true;
}

static enum br_status list_one(int folder, const char *name, struct br_manifest_file *f,
                               struct br_error *err)
{
    f->name = strdup(name);
    if (!f->name)
        return br_no_memory(err, "the list of files");
    const int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    const bool whole = file >= 0 && fsync(file) == 0 && measure(file, f);
    const int reason = errno;
    if (file >= 0)
        close(file);
    return whole ? BR_OK
                 : br_fail(err, BR_IO, "%s could not be written whole: %s", name, strerror(reason));
}

static int is_listed(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

enum br_status br_manifest_compare(int folder, const struct br_manifest_file *listed, bool *same,
                                   struct br_error *err)
{
    struct br_manifest_file there;
    struct stat info;
    const int file = openat(folder, listed->name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    *same = false;
    if (file < 0 && errno == ELOOP)
        return BR_OK; /* a symbolic link now */
    const bool known = file >= 0 && fstat(file, &info) == 0;
    const bool read = known && (!S_ISREG(info.st_mode) || measure(file, &there));
    const int reason = errno;
    if (file >= 0)
        close(file);
    if (!read)
        return br_fail(err, BR_IO, "%s: %s", listed->name, strerror(reason));
    *same = S_ISREG(info.st_mode) && there.size == listed->size &&
            strcmp(there.sha256, listed->sha256) == 0;
    return BR_OK;
}

/* ---- as JSON ---- */

/* An object that has so many members, or NULL: json_pack forgets those that it has no memory for.
 */
static json_t *whole(json_t *object, size_t members)
{
    if (json_object_size(object) == members)
        return object;
    json_decref(object);
    return NULL;
}

/* A name, or where it is not UTF-8, which JSON must be, "name_hex": its bytes. */
static json_t *json_of_file(const struct br_manifest_file *f)
{
    json_t *name = json_string(f->name);
    char hex[2 * 256 + 1] = "";
    for (size_t i = 0; !name && f->name[i] && i < 256; i++)
        snprintf(hex + 2 * i, 3, "%02x", (unsigned char)f->name[i]);
    json_t *file =
        json_pack("{s:o, s:I, s:s}", name ? "name" : "name_hex", name ? name : json_string(hex),
                  "size", (json_int_t)f->size, "sha256", f->sha256);
    return whole(file, 3);
}

/* The set of the files in m, all of them. */
static json_t *json_of(const struct br_manifest *m, const char *run)
{
    json_t *files = json_array();
    for (size_t i = 0; i < m->count; i++) {
        if (json_array_append_new(files, json_of_file(&m->file[i])) != 0) {
            json_decref(files);
            return NULL;
        }
    }
    json_t *set =
        json_pack("{s:s, s:s, s:s, s:o, s:o}", "run", run, "version", br_version(), "commit",
                  br_commit(), "command", br_json_string(br_command_line()), "files", files);
    return whole(set, 5);
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

static enum br_status write_text(int folder, const char *name, const char *text,
                                 struct br_error *err)
{
    static const char unfinished[] = ".unfinished";
    const int file = openat(folder, unfinished, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    const bool written = file >= 0 && br_write_whole(file, text, strlen(text));
    const int reason = errno;
    if (file >= 0)
        close(file);
    if (!written)
        return br_fail(err, BR_IO, "the manifest could not be written: %s", strerror(reason));
    if (renameat(folder, unfinished, folder, name) != 0 || fsync(folder) != 0)
        return br_fail(err, BR_IO, "the manifest: %s", strerror(errno));
    return BR_OK;
}

enum br_status br_manifest_write(int folder, const char *name, const struct br_manifest *m,
                                 struct br_error *err)
{
    json_t *json = whole(json_pack("{s:s, s:O}", "format", format, "sets", m->sets), 2);
    char *text = json ? json_dumps(json, JSON_INDENT(2)) : NULL;
    json_decref(json);
    const enum br_status status =
        text ? write_text(folder, name, text, err) : br_no_memory(err, "the manifest");
    free(text);
    return status;
}

/* false: no name. */
static bool read_name(const json_t *json, struct br_manifest_file *f, enum br_status *status)
{
    const char *name = json_string_value(json_object_get(json, "name"));
    const char *hex = json_string_value(json_object_get(json, "name_hex"));
    if (!name == !hex)
        return false;
    f->name = name ? strdup(name) : br_allocate(strlen(hex) / 2 + 1, 1);
    for (unsigned i = 0, byte; hex && f->name && sscanf(hex + 2 * i, "%2x", &byte) == 1; i++)
        f->name[i] = (char)byte;
    *status = f->name ? BR_OK : BR_NO_MEMORY;
    return true;
}

/* A name that leads elsewhere, or to what is hidden, is none of ours. */
static bool read_file(const json_t *json, struct br_manifest_file *f, enum br_status *status)
{
    const json_t *size = json_object_get(json, "size");
    const char *sum = json_string_value(json_object_get(json, "sha256"));
    if (!json_is_integer(size) || !sum || strlen(sum) != BR_SHA256_TEXT - 1 ||
        !read_name(json, f, status))
        return false;
    f->size = json_integer_value(size);
    strcpy(f->sha256, sum);
    return *status || (*f->name && *f->name != '.' && !strchr(f->name, '/'));
}

/* Adds the files of the set after those that are there. */
static bool read_set(const json_t *set, struct br_manifest *m, enum br_status *status)
{
    const json_t *files = json_object_get(set, "files");
    const size_t count = json_array_size(files), index = json_array_size(m->sets) - 1;
    struct br_manifest_file *all = realloc(m->file, (m->count + count + 1) * sizeof *all);
    *status = all ? BR_OK : BR_NO_MEMORY;
    bool ours = json_is_array(files);
    m->file = all ? all : m->file;
    for (size_t i = 0; i < count && ours && !*status; i++) {
        struct br_manifest_file *f = &m->file[m->count];
        *f = (struct br_manifest_file){.set = index};
        ours = read_file(json_array_get(files, i), f, status);
        m->count += f->name != NULL;
    }
    return ours;
}

static enum br_status add_set(json_t *set, const char *name, struct br_manifest *m,
                              struct br_error *err)
{
    enum br_status status = BR_OK;
    if (!m->sets && !(m->sets = json_array()))
        return br_no_memory(err, "a manifest");
    if (json_array_append(m->sets, set) != 0)
        return br_no_memory(err, "a manifest");
    if (!read_set(set, m, &status))
        return br_fail(err, BR_BAD_INPUT, "%s is not a manifest of this program (\"%s\")", name,
                       format);
    return status ? br_no_memory(err, "a manifest") : BR_OK;
}

static enum br_status read_json(json_t *json, const char *name, struct br_manifest *m,
                                struct br_error *err)
{
    const char *tag = json_string_value(json_object_get(json, "format"));
    const json_t *sets = json_object_get(json, "sets");
    if (!tag || strcmp(tag, format) != 0 || !json_is_array(sets))
        return br_fail(err, BR_BAD_INPUT, "%s is not a manifest of this program (\"%s\")", name,
                       format);
    enum br_status status = BR_OK;
    for (size_t i = 0; i < json_array_size(sets) && !status; i++)
        status = add_set(json_array_get(sets, i), name, m, err);
    return status;
}

enum br_status br_manifest_read(int folder, const char *name, struct br_manifest *m,
                                struct br_error *err)
{
    const int file = openat(folder, name, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0)
        return errno == ENOENT ? BR_OK : br_fail(err, BR_IO, "%s: %s", name, strerror(errno));
    struct stat info;
    const bool plain = fstat(file, &info) == 0 && S_ISREG(info.st_mode) && info.st_size < LARGEST;
    json_error_t why;
    json_t *json = plain ? br_json_read(file, &why) : NULL;
    close(file);
    const enum br_status status = read_json(json, name, m, err);
    json_decref(json);
    return status;
}

/* ---- a new set ---- */

/* The files of the open folder. */
static enum br_status list_files(int folder, struct br_manifest *m, struct br_error *err)
{
    struct dirent **entry;
    const int found = scandirat(folder, ".", &entry, is_listed, alphasort);
    if (found < 0)
        return errno == ENOMEM ? br_no_memory(err, "the list of files")
                               : br_fail(err, BR_IO, "the results: %s", strerror(errno));
    m->file = br_allocate((size_t)found, sizeof *m->file);
    enum br_status status = m->file ? BR_OK : br_no_memory(err, "the list of files");
    for (int i = 0; i < found; i++) {
        if (!status)
            status = list_one(folder, entry[i]->d_name, &m->file[m->count++], err);
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
static bool is_superseded(const struct br_manifest *old, size_t set, const struct br_manifest *new)
{
    for (size_t i = 0; i < old->count; i++)
        for (size_t j = 0; j < new->count && old->file[i].set == set; j++) {
            const char *a = old->file[i].name, *b = new->file[j].name;
            const bool page = strcmp(a, BR_PAGE) == 0 || strcmp(b, BR_PAGE) == 0;
            if (!page && stem_of(a) == stem_of(b) && strncmp(a, b, stem_of(a)) == 0)
                return true;
        }
    return false;
}

/* Takes the page from an old set where the new one has it. Whether the old one has a file left. */
static bool give_up_page(json_t *set, const struct br_manifest *new)
{
    json_t *files = json_object_get(set, "files");
    for (size_t i = json_array_size(files); i > 0 && br_manifest_find(new, BR_PAGE); i--) {
        const json_t *name = json_object_get(json_array_get(files, i - 1), "name");
        if (strcmp(json_string_value(name), BR_PAGE) == 0)
            json_array_remove(files, i - 1);
    }
    return json_array_size(files) > 0;
}

enum br_status br_manifest_list(int folder, const char *run, const struct br_manifest *old,
                                struct br_manifest *m, struct br_error *err)
{
    struct br_manifest new = {.sets = NULL};
    enum br_status status = list_files(folder, &new, err);
    for (size_t i = 0; i < json_array_size(old->sets) && !status; i++) {
        json_t *other = json_array_get(old->sets, i);
        if (!is_superseded(old, i, &new) && give_up_page(other, &new))
            status = add_set(other, "it", m, err);
    }
    json_t *set = status ? NULL : json_of(&new, run);
    if (!status)
        status = set ? add_set(set, "it", m, err) : br_no_memory(err, "the manifest");
    json_decref(set);
    br_manifest_clear(&new);
    return status;
}
