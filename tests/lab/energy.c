/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/each.h"
#include "solver/laws.h"
#include "solver/method.h"
#include "study/extremes/extremes.h"
#include "study/scene/file.h"
#include "tests/lab/energy.h"

/* ---- the scenes ---- */

#define OFFSET(member) offsetof(struct br_scene, member)

const struct br_balance_scene br_balance_scenes[] = {
    {"example1", "example1", NULL, {0}, 0},
    {"example2", "example2", NULL, {0}, 0},
    {"example2, lagged contact", "example2", "lagged", {0}, 0},
    {"example2, lagged contact, c_H = 1e12 N/m",
     "example2",
     "lagged",
     {OFFSET(contact.stiffness)},
     1e12},
    {"example2, c_H = 1e12 N/m", "example2", "implicit", {OFFSET(contact.stiffness)}, 1e12},
    {"example2, density 0", "example2", "implicit", {OFFSET(density)}, 0},
    {"example2, density 1e6 kg/m", "example2", "implicit", {OFFSET(density)}, 1e6},
    {"example2, viscosity 0",
     "example2",
     "implicit",
     {OFFSET(axial.viscosity), OFFSET(bending.viscosity)},
     0},
    {"example2, viscosity 1e6",
     "example2",
     "implicit",
     {OFFSET(axial.viscosity), OFFSET(bending.viscosity)},
     1e6},
    {"example2, c_V = 1e12 N/m", "example2", "implicit", {OFFSET(friction.coefficient)}, 1e12},
    {"example4", "example4", NULL, {0}, 0},
    {"bouncing", "bouncing", "implicit", {0}, 0},
    {"bouncing, lagged contact", "bouncing", "lagged", {0}, 0},
    {"impact", "impact", "implicit", {0}, 0},
    {"chatter", "chatter", "implicit", {0}, 0},
    {"vibration", "vibration", NULL, {0}, 0},
    {"near_elastic", "near_elastic", "implicit", {0}, 0},
    {"heavy_damping", "heavy_damping", "implicit", {0}, 0},
};
enum { SCENES = sizeof br_balance_scenes / sizeof *br_balance_scenes };

/* The caller clears the scene (out). */
static enum br_status read_scene(const struct br_balance_scene *s, struct br_scene *scene,
                                 struct br_error *err)
{
    char path[4096];
    *scene = (struct br_scene){0};
    enum br_status status = br_scene_find(s->bundled, path, sizeof path, err);
    if (!status)
        status = br_scene_read(path, scene, err);
    for (size_t i = 0; i < 2 && s->offset[i] && !status; i++)
        *(double *)((char *)scene + s->offset[i]) = s->value;
    return status;
}

/* ---- what is tried ---- */

static const size_t rates[BR_VIBRATION_RATES] = {6, 12, 24, 48, 96, 192};
static const double tolerances[BR_VIBRATION_RATES] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7};
static const double densities[BR_VIBRATION_DENSITIES] = {1e-6, 1, 1e6};
static const double dampings[] = {0, 0.01};
enum { DAMPINGS = sizeof dampings / sizeof *dampings };

/* The resolution of a balance. */
enum { ELEMENTS = 20, STEPS = 400 };
static const double tolerance = 1e-3;

static struct br_vibration_row vibrations_of(const struct br_time_scheme *scheme,
                                             enum br_field_kind kind, double damping)
{
    struct br_vibration_row row = {.scheme = scheme, .kind = kind, .damping = damping};
    for (size_t r = 0; r < BR_VIBRATION_RATES; r++)
        for (size_t i = 0; i < BR_VIBRATION_DENSITIES; i++)
            row.at[r][i] = (struct br_vibration){
                .scheme = scheme,
                .kind = kind,
                .damping = damping,
                .density = densities[i],
                .per_period = scheme->adaptive ? 1 : rates[r],
                .tolerance = tolerances[r],
            };
    return row;
}

static enum br_status list(struct br_energy_behaviour *b, struct br_error *err)
{
    size_t schemes = 0;
    while (br_time_schemes[schemes])
        schemes++;
    b->vibrations = schemes * 2 * DAMPINGS;
    b->vibration = br_allocate(b->vibrations, sizeof *b->vibration);
    b->balance = br_allocate(schemes * SCENES, sizeof *b->balance);
    if (!b->vibration || !b->balance)
        return br_no_memory(err, "energies of all schemes");
    for (size_t i = 0; i < b->vibrations; i++)
        b->vibration[i] =
            vibrations_of(br_time_schemes[i / (2 * DAMPINGS)],
                          (enum br_field_kind)(i / DAMPINGS % 2), dampings[i % DAMPINGS]);
    for (size_t i = 0; i < SCENES * schemes; i++) {
        const struct br_balance_scene *scene = &br_balance_scenes[i / schemes];
        const struct br_time_scheme *scheme = br_time_schemes[i % schemes];
        if (scheme->may_lag || !scene->contact || strcmp(scene->contact, "lagged") != 0)
            b->balance[b->balances++] = (struct br_balance_row){.scheme = scheme, .scene = scene};
    }
    return BR_OK;
}

/* ---- a balance ---- */

/* A march that fails is a result: the steps before the failure count. */
static enum br_status march(struct br_balance_row *row, struct br_march *march,
                            struct br_energy_meter *meter, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < STEPS && !status; i++) {
        status = br_march_step(march, err);
        if (!status)
            row->worst = br_worst(row->worst, br_energy_meter_step(meter));
    }
    if (status != BR_NOT_FINITE)
        return status;
    row->end = BR_VIBRATION_FAILED;
    row->failure = *err;
    return BR_OK;
}

static enum br_status measure(struct br_balance_row *row, const struct br_scene *scene,
                              const struct br_method *method, struct br_error *err)
{
    struct br_march *m;
    struct br_energy_meter *meter = NULL;
    enum br_status status = br_march_create(&m, scene, ELEMENTS, STEPS, method, err);
    if (status == BR_BAD_INPUT || status == BR_SINGULAR) {
        row->end = BR_VIBRATION_REFUSED;
        row->failure = *err;
        return BR_OK;
    }
    if (status)
        return status;
    row->limit = br_energy_limit(ELEMENTS, br_march_round_off(m));
    status = br_energy_meter_create(&meter, m, scene, method, err);
    if (!status)
        status = march(row, m, meter, err);
    br_energy_meter_free(meter);
    br_march_free(m);
    return status;
}

static enum br_status run_balance(struct br_balance_row *row, struct br_error *err)
{
    struct br_scene scene;
    struct br_method method = br_method_default();
    const char *contact = row->scene->contact;
    enum br_status status = read_scene(row->scene, &scene, err);
    method.scheme = row->scheme;
    method.contact = contact ? br_contact_rule_find(contact) : br_contact_rule_of(row->scheme);
    method.tolerance = tolerance;
    if (!status && (br_method_check(&method, NULL, &row->failure) ||
                    br_method_check(&method, &scene, &row->failure)))
        row->end = BR_VIBRATION_REFUSED;
    else if (!status)
        status = measure(row, &scene, &method, err);
    br_scene_clear(&scene);
    return status;
}

/* ---- all ---- */

/* The last tasks cost most and begin first. */
static enum br_status take_turn(void *self, size_t i, struct br_error *err)
{
    struct br_energy_behaviour *b = self;
    const size_t task = b->vibrations + b->balances - 1 - i;
    if (task >= b->vibrations)
        return run_balance(&b->balance[task - b->vibrations], err);
    enum br_status status = BR_OK;
    for (size_t r = 0; r < BR_VIBRATION_RATES && !status; r++)
        for (size_t d = 0; d < BR_VIBRATION_DENSITIES && !status; d++)
            status = br_vibration_run(&b->vibration[task].at[r][d], err);
    return status;
}

enum br_status br_energy_behaviour_run(struct br_energy_behaviour *b, struct br_error *err)
{
    *b = (struct br_energy_behaviour){0};
    const enum br_status status = list(b, err);
    const struct br_each each = {
        .count = b->vibrations + b->balances, .turn = take_turn, .self = b};
    return status ? status : br_each(&each, err);
}

void br_energy_behaviour_clear(struct br_energy_behaviour *b)
{
    free(b->vibration);
    free(b->balance);
    *b = (struct br_energy_behaviour){0};
}

/* ---- verdicts ---- */

bool br_vibration_row_is_right(const struct br_vibration_row *row)
{
    bool right = true;
    for (size_t r = 0; r < BR_VIBRATION_RATES; r++)
        for (size_t i = 0; i < BR_VIBRATION_DENSITIES; i++)
            right &= br_vibration_is_right(&row->at[r][i]);
    return right;
}

bool br_balance_row_is_right(const struct br_balance_row *row)
{
    return row->end == BR_VIBRATION_REFUSED || row->worst <= row->limit;
}
