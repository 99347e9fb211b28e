/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact at u_n has no limit: every scheme of the registry brings a pressed rod to its rest. */
#include <math.h>

#include "study/extremes/stability.h"
#include "study/run/run.h"

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

static enum br_status try_one(const struct br_scene *scene, size_t n, size_t steps,
                              struct br_stability_scheme *c, struct br_run_report *report,
                              struct br_error *err)
{
    struct br_run_request request = {
        .scene = scene,
        .method = br_method_default(),
        .n = n,
        .steps = steps,
        .check = true,
    };
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

static enum br_status try_scheme(struct br_stability_scheme *c, struct br_run_report *report,
                                 struct br_error *err)
{
    static const double stiffness[] = {1, 1e3, 1e6, 1e9, 1e12, 1e15};
    static const size_t steps[] = {10, 100, 1000};
    struct br_scene scene = {
        .length = 1,
        .duration = 1,
        .density = br_stability_rods[0].density,
        .axial = {.modelled = true,
                  .stiffness = 1000,
                  .viscosity = br_stability_rods[0].viscosity,
                  .load = {{{{.constant = load}, {.constant = 1}}}}},
        .contact = {.modelled = true},
    };
    enum br_status status = BR_OK;
    for (size_t i = 0; i < sizeof stiffness / sizeof *stiffness; i++)
        for (size_t j = 0; j < sizeof steps / sizeof *steps && !status; j++) {
            scene.contact.stiffness = stiffness[i];
            status = try_one(&scene, elements, steps[j], c, report, err);
        }
    return status;
}

enum br_status br_stability_schemes(struct br_stability *s, struct br_error *err)
{
    struct br_run_report *report = br_allocate(1, sizeof *report);
    if (!report)
        return br_no_memory(err, "the schemes' stability");
    enum br_status status = BR_OK;
    for (const struct br_time_scheme *const *t = br_time_schemes; *t && !status; t++) {
        if (s->schemes == BR_STABILITY_SCHEMES)
            break;
        struct br_stability_scheme *c = &s->scheme[s->schemes++];
        *c = (struct br_stability_scheme){.scheme = *t};
        status = try_scheme(c, report, err);
    }
    free(report);
    return status;
}
