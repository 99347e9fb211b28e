/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/kept/kept.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "study/scene/method_fields.h"

static const char format[] = "beamrate kept 1\n";

static const double usual_slice = 2, usual_reference = 0.1;

enum {
    SUM = BR_SHA256_TEXT - 1,
    HEAD = sizeof format - 1 + 2 * (SUM + 1), /* format, key, sum of the bytes, a line each */
    LARGEST = 1 << 26                         /* bytes */
};

/* ---- names ---- */

/* With its final 0, so that different lists of texts have different bytes. */
void br_kept_add(struct br_sha256 *base, const char *text)
{
    br_sha256_add(base, text, strlen(text) + 1);
}

enum br_status br_kept_open(struct br_kept *k, const char *folder, bool take, const char *machine,
                            struct br_error *err)
{
    char program[BR_SHA256_TEXT];
    long long size;
    const int self = open("/proc/self/exe", O_RDONLY | O_CLOEXEC);
    const bool read = self >= 0 && br_sha256_file(self, &size, program);
    if (self >= 0)
        close(self);
    if (!read)
        return br_fail(err, BR_IO, "the program cannot be read, so that no work can be kept: %s",
                       strerror(errno));
    snprintf(k->folder, sizeof k->folder, "%.1000s/.kept", folder);
    k->take = take;
    k->slice = usual_slice;
    k->most_reference = usual_reference;
    br_sha256_start(&k->base);
    br_kept_add(&k->base, format);
    br_kept_add(&k->base, program);
    br_kept_add(&k->base, machine);
    return BR_OK;
}

void br_kept_key(const struct br_sha256 *base, const char *work, char key[BR_SHA256_TEXT])
{
    struct br_sha256 sum = *base;
    br_kept_add(&sum, work);
    br_sha256_end(&sum, key);
}

const char *br_kept_method(const struct br_method *m, char text[BR_KEPT_METHOD])
{
    char value[BR_METHOD_VALUE];
    snprintf(text, BR_KEPT_METHOD, "rounding %d", m->rounding);
    for (const struct br_method_field *f = br_method_fields;
         f < br_method_fields + BR_METHOD_FIELDS; f++)
        br_append(text, BR_KEPT_METHOD, " %s %s", f->name, br_method_field_text(f, m, value));
    return text;
}

/* ---- entries ---- */

static void sum_of(const void *bytes, size_t size, char text[BR_SHA256_TEXT])
{
    struct br_sha256 sum;
    br_sha256_start(&sum);
    br_sha256_add(&sum, bytes, size);
    br_sha256_end(&sum, text);
}

static void write_head(char head[HEAD + 1], const char *key, const void *bytes, size_t size)
{
    char sum[BR_SHA256_TEXT];
    sum_of(bytes, size, sum);
    snprintf(head, HEAD + 1, "%s%s\n%s\n", format, key, sum);
}

/* Whether a whole file is the entry of that name. */
static bool is_entry(const char *file, size_t size, const char *key)
{
    char head[HEAD + 1];
    if (size < HEAD)
        return false;
    write_head(head, key, file + HEAD, size - HEAD);
    return memcmp(file, head, HEAD) == 0;
}

/* All of a regular file; NULL: it is not there, or cannot be read. */
static char *read_file(const char *path, size_t *size)
{
    struct stat info;
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    const bool plain =
        file >= 0 && fstat(file, &info) == 0 && S_ISREG(info.st_mode) && info.st_size <= LARGEST;
    char *text = plain ? br_allocate((size_t)info.st_size + 1, 1) : NULL;
    size_t done = 0;
    for (ssize_t got = 1; text && got > 0 && done < (size_t)info.st_size;) {
        got = read(file, text + done, (size_t)info.st_size - done);
        done += got > 0 ? (size_t)got : 0;
    }
    if (file >= 0)
        close(file);
    *size = done;
    return text;
}

bool br_kept_read(struct br_kept *k, const char *key, void **bytes, size_t *size)
{
    char path[1300];
    *bytes = NULL;
    if (!k || !*k->folder || !k->take)
        return false;
    snprintf(path, sizeof path, "%s/%s", k->folder, key);
    if (access(path, F_OK) != 0)
        return false;
    size_t whole = 0;
    char *file = read_file(path, &whole);
    if (!file || !is_entry(file, whole, key)) {
        free(file);
        atomic_fetch_add(&k->bad, 1);
        return false;
    }
    *size = whole - HEAD;
    memmove(file, file + HEAD, *size);
    *bytes = file;
    return true;
}

bool br_kept_read_into(struct br_kept *k, const char *key, void *into, size_t size)
{
    void *bytes;
    size_t found = 0;
    if (!br_kept_read(k, key, &bytes, &found))
        return false;
    if (found == size)
        memcpy(into, bytes, size);
    free(bytes);
    return found == size;
}

/* Does not wait for the disk: an entry that a crash leaves incomplete is found by its sum. */
static bool write_file(const char *path, const char *head, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "we");
    if (!file)
        return false;
    const bool written =
        fwrite(head, HEAD, 1, file) == 1 && (size == 0 || fwrite(bytes, size, 1, file) == 1);
    return (fclose(file) == 0) & written;
}

bool br_kept_write(struct br_kept *k, const char *key, const void *bytes, size_t size)
{
    char head[HEAD + 1], unfinished[1300], finished[1300];
    if (!k || !*k->folder)
        return true;
    write_head(head, key, bytes, size);
    snprintf(finished, sizeof finished, "%s/%s", k->folder, key);
    snprintf(unfinished, sizeof unfinished, "%s/.%s.%ld", k->folder, key, (long)getpid());
    mkdir(k->folder, 0777); /* only where there is something to keep */
    if (write_file(unfinished, head, bytes, size) && rename(unfinished, finished) == 0)
        return true;
    const int reason = errno;
    unlink(unfinished);
    errno = reason;
    atomic_fetch_add(&k->lost, 1);
    return false;
}
