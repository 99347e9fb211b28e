/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/balance_scenes.h"

#include <string.h>

#include "study/extremes/energy_behaviour.h"
#include "study/scene/file.h"

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

bool br_balance_scene_lags(size_t i)
{
    return scenes[i].contact && strcmp(scenes[i].contact, "lagged") == 0;
}

enum br_status br_balance_scene(size_t i, struct br_scene *scene, const char **contact,
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
