/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/certificate/watched.h"

#include <math.h>
#include <string.h>

#include "solver/method.h"

typedef long double real;

static void add(double *to, real factor, const double *from, size_t size)
{
    for (size_t i = 0; i < size && factor != 0; i++)
        to[i] = (double)((real)to[i] + factor * (real)from[i]);
}

/* Z = sum of past_j Y_{n-1-j} */
static void start_differences(struct br_past_states *f, const struct br_textbook *t)
{
    for (int j = 0; j < t->back; j++) {
        add(f->start.displacement, t->past[j], f->past[j].displacement, f->size);
        add(f->start.velocity, t->past[j], f->past[j].velocity, f->size);
    }
}

/* Z = Y_{n-1} + k sum of a_ij Y'_j; the rate of a displacement is the velocity itself. */
static void start_row(struct br_past_states *f, const struct br_textbook *t, int row, real k)
{
    add(f->start.displacement, 1, f->past[0].displacement, f->size);
    add(f->start.velocity, 1, f->past[0].velocity, f->size);
    for (int j = 0; j < row; j++) {
        const struct br_nodal *y = t->c[j] == 0 ? &f->past[0] : &f->row[j];
        add(f->start.displacement, k * t->a[row][j], y->velocity, f->size);
        add(f->start.velocity, k * t->a[row][j], y->acceleration, f->size);
    }
}

/* Fills Z of a row of a step of length k, s; returns tau, s. */
static real start_of_row(struct br_past_states *f, const struct br_textbook *t, int row, real k)
{
    memset(f->start.displacement, 0, f->size * sizeof(double));
    memset(f->start.velocity, 0, f->size * sizeof(double));
    if (t->rows == 0)
        start_differences(f, t);
    else
        start_row(f, t, row, k);
    return k * (t->rows == 0 ? t->beta : t->a[row][row]);
}

/* ---- a stage ---- */

static void sample(struct br_watched *w, enum br_field_kind kind, struct br_nodal *into)
{
    br_march_get(w->march, kind, into->displacement, into->velocity);
}

/* The velocity's rate of change from the stage's own equation: (v - Z) / tau. */
static void find_acceleration(struct br_watched_field *f, real tau)
{
    struct br_nodal *y = &f->y.row[f->last];
    for (size_t i = 0; i < f->y.size; i++)
        y->acceleration[i] = (double)(((real)y->velocity[i] - f->y.start.velocity[i]) / tau);
}

const struct br_textbook *br_watched_textbook(const struct br_watched *w, enum br_field_kind kind)
{
    return br_textbook_step(w->method->scheme->name, w->field[kind].since);
}

real br_watched_stage(struct br_watched *w, const struct br_march_stage *stage)
{
    struct br_watched_field *f = &w->field[stage->kind];
    const struct br_textbook *t = br_watched_textbook(w, stage->kind);
    const int skipped = t->rows > 0 && t->c[0] == 0, rows = t->rows > 0 ? t->rows : 1;
    f->last = stage->index + skipped;
    f->now = stage->time;
    if (f->last >= rows || stage->count != rows - skipped) {
        f->last = -1;
        return NAN;
    }
    const real tau = start_of_row(&f->y, t, f->last, stage->k);
    sample(w, stage->kind, &f->y.row[f->last]);
    br_march_load(w->march, stage->kind, f->load);
    find_acceleration(f, tau);
    return tau;
}

/* ---- a step ---- */

static void swap(struct br_nodal *a, struct br_nodal *b)
{
    const struct br_nodal old = *a;
    *a = *b;
    *b = old;
}

/* An adaptive scheme reports its switches; for other schemes a switch is a change of the tip's
 * regime. */
void br_watched_step(struct br_watched *w, enum br_field_kind kind, bool switched)
{
    struct br_watched_field *f = &w->field[kind];
    const enum br_regime before = f->regime;
    const struct br_tip *tip = br_march_tip(w->march);
    f->regime = br_textbook_regime(w->scene, kind, tip->force[kind], tip->friction_bound);
    if (!w->method->scheme->adaptive)
        switched = f->steps > 0 && f->regime != before;
    f->since = switched ? 0 : f->since + 1;
    f->steps++;
    f->began = f->now;
    for (int i = w->back - 1; i > 0; i--)
        swap(&f->y.past[i], &f->y.past[i - 1]);
    swap(&f->y.past[0], &f->y.row[f->last < 0 ? 0 : f->last]);
}

/* ---- setting up ---- */

static void find_needs(struct br_watched *w)
{
    w->back = w->rows = 1;
    for (size_t since = 0; since < 3; since++) {
        const struct br_textbook *t = br_textbook_step(w->method->scheme->name, since);
        w->back = t->back > w->back ? t->back : w->back;
        w->rows = t->rows > w->rows ? t->rows : w->rows;
    }
}

static double *take_arrays(struct br_nodal *y, size_t size, double *memory)
{
    *y = (struct br_nodal){memory, memory + size, memory + 2 * size};
    return memory + 3 * size;
}

/* Gives a field its arrays; returns what is left of the memory. */
static double *take_field_arrays(struct br_watched *w, enum br_field_kind kind, double *memory)
{
    struct br_watched_field *f = &w->field[kind];
    f->y.size = br_field_size(br_march_field(w->march, kind));
    for (int i = 0; i < w->back; i++)
        memory = take_arrays(&f->y.past[i], f->y.size, memory);
    for (int i = 0; i < w->rows; i++)
        memory = take_arrays(&f->y.row[i], f->y.size, memory);
    f->y.start = (struct br_nodal){.displacement = memory, .velocity = memory + f->y.size};
    f->load = memory + 2 * f->y.size;
    return memory + 3 * f->y.size;
}

enum br_status br_watched_init(struct br_watched *w, struct br_march *march,
                               const struct br_scene *scene, const struct br_method *method,
                               const struct br_march_watcher *watcher, struct br_error *err)
{
    *w = (struct br_watched){.march = march, .scene = scene, .method = method};
    if (!br_textbook_step(method->scheme->name, 0))
        return br_fail(err, BR_BAD_INPUT,
                       "scheme %s has no certificate, expected a scheme made of Euler steps",
                       method->scheme->name);
    w->n = br_march_field(march, BR_AXIAL)->n;
    find_needs(w);
    const size_t arrays = 3 * (size_t)(w->back + w->rows + 1);
    w->memory = br_allocate(arrays * (br_field_size(br_march_field(march, BR_AXIAL)) +
                                      br_field_size(br_march_field(march, BR_BENDING))),
                            sizeof *w->memory);
    if (!w->memory)
        return br_no_memory(err, "a certificate");
    double *memory = w->memory;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        memory = take_field_arrays(w, kind, memory);
        sample(w, kind, &w->field[kind].y.past[0]);
    }
    if (!br_march_watch(march, watcher))
        return br_fail(err, BR_BAD_INPUT, "the march has %d watchers, and room for no more",
                       BR_MOST_WATCHERS);
    w->watcher = watcher->self;
    return BR_OK;
}

void br_watched_clear(struct br_watched *w)
{
    if (w->watcher)
        br_march_unwatch(w->march, w->watcher);
    free(w->memory);
    *w = (struct br_watched){0};
}
