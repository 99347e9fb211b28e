/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Watches a march stage by stage, and certifies each stage against the scheme's textbook. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "reference/certificate_parts.h"
#include "reference/textbook.h"

typedef long double real;

enum { BACK = 3 };

/* Y = (displacement, velocity), and the rate of change of the velocity. */
struct nodal {
    double *displacement, *velocity, *acceleration;
};

/* What decides where a step starts anew. */
enum regime { NO_REGIME, OPEN, CLOSED, STICKS, SLIPS_UP, SLIPS_DOWN };

struct watched {
    size_t size;                        /* of nodal arrays */
    size_t steps, since;                /* steps so far, and since the last start */
    double began, now;                  /* this step, and its last stage so far, s */
    enum regime regime;                 /* then */
    struct nodal past[BACK];            /* Y_{n-1}, Y_{n-2}, Y_{n-3} */
    struct nodal row[BR_TEXTBOOK_ROWS]; /* of the textbook, in this step */
    int last;                           /* of these rows, the step's end */
    struct nodal start;                 /* Z */
    double *load;
    struct br_certificate trial;     /* the worst of this step's stages so far */
    double branch[BR_MOST_BRANCHES]; /* the worst so far of each branch that may be held */
};

/* The axial tip over one step, for the bound of friction. */
struct tip_path {
    int count;
    double time[BR_TEXTBOOK_ROWS], u[BR_TEXTBOOK_ROWS]; /* of its stages, s and m */
    double from, k;                                     /* s */
    double u_from, v_from, u_to, v_to;                  /* at both ends, m and m/s */
};

struct br_witness {
    struct br_march *march;
    const struct br_scene *scene;
    const struct br_method *method;
    size_t n;
    int back, rows;          /* steps looked back at, and rows of the textbook, at most */
    struct watched field[2]; /* by br_field_kind */
    struct tip_path path;
    struct br_certificate worst; /* since the last call */
    bool any;
    double *memory;
};

static const struct br_certificate not_good = {NAN, NAN, NAN, NAN, NAN};

/* ---- Z by the textbook ---- */

static void add(double *to, real factor, const double *from, size_t size)
{
    for (size_t i = 0; i < size && factor != 0; i++)
        to[i] = (double)((real)to[i] + factor * (real)from[i]);
}

/* Z = sum of past_j Y_{n-1-j} */
static void start_differences(struct watched *f, const struct br_textbook *t)
{
    for (int j = 0; j < t->back; j++) {
        add(f->start.displacement, t->past[j], f->past[j].displacement, f->size);
        add(f->start.velocity, t->past[j], f->past[j].velocity, f->size);
    }
}

/* Z = Y_{n-1} + k sum of a_ij Y'_j; the rate of a displacement is the velocity itself. */
static void start_row(struct watched *f, const struct br_textbook *t, int row, real k)
{
    add(f->start.displacement, 1, f->past[0].displacement, f->size);
    add(f->start.velocity, 1, f->past[0].velocity, f->size);
    for (int j = 0; j < row; j++) {
        const struct nodal *y = t->c[j] == 0 ? &f->past[0] : &f->row[j];
        add(f->start.displacement, k * t->a[row][j], y->velocity, f->size);
        add(f->start.velocity, k * t->a[row][j], y->acceleration, f->size);
    }
}

/* Fills Z; returns tau. */
static real start_of(struct watched *f, const struct br_textbook *t, int row, real k)
{
    memset(f->start.displacement, 0, f->size * sizeof(double));
    memset(f->start.velocity, 0, f->size * sizeof(double));
    if (t->rows == 0)
        start_differences(f, t);
    else
        start_row(f, t, row, k);
    return k * (t->rows == 0 ? t->beta : t->a[row][row]);
}

/* How far a stage's times are from the textbook's, over k; adaptive steps meet a time level to
 * 1e-13 of the duration. */
static double time_error(const struct br_witness *w, const struct br_march_stage *told, real tau,
                         real c)
{
    const double slack = 1e-12 * w->scene->duration;
    const double begun = fabs(told->from - w->field[told->kind].began) - slack;
    const double at = (double)fabsl(told->time - (told->from + c * (real)told->k)) - slack;
    const double step = (double)fabsl(told->tau - tau);
    return br_worse_of(0, br_worse_of(begun, br_worse_of(at, step))) / told->k;
}

/* ---- the tip ---- */

static size_t tip_index(const struct br_witness *w, enum br_field_kind kind)
{
    return w->n * br_step_unknowns(w->method, kind);
}

static void path_stage(struct br_witness *w, const struct br_march_stage *told)
{
    const struct watched *f = &w->field[BR_AXIAL];
    struct tip_path *p = &w->path;
    const size_t tip = tip_index(w, BR_AXIAL);
    const struct nodal *now = &f->row[f->last];
    if (told->index == 0)
        *p = (struct tip_path){.from = told->from,
                               .k = told->k,
                               .u_from = f->past[0].displacement[tip],
                               .v_from = f->past[0].velocity[tip]};
    p->time[p->count] = told->time;
    p->u[p->count++] = p->u_to = now->displacement[tip];
    p->v_to = now->velocity[tip];
}

/* u(L) at a time of a stage; where the axial field had none then, by the cubic that the ends of its
 * step determine. */
static double path_at(const struct tip_path *p, double time)
{
    for (int i = 0; i < p->count; i++)
        if (p->time[i] == time)
            return p->u[i];
    const real s = ((real)time - p->from) / p->k, d = (real)p->u_to - p->u_from;
    const real a = (real)p->k * p->v_from - d, b = d - (real)p->k * p->v_to;
    return (double)(p->u_from + s * d + s * (1 - s) * ((1 - s) * a + s * b));
}

static enum regime regime_of(const struct br_witness *w, enum br_field_kind kind)
{
    const struct br_tip *tip = br_march_tip(w->march);
    if (kind == BR_AXIAL)
        return !w->scene->contact.modelled ? NO_REGIME : tip->contact_force > 0 ? CLOSED : OPEN;
    if (w->scene->friction.law == BR_FRICTIONLESS || !(tip->friction_bound > 0))
        return NO_REGIME;
    if (fabs(tip->friction_force) < tip->friction_bound)
        return STICKS;
    return tip->friction_force > 0 ? SLIPS_UP : SLIPS_DOWN;
}

/* ---- a stage ---- */

/* A branch that is held through a step: all its stages are on one branch, and the last obeys the
 * law itself. */
static double hold(struct watched *f, const double *distance, int count, bool last, double law)
{
    double nearest = INFINITY;
    for (int i = 0; i < count; i++) {
        f->branch[i] = br_worse_of(distance[i], f->branch[i]);
        if (!(f->branch[i] >= nearest))
            nearest = f->branch[i];
    }
    return last ? br_worse_of(nearest, law) : nearest;
}

static struct br_certificate certify(struct br_witness *w, const struct br_march_stage *told,
                                     const double *axial_tip)
{
    struct watched *f = &w->field[told->kind];
    const struct nodal *now = &f->row[f->last];
    struct br_step step = {.scene = w->scene,
                           .method = w->method,
                           .n = w->n,
                           .k = told->tau,
                           .compliance = br_march_compliance(w->march, BR_BENDING),
                           .axial_tip = axial_tip,
                           .tip = *br_march_tip(w->march)};
    step.field[told->kind] = (struct br_step_field){f->start.displacement, now->displacement,
                                                    f->start.velocity, now->velocity, f->load};
    /* The axial field lends its size to the bound's round-off. */
    const struct watched *axial = &w->field[BR_AXIAL];
    if (told->kind == BR_BENDING)
        step.field[BR_AXIAL] = (struct br_step_field){
            axial->start.displacement, axial->row[axial->last].displacement, axial->start.velocity,
            axial->row[axial->last].velocity, axial->load};
    struct br_certificate c = br_certify_field(&step, told->kind);
    double distance[BR_MOST_BRANCHES];
    const int branches =
        w->method->scheme->adaptive ? br_branch_distances(&step, told->kind, distance) : 0;
    double *law = told->kind == BR_AXIAL ? &c.contact : &c.friction;
    if (branches > 0)
        *law = hold(f, distance, branches, told->index + 1 == told->count, *law);
    return c;
}

static void look(struct br_witness *w, enum br_field_kind kind, struct nodal *into)
{
    br_march_get(w->march, kind, into->displacement, into->velocity);
}

/* The velocity's rate of change as the stage's own equation has it: (v - Z) / tau. */
static void find_acceleration(struct watched *f, real tau)
{
    struct nodal *y = &f->row[f->last];
    for (size_t i = 0; i < f->size; i++)
        y->acceleration[i] = (double)(((real)y->velocity[i] - f->start.velocity[i]) / tau);
}

static void watch_stage(void *self, const struct br_march_stage *told)
{
    struct br_witness *w = self;
    struct watched *f = &w->field[told->kind];
    const struct br_textbook *t = br_textbook_step(w->method->scheme->name, f->since);
    const int skipped = t->rows > 0 && t->c[0] == 0, rows = t->rows > 0 ? t->rows : 1;
    if (told->index == 0) {
        f->trial = (struct br_certificate){0};
        memset(f->branch, 0, sizeof f->branch);
    }
    f->last = told->index + skipped;
    if (f->last >= rows) {
        f->last = rows - 1;
        f->trial = not_good;
        return;
    }
    const real tau = start_of(f, t, f->last, told->k);
    look(w, told->kind, &f->row[f->last]);
    br_march_load(w->march, told->kind, f->load);
    find_acceleration(f, tau);
    double axial_tip = 0;
    if (told->kind == BR_AXIAL)
        path_stage(w, told);
    else if (w->scene->axial.modelled)
        axial_tip = path_at(&w->path, told->time);
    struct br_certificate c = certify(w, told, told->kind == BR_AXIAL ? NULL : &axial_tip);
    c.update = br_worse_of(time_error(w, told, tau, t->rows > 0 ? t->c[f->last] : 1), c.update);
    br_certificate_merge(&f->trial, &c);
    if (told->count != rows - skipped)
        f->trial = not_good;
    f->now = told->time;
}

/* ---- a step ---- */

static void swap(struct nodal *a, struct nodal *b)
{
    const struct nodal old = *a;
    *a = *b;
    *b = old;
}

/* An adaptive scheme says itself where it has found a switch; for the others a switch is what the
 * tip's regime shows. */
static void watch_step(void *self, enum br_field_kind kind, bool switched)
{
    struct br_witness *w = self;
    struct watched *f = &w->field[kind];
    const enum regime before = f->regime;
    f->regime = regime_of(w, kind);
    if (!w->method->scheme->adaptive)
        switched = f->steps > 0 && f->regime != before;
    f->since = switched ? 0 : f->since + 1;
    f->steps++;
    f->began = f->now;
    for (int i = w->back - 1; i > 0; i--)
        swap(&f->past[i], &f->past[i - 1]);
    swap(&f->past[0], &f->row[f->last]);
    br_certificate_merge(&w->worst, &f->trial);
    w->any = true;
}

struct br_certificate br_witness_step(struct br_witness *w)
{
    const struct br_certificate worst = w->any ? w->worst : not_good;
    w->worst = (struct br_certificate){0};
    w->any = false;
    return worst;
}

/* ---- setting up ---- */

static void find_needs(struct br_witness *w)
{
    w->back = w->rows = 1;
    for (size_t since = 0; since < 3; since++) {
        const struct br_textbook *t = br_textbook_step(w->method->scheme->name, since);
        w->back = t->back > w->back ? t->back : w->back;
        w->rows = t->rows > w->rows ? t->rows : w->rows;
    }
}

static double *place(struct nodal *y, size_t size, double *memory)
{
    *y = (struct nodal){memory, memory + size, memory + 2 * size};
    return memory + 3 * size;
}

/* Gives a field its arrays; returns what is left of the memory. */
static double *place_field(struct br_witness *w, enum br_field_kind kind, double *memory)
{
    struct watched *f = &w->field[kind];
    f->size = br_step_unknowns(w->method, kind) * (w->n + 1);
    for (int i = 0; i < w->back; i++)
        memory = place(&f->past[i], f->size, memory);
    for (int i = 0; i < w->rows; i++)
        memory = place(&f->row[i], f->size, memory);
    f->start = (struct nodal){.displacement = memory, .velocity = memory + f->size};
    f->load = memory + 2 * f->size;
    return memory + 3 * f->size;
}

static enum br_status refuse(const struct br_method *method, struct br_error *err)
{
    if (!br_textbook_step(method->scheme->name, 0))
        return br_fail(err, BR_BAD_INPUT,
                       "scheme %s has no certificate, expected a scheme made of Euler steps",
                       method->scheme->name);
    return BR_OK;
}

enum br_status br_witness_create(struct br_witness **out, struct br_march *march,
                                 const struct br_scene *scene, const struct br_method *method,
                                 struct br_error *err)
{
    *out = NULL;
    const enum br_status status = refuse(method, err);
    if (status)
        return status;
    struct br_witness *w = br_allocate(1, sizeof *w);
    if (!w)
        return br_no_memory(err, "a certificate");
    *w = (struct br_witness){.march = march, .scene = scene, .method = method};
    w->n = br_march_field(march, BR_AXIAL)->n;
    find_needs(w);
    const size_t arrays = 3 * (size_t)(w->back + w->rows + 1);
    const size_t unknowns =
        br_step_unknowns(method, BR_AXIAL) + br_step_unknowns(method, BR_BENDING);
    w->memory = br_allocate(arrays * unknowns * (w->n + 1), sizeof *w->memory);
    if (!w->memory) {
        free(w);
        return br_no_memory(err, "a certificate");
    }
    double *memory = w->memory;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        memory = place_field(w, (enum br_field_kind)kind, memory);
        look(w, (enum br_field_kind)kind, &w->field[kind].past[0]);
    }
    br_march_watch(march, &(struct br_march_watcher){w, watch_stage, watch_step});
    *out = w;
    return BR_OK;
}

void br_witness_free(struct br_witness *w)
{
    if (!w)
        return;
    br_march_watch(w->march, NULL);
    free(w->memory);
    free(w);
}
