/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/foresee/prediction.h"

#include <math.h>
#include <stdio.h>

#include "solver/clock.h"
#include "solver/laws.h"
#include "study/foresee/prediction_probes.h"

/* The uncertainty of an extrapolated error: a factor. */
static const double doubt = 3;

/* The same of a distance from a surer reference: the norm samples only the levels and elements of
 * the run. */
static const double measured_doubt = 2;

static bool can_switch(const struct br_scene *scene)
{
    return (scene->contact.modelled && scene->contact.stiffness > 0) ||
           scene->friction.law != BR_FRICTIONLESS;
}

/* The error of a reference of order one over its distance from its check, at most. */
static const double of_check = 1.5;

/* The range of orders that reference_error distinguishes. */
static const double lowest_order = 0.25, highest_order = 1;

/* The largest ratio of true to predicted round-off. */
static const double of_round_off = 4;

/* An interval is useful if its ends differ by at most the factor `widest`, or if its upper end is
 * below the solution (`all`) or within the factor `near` of the expected error. */
static const double widest = 300, all = 1, near = 10;

/* Exponents of the tolerance: least, expected, most. */
static const double by_tolerance[] = {0.6, 0.9, 1.2};

/* A lower observed order counts as no convergence. */
static const double least_order = 0.5;

/* The references sample loads and initial data with so many times the levels and elements of the
 * run. A share below `least_share` that they miss is ignored. */
enum { FINER_LEVELS = 64, FINER_ELEMENTS = 4 };
static const double least_share = 1e-3;

static const enum br_part part_of[2] = {BR_PART_AXIAL, BR_PART_BENDING};

/* The smallest and the largest size of a field's solution, among the marches up to t = T: a coarse
 * mesh may move far more than a fine one. If the field is at rest in a march, the size of the other
 * field counts. */
struct size {
    double least, most;
};

static struct size solution_size(const struct br_probe_set *s, int kind)
{
    struct size size = {INFINITY, 0};
    for (int i = 0; i < BR_PROBES; i++) {
        const double *seen = s->probe[i].study.reference_size;
        if (!s->probe[i].active || i == BR_PROBE_START)
            continue;
        const double one = seen[kind] > 0 ? seen[kind] : seen[1 - kind];
        size.least = fmin(size.least, one);
        size.most = fmax(size.most, one);
    }
    return size;
}

static double cell_error(const struct br_probe *p, size_t cell, int kind)
{
    return p->study.cell[cell].error[part_of[kind]];
}

/* Extrapolates the error e of a cell to a resolution that is `beyond` times finer, by the least,
 * the expected and the highest order. */
static struct br_predicted by_orders(double e, double beyond, const double order[3])
{
    return (struct br_predicted){
        .error = e * pow(beyond, -order[1]),
        .low = e * pow(beyond, -order[2]) / doubt,
        .high = e * pow(beyond, -order[0]) * doubt,
        .order = NAN,
    };
}

/* The least, the expected and the highest order of the run, from the observed order and the order q
 * of theory; the least is at most `spoilt`. */
static void bracket(double observed, double q, double spoilt, double order[3])
{
    const bool trusted = observed >= least_order;
    order[1] = trusted ? fmin(observed, q) : fmin(q, 1);
    order[0] = trusted ? fmin(order[1], spoilt) : 0;
    order[2] = fmax(q, order[1]);
}

/* ---- the run itself ---- */

/* The depth to which an event at an end reaches by t = T, by waves and by diffusion, m. */
static double layer(const struct br_scene *s, int kind)
{
    const struct br_field f = br_field_of_scene(s, (enum br_field_kind)kind, 1, s->duration);
    if (s->density == 0)
        return INFINITY;
    const double waves = sqrt(f.stiffness / s->density) * s->duration;
    const double spread = f.viscosity * s->duration / s->density;
    return kind == BR_AXIAL ? waves + sqrt(spread) : sqrt(waves) + pow(spread, 0.25);
}

/* A factor, in L2, by which a layer at the tip moves more than elements that are wider than the
 * layer: these move the mass of a whole element. The worst cases are a force on a rod, whose tip
 * moves by 1/h, and a moment on a beam, by 1/h^2. */
static double unresolved(const struct br_scene *s, int kind, size_t n)
{
    const double wide = br_mesh_size(s, n) / layer(s, kind);
    return pow(fmax(1, wide), kind == BR_AXIAL ? 0.5 : 1.5);
}

/* A bound of the error of a reference. Two cells have 1/a and 1/b of its elements or steps, and the
 * distances `coarse` and `finer` from it; the order q solves coarse/finer = (a^q - 1)/(b^q - 1).
 * If a layer is narrower than all elements, nothing converges: then the bound is `unseen` times
 * larger. */
static double reference_error(double coarse, double a, double finer, double b, double unseen)
{
    double low = lowest_order, high = highest_order;
    for (int i = 0; i < 30; i++) {
        const double q = (low + high) / 2;
        if ((pow(a, q) - 1) * finer < coarse * (pow(b, q) - 1))
            low = q;
        else
            high = q;
    }
    return of_check * finer / (pow(b, low) - 1) * (low > lowest_order ? 1 : unseen);
}

/* The accumulated error of steps by a tolerance, in tolerances, without switching. */
static const double gathered = 10;

/* A bound of the error of the run's own reference: in time from the steps of its check and of the
 * run, in space from three meshes. Two tolerances may choose the same steps, with no difference: so
 * the bound is at least the accumulated error of steps by a tolerance. */
static double whole_reference_error(const struct br_probe *p, int kind)
{
    const double steps = cell_error(p, BR_WHOLE_STEPS, kind);
    const double shorter = (double)p->study.reference.steps / (double)p->steps[BR_WHOLE_RUN];
    const double tolerance = p->study.reference_method.tolerance;
    const double in_time =
        p->study.reference_method.scheme->adaptive
            ? fmax(of_check * steps, gathered * tolerance * p->study.reference_size[kind])
            : reference_error(cell_error(p, BR_WHOLE_TIME, kind), shorter, steps, 2, 1);
    const double finer = fmax(0, cell_error(p, BR_WHOLE_CHECK, kind) - steps);
    const double coarse = fmax(0, cell_error(p, BR_WHOLE_SPACE, kind) - steps);
    const double a = (double)p->study.reference.n / (double)p->n[BR_WHOLE_RUN];
    return in_time +
           reference_error(coarse, a, finer, 2, unresolved(&p->scene, kind, p->study.reference.n));
}

/* An error from a distance e to a reference with an error of at most `unsure`; `factor` widens the
 * interval. */
static struct br_predicted around(double e, double unsure, double factor)
{
    return (struct br_predicted){
        .error = e,
        .low = fmax(0, (e - unsure) / factor),
        .high = factor * (e + unsure),
        .order = NAN,
    };
}

/* A cell's error from its distance to the reference. The interval is wider if the tip can switch: a
 * finer reference does not show how far off the point is where the tip comes to rest. */
static struct br_predicted distance(const struct br_probe *p, enum br_whole_cell cell, int kind)
{
    return around(cell_error(p, cell, kind), whole_reference_error(p, kind),
                  can_switch(&p->scene) ? doubt : measured_doubt);
}

/* The probe with the surer reference for the run's error. Equal steps may miss what decays within a
 * step: their probe is not used if BR_PROBE_TIGHT contradicts it. NULL: the run itself was not
 * marched. */
static const struct br_probe *whole_probe(const struct br_probe_set *s, int kind)
{
    const struct br_probe *tight = &s->probe[BR_PROBE_TIGHT], *whole = &s->probe[BR_PROBE_WHOLE];
    if (!whole->active || !tight->active)
        return whole->active ? whole : tight->active ? tight : NULL;
    const struct br_predicted a = distance(tight, BR_WHOLE_RUN, kind);
    const struct br_predicted b = distance(whole, BR_WHOLE_RUN, kind);
    return b.high < a.low || a.high <= b.high ? tight : whole;
}

/* ---- time ---- */

static struct br_predicted measured_time(const struct br_probe *p, int kind)
{
    const double e = cell_error(p, 0, kind);
    const double finer = p->study.k_count > 1 ? cell_error(p, 1, kind) : e / 2;
    return around(e, reference_error(e, p->ratio, finer, 3, 1), doubt);
}

/* Adds the error of an iteration: it accumulates over the steps if its sign stays the same. */
static struct br_predicted extrapolated_time(const struct br_probe_set *s, int kind)
{
    const struct br_planned_march *o = s->planned;
    const struct br_probe *p = &s->probe[BR_PROBE_TIME], *iterated = &s->probe[BR_PROBE_ITERATION];
    const double q = o->method->contact->at_new_step ? o->method->scheme->order : 1;
    const double fine = cell_error(p, 1, kind), observed = log2(cell_error(p, 0, kind) / fine);
    const double left = iterated->active ? iterated->beyond * cell_error(iterated, 0, kind) : 0;
    double order[3];
    bracket(observed, q, can_switch(o->scene) ? fmin(1, q) : q, order);
    struct br_predicted e = by_orders(fine, p->beyond, order);
    e.order = observed;
    e.error += left;
    e.high += doubt * left;
    return e;
}

/* The error of the run is at least that of its first steps. */
static struct br_predicted and_at_start(const struct br_probe_set *s, struct br_predicted e,
                                        int kind)
{
    const struct br_probe *start = &s->probe[BR_PROBE_START];
    const double first = start->active ? cell_error(start, 0, kind) : 0;
    e.error = fmax(e.error, first);
    e.low = fmax(e.low, first / doubt);
    e.high = fmax(e.high, first * doubt);
    return e;
}

static struct br_predicted time_error(const struct br_probe_set *s, int kind)
{
    const struct br_probe *p = &s->probe[BR_PROBE_TIME], *whole = whole_probe(s, kind);
    const struct br_predicted e = whole ? distance(whole, BR_WHOLE_TIME, kind)
                                  : s->planned->method->scheme->adaptive
                                      ? by_orders(cell_error(p, 0, kind), p->beyond, by_tolerance)
                                  : p->measured ? measured_time(p, kind)
                                                : extrapolated_time(s, kind);
    return and_at_start(s, e, kind);
}

/* ---- space ---- */

static struct br_predicted space_error(const struct br_probe_set *s, int kind)
{
    const struct br_probe *p = &s->probe[BR_PROBE_SPACE], *whole = whole_probe(s, kind);
    if (whole)
        return distance(whole, BR_WHOLE_SPACE, kind);
    const double q = kind == BR_AXIAL ? s->planned->method->axial_degree + 1 : 4;
    const double fine = cell_error(p, p->study.n_count - 1, kind);
    const double unseen = unresolved(s->planned->scene, kind, p->study.reference.n);
    if (fine == 0) /* not modelled, or at rest */
        return (struct br_predicted){.order = NAN};
    if (p->measured)
        return around(cell_error(p, 0, kind),
                      reference_error(cell_error(p, 0, kind), p->ratio, fine, 2, unseen), doubt);
    double order[3]; /* with errors C h^q of cells h and h/2 against h/4 their ratio is 2^q + 1 */
    bracket(log2(cell_error(p, 0, kind) / fine - 1), q, q, order);
    struct br_predicted e =
        by_orders(fine / (1 - pow(p->ratio, -fmax(order[1], least_order))), p->beyond, order);
    e.high *= order[0] > 0 ? 1 : unseen;
    return e;
}

/* ---- both ---- */

static struct br_predicted whole_error(const struct br_probe_set *s, int kind)
{
    const struct br_probe *whole = whole_probe(s, kind);
    if (whole)
        return and_at_start(s, distance(whole, BR_WHOLE_RUN, kind), kind);
    const struct br_predicted time = time_error(s, kind), space = space_error(s, kind);
    return (struct br_predicted){
        .error = time.error + space.error,
        .low = fmax(time.low, space.low), /* they may have opposite signs */
        .high = time.high + space.high,
        .order = NAN,
    };
}

/* An error relative to the solution; 0 if the field is at rest in every march. */
static struct br_predicted relative(struct br_predicted e, struct size size)
{
    if (e.high == 0)
        return (struct br_predicted){.order = e.order};
    return (struct br_predicted){e.error / size.least, e.low / size.most, e.high / size.least,
                                 e.order};
}

static bool is_modelled(const struct br_scene *scene, int kind)
{
    return kind == BR_AXIAL ? scene->axial.modelled : scene->bending.modelled;
}

/* Whether a march with a tolerance has resolved the start, however quick it is. */
static bool start_is_seen(const struct br_probe_set *s)
{
    const struct br_probe *start = &s->probe[BR_PROBE_START];
    return s->probe[BR_PROBE_TIGHT].active ||
           (start->active && start->study.reference_method.scheme->adaptive);
}

/* Whether the slowest vibration of a field, the first clamped-free mode, is quicker than steps of
 * k, s, and is not overdamped. */
static bool swings_within(const struct br_scene *s, int kind, double k)
{
    const struct br_field f = br_field_of_scene(s, (enum br_field_kind)kind, 1, k);
    const double wave = (kind == BR_AXIAL ? 1.5708 : 1.8751) / s->length;
    const double angular = sqrt(f.stiffness / s->density) * (kind == BR_AXIAL ? wave : wave * wave);
    return s->density > 0 && angular * k > 1 && f.viscosity * angular < 2 * f.stiffness;
}

static double finest_step(const struct br_probe_set *s)
{
    const enum br_probe_kind finest =
        s->probe[BR_PROBE_WHOLE].active ? BR_PROBE_WHOLE : BR_PROBE_TIME;
    return s->planned->scene->duration / (double)s->probe[finest].study.reference.steps;
}

/* Whether the tip starts pressed into a contact that releases it within one step of every march: no
 * march then resolves the energy that the rod receives. */
static bool release_unseen(const struct br_probe_set *s)
{
    const struct br_scene *scene = s->planned->scene;
    if (!scene->axial.modelled || !scene->contact.modelled || start_is_seen(s))
        return false;
    double tip;
    br_function_evaluate(&scene->axial.displacement, 1, &scene->length, 0, &tip);
    const struct br_field field = br_field_of_scene(scene, BR_AXIAL, s->planned->n, finest_step(s));
    return tip > scene->contact.gap &&
           scene->contact.stiffness > br_contact_limit_stiffness(&field);
}

/* Whether vibrations that no march resolves may open or close the contact, or slip. */
static bool switches_unseen(const struct br_probe_set *s)
{
    const struct br_scene *scene = s->planned->scene;
    const double k = finest_step(s);
    return can_switch(scene) && !start_is_seen(s) &&
           ((scene->axial.modelled && swings_within(scene, BR_AXIAL, k)) ||
            (scene->bending.modelled && swings_within(scene, BR_BENDING, k)));
}

/* The error by a peak of the load between two steps of the finest march, relative to the solution:
 * friction keeps the largest displacement, and steps over a peak miss a share of (k/T)^2 of it. */
static double unseen_peak(const struct br_probe_set *s)
{
    static const double curved = 10; /* a peak: how much more than the load's mean curvature */
    const struct br_planned_march *o = s->planned;
    if (o->method->scheme->adaptive || /* its steps are as short as peaks ask for */
        !br_follows_at_once(o->scene, br_time_step(o->scene, o->steps)))
        return 0;
    const double share = finest_step(s) / o->scene->duration;
    return curved * share * share;
}

static void judge(struct br_prediction *p, const struct br_probe_set *s)
{
    for (int i = BR_PROBE_TIME; i < BR_PROBES; i++)
        if (br_probe_failed(&s->probe[i], p->why))
            return;
    bool useful = true;
    p->bounded = true;
    p->whole.high = -1;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct size size = solution_size(s, kind);
        if (!is_modelled(s->planned->scene, kind))
            continue;
        p->size[kind] = size.most;
        struct br_predicted e = relative(whole_error(s, kind), size);
        e.high += unseen_peak(s);
        p->field[kind] = e;
        p->bounded = p->bounded && isfinite(e.high);
        useful = useful && (e.high <= fmax(all, near * e.error) || e.high <= widest * e.low);
        if (e.high <= p->whole.high)
            continue;
        p->whole = e;
        p->time = relative(time_error(s, kind), size);
        p->space = relative(space_error(s, kind), size);
    }
    p->known = p->bounded && useful && !release_unseen(s) && !switches_unseen(s);
    if (!(p->bounded && useful))
        snprintf(p->why, sizeof p->why,
                 "the marches that predict it differ too much from each other");
    else if (!p->known)
        snprintf(p->why, sizeof p->why, "no march that predicts it resolves %s",
                 release_unseen(s) ? "how the contact, closed at t = 0, pushes the tip back"
                                   : "the oscillations after t = 0, in which the tip may switch");
    /* If an error may be as large as the solution, the marches may be as wrong, too: they give no
     * upper bound. */
    struct br_predicted *const each[] = {&p->field[0], &p->field[1], &p->space, &p->time,
                                         &p->whole};
    for (size_t i = 0; i < sizeof each / sizeof *each && p->bounded && useful; i++)
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
    return br_predicted_most(p, kind) * p->size[kind] * sqrt(shape / length);
}

double br_predict_round_off(const struct br_planned_march *o)
{
    double largest = 0;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        struct br_field field = br_field_of_scene(o->scene, (enum br_field_kind)kind, o->n,
                                                  br_time_step(o->scene, o->steps));
        field.degree = o->method->axial_degree;
        if (is_modelled(o->scene, kind))
            largest = fmax(largest, br_method_round_off(o->method, &field));
    }
    return largest;
}

/* Names loads or initial data that are too short even for the references; *name (out): NULL: none.
 * Fails with BR_NO_MEMORY. */
static enum br_status find_too_short(const struct br_planned_march *o, const char **name,
                                     struct br_error *err)
{
    struct br_planned_march finer = *o;
    struct br_warnings unseen = {0};
    finer.steps *= FINER_LEVELS;
    finer.n *= FINER_ELEMENTS;
    *name = NULL;
    if (br_check_loads(&finer, &unseen, err))
        return err->status;
    const double of_load =
        fmax(unseen.unseen[BR_WARN_LOAD_TIME], unseen.unseen[BR_WARN_LOAD_SPACE]);
    *name = unseen.unseen[BR_WARN_INITIAL] > least_share ? "the initial data are"
            : of_load > least_share                      ? "a load is"
                                                         : NULL;
    return BR_OK;
}

enum br_status br_predict(const struct br_planned_march *planned, struct br_prediction *p,
                          struct br_error *err)
{
    const double begun = br_seconds();
    struct br_probe_set set;
    *p = (struct br_prediction){.round_off = br_predict_round_off(planned)};
    enum br_status status = br_probes_march(&set, planned, err);
    if (!status)
        judge(p, &set);
    const char *unseen = NULL;
    if (!status && p->known)
        status = find_too_short(planned, &unseen, err);
    if (unseen) {
        p->known = p->bounded = false;
        snprintf(p->why, sizeof p->why, "%s too short for the marches that predict it", unseen);
    }
    br_probes_clear(&set);
    p->seconds = br_seconds() - begun;
    return status;
}
