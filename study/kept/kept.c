/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/kept/kept.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "study/base/quote.h"
#include "study/base/text.h"

static const double usual_slice = 2, usual_reference = 0.1;

enum {
    SUM = BR_SHA256_TEXT, /* of all that follows, in a line of its own */
    LARGEST = 1 << 26     /* bytes */
};

enum br_status br_kept_open(struct br_kept *k, const char *folder, bool take, const char *machine,
                            struct br_error *err)
{
    long long size;
    const int self = open("/proc/self/exe", O_RDONLY | O_CLOEXEC);
    const bool read = self >= 0 && br_sha256_file(self, &size, k->program);
    if (self >= 0)
        close(self);
    if (!read)
        return br_fail(err, BR_IO, "the program cannot be read, so that no work can be kept: %s",
                       strerror(errno));
    snprintf(k->folder, sizeof k->folder, "%.1000s/.kept", folder);
    k->take = take;
    k->slice = usual_slice;
    k->most_reference = usual_reference;
    k->machine = machine;
    return BR_OK;
}

void br_kept_begin(const struct br_kept *k, const char *work, struct br_statement *text)
{
    br_statement_begin(text);
    br_state(text, "beamrate-kept", "%s", "3");
    br_state(text, "program", "%s", k->program);
    br_state(text, "machine", "%s", k->machine ? k->machine : "");
    br_state(text, "work", "%s", work);
}

/* ---- the numbers of an entry ---- */

static void pass_bytes(struct br_record *r, void *bytes, size_t size)
{
    if (r->wrong || size == 0)
        return;
    if (!r->from)
        r->wrong = fwrite(bytes, size, 1, r->to) != 1;
    else if (size > r->left)
        r->wrong = true;
    else {
        memcpy(bytes, r->from, size);
        r->from += size;
        r->left -= size;
    }
}

static void pass(struct br_record *r, double *x, double low, double high, bool or_nan)
{
    double value = *x;
    pass_bytes(r, &value, sizeof value);
    r->wrong |= !((value >= low && value <= high && isfinite(value)) || (or_nan && isnan(value)));
    if (!r->wrong)
        *x = value;
}

void br_record_number(struct br_record *r, double *x, double low, double high)
{
    pass(r, x, low, high, false);
}

void br_record_or_nan(struct br_record *r, double *x, double low, double high)
{
    pass(r, x, low, high, true);
}

void br_record_count(struct br_record *r, size_t *count, size_t low, size_t high)
{
    size_t value = *count;
    pass_bytes(r, &value, sizeof value);
    r->wrong |= value < low || value > high;
    if (!r->wrong)
        *count = value;
}

void br_record_flag(struct br_record *r, bool *flag)
{
    size_t value = *flag;
    br_record_count(r, &value, 0, 1);
    *flag = value == 1;
}

void br_record_text(struct br_record *r, char **text, size_t most)
{
    const bool reads = r->from;
    size_t size = !reads && *text ? strlen(*text) : 0;
    br_record_count(r, &size, 0, reads && r->left < most ? r->left : most);
    if (reads)
        *text = r->wrong ? NULL : br_allocate(size + 1, 1);
    r->wrong |= reads && !*text;
    pass_bytes(r, *text, size);
    r->wrong |= reads && *text && (strlen(*text) != size || br_not_utf8(*text));
}

/* ---- entries ---- */

/* Of a kept folder: the path of an entry, or of its unfinished file. */
static void name(const struct br_kept *k, const char *text, bool finished, char path[1300])
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

bool br_kept_take(struct br_kept *k, const char *text, br_record_pass *pass_all, void *self)
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
    if (!record.wrong && record.left == 0)
        return true;
    atomic_fetch_add(&k->bad, 1);
    return false;
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

static bool put_in_place(const struct br_kept *k, const char *text, const char *bytes, size_t size)
{
    char unfinished[1300], finished[1300];
    name(k, text, false, unfinished);
    name(k, text, true, finished);
    mkdir(k->folder, 0777); /* only where there is something to keep */
    if (write_file(unfinished, bytes, size) && rename(unfinished, finished) == 0)
        return true;
    const int reason = errno;
    unlink(unfinished);
    errno = reason;
    return false;
}

bool br_kept_put(struct br_kept *k, const char *text, br_record_pass *pass_all, void *self)
{
    char *bytes = NULL;
    size_t size;
    if (!k || !*k->folder)
        return true;
    struct br_record record = {.to = text ? br_text_open(&bytes, &size) : NULL};
    bool kept = false;
    if (record.to) {
        pass_bytes(&record, (char *)text, strlen(text) + 1);
        if (!record.wrong)
            pass_all(&record, self);
        kept = fclose(record.to) == 0 && (record.wrong || put_in_place(k, text, bytes, size));
    }
    free(bytes);
    if (!kept)
        atomic_fetch_add(&k->lost, 1);
    return kept;
}
