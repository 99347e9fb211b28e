/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tips: pressed ones near and beyond the limit of the lagged contact, and ones that bounce; and
 * that contact at u_n has no limit: every scheme of the registry brings a pressed rod to its rest.
 */
#include "study/extremes/stability.h"

#include <math.h>

#include "reference/energy/energy.h"
#include "solver/laws.h"
#include "study/run/run.h"

static const double tip_shares[BR_STABILITY_TIPS] = {0.5, 0.9, 0.99, 1.01, 1.1, 2, 10, 1e3, 1e6};

/* Of the limit of a contact that closes and opens, and, from the fifth on, of a closed one. */
static const double bounce_shares[BR_STABILITY_BOUNCES] = {0.1, 0.5, 0.9, 1, 0.1, 0.5, 0.9, 0.99};
enum { OF_BOUNCING = 4, TIP_STEPS = 4000, BOUNCE_STEPS = 20000, BOUNCE_ELEMENTS = 20 };

static struct br_scene scene_of(const struct br_field *field, double duration)
{
    return (struct br_scene){
        .length = (double)field->n * field->h,
        .duration = duration,
        .density = field->density,
        .axial = {.modelled = true, .stiffness = field->stiffness, .viscosity = field->viscosity},
        .contact = {.modelled = true},
    };
}

/* Marches, and looks at the beginning and after each step. A march that fails is a result: *done
 * (out) is false then. */
static enum br_status follow(const struct br_scene *scene, size_t n, size_t steps,
                             void (*look)(void *self, const struct br_march *march, size_t step),
                             void *self, bool *done, struct br_error *err)
{
    const struct br_method method = br_method_default();
    struct br_error failure = {0};
    struct br_march *march;
    enum br_status status = br_march_create(&march, scene, n, steps, &method, &failure);
    if (!status)
        look(self, march, 0);
    for (size_t i = 1; i <= steps && !status; i++) {
        status = br_march_step(march, &failure);
        if (!status)
            look(self, march, i);
    }
    br_march_free(march);
    *done = !status;
    return status == BR_NO_MEMORY ? br_fail(err, status, "%s", failure.message) : BR_OK;
}

/* ---- pressed ---- */

struct watch {
    struct br_stability_tip *tip;
    double low, high; /* u(L) in the last quarter, m */
    bool closed;
};

static void look(void *self, const struct br_march *march, size_t step)
{
    struct watch *w = self;
    const struct br_tip *tip = br_march_tip(march);
    const bool closed = tip->contact_force > 0;
    if (!(fabs(tip->displacement) <= w->tip->farthest))
        w->tip->farthest = fabs(tip->displacement);
    if (step > TIP_STEPS * 3 / 4) {
        w->low = fmin(w->low, tip->displacement);
        w->high = fmax(w->high, tip->displacement);
        w->tip->opened += w->closed && !closed;
    }
    w->closed = closed;
}

enum br_status br_stability_tips(struct br_stability *s, struct br_error *err)
{
    s->tip_k = 1e-3;
    const struct br_field field = br_stability_field(&br_stability_rods[0], s->n, s->tip_k);
    struct br_scene scene = scene_of(&field, s->tip_k * TIP_STEPS);
    const double force = field.stiffness; /* N/m */
    const double free_tip = force * scene.length * scene.length / 2 / field.stiffness;
    scene.axial.load = (struct br_load){{{{.constant = force}, {.constant = 1}}}};
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_STABILITY_TIPS && !status; i++) {
        struct br_stability_tip *tip = &s->tip[i];
        struct watch w = {.tip = tip, .low = INFINITY, .high = -INFINITY};
        bool done;
        tip->share = tip_shares[i];
        tip->stiffness = tip->share * br_contact_limit_stiffness(&field);
        scene.contact.stiffness = tip->stiffness;
        status = follow(&scene, s->n, TIP_STEPS, look, &w, &done, err);
        tip->swing = done ? (w.high - w.low) / free_tip : NAN;
        tip->farthest = done ? tip->farthest / free_tip : NAN;
    }
    return status;
}

/* ---- bouncing ---- */

struct flight {
    struct br_stability_bounce *bounce;
    const struct br_contact *contact;
    double start; /* energy */
    bool closed;
};

static double energy_of(const struct br_march *march, const struct br_contact *contact)
{
    const struct br_field *field = br_march_field(march, BR_AXIAL);
    const size_t size = br_field_size(field);
    double nodal[2 * (BOUNCE_ELEMENTS + 1)];
    br_march_get(march, BR_AXIAL, nodal, nodal + size);
    const double depth = br_penetration(contact, nodal[size - 1]);
    return br_energy_stored(field, nodal) + br_energy_kinetic(field, nodal + size) +
           contact->stiffness / 2 * depth * depth;
}

static void look_at_flight(void *self, const struct br_march *march, size_t step)
{
    struct flight *f = self;
    const double energy = energy_of(march, f->contact);
    const bool closed = br_march_tip(march)->contact_force > 0;
    if (step == 0)
        f->start = energy;
    else if (!(energy / f->start <= f->bounce->energy))
        f->bounce->energy = energy / f->start;
    f->bounce->impacts += closed && !f->closed;
    f->closed = closed;
}

/* Every point of the rod is thrown alike. */
enum br_status br_stability_bounces(struct br_stability *s, struct br_error *err)
{
    s->bounce_k = 1e-5;
    const struct br_field field =
        br_stability_field(&br_stability_rods[4], BOUNCE_ELEMENTS, s->bounce_k);
    struct br_scene scene = scene_of(&field, s->bounce_k * BOUNCE_STEPS);
    scene.axial.velocity.constant = 1;
    scene.contact.gap = 0.01;
    const double bouncing = br_contact_limit_bouncing(&field);
    const double limit = br_contact_limit_stiffness(&field);
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_STABILITY_BOUNCES && !status; i++) {
        struct br_stability_bounce *b = &s->bounce[i];
        b->stiffness = bounce_shares[i] * (i < OF_BOUNCING ? bouncing : limit);
        b->bouncing = b->stiffness / bouncing;
        b->limit = b->stiffness / limit;
        scene.contact.stiffness = b->stiffness;
        struct flight flight = {.bounce = b, .contact = &scene.contact};
        bool done;
        status = follow(&scene, BOUNCE_ELEMENTS, BOUNCE_STEPS, look_at_flight, &flight, &done, err);
        if (!done)
            b->energy = NAN;
    }
    return status;
}

/* ---- schemes with contact at u_n ---- */

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
    const double force = fabs(end->contact_force / (stiffness * rest) - 1);
    const double depth = fabs(end->displacement[BR_AXIAL] - rest) / free_tip;
    if (!(force <= c->force))
        c->force = force;
    if (!(depth <= c->depth))
        c->depth = depth;
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

enum br_status br_stability_schemes(struct br_stability *s, struct br_error *err)
{
    static const double stiffness[] = {1, 1e3, 1e6, 1e9, 1e12, 1e15};
    static const size_t steps[] = {10, 100, 1000};
    const struct br_field rod = br_stability_field(&br_stability_rods[0], 1, 1);
    struct br_scene scene = scene_of(&rod, 1);
    struct br_run_report *report = br_allocate(1, sizeof *report);
    enum br_status status = report ? BR_OK : br_no_memory(err, "the schemes' stability");
    scene.axial.load = (struct br_load){{{{.constant = load}, {.constant = 1}}}};
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
