/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/estimate/prediction.h"

#include <math.h>
#include <stdio.h>

#include "base/clock.h"
#include "solver/laws.h"
#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "study/grid/sweep.h"

/* ---- comparisons: marches beside a reference R, the most accurate of them ---- */

enum {
    TIGHT,    /* the run against steps by a tolerance on more elements */
    IN_TIME,  /* its steps, or fewer, on a coarse mesh against more steps */
    IN_SPACE, /* its elements, or fewer, with few steps against more elements */
    START,    /* its first steps on a coarse mesh against steps by a tolerance */
    COMPARISONS
};

/* The marches of a comparison. Those that are the same are made once. */
enum cell {
    RUN,   /* elements and steps of the run, or fewer */
    CHECK, /* R with half its elements, and half its steps or a larger tolerance */
    TIME,  /* the steps of RUN on the elements of R: the error of time */
    SPACE, /* the elements of RUN with the steps of CHECK: the error of space */
    STEPS, /* the elements of R with the steps of CHECK */
    HALF,  /* half of RUN in what R refines, if the error is extrapolated: shows the order */
    CELLS
};

/* Must not be moved: the study points into it. */
struct comparison {
    bool active;
    double beyond; /* the run's elements, steps or 1/tolerance over RUN's; 0: it is the run */
    struct br_scene scene; /* borrows; its duration may be shorter */
    int at[CELLS];         /* of each cell in the study; -1: it is R, or not marched */
    size_t n[CELLS], steps[CELLS];
    const struct br_method *of[CELLS]; /* the setting's: the same pointer is the same method */
    struct br_method method[CELLS];
    struct br_study study, tip; /* in the L2 norm, and at the tip */
};

struct marches {
    const struct br_planned_march *run;
    struct comparison by[COMPARISONS];
    char why[200]; /* why the last failed comparison failed */
};

/* What is compared: RUN, the factors of elements and steps of R, and methods. */
struct setting {
    size_t n, steps, finer, shorter;
    const struct br_method *own, *check, *reference;
};

/* The cost of a solve, and of an element whose load is a function of x and t that is evaluated at
 * each time level, in elements: both measured. A scheme that chooses its steps makes some 12 solves
 * a step, with those that it takes back. */
static const double overhead = 700, evaluated = 30, chosen_stages = 12;

/* Work of each comparison, elements times solves: some ten milliseconds at least, a share of the
 * run's own work at most. The work of an adaptive run is not known. */
static const double least_work = 1e7, most_work = 5e7, most_share = 0.06, adaptive_work = 6e7;

enum {
    COARSE_N = 32,    /* so many elements resolve what is slower than a step */
    SPACE_N = 128,    /* from so many on, errors of space follow their order: R has them at least */
    LOAD_LEVELS = 64, /* where a step of R ends, at least, so that it meets loads that oscillate */
    MANY_N = 1000,    /* the check of so many elements may have the run's mesh */
    FIRST = 4,        /* steps of START: what dies away at once */
    LEVELS = 24,      /* of adaptive runs: levels say nothing about their steps */
    LEAST_STEPS = 40  /* by a tolerance beside the levels, or the levels choose the steps */
};

/* R divides the run's tolerance by `tighter`, its check by the root of it: with errors like
 * tolerance^0.9, R is then 18 times as accurate. Errors are extrapolated from `loosest` at most.
 * For equal steps R has `tight`; `tightest` is near round-off. */
static const double tighter = 25, loosest = 1e-4, tight = 1e-6, tightest = 1e-12;

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

static double stages(const struct br_method *m)
{
    return m->scheme->adaptive ? chosen_stages : br_time_scheme_stages(m->scheme);
}

/* The work of a solve on n elements. */
static double solve(const struct br_planned_march *o, size_t n)
{
    double cost = 1;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_scene_field *f = &o->scene->field[kind];
        for (size_t i = 0; i < BR_LOAD_TERMS && f->modelled; i++)
            if (f->load.term[i].space.uses_x && f->load.term[i].space.uses_t)
                cost = evaluated;
    }
    return (double)n * cost + overhead;
}

static double budget(const struct br_planned_march *o)
{
    const double own = solve(o, o->n) * (double)o->steps * stages(o->method);
    return o->budget > 0                 ? o->budget
           : o->method->scheme->adaptive ? adaptive_work
                                         : fmin(fmax(most_share * own, least_work), most_work);
}

bool br_follows_at_once(const struct br_scene *s, double k)
{
    return s->bending.modelled && s->density == 0 &&
           s->bending.viscosity <= k * s->bending.stiffness && s->friction.law != BR_FRICTIONLESS;
}

static bool at_once(const struct br_planned_march *o)
{
    return br_follows_at_once(o->scene, br_time_step(o->scene, o->steps));
}

struct br_method br_accurate_method(const struct br_method *own, const char *scheme)
{
    struct br_method m = *own;
    m.scheme = br_time_scheme_find(scheme);
    m.solver = br_linear_solvers[0];
    m.contact = br_contact_rule_find("implicit");
    if (m.friction->iterates)
        m.friction = br_friction_rules[0];
    m.most_steps = 0;
    return m;
}

/* The place of a cell in the study, where an equal one is used again; -1: it is R. */
static int place(struct comparison *c, const struct setting *s, const struct br_method *method,
                 size_t n, size_t steps)
{
    struct br_study *study = &c->study;
    if (n == study->reference.n && steps == study->reference.steps && method == s->reference)
        return -1;
    for (size_t i = 0; i < study->n_count; i++)
        if (n == c->n[i] && steps == c->steps[i] && method == c->of[i])
            return (int)i;
    const size_t last = study->n_count++;
    study->k_count = study->n_count;
    c->n[last] = n;
    c->steps[last] = steps;
    c->of[last] = method;
    c->method[last] = *method;
    c->method[last].most_steps = s->reference->most_steps;
    if (n > s->n) /* a mesh of ours takes the most accurate solver */
        c->method[last].solver = br_linear_solvers[0];
    return (int)last;
}

/* Whether a comparison failed, and why. TIME and SPACE only split the error of the run itself. */
static bool failed(const struct comparison *c, bool longer_steps, char why[200])
{
    const struct br_error *failure = &c->study.failure;
    for (int i = 0; !failure->status && i < CELLS; i++) {
        if (c->at[i] < 0 || (c->beyond == 0 && (i == TIME || i == SPACE)))
            continue;
        if (c->study.cell[c->at[i]].unstable) {
            snprintf(why, 200, "the lagged contact is beyond its stability limit%s",
                     longer_steps ? " at the steps of a cheap march" : "");
            return true;
        }
        failure = &c->study.cell[c->at[i]].failure;
    }
    if (failure->status)
        snprintf(why, 200, "a march that predicts it failed: %.150s", failure->message);
    return failure->status;
}

/* Marches a comparison, and clears it if it fails. */
static enum br_status march(struct marches *m, int which, const struct setting *s,
                            struct br_error *err)
{
    struct comparison *c = &m->by[which];
    const bool chosen = s->reference->scheme->adaptive, itself = which == TIGHT;
    const size_t fine = s->n * s->finer, many = s->steps * s->shorter;
    const size_t coarse = s->finer > 1 ? fine / 2 : fine, some = s->shorter > 1 ? many / 2 : many;
    struct br_error failure = {0};
    br_study_clear(&c->study);
    br_study_clear(&c->tip);
    *c = (struct comparison){.active = true, .scene = *m->run->scene, .beyond = itself ? 0 : 1};
    if (which == START)
        c->scene.duration *= (double)s->steps / (double)m->run->steps;
    c->study = (struct br_study){.scene = &c->scene, .norm = &br_norm_l2, .method = *s->own};
    c->study.reference_kind = &br_reference_fine;
    c->study.reference_method = *s->reference;
    c->study.reference = (struct br_resolution){fine, many};
    c->study.path = true;
    c->study.here = true; /* only the first rank predicts */
    c->study.n = c->n;
    c->study.steps = c->steps;
    c->study.cell_method = c->method;
    c->at[RUN] = place(c, s, s->own, s->n, s->steps);
    c->at[CHECK] = place(c, s, s->check, coarse, some);
    c->at[TIME] = place(c, s, s->own, fine, s->steps);
    c->at[SPACE] = place(c, s, s->check, s->n, some);
    c->at[STEPS] = place(c, s, s->check, fine, some);
    const bool fewer_n = which == IN_SPACE && s->n < m->run->n;
    const bool fewer_steps = which == IN_TIME && !chosen && s->steps < m->run->steps;
    c->at[HALF] = fewer_n       ? place(c, s, s->own, s->n / 2, s->steps)
                  : fewer_steps ? place(c, s, s->own, s->n, s->steps / 2)
                                : -1;
    c->tip = c->study;
    c->tip.norm = &br_norm_tip;
    c->study.next_norm = &c->tip;
    if (br_study_run_each(&c->study, 1, 1, NULL, &failure)) {
        if (failure.status != BR_INTERRUPTED) /* by itself, for its many steps */
            return br_fail(err, failure.status, "%s", failure.message);
        c->study.failure = failure;
    }
    c->active = !failed(c, which == IN_TIME && s->steps < m->run->steps, m->why);
    return BR_OK;
}

static double off(const struct comparison *c, enum cell cell, enum br_field_kind kind)
{
    const enum br_part part = br_part_of(kind);
    return c->at[cell] < 0 ? 0 : c->study.cell[c->at[cell]].error[part];
}

/* The least power of two, 2 or 4 at least, that makes n elements so many. */
static size_t refinement(size_t n, size_t most)
{
    size_t ratio = n < MANY_N ? 4 : 2;
    while (n * ratio < most)
        ratio *= 2;
    return ratio;
}

/* R by a tolerance: not for friction that follows the load at once, where stages overshoot. */
static enum br_status march_tight(struct marches *m, int which, const struct br_method *own,
                                  size_t n, size_t steps, struct br_error *err)
{
    const struct br_planned_march *o = m->run;
    struct br_method r = br_accurate_method(own, "adaptive"), check;
    const bool adaptive = own->scheme->adaptive;
    const size_t finer = which == TIGHT ? refinement(n, SPACE_N) : 1;
    size_t shorter = 1;
    while (which == TIGHT && !adaptive && steps * shorter < LOAD_LEVELS)
        shorter *= 2;
    r.most_steps = 1 + (size_t)(budget(o) / 2 / (solve(o, n * finer) * chosen_stages));
    r.tolerance = fmax(adaptive ? own->tolerance / tighter : tight, tightest);
    check = r;
    check.tolerance =
        fmax(adaptive ? own->tolerance / sqrt(tighter) : tight * sqrt(tighter), tightest);
    if ((which == TIGHT && steps * shorter + LEAST_STEPS > r.most_steps) ||
        (!adaptive && at_once(o)))
        return BR_OK;
    return march(m, which, &(struct setting){n, steps, finer, shorter, own, &check, &r}, err);
}

/* Time and space apart: its steps on a coarse mesh, its elements with few steps. Two marches that
 * both step over a peak of the load agree, but friction keeps the effect of the peak: for a beam
 * that follows its load at once R has as many steps as the budget allows. */
static enum br_status march_one_by_one(struct marches *m, size_t n, struct br_error *err)
{
    enum { SHORTER = 16 };
    const struct br_planned_march *o = m->run;
    const struct br_method best = br_accurate_method(o->method, at_once(o) ? "euler" : "esdirk4");
    struct br_method own = *o->method;
    const double most = budget(o) / solve(o, n), r = 1.5 * stages(&best), steps = (double)o->steps;
    struct setting time = {n, o->steps, 1, 4, &own, &best, &best};
    enum br_status status;
    if (own.scheme->adaptive) {
        own.tolerance = fmax(own.tolerance, loosest);
        status = march_tight(m, IN_TIME, &own, n, LEVELS, err);
        m->by[IN_TIME].beyond = own.tolerance / o->method->tolerance;
    } else {
        while ((time.shorter < SHORTER || at_once(o)) &&
               steps * (stages(&own) + 2 * (double)time.shorter * r) <= most)
            time.shorter *= 2;
        if (steps * (stages(&own) + 4 * r) > most) /* half of them odd: a periodic load is seen */
            time.steps = 2 * ((size_t)(most / (3 * stages(&own) + 8 * r)) | 1);
        status = march(m, IN_TIME, &time, err);
        m->by[IN_TIME].beyond = steps / (double)time.steps;
    }
    struct setting space = {least(o->n, SPACE_N), 1, 4, 1, &best, &best, &best};
    space.finer = refinement(space.n, SPACE_N);
    const double a_step = 2 * solve(o, space.n * space.finer) * stages(&best);
    const double few = budget(o) / 3 / a_step + 1;
    space.steps = own.scheme->adaptive || steps > few ? (size_t)few : o->steps;
    if (!status)
        status = march(m, IN_SPACE, &space, err);
    m->by[IN_SPACE].beyond = (double)o->n / (double)space.n;
    return status;
}

static enum br_status march_all(struct marches *m, struct br_error *err)
{
    const struct br_planned_march *o = m->run;
    const bool adaptive = o->method->scheme->adaptive;
    const size_t levels = adaptive ? least(o->steps, LEVELS) : o->steps;
    const size_t coarse = least(o->n, COARSE_N);
    enum br_status status = march_tight(m, TIGHT, o->method, o->n, levels, err);
    if (status || m->by[TIGHT].active)
        return status;
    status = march_one_by_one(m, coarse, err);
    return status || adaptive
               ? status
               : march_tight(m, START, o->method, coarse, least(o->steps, FIRST), err);
}

/* ---- from distances to an error ---- */

/* An error is uncertain by a factor: where the tip can switch, a finer R does not show how far off
 * the point is where it comes to rest; else the norm samples only the run's levels and elements. */
static const double doubt = 3, measured_doubt = 2;

/* The error of a reference of order one over its distance from its check, at most; and the orders
 * that reference_error distinguishes. */
static const double of_check = 1.5, lowest_order = 0.25, highest_order = 1;

/* The accumulated error of steps by a tolerance without switches, in tolerances: measured. Errors
 * are like tolerance^p: the least, the expected, the highest p. */
static const double gathered = 10, by_tolerance[] = {0.6, 0.9, 1.2};

/* A lower observed order counts as no convergence. */
static const double least_order = 0.5;

/* An interval is useful if its ends differ by at most the factor `widest`, or if its upper end is
 * below the solution (`all`) or within the factor `near` of the expected error. The two factors
 * keep what a reader can use: an order of magnitude upwards, two and a half in all. */
static const double widest = 300, all = 1, near = 10;

/* The largest ratio of true to predicted round-off: measured. */
static const double of_round_off = 4;

static bool can_switch(const struct br_scene *scene)
{
    return br_contact_pushes(&scene->contact) || scene->friction.law != BR_FRICTIONLESS;
}

/* A factor, in L2, by which a layer at the tip moves more than n elements that are wider than the
 * layer. Waves and diffusion make it so deep until t = T. The worst cases are a force on a rod,
 * whose tip moves by 1/h, and a moment on a beam, by 1/h^2. */
static double unresolved(const struct br_scene *s, enum br_field_kind kind, size_t n)
{
    const struct br_field f = br_field_of_scene(s, kind, n, s->duration, 1);
    const double waves = sqrt(f.stiffness / s->density) * s->duration;
    const double spread = f.viscosity * s->duration / s->density;
    const double depth = kind == BR_AXIAL ? waves + sqrt(spread) : sqrt(waves) + sqrt(sqrt(spread));
    return pow(fmax(1, br_mesh_size(s, n) / depth),
               kind == BR_AXIAL ? 0.5 : 1.5); /* NaN: no mass */
}

/* A bound of the error of R. Two cells have 1/a and 1/2 of its elements or steps, and the distances
 * `coarse` and `finer` from it; the order q solves coarse/finer = (a^q - 1)/(2^q - 1). Where
 * nothing converges, it is `unresolved` times as large. */
static double reference_error(double coarse, double a, double finer, double unresolved)
{
    double low = lowest_order, high = highest_order;
    for (int i = 0; i < 30; i++) {
        const double q = (low + high) / 2;
        if ((pow(a, q) - 1) * finer < coarse * (pow(2, q) - 1))
            low = q;
        else
            high = q;
    }
    return of_check * finer / (pow(2, low) - 1) * (low > lowest_order ? 1 : unresolved);
}

/* A cell's error from its distance to R. Two tolerances may choose the same steps: the bound in
 * time is at least the accumulated error of steps by a tolerance. */
static struct br_predicted distance(const struct comparison *c, enum cell cell,
                                    enum br_field_kind kind)
{
    const struct br_study *s = &c->study;
    const double steps = off(c, STEPS, kind), size = s->reference_size[kind];
    const double check = fmax(0, off(c, CHECK, kind) - steps), e = off(c, cell, kind);
    const double shorter = (double)s->reference.steps / (double)c->steps[c->at[RUN]];
    const double finer = (double)s->reference.n / (double)c->n[c->at[RUN]];
    const double in_time =
        s->reference_method.scheme->adaptive
            ? fmax(of_check * steps, gathered * s->reference_method.tolerance * size)
            : reference_error(off(c, TIME, kind), shorter, steps, 1);
    const double in_space = reference_error(fmax(0, off(c, SPACE, kind) - steps), finer, check,
                                            unresolved(&c->scene, kind, s->reference.n));
    const double unsure = in_time + in_space;
    const double factor = can_switch(&c->scene) || c->beyond > 0 ? doubt : measured_doubt;
    return (struct br_predicted){e, fmax(0, (e - unsure) / factor), factor * (e + unsure), NAN};
}

/* The error of RUN, extrapolated to the run by the observed order, at most that of theory; by one
 * if it is not plausible. Switches, and loads that jump or bend, leave order one in time, and
 * coarse marches do not show that, since their error depends on where in a step that happens: so
 * the upper end counts on no more. Errors of friction that iterates grow with the steps. */
static struct br_predicted extrapolated(const struct marches *m, int which, enum br_field_kind kind)
{
    const struct comparison *c = &m->by[which];
    const struct br_method *own = m->run->method;
    const bool time = which == IN_TIME, rubs = m->run->scene->friction.law != BR_FRICTIONLESS;
    const double theory = !time ? (kind == BR_AXIAL ? own->axial_degree + 1 : 4)
                          : own->contact->at_new_step ? own->scheme->order
                                                      : 1;
    const double observed = log2(off(c, HALF, kind) / off(c, RUN, kind));
    const bool plausible = observed >= least_order;
    const double expected = fmin(plausible ? observed : 1, theory);
    double order[] = {plausible ? expected : 0, expected, theory};
    if (time)
        order[0] = fmin(order[0], 1);
    if (time && rubs && own->friction->iterates)
        order[0] = -1;
    const double *p = time && own->scheme->adaptive ? by_tolerance : order;
    const struct br_predicted e = distance(c, RUN, kind);
    if (!(c->beyond > 1))
        return e;
    return (struct br_predicted){e.error * pow(c->beyond, -p[1]), e.low * pow(c->beyond, -p[2]),
                                 e.high * pow(c->beyond, -p[0]), observed};
}

/* The error of time (TIME), of space (SPACE) or of both (RUN), which may have opposite signs. Equal
 * steps may miss what decays within a step: where time counts, the error is at least that of the
 * first steps. */
static struct br_predicted error_of(const struct marches *m, enum cell cell,
                                    enum br_field_kind kind)
{
    const struct comparison *c = &m->by[TIGHT];
    struct br_predicted e = c->active ? distance(c, cell, kind)
                                      : extrapolated(m, cell == SPACE ? IN_SPACE : IN_TIME, kind);
    if (cell != SPACE && m->by[START].active) {
        const double first = off(&m->by[START], RUN, kind);
        e.error = fmax(e.error, first);
        e.low = fmax(e.low, first / doubt);
        e.high = fmax(e.high, first * doubt);
    }
    if (cell == RUN && !c->active) {
        const struct br_predicted space = extrapolated(m, IN_SPACE, kind);
        e.error += space.error;
        e.low = fmax(e.low, space.low);
        e.high += space.high;
    }
    return e;
}

/* ---- what no march follows ---- */

/* What happens within one step of k, s, of the finest march, unless steps by a tolerance have
 * followed the start; NULL: nothing. A field's first mode, clamped and free, is compared with k:
 * its frequency, and the decay of its velocity. */
static const char *unresolved_start(const struct marches *m, double k)
{
    const struct br_scene *s = m->run->scene;
    if (m->by[TIGHT].active || m->by[START].active)
        return NULL;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const bool rod = kind == BR_AXIAL;
        const struct br_field f = br_field_of_scene(s, kind, m->run->n, k, 1);
        const double curved = rod ? pow(1.5708 / s->length, 2) : pow(1.8751 / s->length, 4);
        const double angular = sqrt(f.stiffness * curved / s->density);
        double tip = 0;
        if (!s->field[kind].modelled || s->density == 0)
            continue;
        if (rod)
            br_function_evaluate(&s->axial.displacement, 1, &s->length, 0, &tip);
        const double force = rod && s->contact.modelled ? br_contact_force(&s->contact, tip) : 0;
        if (br_contact_slope(&s->contact, force) > br_contact_limit_stiffness(&f))
            return "how the contact, closed at t = 0, pushes the tip back";
        if (can_switch(s) && angular * k > 1 && f.viscosity * angular < 2 * f.stiffness)
            return "the oscillations after t = 0, in which the tip may switch";
        if (!br_function_is_zero(&s->field[kind].velocity) && f.viscosity * curved * k > s->density)
            return "how the velocity of t = 0 dies away";
    }
    return NULL;
}

/* Loads or initial data that are too short even for R, which has the elements of a comparison. It
 * meets them at the stages of its steps: FINER_LEVELS times a level of the run (16 steps of 4
 * stages), STAGES times between two of its own levels (4 steps of 4), which its tolerance has it
 * take where a load changes. *name (out): NULL: none. Fails with BR_NO_MEMORY. */
static enum br_status find_too_short(const struct marches *m, const char **name,
                                     struct br_error *err)
{
    enum { STAGES = 16, FINER_LEVELS = 64 };
    static const double ignored = 1e-3; /* a smaller share of a load is ignored */
    const struct comparison *c = &m->by[m->by[TIGHT].active ? TIGHT : IN_SPACE];
    const size_t resolved = STAGES * c->study.reference.steps;
    struct br_planned_march finer = *m->run;
    struct br_warnings w = {0};
    finer.steps *= FINER_LEVELS;
    finer.steps = m->by[TIGHT].active && resolved > finer.steps ? resolved : finer.steps;
    finer.n *= c->study.reference.n / c->n[c->at[RUN]];
    *name = NULL;
    if (br_check_loads(&finer, &w, err))
        return err->status;
    if (fmax(w.unresolved[BR_WARN_LOAD_TIME], w.unresolved[BR_WARN_LOAD_SPACE]) > ignored)
        *name = "a load is";
    if (w.unresolved[BR_WARN_INITIAL] > ignored)
        *name = "the initial data are";
    return BR_OK;
}

/* ---- the verdict ---- */

/* An error relative to the solution, whose size differs among the marches: a coarse mesh may move
 * far more than a fine one. If a field is at rest, the size of the other one counts. */
static struct br_predicted relative(const struct marches *m, struct br_predicted e,
                                    enum br_field_kind kind, double *largest)
{
    double least = INFINITY;
    *largest = 0;
    for (int i = TIGHT; i < START; i++) {
        const double *norm = m->by[i].study.reference_size;
        const double size = norm[kind] > 0 ? norm[kind] : norm[1 - kind];
        least = m->by[i].active ? fmin(least, size) : least;
        *largest = m->by[i].active ? fmax(*largest, size) : *largest;
    }
    if (e.high == 0)
        return (struct br_predicted){.order = e.order};
    return (struct br_predicted){e.error / least, e.low / *largest, e.high / least, e.order};
}

/* The largest ratio of RUN's error at the tip to its L2 norm, m^(-1/2). */
static double at_tip(const struct marches *m, enum br_field_kind kind)
{
    const enum br_part part = br_part_of(kind);
    double most = 0;
    for (const struct comparison *c = m->by + TIGHT; c < m->by + START; c++)
        if (c->active && off(c, RUN, kind) > 0)
            most = fmax(most, c->tip.cell[c->at[RUN]].error[part] / off(c, RUN, kind));
    return most;
}

static void set_estimate(struct br_prediction *p, const struct marches *m)
{
    const struct comparison *by = m->by;
    bool useful = true, finite = true;
    snprintf(p->why, sizeof p->why, "%s", m->why);
    p->whole.high = -1;
    p->bounded = by[TIGHT].active || (by[IN_TIME].active && by[IN_SPACE].active);
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && p->bounded; kind++) {
        double size;
        if (!m->run->scene->field[kind].modelled)
            continue;
        const struct br_predicted e = p->field[kind] =
            relative(m, error_of(m, RUN, kind), kind, &p->size[kind]);
        p->at_tip[kind] = at_tip(m, kind);
        finite = finite && isfinite(e.high);
        useful = useful && (e.high <= fmax(all, near * e.error) || e.high <= widest * e.low);
        if (!(e.high > p->whole.high))
            continue;
        p->whole = e;
        p->time = relative(m, error_of(m, TIME, kind), kind, &size);
        p->space = relative(m, error_of(m, SPACE, kind), kind, &size);
    }
    if (!p->bounded)
        return;
    const char *unresolved =
        unresolved_start(m, br_time_step(m->run->scene, by[IN_TIME].study.reference.steps));
    p->bounded = finite && !unresolved;
    p->known = p->bounded && useful;
    snprintf(p->why, sizeof p->why, "%s%s", unresolved ? "no march that predicts it resolves " : "",
             p->known     ? ""
             : unresolved ? unresolved
                          : "the marches that predict it differ too much from each other");
    /* If an error may be as large as the solution, the marches may be as wrong, too: they give no
     * upper bound. */
    struct br_predicted *const each[] = {&p->field[0], &p->field[1], &p->space, &p->time,
                                         &p->whole};
    for (size_t i = 0; i < sizeof each / sizeof *each && p->known; i++)
        if (each[i]->high > all)
            each[i]->high = INFINITY;
}

const char *br_predicted_interval(const struct br_predicted *e, char text[BR_PREDICTED_TEXT])
{
    if (isfinite(e->high))
        snprintf(text, BR_PREDICTED_TEXT, "%.2g, between %.2g and %.2g", e->error, e->low, e->high);
    else
        snprintf(text, BR_PREDICTED_TEXT, "%.2g, at least %.2g, perhaps more than the solution",
                 e->error, e->low);
    return text;
}

double br_predicted_most(const struct br_prediction *p, enum br_field_kind kind)
{
    return p->known ? p->field[kind].high + of_round_off * p->round_off : INFINITY;
}

double br_predicted_tip(const struct br_prediction *p, enum br_field_kind kind, double length)
{
    const double shape = kind == BR_AXIAL ? 3 : 5;
    return br_predicted_most(p, kind) * p->size[kind] * fmax(sqrt(shape / length), p->at_tip[kind]);
}

double br_predict_round_off(const struct br_planned_march *o)
{
    double largest = 0;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_field field = br_field_of_scene(
            o->scene, kind, o->n, br_time_step(o->scene, o->steps), o->method->axial_degree);
        if (o->scene->field[kind].modelled)
            largest = fmax(largest, br_method_round_off(o->method, &field));
    }
    return largest;
}

enum br_status br_predict(const struct br_planned_march *planned, struct br_prediction *p,
                          struct br_error *err)
{
    const double begun = br_seconds();
    struct marches m = {.run = planned};
    const char *unresolved = NULL;
    *p = (struct br_prediction){.round_off = br_predict_round_off(planned)};
    enum br_status status = march_all(&m, err);
    if (!status)
        set_estimate(p, &m);
    if (!status && p->known)
        status = find_too_short(&m, &unresolved, err);
    if (unresolved) {
        p->known = p->bounded = false;
        snprintf(p->why, sizeof p->why, "%s too short for the marches that predict it", unresolved);
    }
    for (int i = 0; i < COMPARISONS; i++) {
        br_study_clear(&m.by[i].study);
        br_study_clear(&m.by[i].tip);
    }
    p->seconds = br_seconds() - begun;
    return status;
}
