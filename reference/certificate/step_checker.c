/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Watches a march stage by stage, and certifies each stage against the scheme's textbook. */
#include <math.h>
#include <string.h>

#include "reference/certificate/certificate.h"
#include "reference/certificate/watched.h"
#include "solver/scene.h"

typedef long double real;

/* The axial tip over one step, for the bound of friction. */
struct tip_path {
    int count;
    double time[BR_TEXTBOOK_ROWS], u[BR_TEXTBOOK_ROWS]; /* of its stages, s and m */
    double from, k;                                     /* s */
    double u_from, v_from, u_to, v_to;                  /* at both ends, m and m/s */
};

/* What is known of the step that a field is in. */
struct trial {
    struct br_certificate worst;     /* of this step's stages so far */
    double branch[BR_MOST_BRANCHES]; /* the worst so far of each branch that may be kept active */
    double law;                      /* the worst so far of the law itself */
};

/* A step uses at most three steps before it, whose states use as many, and the tip's increments are
 * corrected by those of the step before. */
enum { REMEMBERED = 8 };

struct br_step_checker {
    struct br_watched watched;
    struct trial trial[2]; /* by br_field_kind */
    struct tip_path path;
    struct br_certificate worst;  /* since the last call */
    double largest[2][BR_SCALES]; /* so far */
    double speed[2][REMEMBERED];  /* the largest of each of the last steps, m/s */
    double size[2][REMEMBERED];   /* the same of the norms of the equation's terms */
    struct br_certificate limits; /* as predicted when the march began */
    bool any;
};

static const struct br_certificate not_good = {NAN, NAN, NAN, NAN, NAN};

/* How far a stage's times are from the textbook's, over k; adaptive steps meet a time level to
 * 1e-13 of the duration. */
static double time_error(const struct br_step_checker *w, const struct br_march_stage *stage,
                         real tau, real c)
{
    const double slack = 1e-12 * w->watched.scene->duration;
    const double begun = fabs(stage->from - w->watched.field[stage->kind].began) - slack;
    const double at = (double)fabsl(stage->time - (stage->from + c * (real)stage->k)) - slack;
    const double step = (double)fabsl(stage->tau - tau);
    return br_worse_of(0, br_worse_of(begun, br_worse_of(at, step))) / stage->k;
}

/* ---- the tip ---- */

static void path_stage(struct br_step_checker *w, const struct br_march_stage *stage)
{
    const struct br_watched_field *f = &w->watched.field[BR_AXIAL];
    struct tip_path *p = &w->path;
    const size_t tip = w->watched.n * br_step_unknowns(w->watched.method, BR_AXIAL);
    const struct br_nodal *now = &f->y.row[f->last];
    if (stage->index == 0)
        *p = (struct tip_path){.from = stage->from,
                               .k = stage->k,
                               .u_from = f->y.past[0].displacement[tip],
                               .v_from = f->y.past[0].velocity[tip]};
    p->time[p->count] = stage->time;
    p->u[p->count++] = p->u_to = now->displacement[tip];
    p->v_to = now->velocity[tip];
}

/* u(L), m, at the time of a stage, s. Where the axial field had no stage then: of the cubic through
 * the ends of its step. */
static double tip_path_at(const struct tip_path *p, double time)
{
    for (int i = 0; i < p->count; i++)
        if (p->time[i] == time)
            return p->u[i];
    const real s = ((real)time - p->from) / p->k, d = (real)p->u_to - p->u_from;
    const real a = (real)p->k * p->v_from - d, b = d - (real)p->k * p->v_to;
    return (double)(p->u_from + s * d + s * (1 - s) * ((1 - s) * a + s * b));
}

/* ---- a stage ---- */

/* Error of the law in an adaptive step. Either one branch is kept active: all stages are on it, and
 * the last one obeys the law. Or the step is a short one over a switch, and each stage obeys the
 * law. */
static double adaptive_error(struct trial *f, const double *distance, int count, bool last,
                             double law)
{
    double nearest = INFINITY;
    for (int i = 0; i < count; i++) {
        f->branch[i] = br_worse_of(distance[i], f->branch[i]);
        if (!(f->branch[i] >= nearest))
            nearest = f->branch[i];
    }
    f->law = br_worse_of(law, f->law);
    const double on_branch = last ? br_worse_of(nearest, law) : nearest;
    return f->law < on_branch ? f->law : on_branch;
}

/* A field's last stage, after Z or another state. */
static struct br_step_field stage_after(const struct br_nodal *before,
                                        const struct br_watched_field *f)
{
    const struct br_nodal *now = &f->y.row[f->last < 0 ? 0 : f->last];
    return (struct br_step_field){before->displacement, now->displacement, before->velocity,
                                  now->velocity, f->load};
}

/* ---- what was before ---- */

static void remember(struct br_step_checker *w, enum br_field_kind kind)
{
    const struct br_watched_field *f = &w->watched.field[kind];
    double *most = &w->speed[kind][f->steps % REMEMBERED];
    for (size_t i = 0; i < f->y.size; i++) {
        *most = br_worse_of(fabs(f->y.past[0].velocity[i]), *most);
        *most = br_worse_of(fabs(f->y.row[f->last].velocity[i]), *most);
    }
}

static double largest_of(const double remembered[REMEMBERED])
{
    double most = 0;
    for (int i = 0; i < REMEMBERED; i++)
        most = br_worse_of(remembered[i], most);
    return most;
}

/* ---- what a stage may lose ---- */

/* How far the limits of this stage are above those of the march's first step: round-off depends on
 * the stage's tau, and some solvers leave a residual of their own. */
static struct br_certificate excess_of(const struct br_step_checker *w, enum br_field_kind kind)
{
    const struct br_method *method = w->watched.method;
    struct br_certificate then = w->limits;
    struct br_certificate now =
        br_certificate_limits(method->scheme, w->watched.n, br_march_round_off(w->watched.march));
    const double own = br_method_residual(method, br_march_field(w->watched.march, kind));
    now.axial_residual += own;
    now.bending_residual += own;
    double *excess = br_certificate_entries(&now), *first = br_certificate_entries(&then);
    for (size_t i = 0; i < BR_CERTIFICATE_ENTRIES; i++)
        excess[i] = fmax(1, excess[i] / first[i]);
    return now;
}

/* What the mass adds to the predicted round-off of a field, at the stage's tau. */
static double inertia_round_off(const struct br_step_checker *w, enum br_field_kind kind)
{
    const struct br_method *method = w->watched.method;
    const struct br_field *field = br_march_field(w->watched.march, kind);
    struct br_field massless = *field;
    massless.density = 0;
    return br_method_round_off(method, field) - br_method_round_off(method, &massless);
}

static struct br_certificate certify(struct br_step_checker *w, const struct br_march_stage *stage,
                                     const double *axial_tip)
{
    const struct br_watched *watched = &w->watched;
    double size_now[2] = {0, 0};
    struct br_checked_step step = {
        .scene = watched->scene,
        .method = watched->method,
        .n = watched->n,
        .k = stage->tau,
        .compliance = {br_march_compliance(w->watched.march, BR_AXIAL),
                       br_march_compliance(w->watched.march, BR_BENDING)},
        .axial_tip = axial_tip,
        .tip = *br_march_tip(w->watched.march),
        .largest = w->largest,
        .speed = {largest_of(w->speed[BR_AXIAL]), largest_of(w->speed[BR_BENDING])},
        .size = {largest_of(w->size[BR_AXIAL]), largest_of(w->size[BR_BENDING])},
        .size_now = size_now,
        .inertia_round_off = inertia_round_off(w, stage->kind)};
    const struct br_watched_field *own = &watched->field[stage->kind],
                                  *rod = &watched->field[BR_AXIAL];
    step.field[stage->kind] = stage_after(&own->y.start, own);
    /* The bound's round-off depends on the axial field, whose step may be complete. */
    if (stage->kind == BR_BENDING)
        step.field[BR_AXIAL] = stage_after(&rod->y.past[0], rod);
    struct br_certificate excess = excess_of(w, stage->kind);
    struct br_certificate c = br_certify_field(&step, stage->kind);
    double *size = &w->size[stage->kind][watched->field[stage->kind].steps % REMEMBERED];
    *size = br_worse_of(size_now[stage->kind], *size);
    for (size_t i = 0; i < BR_CERTIFICATE_ENTRIES; i++)
        br_certificate_entries(&c)[i] /= br_certificate_entries(&excess)[i];
    double distance[BR_MOST_BRANCHES];
    const int branches =
        watched->method->scheme->adaptive ? br_branch_distances(&step, stage->kind, distance) : 0;
    const double by = stage->kind == BR_AXIAL ? excess.contact : excess.friction;
    for (int i = 0; i < branches; i++)
        distance[i] /= by;
    double *law = stage->kind == BR_AXIAL ? &c.contact : &c.friction;
    if (branches > 0)
        *law = adaptive_error(&w->trial[stage->kind], distance, branches,
                              stage->index + 1 == stage->count, *law);
    return c;
}

static void watch_stage(void *self, const struct br_march_stage *stage)
{
    struct br_step_checker *w = self;
    struct trial *trial = &w->trial[stage->kind];
    if (stage->index == 0)
        *trial = (struct trial){0};
    const real tau = br_watched_stage(&w->watched, stage);
    const int row = w->watched.field[stage->kind].last;
    if (row < 0) {
        trial->worst = not_good;
        return;
    }
    remember(w, stage->kind);
    double axial_tip = 0;
    if (stage->kind == BR_AXIAL)
        path_stage(w, stage);
    else if (w->watched.scene->axial.modelled)
        axial_tip = tip_path_at(&w->path, stage->time);
    struct br_certificate c = certify(w, stage, stage->kind == BR_AXIAL ? NULL : &axial_tip);
    const struct br_textbook *t = br_watched_textbook(&w->watched, stage->kind);
    c.update = br_worse_of(time_error(w, stage, tau, t->rows > 0 ? t->c[row] : 1), c.update);
    br_certificate_merge(&trial->worst, &c);
}

static void watch_step(void *self, enum br_field_kind kind, bool switched)
{
    struct br_step_checker *w = self;
    br_watched_step(&w->watched, kind, switched);
    w->speed[kind][w->watched.field[kind].steps % REMEMBERED] = 0;
    w->size[kind][w->watched.field[kind].steps % REMEMBERED] = 0;
    br_certificate_merge(&w->worst, &w->trial[kind].worst);
    w->any = true;
}

struct br_certificate br_step_checker_step(struct br_step_checker *w)
{
    const struct br_certificate worst = w->any ? w->worst : not_good;
    w->worst = (struct br_certificate){0};
    w->any = false;
    return worst;
}

enum br_status br_step_checker_create(struct br_step_checker **out, struct br_march *march,
                                      const struct br_scene *scene, const struct br_method *method,
                                      struct br_error *err)
{
    struct br_step_checker *w = *out = br_allocate(1, sizeof *w);
    if (!w)
        return br_no_memory(err, "a certificate");
    w->limits = br_certificate_limits(method->scheme, br_march_field(march, BR_AXIAL)->n,
                                      br_march_round_off(march));
    const struct br_march_watcher watcher = {w, watch_stage, watch_step};
    const enum br_status status = br_watched_init(&w->watched, march, scene, method, &watcher, err);
    if (status) {
        br_step_checker_free(w);
        *out = NULL;
    }
    return status;
}

void br_step_checker_free(struct br_step_checker *w)
{
    if (!w)
        return;
    br_watched_clear(&w->watched);
    free(w);
}
