/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/cache.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/quote.h"

enum {
    SUM = BR_SHA256_TEXT, /* of all that follows, in a line of its own */
    LARGEST = 1 << 26     /* bytes */
};

static atomic_bool finished_work;

bool br_cache_has_work(void)
{
    return atomic_load(&finished_work);
}

/* Of a cache: the path of an entry, or of its unfinished file. */
static void name(const struct br_cache *k, const char *text, bool finished, char path[1300])
{
    char key[BR_SHA256_TEXT];
    br_sha256_of(text, strlen(text), key);
    if (finished)
        snprintf(path, 1300, "%s/%s", k->folder, key);
    else
        snprintf(path, 1300, "%s/.%s.%ld", k->folder, key, (long)getpid());
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

/* The numbers in a whole file, if it is the entry of that text. */
static struct br_record open_record(const char *file, size_t size, const char *text)
{
    const size_t head = SUM + strlen(text) + 1;
    char sum[BR_SHA256_TEXT];
    if (!file || size < head)
        return (struct br_record){.wrong = true};
    br_sha256_of(file + SUM, size - SUM, sum);
    sum[SUM - 1] = '\n';
    return (struct br_record){
        .from = file + head,
        .left = size - head,
        .wrong = memcmp(file, sum, SUM) != 0 || strcmp(file + SUM, text) != 0,
    };
}

bool br_cache_take(const struct br_cache *k, const char *text, br_record_pass *pass_all, void *self)
{
    char path[1300];
    if (!k || !text || !*k->folder || !k->take)
        return false;
    name(k, text, true, path);
    if (access(path, F_OK) != 0)
        return false;
    size_t size = 0;
    char *file = read_file(path, &size);
    struct br_record record = open_record(file, size, text);
    if (!record.wrong)
        pass_all(&record, self);
    free(file);
    const bool taken = !record.wrong && record.left == 0;
    if (taken)
        atomic_store(&finished_work, true);
    return taken;
}

/* Does not wait for the disk: an entry that a crash leaves incomplete is found by its sum. */
static bool write_file(const char *path, const char *bytes, size_t size)
{
    char sum[BR_SHA256_TEXT];
    FILE *file = fopen(path, "we");
    if (!file)
        return false;
    br_sha256_of(bytes, size, sum);
    const bool written = fprintf(file, "%s\n", sum) > 0 && fwrite(bytes, size, 1, file) == 1;
    return (fclose(file) == 0) & written;
}

static bool put_in_place(const struct br_cache *k, const char *text, const char *bytes, size_t size)
{
    char unfinished[1300], finished[1300];
    name(k, text, false, unfinished);
    name(k, text, true, finished);
    mkdir(k->folder, 0777); /* only where there is something to keep */
    if (write_file(unfinished, bytes, size) && rename(unfinished, finished) == 0) {
        atomic_store(&finished_work, true);
        return true;
    }
    const int reason = errno;
    unlink(unfinished);
    errno = reason;
    return false;
}

bool br_cache_put(const struct br_cache *k, const char *text, br_record_pass *pass_all, void *self)
{
    char *bytes = NULL;
    size_t size;
    if (!k || !*k->folder)
        return true;
    struct br_record record = {.to = text ? br_text_open(&bytes, &size) : NULL};
    bool written = false;
    if (record.to) {
        br_record_bytes(&record, (char *)text, strlen(text) + 1);
        if (!record.wrong)
            pass_all(&record, self);
        written = fclose(record.to) == 0 && (record.wrong || put_in_place(k, text, bytes, size));
    }
    free(bytes);
    return written;
}
