/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/extremes.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_sort.h>
#include <math.h>
#include <string.h>

#include "reference/energy/energy.h"
#include "solver/laws.h"
#include "study/grid/each.h"
#include "study/run/run.h"

const double br_stability_tolerance = 1e-9;

/* An eigenvalue counts as outside the unit circle if it is outside by more than this. */
static const double outside = 1e-11;

enum { A_DECADE = 4, DECADES_OF_STEPS = 5 };

const struct br_stability_rod br_stability_rods[BR_STABILITY_RODS] = {
    {"example", "the paper's Examples", 1e-4, 1, 1},
    {"quasi-static", "without inertia", 0, 1, 1},
    {"heavy", "much inertia", 1000, 1, 1},
    {"light-damping", "little viscosity", 1, 1e-6, 1},
    {"undamped", "no viscosity", 1, 0, 1},
    {"quadratic", "quadratic elements", 1, 1e-3, 2},
};

struct br_field br_stability_field(const struct br_stability_rod *rod, size_t n, double k)
{
    return (struct br_field){
        .kind = BR_AXIAL,
        .n = n,
        .h = 1.0 / (double)n,
        .density = rod->density,
        .stiffness = 1000,
        .viscosity = rod->viscosity,
        .k = k,
        .degree = rod->degree,
    };
}

struct br_scene br_stability_scene(const struct br_field *field, double duration)
{
    return (struct br_scene){
        .length = (double)field->n * field->h,
        .duration = duration,
        .density = field->density,
        .axial = {.modelled = true, .stiffness = field->stiffness, .viscosity = field->viscosity},
        .contact = {.modelled = true},
    };
}

/* ---- a row: one rod, one time step ---- */

/* Finds by bisection the c_H at which the largest eigenvalue leaves the unit circle. */
static enum br_status find_limit(const struct br_field *field, double low, double high,
                                 double *limit, struct br_error *err)
{
    while (high / low - 1 > 1e-14) {
        const double middle = sqrt(low) * sqrt(high);
        double radius;
        if (!(middle > low && middle < high))
            break;
        const enum br_status status = br_step_radius(field, middle, &radius, err);
        if (status)
            return status;
        if (radius > 1 + outside)
            high = middle;
        else
            low = middle;
    }
    *limit = low;
    return BR_OK;
}

static enum br_status measure_row(void *self, size_t i, struct br_error *err)
{
    const struct br_stability *s = self;
    struct br_stability_row *r = &s->row[i];
    const struct br_field field = br_stability_field(r->rod, s->n, r->k);
    r->limit = br_contact_limit_stiffness(&field);
    r->bouncing = br_contact_limit_bouncing(&field);
    r->measured = NAN;
    for (size_t j = 0; j < BR_STABILITY_COLUMNS; j++) {
        const enum br_status status = br_step_radius(&field, s->stiffness[j], &r->radius[j], err);
        if (status)
            return status;
        r->growth[j] = br_contact_growth(&field, s->stiffness[j]);
    }
    size_t first = 0;
    while (first < BR_STABILITY_COLUMNS && !(r->radius[first] > 1 + outside))
        first++;
    if (first == 0 || first == BR_STABILITY_COLUMNS)
        return BR_OK; /* no limit within the columns */
    return find_limit(&field, s->stiffness[first - 1], s->stiffness[first], &r->measured, err);
}

/* ---- all rows ---- */

static enum br_status measure_planes(struct br_stability *s, const struct br_extremes_job *job,
                                     struct br_error *err)
{
    const struct br_each each = {.count = BR_STABILITY_RODS * s->rows,
                                 .threads = job->threads,
                                 .observer = job->observer,
                                 .turn = measure_row,
                                 .self = s};
    gsl_error_handler_t *handler = gsl_set_error_handler_off(); /* it would end the program */
    const enum br_status status = br_each(&each, err);
    gsl_set_error_handler(handler);
    return status;
}

/* ---- tips: pressed ones near and beyond the limit of the lagged contact, and ones that bounce
 * ---- */

static const double tip_shares[BR_STABILITY_TIPS] = {0.5, 0.9, 0.99, 1.01, 1.1, 2, 10, 1e3, 1e6};

/* c_H over the limit of a contact that closes and opens; from the fifth on, of a closed one. */
static const double bounce_shares[BR_STABILITY_BOUNCES] = {0.1, 0.5, 0.9, 1, 0.1, 0.5, 0.9, 0.99};
enum { OF_BOUNCING = 4, TIP_STEPS = 4000, BOUNCE_STEPS = 20000 };

struct watch {
    struct br_stability_tip *tip;
    const struct br_contact *contact;
    size_t quarter;   /* the last one begins after this step */
    double low, high; /* u(L) there, m */
    double start;     /* energy, J */
    bool closed;
};

static double energy_of(const struct br_march *march, const struct br_contact *contact)
{
    const struct br_field *field = br_march_field(march, BR_AXIAL);
    const size_t size = br_field_size(field);
    double nodal[2 * (BR_STABILITY_MOST_ELEMENTS + 1)];
    br_march_get(march, BR_AXIAL, nodal, nodal + size);
    const double depth = br_penetration(contact, nodal[size - 1]);
    return br_energy_stored(field, nodal) + br_energy_kinetic(field, nodal + size) +
           contact->stiffness / 2 * depth * depth;
}

/* Records a step. Only a thrown rod has energy at the start. */
static void record(struct watch *w, const struct br_march *march, size_t step)
{
    struct br_stability_tip *t = w->tip;
    const double u = br_march_tip(march)->displacement, energy = energy_of(march, w->contact);
    const bool closed = br_march_tip(march)->contact_force > 0;
    if (step == 0)
        w->start = energy;
    else if (w->start > 0)
        t->energy = br_worst(t->energy, energy / w->start);
    t->farthest = br_worst(t->farthest, fabs(u));
    if (step > w->quarter) {
        w->low = fmin(w->low, u);
        w->high = fmax(w->high, u);
        t->opened += w->closed && !closed;
    }
    t->impacts += closed && !w->closed;
    w->closed = closed;
}

/* unit: of displacements, m. A march that fails is a result: its numbers are NaN. */
static enum br_status march_tip(struct br_stability_tip *tip, struct br_scene *scene, size_t n,
                                size_t steps, double unit, struct br_error *err)
{
    const struct br_method method = br_method_default();
    struct watch w = {.tip = tip,
                      .contact = &scene->contact,
                      .quarter = steps * 3 / 4,
                      .low = INFINITY,
                      .high = -INFINITY};
    struct br_error failure = {0};
    struct br_march *march;
    scene->contact.stiffness = tip->stiffness;
    enum br_status status = br_march_create(&march, scene, n, steps, &method, &failure);
    for (size_t i = 0; i <= steps && !status; i++) {
        if (i > 0)
            status = br_march_step(march, &failure);
        if (!status)
            record(&w, march, i);
    }
    br_march_free(march);
    tip->swing = status ? NAN : (w.high - w.low) / unit;
    tip->farthest = status ? NAN : tip->farthest / unit;
    tip->energy = status ? NAN : tip->energy;
    return status == BR_NO_MEMORY ? br_fail(err, status, "%s", failure.message) : BR_OK;
}

static struct br_load constant_load(double size)
{
    return (struct br_load){{{{.constant = size}, {.constant = 1}}}};
}

static enum br_status press(struct br_stability *s, struct br_error *err)
{
    s->tip_k = 1e-3;
    const struct br_field field = br_stability_field(&br_stability_rods[0], s->n, s->tip_k);
    struct br_scene scene = br_stability_scene(&field, s->tip_k * TIP_STEPS);
    const double force = field.stiffness; /* N/m */
    const double free_tip = force * scene.length * scene.length / 2 / field.stiffness;
    scene.axial.load = constant_load(force);
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_STABILITY_TIPS && !status; i++) {
        s->tip[i].limit = tip_shares[i];
        s->tip[i].stiffness = tip_shares[i] * br_contact_limit_stiffness(&field);
        status = march_tip(&s->tip[i], &scene, s->n, TIP_STEPS, free_tip, err);
    }
    return status;
}

/* All points of the rod start with the same velocity. */
static enum br_status bounce(struct br_stability *s, struct br_error *err)
{
    s->bounce_k = 1e-5;
    const struct br_field field =
        br_stability_field(&br_stability_rods[4], BR_STABILITY_MOST_ELEMENTS, s->bounce_k);
    struct br_scene scene = br_stability_scene(&field, s->bounce_k * BOUNCE_STEPS);
    scene.axial.velocity.constant = 1;
    scene.contact.gap = 0.01;
    const double bouncing = br_contact_limit_bouncing(&field);
    const double limit = br_contact_limit_stiffness(&field);
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_STABILITY_BOUNCES && !status; i++) {
        struct br_stability_tip *b = &s->bounce[i];
        b->stiffness = bounce_shares[i] * (i < OF_BOUNCING ? bouncing : limit);
        b->bouncing = b->stiffness / bouncing;
        b->limit = b->stiffness / limit;
        status = march_tip(b, &scene, field.n, BOUNCE_STEPS, 1, err);
    }
    return status;
}

/* ---- contact at u_n has no limit: every scheme of the registry brings a pressed rod to its rest
 * ---- */

static const double load = 1000; /* N/m, from t = 0 on */

/* Enough for the adaptive scheme to pass over the vibrations of a few elements against a rigid
 * wall. */
static const size_t elements = 8;

/* The rest by the balance of the whole rod: the free tip is at q L^2 / (2 a), and the contact's
 * share of q L / 2 is c_H L over a + c_H L. */
static void compare(struct br_stability_scheme *c, const struct br_scene *scene,
                    const struct br_history_row *end)
{
    const double stiffness = scene->contact.stiffness, a = scene->axial.stiffness;
    const double free_tip = load / 2 / a, rest = load / 2 / (a + stiffness);
    c->force = br_worst(c->force, fabs(end->contact_force / (stiffness * rest) - 1));
    c->depth = br_worst(c->depth, fabs(end->displacement[BR_AXIAL] - rest) / free_tip);
}

static enum br_status try_one(struct br_stability_scheme *c, const struct br_scene *scene,
                              size_t steps, struct br_run_report *report, struct br_error *err)
{
    struct br_run_request request = {.scene = scene,
                                     .method = br_method_default(),
                                     .n = elements,
                                     .steps = steps,
                                     .check = true};
    struct br_error failure = {0};
    request.method.scheme = c->scheme;
    request.method.contact = br_contact_rule_find("implicit");
    const enum br_status status = br_run(&request, report, &failure);
    if (status == BR_NO_MEMORY)
        return br_fail(err, status, "%s", failure.message);
    c->marches++;
    if (status || report->failure.status) {
        c->failed++;
        return BR_OK;
    }
    c->uncertain += report->bad_steps > 0;
    compare(c, scene, &report->end.last);
    return BR_OK;
}

static enum br_status try_schemes(struct br_stability *s, struct br_error *err)
{
    static const double stiffness[] = {1, 1e3, 1e6, 1e9, 1e12, 1e15};
    static const size_t steps[] = {10, 100, 1000};
    const struct br_field rod = br_stability_field(&br_stability_rods[0], 1, 1);
    struct br_scene scene = br_stability_scene(&rod, 1);
    struct br_run_report *report = br_allocate(1, sizeof *report);
    enum br_status status = report ? BR_OK : br_no_memory(err, "the schemes' stability");
    scene.axial.load = constant_load(load);
    for (size_t i = 0; br_time_schemes[i] && i < BR_STABILITY_SCHEMES && !status; i++) {
        struct br_stability_scheme *c = &s->scheme[s->schemes++];
        *c = (struct br_stability_scheme){.scheme = br_time_schemes[i]};
        for (size_t j = 0; j < 18 && !status; j++) {
            scene.contact.stiffness = stiffness[j / 3];
            status = try_one(c, &scene, steps[j % 3], report, err);
        }
    }
    free(report);
    return status;
}

/* ---- what is tried ---- */

static enum br_status check_job(const struct br_extremes_job *job, struct br_error *err)
{
    if (job->n_count > 1)
        return br_fail(err, BR_BAD_INPUT, "--n: found %zu numbers, expected one", job->n_count);
    if (job->n_count && job->n[0] > BR_STABILITY_MOST_ELEMENTS)
        return br_fail(
            err, BR_BAD_INPUT,
            "n is %zu, expected at most %d elements: all eigenvalues of a step are taken",
            job->n[0], BR_STABILITY_MOST_ELEMENTS);
    for (size_t i = 0; i < job->k_count; i++)
        if (!(job->k[i] >= 1e-9 && job->k[i] <= 1e3))
            return br_fail(err, BR_BAD_INPUT, "k is %g s, expected 1e-9 s to 1000 s", job->k[i]);
    return BR_OK;
}

static enum br_status prepare(struct br_stability *s, const struct br_extremes_job *job,
                              struct br_error *err)
{
    s->n = job->n_count ? job->n[0] : 8;
    s->rows = job->k_count ? job->k_count : DECADES_OF_STEPS * A_DECADE + 1;
    s->row = br_allocate(BR_STABILITY_RODS * s->rows, sizeof *s->row);
    if (!s->row)
        return br_no_memory(err, "the planes of stability");
    for (size_t j = 0; j < BR_STABILITY_COLUMNS; j++)
        s->stiffness[j] = pow(10, (double)j / A_DECADE);
    for (size_t i = 0; i < BR_STABILITY_RODS * s->rows; i++) {
        const size_t j = i % s->rows;
        s->row[i].rod = &br_stability_rods[i / s->rows];
        s->row[i].k = job->k_count ? job->k[j] : pow(10, -6 + (double)j / A_DECADE);
    }
    for (size_t i = 0; i < BR_STABILITY_RODS; i++)
        gsl_sort(&s->row[i * s->rows].k, sizeof *s->row / sizeof s->row->k, s->rows);
    return BR_OK;
}

/* ---- what has come out ---- */

static void sum_up(struct br_stability *s, const struct br_stability_row *r)
{
    const bool within =
        r->limit > s->stiffness[0] && r->limit < s->stiffness[BR_STABILITY_COLUMNS - 1];
    if (within || isfinite(r->measured))
        s->limit_error = br_worst(s->limit_error, fabs(r->measured / r->limit - 1));
    for (size_t j = 0; j < BR_STABILITY_COLUMNS; j++) {
        s->cells++;
        if (r->growth[j] > 1) {
            s->growing++;
            s->growth_error = br_worst(s->growth_error, fabs(r->radius[j] / r->growth[j] - 1));
        } else {
            s->excess = br_worst(s->excess, fmax(r->radius[j] - 1, 0));
        }
    }
}

enum br_status br_stability_run(struct br_stability *s, const struct br_extremes_job *job,
                                struct br_error *err)
{
    *s = (struct br_stability){0};
    const bool failed = check_job(job, err) || prepare(s, job, err) ||
                        measure_planes(s, job, err) || try_schemes(s, err) || press(s, err) ||
                        bounce(s, err);
    for (size_t i = 0; i < BR_STABILITY_RODS * s->rows && !failed; i++)
        sum_up(s, &s->row[i]);
    return failed ? err->status : BR_OK;
}

void br_stability_clear(struct br_stability *s)
{
    free(s->row);
    *s = (struct br_stability){0};
}

/* ---- the verdict ---- */

static enum br_status check_planes(const struct br_stability *s, struct br_error *err)
{
    const struct {
        double found;
        const char *text;
    } rows[] = {
        {s->limit_error, "a measured stability limit is %.3g off the predicted one, relative"},
        {s->growth_error, "a measured growth is %.3g off the predicted one, relative"},
        {s->excess, "a step within the limit has an eigenvalue that is %.3g outside the unit "
                    "circle"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (!(rows[i].found <= br_stability_tolerance)) {
            char what[120];
            snprintf(what, sizeof what, rows[i].text, rows[i].found);
            return br_fail(err, BR_VERDICT, "%s, expected at most %g", what,
                           br_stability_tolerance);
        }
    return BR_OK;
}

/* Ten steps of a hundred relaxation times leave 1e-8 of the way to the rest with bdf3, and less
 * with all others. */
static const double rest = 1e-7;

static enum br_status check_scheme(const struct br_stability_scheme *c, struct br_error *err)
{
    if (c->failed || c->uncertain)
        return br_fail(err, BR_VERDICT,
                       "scheme %s with contact at u_n: %zu of %zu marches failed, %zu are beyond "
                       "their certificate's limits",
                       c->scheme->name, c->failed, c->marches, c->uncertain);
    if (!(c->force <= rest && c->depth <= rest))
        return br_fail(err, BR_VERDICT,
                       "scheme %s with contact at u_n: a pressed rod's contact force is %.3g off, "
                       "its penetration %.3g, expected at most %g",
                       c->scheme->name, c->force, c->depth, rest);
    return BR_OK;
}

/* Within the limit a tip comes to rest; beyond it, it opens again and again, or swings. */
static enum br_status check_tip(const struct br_stability_tip *t, struct br_error *err)
{
    if (!isfinite(t->farthest) || !isfinite(t->swing))
        return br_fail(err, BR_VERDICT, "at %g of the limit a pressed tip is nowhere", t->limit);
    if (t->limit < 1 && !(t->swing <= 1e-11 && t->opened == 0))
        return br_fail(err, BR_VERDICT,
                       "at %g of the limit a pressed tip does not rest: it swings by %.3g of the "
                       "free displacement and opened %zu times",
                       t->limit, t->swing, t->opened);
    if (t->limit > 1 && !(t->opened > 0))
        return br_fail(err, BR_VERDICT, "at %g of the limit a pressed tip does not chatter",
                       t->limit);
    return BR_OK;
}

/* Checks that no energy is gained below the limit. */
static enum br_status check_bounce(const struct br_stability_tip *b, struct br_error *err)
{
    if (b->bouncing <= 1 && !(b->energy <= 1 + 1e-12))
        return br_fail(err, BR_VERDICT,
                       "a bouncing rod within %g of the limit without inertia has %.15g times its "
                       "energy",
                       b->bouncing, b->energy);
    return BR_OK;
}

enum br_status br_stability_verdict(const struct br_stability *s, struct br_error *err)
{
    enum br_status status = check_planes(s, err);
    for (size_t i = 0; i < s->schemes && !status; i++)
        status = check_scheme(&s->scheme[i], err);
    for (size_t i = 0; i < BR_STABILITY_TIPS && !status; i++)
        status = check_tip(&s->tip[i], err);
    for (size_t i = 0; i < BR_STABILITY_BOUNCES && !status; i++)
        status = check_bounce(&s->bounce[i], err);
    return status;
}
