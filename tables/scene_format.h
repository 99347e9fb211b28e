/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scene format for people and for editors. Both walk br_scene_keys and the registries of the
 * methods and norms, and so cannot go stale. */
#ifndef BR_TABLES_SCENE_FORMAT_H
#define BR_TABLES_SCENE_FORMAT_H

#include <stdio.h>

#include "solver/status.h"

/* A valid scene with every key, its meaning, unit and default; those that are optional stand behind
 * a #. schema: the path of the JSON schema, for an editor; NULL: not known. */
void br_scene_template_write(FILE *out, const char *schema);

/* The JSON schema (draft 7) of a scene. It refuses nothing that the program takes, but for numbers
 * in an odd notation (hexadecimal, -0); what needs more than one value at a time (a slope that is
 * no derivative, an expression that does not parse) is left to the program. Fails with
 * BR_NO_MEMORY. */
enum br_status br_scene_schema_write(FILE *out, struct br_error *err);

#endif
