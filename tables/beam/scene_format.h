/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scene format for people. It walks br_scene_keys and the registry of norms, and so cannot go
 * stale. */
#ifndef BR_TABLES_BEAM_SCENE_FORMAT_H
#define BR_TABLES_BEAM_SCENE_FORMAT_H

#include <stdio.h>

/* A valid scene with every key, its meaning, unit and default; those that are optional stand behind
 * a #. */
void br_scene_template_write(FILE *out);

#endif
