/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/map.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#include "study/grid/each.h"

/* ---- the file in which verdicts are kept as they come, a line each, so that a run that was ended
 * may go on. Its first line tells the program, the seed and the judging options. ---- */

enum { LINE = 512 };

static void head_of(const struct br_extreme_request *w, char head[LINE])
{
    snprintf(head, LINE, "beamrate extremes map 2, %.300s, seed %llu, rounding %d%s\n", w->program,
             (unsigned long long)w->seed, w->judging.rounding, w->judging.quick ? ", quick" : "");
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

/* Hours of work of another seed, program or kind of judging are not thrown away. */
static enum br_status check_head(const struct br_extreme_request *w, const char *found,
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

static enum br_status read_kept(const struct br_extreme_request *w,
                                struct br_extreme_verdict *verdict, bool *done,
                                struct br_error *err)
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
static enum br_status write_kept(const struct br_extreme_request *w,
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

/* Reads what is there of the request's cases: verdict[i] and done[i] (out). A last line without an
 * end counts as nothing; the file is then whole, and open for more lines: *file (out), NULL where
 * the request keeps nothing. Fails with BR_BAD_INPUT where it has the cases of other options, which
 * the message names, and does not touch it; with BR_IO or BR_NO_MEMORY. */
static enum br_status open_kept(const struct br_extreme_request *w,
                                struct br_extreme_verdict *verdict, bool *done, FILE **file,
                                struct br_error *err)
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

/* Adds a line; whole in the file when it returns. */
static enum br_status add_kept(FILE *file, size_t index, const struct br_extreme_verdict *verdict,
                               struct br_error *err)
{
    if (!file)
        return BR_OK;
    print(file, index, verdict);
    return fflush(file) == 0 ? BR_OK : br_fail(err, BR_IO, "the kept cases: %s", strerror(errno));
}

/* ---- cases ---- */

struct work {
    const struct br_extreme_request *request;
    struct br_extreme_map *map;
    bool *done;
    FILE *kept;
};

bool br_extreme_stopped(const struct br_extreme_request *w)
{
    return w->observer && w->observer->stop && w->observer->stop(w->observer->self);
}

enum br_status br_extreme_ask(const struct br_extreme_request *w, const struct br_extreme_case *one,
                              struct br_extreme_verdict *verdict, struct br_error *err)
{
    return (w->judge ? w->judge : br_extreme_judge)(one, &w->judging, verdict, err);
}

static enum br_status do_case(void *self, size_t i, struct br_error *err)
{
    struct work *work = self;
    struct br_extreme_map *m = work->map;
    br_extreme_draw(m->seed, i, &m->one[i]);
    if (work->done[i])
        return BR_OK;
    enum br_status status = br_extreme_ask(work->request, &m->one[i], &m->verdict[i], err);
    if (!status) {
#pragma omp critical(extreme_map)
        status = add_kept(work->kept, i, &m->verdict[i], err);
    }
    return status;
}

/* ---- those that are wrong ---- */

static enum br_status write_scene(const struct br_extreme_request *w, struct br_extreme_shrunk *s,
                                  struct br_error *err)
{
    char text[BR_EXTREME_TEXT], path[4096];
    snprintf(s->file, sizeof s->file, "wrong-%zu.yaml", s->one.index);
    br_extreme_command(&s->one, s->file, s->command);
    if (!w->folder)
        return BR_OK;
    snprintf(path, sizeof path, "%s/%s", w->folder, s->file);
    br_extreme_scene(&s->one, text);
    FILE *file = fopen(path, "w");
    if (!file)
        return br_fail(err, BR_IO, "%.900s: %s", path, strerror(errno));
    fprintf(file, "# Silently wrong: %s\n%s", s->verdict.why, text);
    const bool failed = ferror(file) != 0;
    return fclose(file) == 0 && !failed ? BR_OK
                                        : br_fail(err, BR_IO, "%.900s: %s", path, strerror(errno));
}

static enum br_status shrink(void *self, size_t i, struct br_error *err)
{
    const struct work *work = self;
    struct br_extreme_shrunk *s = &work->map->shrunk[i];
    enum br_status status = br_extreme_shrink(work->request, &s->one, err);
    if (!status)
        status = br_extreme_ask(work->request, &s->one, &s->verdict, err);
    return status ? status : write_scene(work->request, s, err);
}

static enum br_status shrink_all(struct work *work, struct br_error *err)
{
    struct br_extreme_map *m = work->map;
    for (size_t i = 0; i < m->cases && m->shrunks < BR_EXTREME_MOST_SHRUNK; i++)
        if (m->verdict[i].which == BR_EXTREME_WRONG)
            m->shrunk[m->shrunks++] =
                (struct br_extreme_shrunk){.one = m->one[i], .verdict = m->verdict[i]};
    const struct br_each each = {
        .count = m->shrunks, .threads = work->request->threads, .turn = shrink, .self = work};
    return br_each(&each, err);
}

/* ---- all ---- */

static enum br_status run(struct work *work, struct br_error *err)
{
    struct br_extreme_map *m = work->map;
    enum br_status status = open_kept(work->request, m->verdict, work->done, &work->kept, err);
    for (size_t i = 0; i < m->cases; i++)
        m->resumed += work->done[i];
    const struct br_each each = {.count = m->cases,
                                 .threads = work->request->threads,
                                 .observer = work->request->observer,
                                 .turn = do_case,
                                 .self = work};
    if (!status)
        status = br_each(&each, err);
    if (work->kept)
        fclose(work->kept);
    if (status)
        return status;
    for (size_t i = 0; i < m->cases; i++)
        m->count[m->verdict[i].which]++;
    return shrink_all(work, err);
}

enum br_status br_extreme_map_run(const struct br_extreme_request *request,
                                  struct br_extreme_map *map, struct br_error *err)
{
    *map = (struct br_extreme_map){.seed = request->seed, .cases = request->cases};
    struct work work = {.request = request, .map = map};
    map->one = br_allocate(request->cases, sizeof *map->one);
    map->verdict = br_allocate(request->cases, sizeof *map->verdict);
    map->shrunk = br_allocate(BR_EXTREME_MOST_SHRUNK, sizeof *map->shrunk);
    work.done = br_allocate(request->cases, sizeof *work.done);
    enum br_status status = BR_OK;
    if (!map->one || !map->verdict || !map->shrunk || !work.done)
        status = br_no_memory(err, "the map");
    else
        status = run(&work, err);
    free(work.done);
    return status;
}

void br_extreme_map_clear(struct br_extreme_map *map)
{
    free(map->one);
    free(map->verdict);
    free(map->shrunk);
    *map = (struct br_extreme_map){0};
}
