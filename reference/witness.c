/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Watches a march stage by stage, and certifies each stage against the scheme's textbook. */
#include <math.h>
#include <string.h>

#include "reference/certificate_parts.h"
#include "reference/past_states.h"

typedef long double real;

/* What decides where a step starts anew. */
enum regime { NO_REGIME, OPEN, CLOSED, STICKS, SLIPS_UP, SLIPS_DOWN };

struct watched {
    struct br_past_states y; /* what the step starts from, and its rows so far */
    size_t steps, since;     /* steps so far, and since the last start */
    double began, now;       /* this step, and its last stage so far, s */
    enum regime regime;      /* then */
    int last;                /* of the rows, the step's end */
    double *load;
    struct br_certificate trial;     /* the worst of this step's stages so far */
    double branch[BR_MOST_BRANCHES]; /* the worst so far of each branch that may be held */
};

struct br_witness {
    struct br_march *march;
    const struct br_scene *scene;
    const struct br_method *method;
    size_t n;
    int back, rows;          /* steps looked back at, and rows of the textbook, at most */
    struct watched field[2]; /* by br_field_kind */
    struct br_tip_path path;
    struct br_certificate worst;  /* since the last call */
    double largest[2][BR_SCALES]; /* so far */
    bool any;
    double *memory;
};

static const struct br_certificate not_good = {NAN, NAN, NAN, NAN, NAN};

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
    struct br_tip_path *p = &w->path;
    const size_t tip = tip_index(w, BR_AXIAL);
    const struct br_nodal *now = &f->y.row[f->last];
    if (told->index == 0)
        *p = (struct br_tip_path){.from = told->from,
                                  .k = told->k,
                                  .u_from = f->y.past[0].displacement[tip],
                                  .v_from = f->y.past[0].velocity[tip]};
    p->time[p->count] = told->time;
    p->u[p->count++] = p->u_to = now->displacement[tip];
    p->v_to = now->velocity[tip];
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
    const struct br_nodal *now = &f->y.row[f->last];
    struct br_step step = {.scene = w->scene,
                           .method = w->method,
                           .n = w->n,
                           .k = told->tau,
                           .compliance = {br_march_compliance(w->march, BR_AXIAL),
                                          br_march_compliance(w->march, BR_BENDING)},
                           .axial_tip = axial_tip,
                           .tip = *br_march_tip(w->march),
                           .largest = w->largest};
    step.field[told->kind] = (struct br_step_field){f->y.start.displacement, now->displacement,
                                                    f->y.start.velocity, now->velocity, f->load};
    /* The axial field lends its size to the bound's round-off. */
    const struct watched *axial = &w->field[BR_AXIAL];
    if (told->kind == BR_BENDING)
        step.field[BR_AXIAL] = (struct br_step_field){
            axial->y.start.displacement, axial->y.row[axial->last].displacement,
            axial->y.start.velocity, axial->y.row[axial->last].velocity, axial->load};
    struct br_certificate c = br_certify_field(&step, told->kind);
    double distance[BR_MOST_BRANCHES];
    const int branches =
        w->method->scheme->adaptive ? br_branch_distances(&step, told->kind, distance) : 0;
    double *law = told->kind == BR_AXIAL ? &c.contact : &c.friction;
    if (branches > 0)
        *law = hold(f, distance, branches, told->index + 1 == told->count, *law);
    return c;
}

static void look(struct br_witness *w, enum br_field_kind kind, struct br_nodal *into)
{
    br_march_get(w->march, kind, into->displacement, into->velocity);
}

/* The velocity's rate of change as the stage's own equation has it: (v - Z) / tau. */
static void find_acceleration(struct watched *f, real tau)
{
    struct br_nodal *y = &f->y.row[f->last];
    for (size_t i = 0; i < f->y.size; i++)
        y->acceleration[i] = (double)(((real)y->velocity[i] - f->y.start.velocity[i]) / tau);
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
    const real tau = br_start_of_row(&f->y, t, f->last, told->k);
    look(w, told->kind, &f->y.row[f->last]);
    br_march_load(w->march, told->kind, f->load);
    find_acceleration(f, tau);
    double axial_tip = 0;
    if (told->kind == BR_AXIAL)
        path_stage(w, told);
    else if (w->scene->axial.modelled)
        axial_tip = br_tip_path_at(&w->path, told->time);
    struct br_certificate c = certify(w, told, told->kind == BR_AXIAL ? NULL : &axial_tip);
    c.update = br_worse_of(time_error(w, told, tau, t->rows > 0 ? t->c[f->last] : 1), c.update);
    br_certificate_merge(&f->trial, &c);
    if (told->count != rows - skipped)
        f->trial = not_good;
    f->now = told->time;
}

/* ---- a step ---- */

static void swap(struct br_nodal *a, struct br_nodal *b)
{
    const struct br_nodal old = *a;
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
        swap(&f->y.past[i], &f->y.past[i - 1]);
    swap(&f->y.past[0], &f->y.row[f->last]);
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

static double *place(struct br_nodal *y, size_t size, double *memory)
{
    *y = (struct br_nodal){memory, memory + size, memory + 2 * size};
    return memory + 3 * size;
}

/* Gives a field its arrays; returns what is left of the memory. */
static double *place_field(struct br_witness *w, enum br_field_kind kind, double *memory)
{
    struct watched *f = &w->field[kind];
    f->y.size = br_step_unknowns(w->method, kind) * (w->n + 1);
    for (int i = 0; i < w->back; i++)
        memory = place(&f->y.past[i], f->y.size, memory);
    for (int i = 0; i < w->rows; i++)
        memory = place(&f->y.row[i], f->y.size, memory);
    f->y.start = (struct br_nodal){.displacement = memory, .velocity = memory + f->y.size};
    f->load = memory + 2 * f->y.size;
    return memory + 3 * f->y.size;
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
        look(w, (enum br_field_kind)kind, &w->field[kind].y.past[0]);
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
