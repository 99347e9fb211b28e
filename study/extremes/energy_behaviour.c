/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/energy_behaviour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study/grid/each.h"
#include "study/scene/file.h"

/* ---- the scenes: bundled ones, and what is changed in them ---- */

static void massless(struct br_scene *s)
{
    s->density = 0;
}

static void heavy(struct br_scene *s)
{
    s->density = 1e6;
}

static void elastic(struct br_scene *s)
{
    s->axial.viscosity = s->bending.viscosity = 0;
}

static void tough(struct br_scene *s)
{
    s->axial.viscosity = s->bending.viscosity = 1e6;
}

static void hard(struct br_scene *s)
{
    s->contact.stiffness = 1e12;
}

static void rough(struct br_scene *s)
{
    s->friction.coefficient = 1e12;
}

static const struct {
    const char *bundled;
    void (*change)(struct br_scene *scene); /* NULL: as it is */
    const char *contact;
} scenes[] = {
    {"example1", NULL, NULL},           {"example2", NULL, NULL},
    {"example2", NULL, "lagged"},       {"example2", hard, "lagged"},
    {"example2", hard, "implicit"},     {"example2", massless, "implicit"},
    {"example2", heavy, "implicit"},    {"example2", elastic, "implicit"},
    {"example2", tough, "implicit"},    {"example2", rough, "implicit"},
    {"example4", NULL, NULL},           {"bouncing", NULL, "implicit"},
    {"bouncing", NULL, "lagged"},       {"impact", NULL, "implicit"},
    {"chatter", NULL, "implicit"},      {"vibration", NULL, NULL},
    {"near_elastic", NULL, "implicit"}, {"heavy_damping", NULL, "implicit"},
};

const char *const br_balance_scenes[] = {
    "example1",
    "example2",
    "example2, lagged contact",
    "example2, lagged contact, c_H = 1e12 N/m",
    "example2, c_H = 1e12 N/m",
    "example2, density 0",
    "example2, density 1e6 kg/m",
    "example2, viscosity 0",
    "example2, viscosity 1e6",
    "example2, c_V = 1e12 N/m",
    "example4",
    "bouncing",
    "bouncing, lagged contact",
    "impact",
    "chatter",
    "vibration",
    "near_elastic",
    "heavy_damping",
};
const size_t br_balance_scene_count = sizeof scenes / sizeof *scenes;
_Static_assert(sizeof scenes / sizeof *scenes ==
                   sizeof br_balance_scenes / sizeof *br_balance_scenes,
               "a name for each scene");

/* Whether its contact is lagged, which few schemes take. */
static bool scene_lags(size_t i)
{
    return scenes[i].contact && strcmp(scenes[i].contact, "lagged") == 0;
}

/* Scene i (out) and the contact rule by name, NULL: the scheme's own. The caller clears the scene.
 */
static enum br_status read_scene(size_t i, struct br_scene *scene, const char **contact,
                                 struct br_error *err)
{
    char path[4096];
    *scene = (struct br_scene){0};
    *contact = scenes[i].contact;
    enum br_status status = br_scene_find(scenes[i].bundled, path, sizeof path, err);
    if (!status)
        status = br_scene_read(path, scene, err);
    if (!status && scenes[i].change)
        scenes[i].change(scene);
    return status;
}

/* ---- what is tried ---- */

static const size_t rates[BR_VIBRATION_RATES] = {6, 12, 24, 48, 96, 192};
static const double tolerances[BR_VIBRATION_RATES] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7};
static const double densities[BR_VIBRATION_DENSITIES] = {1e-6, 1, 1e6};
static const double dampings[] = {0, 0.01};

/* Of a balance. */
enum { ELEMENTS = 20, STEPS = 400 };
static const double tolerance = 1e-3;

size_t br_vibration_per_period(size_t rate)
{
    return rates[rate];
}

double br_vibration_tolerance(size_t rate)
{
    return tolerances[rate];
}

static void list_vibrations(struct br_energy_behaviour *b)
{
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++)
            for (size_t d = 0; d < sizeof dampings / sizeof *dampings; d++) {
                struct br_vibration_row *row = &b->vibration[b->vibrations++];
                *row =
                    (struct br_vibration_row){*s, (enum br_field_kind)kind, dampings[d], {{{0}}}};
                for (size_t r = 0; r < BR_VIBRATION_RATES; r++)
                    for (size_t i = 0; i < BR_VIBRATION_DENSITIES; i++)
                        row->at[r][i] = (struct br_vibration){
                            .scheme = *s,
                            .kind = (enum br_field_kind)kind,
                            .damping = dampings[d],
                            .density = densities[i],
                            .per_period = (*s)->adaptive ? 1 : rates[r],
                            .tolerance = tolerances[r],
                        };
            }
}

static enum br_status list(struct br_energy_behaviour *b, struct br_error *err)
{
    size_t schemes = 0;
    while (br_time_schemes[schemes])
        schemes++;
    b->vibration =
        br_allocate(schemes * 2 * sizeof dampings / sizeof *dampings, sizeof *b->vibration);
    b->balance = br_allocate(schemes * br_balance_scene_count, sizeof *b->balance);
    if (!b->vibration || !b->balance)
        return br_no_memory(err, "energies of all schemes");
    list_vibrations(b);
    for (size_t scene = 0; scene < br_balance_scene_count; scene++)
        for (size_t s = 0; s < schemes; s++)
            if (br_time_schemes[s]->may_lag || !scene_lags(scene))
                b->balance[b->balances++] =
                    (struct br_balance_row){.scheme = br_time_schemes[s], .scene = scene};
    return BR_OK;
}

/* ---- a balance ---- */

struct balance {
    struct br_balance_row *row;
    struct br_scene scene;
    struct br_method method;
    struct br_march *march;
    struct br_energy_meter *meter;
};

/* A march that ends is a result: what came before it counts. */
static enum br_status march(struct balance *b, struct br_error *err)
{
    struct br_balance_row *row = b->row;
    enum br_status status = BR_OK;
    for (row->marched = 0; row->marched < STEPS && !status; row->marched += !status) {
        status = br_march_step(b->march, err);
        const double imbalance = status ? 0 : br_energy_meter_step(b->meter);
        if (isnan(imbalance) || imbalance > row->worst)
            row->worst = imbalance;
    }
    br_energy_meter_read(b->meter, &row->start, &row->now, &row->work);
    if (status != BR_NOT_FINITE)
        return status;
    row->end = BR_VIBRATION_FAILED;
    row->failure = *err;
    return BR_OK;
}

static enum br_status measure(struct balance *b, struct br_error *err)
{
    struct br_balance_row *row = b->row;
    enum br_status status = br_march_create(&b->march, &b->scene, ELEMENTS, STEPS, &b->method, err);
    if (status == BR_BAD_INPUT || status == BR_SINGULAR) {
        row->end = BR_VIBRATION_REFUSED;
        row->failure = *err;
        return BR_OK;
    }
    if (status)
        return status;
    row->limit = br_energy_limit(ELEMENTS, br_march_round_off(b->march));
    status = br_energy_meter_create(&b->meter, b->march, &b->scene, &b->method, err);
    if (!status)
        status = march(b, err);
    br_energy_meter_free(b->meter);
    br_march_free(b->march);
    return status;
}

static enum br_status run_balance(struct br_balance_row *row, struct br_error *err)
{
    struct balance b = {.row = row, .method = br_method_default()};
    const char *contact;
    enum br_status status = read_scene(row->scene, &b.scene, &contact, err);
    b.method.scheme = row->scheme;
    b.method.contact = contact ? br_contact_rule_find(contact) : br_contact_rule_of(row->scheme);
    b.method.tolerance = tolerance;
    if (!status && (br_method_check(&b.method, &row->failure) ||
                    br_method_check_scene(&b.method, &b.scene, &row->failure)))
        row->end = BR_VIBRATION_REFUSED;
    else if (!status)
        status = measure(&b, err);
    br_scene_clear(&b.scene);
    return status;
}

/* ---- all ---- */

/* The last ones are the dearest. */
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

enum br_status br_energy_behaviour_run(struct br_energy_behaviour *b, int threads,
                                       const struct br_observer *observer, struct br_error *err)
{
    *b = (struct br_energy_behaviour){0};
    const enum br_status status = list(b, err);
    const struct br_each each = {.count = b->vibrations + b->balances,
                                 .threads = threads,
                                 .observer = observer,
                                 .turn = take_turn,
                                 .self = b};
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

double br_vibration_difference(const struct br_vibration_row *row)
{
    double most = NAN;
    for (size_t r = 0; r < BR_VIBRATION_RATES; r++)
        for (size_t i = 0; i < BR_VIBRATION_DENSITIES; i++) {
            const struct br_vibration *v = &row->at[r][i];
            if (v->end == BR_VIBRATION_DONE)
                most = fmax(most, fabs(v->measured - v->predicted)); /* of NAN: the other */
        }
    return most;
}

bool br_balance_row_is_right(const struct br_balance_row *row)
{
    return row->end == BR_VIBRATION_REFUSED || row->worst <= row->limit;
}
