/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/manifest.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "cli/output.h"
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

/* ---- SHA-256: FIPS 180-4, section 6.2, with its letters ---- */

/* Of a stream of bytes: start it, add to it, end it once. */
struct sha256 {
    uint32_t state[8];
    uint64_t length; /* bytes so far */
    unsigned char block[64];
};

enum { SHA256_TEXT = 65 }; /* 64 hexadecimal digits, as sha256sum prints them */

static const uint32_t K[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

static uint32_t rotate(uint32_t x, int n)
{
    return x >> n | x << (32 - n);
}

/* W: the message schedule. */
static void expand(const unsigned char block[64], uint32_t W[64])
{
    for (int t = 0; t < 16; t++)
        W[t] = (uint32_t)block[4 * t] << 24 | (uint32_t)block[4 * t + 1] << 16 |
               (uint32_t)block[4 * t + 2] << 8 | block[4 * t + 3];
    for (int t = 16; t < 64; t++) {
        const uint32_t a = W[t - 15], b = W[t - 2];
        W[t] = (rotate(b, 17) ^ rotate(b, 19) ^ b >> 10) + W[t - 7] +
               (rotate(a, 7) ^ rotate(a, 18) ^ a >> 3) + W[t - 16];
    }
}

/* h: a to h of the standard. */
static void compress(uint32_t state[8], const unsigned char block[64])
{
    uint32_t W[64], h[8];
    expand(block, W);
    memcpy(h, state, sizeof h);
    for (int t = 0; t < 64; t++) {
        const uint32_t a = h[0], e = h[4];
        const uint32_t choice = (e & h[5]) ^ (~e & h[6]);
        const uint32_t majority = (a & h[1]) ^ (a & h[2]) ^ (h[1] & h[2]);
        const uint32_t first =
            h[7] + (rotate(e, 6) ^ rotate(e, 11) ^ rotate(e, 25)) + choice + K[t] + W[t];
        const uint32_t second = (rotate(a, 2) ^ rotate(a, 13) ^ rotate(a, 22)) + majority;
        memmove(h + 1, h, 7 * sizeof *h);
        h[4] += first;
        h[0] = first + second;
    }
    for (int i = 0; i < 8; i++)
        state[i] += h[i];
}

static void start_sum(struct sha256 *s)
{
    *s = (struct sha256){.state = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f,
                                   0x9b05688c, 0x1f83d9ab, 0x5be0cd19}};
}

static void add_to_sum(struct sha256 *s, const void *bytes, size_t count)
{
    const unsigned char *from = bytes;
    while (count) {
        const size_t used = s->length % 64, room = 64 - used, piece = count < room ? count : room;
        memcpy(s->block + used, from, piece);
        s->length += piece;
        from += piece;
        count -= piece;
        if (s->length % 64 == 0)
            compress(s->state, s->block);
    }
}

static void end_sum(struct sha256 *s, char text[SHA256_TEXT])
{
    static const unsigned char padding[64] = {0x80};
    const uint64_t bits = 8 * s->length;
    unsigned char size[8];
    for (int i = 0; i < 8; i++)
        size[i] = (unsigned char)(bits >> (56 - 8 * i));
    add_to_sum(s, padding, 1 + (119 - s->length % 64) % 64);
    add_to_sum(s, size, sizeof size);
    for (int i = 0; i < 8; i++)
        snprintf(text + 8 * i, 9, "%08x", s->state[i]);
}

/* ---- files ---- */

/* Size and sum of an open file. */
static bool measure(int file, long long *size, char text[SHA256_TEXT])
{
    struct sha256 sum;
    char piece[1 << 15];
    ssize_t got;
    *size = 0;
    start_sum(&sum);
    while ((got = read(file, piece, sizeof piece)) != 0) {
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return false;
        add_to_sum(&sum, piece, (size_t)got);
        *size += got;
    }
    end_sum(&sum, text);
    return true;
}

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
    char sum[SHA256_TEXT];
    long long size;
    struct stat info;
    const int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    *same = false;
    if (file < 0 && errno == ELOOP)
        return BR_OK; /* a symbolic link now */
    const bool known = file >= 0 && fstat(file, &info) == 0;
    const bool read = known && (!S_ISREG(info.st_mode) || measure(file, &size, sum));
    const int reason = errno;
    if (file >= 0)
        close(file);
    if (!read)
        return br_fail(err, BR_IO, "%s: %s", name, strerror(reason));
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

/* An object that has so many members, or NULL: json_pack forgets those that it has no memory for.
 */
static json_t *whole(json_t *object, size_t members)
{
    if (json_object_size(object) == members)
        return object;
    json_decref(object);
    return NULL;
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

enum br_status br_sets_write(int folder, const char *name, json_t *sets, struct br_error *err)
{
    json_t *json = whole(json_pack("{s:s, s:O}", "format", format, "sets", sets), 2);
    char *text = json ? json_dumps(json, JSON_INDENT(2)) : NULL;
    json_decref(json);
    const enum br_status status =
        text ? write_text(folder, name, text, err) : br_no_memory(err, "the manifest");
    free(text);
    return status;
}

/* A name that leads elsewhere, or to what is hidden, is none of ours. */
static bool is_file(const json_t *file)
{
    const char *name = br_listed_name(file), *sum = sum_of(file);
    return json_is_integer(json_object_get(file, "size")) && sum &&
           strlen(sum) == SHA256_TEXT - 1 && name && *name && *name != '.' && !strchr(name, '/');
}

static bool are_sets(const json_t *sets)
{
    bool ours = json_is_array(sets);
    for (size_t i = 0; i < json_array_size(sets) && ours; i++) {
        const json_t *files = json_object_get(json_array_get(sets, i), "files");
        ours = json_is_array(files);
        for (size_t j = 0; j < json_array_size(files) && ours; j++)
            ours = is_file(json_array_get(files, j));
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

/* Of the files of one set. */
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
    char sum[SHA256_TEXT];
    long long size;
    const int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    const bool read = file >= 0 && fsync(file) == 0 && measure(file, &size, sum);
    const int reason = errno;
    if (file >= 0)
        close(file);
    if (!read)
        return br_fail(err, BR_IO, "%s could not be written whole: %s", name, strerror(reason));
    json_t *listed = whole(
        json_pack("{s:s, s:I, s:s}", "name", name, "size", (json_int_t)size, "sha256", sum), 3);
    return json_array_append_new(files, listed) == 0 ? BR_OK
                                                     : br_no_memory(err, "the list of files");
}

/* The files of the open folder. */
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
static bool keep(json_t *sets, const json_t *set, const json_t *new)
{
    if (is_superseded(json_object_get(set, "files"), new))
        return true;
    json_t *copy = json_deep_copy(set), *files = json_object_get(copy, "files");
    for (size_t i = json_array_size(files); i > 0 && find(new, BR_PAGE); i--)
        if (strcmp(br_listed_name(json_array_get(files, i - 1)), BR_PAGE) == 0)
            json_array_remove(files, i - 1);
    const bool kept = json_array_size(files) == 0 || json_array_append(sets, copy) == 0;
    json_decref(copy);
    return kept;
}

enum br_status br_sets_add(int folder, const char *run, const json_t *old, json_t **sets,
                           struct br_error *err)
{
    json_t *files = json_array();
    *sets = json_array();
    enum br_status status =
        files && *sets ? list_files(folder, files, err) : br_no_memory(err, "the list of files");
    bool kept = true;
    for (size_t i = 0; i < json_array_size(old) && kept && !status; i++)
        kept = keep(*sets, json_array_get(old, i), files);
    json_t *set =
        whole(json_pack("{s:s, s:s, s:s, s:o, s:O}", "run", run, "version", br_version(), "commit",
                        br_commit(), "command", br_json_string(br_command_line()), "files", files),
              5);
    if (json_array_append_new(*sets, set) != 0 && !status)
        kept = false;
    json_decref(files);
    return !kept ? br_no_memory(err, "the manifest") : status;
}
