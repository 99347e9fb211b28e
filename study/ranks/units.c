/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/ranks/units.h"

#include <string.h>

/* ---- costs ---- */

/* Measured on one core of a 2 GHz Xeon, both fields, n = 1600 and 3200, 1e4 time levels. They
 * decide who does what, not what comes out: a wrong one costs time. */
static const double measure_ns = 50;     /* to look at an element of a cell, and to project there */
static const double look_fine_ns = 45;   /* to look at an element of a fine run */
static const double look_other_ns = 110; /* of a judge that evaluates a solution; mms: 150 */
static const double create_ns = 5e7;     /* a solution of the continuous problem */

static double march_ns(const struct br_method *method)
{
    static const struct {
        const char *solver;
        double ns; /* docs/methods.md, "Linear solvers" */
    } known[] = {{"lanes", 4}, {"riccati", 13}, {"umfpack", 85}, {"cholmod", 100}, {"banded", 100}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(method->solver->name, known[i].solver) == 0)
            return known[i].ns;
    return known[1].ns;
}

static size_t largest(const size_t *list, size_t count)
{
    size_t most = 0;
    for (size_t i = 0; i < count; i++)
        most = list[i] > most ? list[i] : most;
    return most;
}

/* The reference is looked at wherever some cell has a time level: as often as the cell of most
 * steps has some, about. */
double br_reference_cost(const struct br_study *s)
{
    const double levels = (double)largest(s->steps, s->k_count);
    if (!s->judge->nests)
        return create_ns + look_other_ns * levels * (double)largest(s->n, s->n_count);
    const double n = (double)s->reference.n;
    return march_ns(&s->reference_method) * n * (double)s->reference.steps +
           look_fine_ns * n * levels;
}

double br_cell_cost(const struct br_study *s, size_t cell)
{
    const struct br_resolution at = s->cell[cell].at;
    return (march_ns(&s->method) + measure_ns) * (double)at.n * (double)at.steps;
}

/* ---- slices ---- */

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

/* The dearest cell first, each to the slice that has least (Graham 1969). */
double br_slice_cells(const struct br_study *s, size_t slices, size_t *owner)
{
    const size_t cells = br_study_cells(s);
    struct priced *cell = br_allocate(cells, sizeof *cell);
    double *load = br_allocate(slices, sizeof *load), most = -1;
    for (size_t i = 0; cell && i < cells; i++)
        cell[i] = (struct priced){br_cell_cost(s, i), i};
    if (cell && load)
        qsort(cell, cells, sizeof *cell, dearest_first);
    for (size_t i = 0; cell && load && i < cells; i++) {
        const size_t slice = least(load, slices);
        owner[cell[i].index] = slice;
        load[slice] += cell[i].cost;
        most = load[slice] > most ? load[slice] : most;
    }
    free(cell);
    free(load);
    return most;
}

/* The cutting of all studies, as it stands. */
struct cutting {
    const struct br_study *studies;
    size_t count, ranks;
    size_t *slices; /* of each study; 0: it has failed */
    double *unit;   /* the cost of its dearest slice, reference included, ns */
    double total;   /* ns */
    size_t units;
    size_t *owner; /* workspace */
};

/* Whether to cut study s into one slice more, and if so, does.
 *
 * A slice marches some of the cells, and the whole reference again. So it pays where the reference
 * is cheap beside the cells, or where ranks would have nothing to do, and its last slice ends
 * clearly sooner. That leaves the cells of a much finer run with it: it is the work.
 *
 * The reference could also be worked out by one rank and broadcast. Compared with slices on ranks
 * that are idle otherwise, this saves the owner of the reference its share of the cells, and costs
 * it the sending, each time level after the other: 48 bytes an element of every mesh. Measured for
 * the exact reference of the tables' grid on 4 ranks of one machine, per element of its mesh and
 * time level: 107 ns for the reference; 34 ns for a quarter of the cells; and for 94 bytes at 4.5
 * GB/s (MPI_Bcast, 9.6 MB; 2.7 GB/s by TCP on the same machine) 21 ns (35 ns). So it would save a
 * tenth at most, by the fastest of networks, and lose with more ranks, where the share is less and
 * the bytes are not: slices it is. */
static bool cut(struct cutting *c, size_t s)
{
    const struct br_study *study = &c->studies[s];
    const double reference = br_reference_cost(study);
    const double cells = br_slice_cells(study, c->slices[s] + 1, c->owner);
    const double all_cells = c->unit[s] - reference; /* of the dearest slice so far */
    const bool idle = c->units < c->ranks;
    if (c->slices[s] == br_study_cells(study) || !(cells >= 0) ||
        reference + cells > 0.9 * c->unit[s] || !(idle || reference < 0.1 * all_cells))
        return false;
    c->slices[s]++;
    c->units++;
    c->unit[s] = reference + cells;
    c->total += reference;
    return true;
}

/* As long as one unit is so large that the ranks would wait for it. */
static void cut_all(struct cutting *c)
{
    for (;;) {
        size_t dearest = 0;
        for (size_t s = 1; s < c->count; s++)
            dearest = c->unit[s] > c->unit[dearest] ? s : dearest;
        if (c->count == 0 || c->unit[dearest] <= c->total / (2 * (double)c->ranks) ||
            !cut(c, dearest))
            return;
    }
}

static enum br_status create_cutting(struct cutting *c, struct br_error *err)
{
    size_t most = 0;
    for (size_t s = 0; s < c->count; s++)
        most = br_study_cells(&c->studies[s]) > most ? br_study_cells(&c->studies[s]) : most;
    c->slices = br_allocate(c->count, sizeof *c->slices);
    c->unit = br_allocate(c->count, sizeof *c->unit);
    c->owner = br_allocate(most, sizeof *c->owner);
    if (!c->slices || !c->unit || !c->owner)
        return br_no_memory(err, "the work of the ranks");
    for (size_t s = 0; s < c->count; s++) {
        if (c->studies[s].failure.status)
            continue;
        c->slices[s] = 1;
        c->unit[s] = br_reference_cost(&c->studies[s]);
        for (size_t i = 0; i < br_study_cells(&c->studies[s]); i++)
            c->unit[s] += br_cell_cost(&c->studies[s], i);
        c->total += c->unit[s];
        c->units++;
    }
    return BR_OK;
}

static void clear_cutting(struct cutting *c)
{
    free(c->slices);
    free(c->unit);
    free(c->owner);
}

/* ---- groups ---- */

static int dearest_unit_first(const void *a, const void *b)
{
    const struct br_unit *x = a, *y = b;
    if (x->cost != y->cost)
        return x->cost < y->cost ? 1 : -1;
    if (x->study != y->study)
        return x->study < y->study ? -1 : 1;
    return (x->slice > y->slice) - (x->slice < y->slice);
}

/* Units are dealt like cards, the dearest first: in each round every rank gets as many as it has
 * threads, or its share of those that are left. sorted: in; u->unit, first, groups: out. */
static void deal(struct br_units *u, const struct br_unit *sorted, size_t ranks, size_t threads)
{
    size_t filled = 0;
    for (size_t done = 0; done < u->count;) {
        const size_t left = u->count - done, share = (left + ranks - 1) / ranks;
        const size_t each = share < threads ? share : threads;
        const size_t round = each * ranks < left ? each * ranks : left;
        for (size_t r = 0; r < ranks && r < round; r++) {
            u->first[u->groups++] = filled;
            for (size_t i = r; i < round; i += ranks)
                u->unit[filled++] = sorted[done + i];
        }
        done += round;
    }
    u->first[u->groups] = filled;
}

static void list_units(const struct cutting *c, struct br_unit *unit)
{
    size_t next = 0;
    for (size_t s = 0; s < c->count; s++)
        for (size_t slice = 0; slice < c->slices[s]; slice++)
            unit[next++] = (struct br_unit){s, slice, c->slices[s], c->unit[s]};
    qsort(unit, next, sizeof *unit, dearest_unit_first);
}

enum br_status br_units_create(struct br_units *u, const struct br_study *studies, size_t count,
                               int ranks, int threads, struct br_error *err)
{
    struct cutting c = {.studies = studies, .count = count, .ranks = (size_t)ranks};
    *u = (struct br_units){0};
    enum br_status status = create_cutting(&c, err);
    if (!status)
        cut_all(&c);
    u->count = c.units;
    struct br_unit *sorted = br_allocate(u->count, sizeof *sorted);
    u->unit = br_allocate(u->count, sizeof *u->unit);
    u->first = br_allocate(u->count + 1, sizeof *u->first);
    if (!status && (!sorted || !u->unit || !u->first))
        status = br_no_memory(err, "the work of the ranks");
    if (!status) {
        list_units(&c, sorted);
        deal(u, sorted, (size_t)ranks, threads > 0 ? (size_t)threads : 1);
    }
    free(sorted);
    clear_cutting(&c);
    return status;
}

void br_units_clear(struct br_units *u)
{
    free(u->unit);
    free(u->first);
    *u = (struct br_units){0};
}
