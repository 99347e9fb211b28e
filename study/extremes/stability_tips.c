/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tips: pressed ones near and beyond the limit of the lagged contact, and ones that bounce; and
 * that contact at u_n has no limit: every scheme of the registry brings a pressed rod to its rest.
 */
#include <math.h>

#include "solver/laws.h"
#include "study/extremes/extremes.h"
#include "study/run/run.h"

static const double tip_shares[BR_STABILITY_TIPS] = {0.5, 0.9, 0.99, 1.01, 1.1, 2, 10, 1e3, 1e6};

/* Of the limit of a contact that closes and opens, and, from the fifth on, of a closed one. */
static const double bounce_shares[BR_STABILITY_BOUNCES] = {0.1, 0.5, 0.9, 1, 0.1, 0.5, 0.9, 0.99};
enum { OF_BOUNCING = 4, TIP_STEPS = 4000, BOUNCE_STEPS = 20000 };

/* ---- tips ---- */

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

/* A rod that is pressed has no energy at the start. */
static void look(struct watch *w, const struct br_march *march, size_t step)
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

/* unit: of its ways, m. A march that fails is a result: what it would tell is NaN. */
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
            look(&w, march, i);
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

/* Every point of the rod is thrown alike. */
static enum br_status throw(struct br_stability * s, struct br_error *err) {
    s->bounce_k = 1e-5; const struct br_field field = br_stability_field(
                            &br_stability_rods[4], BR_STABILITY_MOST_ELEMENTS, s->bounce_k);
    struct br_scene scene = br_stability_scene(&field, s->bounce_k *BOUNCE_STEPS);
    scene.axial.velocity.constant = 1; scene.contact.gap = 0.01;
    const double bouncing = br_contact_limit_bouncing(&field);
    const double limit = br_contact_limit_stiffness(&field); enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_STABILITY_BOUNCES && !status;
         i++){struct br_stability_tip *b = &s->bounce[i];
              b->stiffness = bounce_shares[i] * (i < OF_BOUNCING ? bouncing : limit);
              b->bouncing = b->stiffness / bouncing; b->limit = b->stiffness / limit;
              status = march_tip(b, &scene, field.n, BOUNCE_STEPS, 1, err);}
return status;
}

enum br_status br_stability_tips(struct br_stability *s, struct br_error *err)
{
    const enum br_status status = press(s, err);
    return status ? status : throw(s, err);
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

enum br_status br_stability_schemes(struct br_stability *s, struct br_error *err)
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
