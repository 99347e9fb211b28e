/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/kept.h"

#include <errno.h>
#include <math.h>
#include <string.h>

enum { LINE = 512 };

static void head_of(const struct br_extreme_wish *w, char head[LINE])
{
    snprintf(head, LINE, "beamrate extremes map 2, %.300s, seed %llu, rounding %d%s\n", w->program,
             (unsigned long long)w->seed, w->court.rounding, w->court.quick ? ", quick" : "");
}

static void print(FILE *file, size_t index, const struct br_extreme_verdict *v)
{
    fprintf(file, "%zu %s %d %d %.17g %.17g %.17g %.17g %u;%s\n", index, br_extreme_word(v->which),
            (int)v->by, (int)v->known, v->error, v->stated, v->units, v->round_off, v->warned,
            v->why);
}

static bool find_class(const char *word, enum br_extreme_class *which)
{
    for (int i = 0; i < BR_EXTREME_CLASSES; i++)
        if (strcmp(br_extreme_word((enum br_extreme_class)i), word) == 0) {
            *which = (enum br_extreme_class)i;
            return true;
        }
    return false;
}

/* Whether the line is a verdict. */
static bool scan(const char *line, size_t *index, struct br_extreme_verdict *v)
{
    char word[32];
    int by, known, used = 0;
    *v = (struct br_extreme_verdict){0};
    if (sscanf(line, "%zu %31s %d %d %lf %lf %lf %lf %u;%n", index, word, &by, &known, &v->error,
               &v->stated, &v->units, &v->round_off, &v->warned, &used) != 9 ||
        used == 0 || by < BR_BY_NOBODY || by > BR_BY_REFINEMENT || !find_class(word, &v->which))
        return false;
    v->by = (enum br_extreme_by)by;
    v->known = known != 0;
    snprintf(v->why, sizeof v->why, "%.*s", (int)strcspn(line + used, "\n"), line + used);
    return true;
}

/* Hours of work of another seed, program or kind of court are not thrown away. */
static enum br_status check_head(const struct br_extreme_wish *w, const char *found,
                                 struct br_error *err)
{
    char head[LINE];
    head_of(w, head);
    if (strcmp(found, head) == 0)
        return BR_OK;
    return br_fail(
        err, BR_BAD_INPUT,
        "%.300s: found the cases of '%.*s', expected those of '%.*s': repeat its options, "
        "or remove the file to begin anew",
        w->kept, (int)strcspn(found, "\n"), found, (int)strcspn(head, "\n"), head);
}

static enum br_status read_kept(const struct br_extreme_wish *w, struct br_extreme_verdict *verdict,
                                bool *done, struct br_error *err)
{
    char line[LINE];
    FILE *file = fopen(w->kept, "r");
    if (!file)
        return errno == ENOENT ? BR_OK
                               : br_fail(err, BR_IO, "%.900s: %s", w->kept, strerror(errno));
    enum br_status status = BR_OK;
    if (fgets(line, sizeof line, file))
        status = check_head(w, line, err);
    while (!status && fgets(line, sizeof line, file)) {
        struct br_extreme_verdict v;
        size_t index;
        if (strchr(line, '\n') && scan(line, &index, &v) && index < w->cases) {
            verdict[index] = v;
            done[index] = true;
        }
    }
    fclose(file);
    return status;
}

/* Whole at every moment: under another name first. */
static enum br_status write_kept(const struct br_extreme_wish *w,
                                 const struct br_extreme_verdict *verdict, const bool *done,
                                 struct br_error *err)
{
    char head[LINE], path[4096];
    if ((size_t)snprintf(path, sizeof path, "%s.new", w->kept) >= sizeof path)
        return br_fail(err, BR_IO, "%.200s...: the name is too long", w->kept);
    FILE *file = fopen(path, "w");
    if (!file)
        return br_fail(err, BR_IO, "%.900s: %s", path, strerror(errno));
    head_of(w, head);
    fputs(head, file);
    for (size_t i = 0; i < w->cases; i++)
        if (done[i])
            print(file, i, &verdict[i]);
    const bool failed = ferror(file) != 0;
    if (fclose(file) != 0 || failed || rename(path, w->kept) != 0)
        return br_fail(err, BR_IO, "%.900s: %s", path, strerror(errno));
    return BR_OK;
}

enum br_status br_kept_open(const struct br_extreme_wish *w, struct br_extreme_verdict *verdict,
                            bool *done, FILE **file, struct br_error *err)
{
    *file = NULL;
    if (!w->kept)
        return BR_OK;
    enum br_status status = read_kept(w, verdict, done, err);
    if (!status)
        status = write_kept(w, verdict, done, err);
    if (status)
        return status;
    *file = fopen(w->kept, "a");
    return *file ? BR_OK : br_fail(err, BR_IO, "%.900s: %s", w->kept, strerror(errno));
}

enum br_status br_kept_add(FILE *file, size_t index, const struct br_extreme_verdict *verdict,
                           struct br_error *err)
{
    if (!file)
        return BR_OK;
    print(file, index, verdict);
    return fflush(file) == 0 ? BR_OK : br_fail(err, BR_IO, "the kept cases: %s", strerror(errno));
}
