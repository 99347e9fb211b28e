/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cuts studies into slices of some cells, deals these into batches, marches a batch, and turns its
 * results into bytes. */
#include "study/grid/batches.h"

#include <math.h>
#include <stdint.h>

#include "base/statement.h"
#include "base/text.h"
#include "solver/scene.h"
#include "study/grid/costs.h"
#include "study/grid/sweep.h"

/* ---- slices of a study ---- */

struct priced {
    double cost;
    size_t index;
};

static int dearest_first(const void *a, const void *b)
{
    const struct priced *x = a, *y = b;
    if (x->cost != y->cost)
        return x->cost < y->cost ? 1 : -1;
    return (x->index > y->index) - (x->index < y->index);
}

static size_t least(const double *load, size_t count)
{
    size_t best = 0;
    for (size_t i = 1; i < count; i++)
        best = load[i] < load[best] ? i : best;
    return best;
}

/* The dearest cell first, each to the slice with the least work (Graham 1969). */
double br_slice_cells(const struct br_study *s, size_t slices, size_t *slice)
{
    const size_t cells = br_study_cells(s);
    struct priced *cell = br_allocate(cells, sizeof *cell);
    double *load = br_allocate(slices, sizeof *load), most = -1;
    for (size_t i = 0; cell && i < cells; i++)
        cell[i] = (struct priced){br_cell_seconds(s, i), i};
    if (cell && load)
        qsort(cell, cells, sizeof *cell, dearest_first);
    for (size_t i = 0; cell && load && i < cells; i++) {
        const size_t to = least(load, slices);
        slice[cell[i].index] = to;
        load[to] += cell[i].cost;
        most = load[to] > most ? load[to] : most;
    }
    free(cell);
    free(load);
    return most;
}

/* ---- how many slices ---- */

/* A study, cut. */
struct cut {
    size_t slices; /* 0: it has failed */
    double cost;   /* of its dearest slice, reference included, about, s */
};

static double whole_cost(const struct br_study *s, double *dearest)
{
    double cost = br_reference_seconds(s);
    *dearest = 0;
    for (size_t i = 0; i < br_study_cells(s); i++) {
        const double cell = br_cell_seconds(s, i);
        cost += cell;
        *dearest = fmax(*dearest, cell);
    }
    return cost;
}

/* Cuts a study into ever more slices, as long as one is dearer than `most`, so that ranks would
 * wait for it. idle: with fewer of them ranks would have nothing to do.
 *
 * A slice marches some of the cells, and the whole reference again. So it pays where the reference
 * is cheap beside the cells, or where ranks would have nothing to do, and a slice ends clearly
 * sooner. The cells of a study with a much finer reference stay together: its reference is the
 * work.
 *
 * The reference could also be computed by one rank and broadcast. Measured on 4 ranks of one
 * machine, that saves a tenth at most, by the fastest of networks, and loses with more ranks: its
 * owner is spared its share of the cells, but sends 48 bytes an element of every mesh and time
 * level. */
static struct cut cut(const struct br_study *s, double most, size_t idle)
{
    const double reference = br_reference_seconds(s);
    double dearest;
    struct cut cut = {1, whole_cost(s, &dearest)};
    const double cells = cut.cost - reference;
    while (cut.slices < br_study_cells(s) && cut.cost > most) {
        const double next = reference + fmax(cells / (double)(cut.slices + 1), dearest);
        const bool pays = cut.slices < idle || reference < 0.1 * (cut.cost - reference);
        if (next > 0.9 * cut.cost || !pays)
            break;
        cut = (struct cut){cut.slices + 1, next};
    }
    return cut;
}

/* ---- batches ---- */

/* The dearest slices come first: each batch gets as many as a rank has threads, or a rank's share
 * of those that are left. slice: in; batch: of each slice, out. */
static void deal(struct br_batches *b, const struct priced *slice, size_t slices, size_t ranks,
                 size_t threads, size_t *batch)
{
    for (size_t done = 0; done < slices; b->count++) {
        const size_t share = (slices - done + ranks - 1) / ranks;
        for (const size_t end = done + (share < threads ? share : threads); done < end; done++) {
            batch[slice[done].index] = b->count;
            b->cost[b->count] += slice[done].cost;
        }
    }
}

enum br_status br_batches_create(struct br_batches *b, const struct br_study *studies, size_t count,
                                 int ranks, int threads, struct br_error *err)
{
    size_t cells = 0, sound = 0, slices = 0;
    double total = 0, most = 0; /* no rank is done before the longest slice of one cell */
    for (size_t s = 0; s < count; s++) {
        cells += br_study_cells(&studies[s]);
        if (studies[s].failure.status)
            continue;
        double dearest;
        total += whole_cost(&studies[s], &dearest);
        most = fmax(most, br_reference_seconds(&studies[s]) + dearest);
        sound++;
    }
    most = fmax(most, total / (2 * ranks));
    /* A cell is in one slice, so there are no more slices than cells. */
    struct priced *slice = br_allocate(cells, sizeof *slice);
    size_t *batch = br_allocate(cells, sizeof *batch), *of;
    *b = (struct br_batches){.of = of = br_allocate(cells, sizeof *b->of),
                             .cost = br_allocate(cells, sizeof *b->cost)};
    bool full = slice && batch && b->of && b->cost;
    for (size_t s = 0; s < count && full; of += br_study_cells(&studies[s++])) {
        const bool failed = studies[s].failure.status != BR_OK;
        const struct cut c =
            failed ? (struct cut){0} : cut(&studies[s], most, (size_t)ranks / sound);
        full = failed || br_slice_cells(&studies[s], c.slices, of) >= 0;
        for (size_t i = 0; i < br_study_cells(&studies[s]); i++)
            of[i] = failed ? SIZE_MAX : slices + of[i];
        for (size_t i = 0; i < c.slices; i++, slices++)
            slice[slices] = (struct priced){c.cost, slices};
    }
    if (full) {
        qsort(slice, slices, sizeof *slice, dearest_first);
        deal(b, slice, slices, (size_t)ranks, threads > 0 ? (size_t)threads : 1, batch);
    }
    for (size_t i = 0; i < cells && full; i++)
        b->of[i] = b->of[i] == SIZE_MAX ? SIZE_MAX : batch[b->of[i]];
    free(slice);
    free(batch);
    return full ? BR_OK : br_no_memory(err, "the batches of the ranks");
}

void br_batches_clear(struct br_batches *b)
{
    free(b->cost);
    free(b->of);
    *b = (struct br_batches){0};
}

/* ---- marching a batch ---- */

/* of: the batch of each of the study's cells. */
static bool has_cells_in(const struct br_study *s, const size_t *of, size_t batch)
{
    bool takes = false;
    for (size_t i = 0; i < br_study_cells(s); i++)
        takes |= of[i] == batch;
    return takes;
}

/* The cells of other batches take one step only. So the reference is sampled on the same meshes and
 * at the same time levels, and every bit is that of the whole study. */
static void set_cells(struct br_study *s, const size_t *of, size_t batch)
{
    for (; s; s = s->next_norm)
        for (size_t i = 0; i < br_study_cells(s); i++) {
            const struct br_resolution against = s->cell[i].against;
            s->cell[i] = (struct br_cell){.at = br_study_resolution(s, i), .against = against};
            if (of[i] != batch)
                s->cell[i].at.steps = 1;
        }
}

/* ---- results: the batch's number, then those of its studies ---- */

/* All batches of a study report the same about it, except times; a failure is kept. */
static void pass_study(struct br_record *r, struct br_study *s, const size_t *of, size_t batch)
{
    bool checked = s->reference_check != NULL;
    const struct br_error before = s->failure;
    br_record_flag(r, &checked);
    br_record_bytes(r, &s->reference_report, sizeof s->reference_report);
    br_record_bytes(r, &s->reference_scale, sizeof s->reference_scale);
    br_record_bytes(r, s->reference_size, sizeof s->reference_size);
    br_record_bytes(r, s->reference_error, sizeof s->reference_error);
    br_record_bytes(r, s->reference_tip, sizeof s->reference_tip);
    br_record_bytes(r, &s->failure, sizeof s->failure);
    char *printed = s->events;
    br_record_text(r, &s->events, SIZE_MAX);
    if (s->events != printed)
        free(printed);
    for (size_t i = 0; i < br_study_cells(s); i++)
        if (of[i] == batch)
            br_record_bytes(r, &s->cell[i], sizeof s->cell[i]);
    if (!checked)
        s->reference_check = NULL;
    if (before.status)
        s->failure = before;
}

enum br_status br_batch_march(struct br_study *studies, size_t count, const struct br_batches *b,
                              size_t batch, int threads, const struct br_observer *observer,
                              FILE *results, struct br_error *err)
{
    struct br_record r = {.to = results};
    struct br_study *copy = br_allocate(count, sizeof *copy);
    size_t copies = 0, written = 0;
    const size_t *of = b->of;
    if (!copy)
        return br_no_memory(err, "a batch of studies");
    for (size_t s = 0; s < count; of += br_study_cells(&studies[s++]))
        if (has_cells_in(&studies[s], of, batch)) {
            set_cells(&studies[s], of, batch);
            copy[copies++] = studies[s];
        }
    enum br_status status = br_march_studies(copy, copies, threads, observer, err);
    br_record_bytes(&r, &batch, sizeof batch);
    of = b->of;
    for (size_t s = 0; s < count; of += br_study_cells(&studies[s++])) {
        const bool takes = has_cells_in(&studies[s], of, batch);
        for (struct br_study *norm = takes ? &copy[written++] : NULL; norm;
             norm = norm->next_norm) {
            pass_study(&r, norm, of, batch);
            free(norm->events);
            norm->events = NULL;
        }
    }
    free(copy);
    return !status && r.wrong ? br_no_memory(err, "the results") : status;
}

static void read_batch(struct br_record *r, struct br_study *studies, size_t count,
                       const struct br_batches *b)
{
    size_t batch = SIZE_MAX;
    const size_t *of = b->of;
    br_record_bytes(r, &batch, sizeof batch);
    for (size_t s = 0; s < count; of += br_study_cells(&studies[s++]))
        for (struct br_study *norm = &studies[s]; norm; norm = norm->next_norm)
            if (has_cells_in(&studies[s], of, batch))
                pass_study(r, norm, of, batch);
}

enum br_status br_batches_read(struct br_study *studies, size_t count, const struct br_batches *b,
                               char *bytes, size_t size, struct br_error *err)
{
    struct br_record r = {.from = bytes, .left = size};
    for (size_t i = 0; i < b->count && !r.wrong; i++)
        read_batch(&r, studies, count, b);
    if (r.no_memory)
        return br_no_memory(err, "the results");
    return r.wrong || r.left ? br_fail(err, BR_IO, "the results of the ranks: cut off, or too long")
                             : BR_OK;
}

/* ---- whether ranks have read the same ---- */

unsigned long long br_studies_fingerprint(const struct br_study *studies, size_t count)
{
    struct br_statement text;
    unsigned long long hash = 0xcbf29ce484222325ull; /* FNV-1a, 64 bits */
    br_statement_begin(&text);
    text.everywhere = true;
    br_state(&text, "cell-bytes", "%zu", sizeof(struct br_cell));
    for (size_t i = 0; i < count; i++)
        for (const struct br_study *s = &studies[i]; s; s = s->next_norm)
            br_state_study(&text, s);
    br_statement_end(&text);
    for (const char *c = text.text; c && *c; c++)
        hash = (hash ^ (unsigned char)*c) * 0x100000001b3ull;
    free(text.text);
    return hash;
}
