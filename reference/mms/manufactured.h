/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method of manufactured solutions: a scene whose loads, tip forces and initial data
 * are derived from a solution that is given (Roache 2002; Oberkampf and Roy 2010). */
#ifndef BR_REFERENCE_MMS_MANUFACTURED_H
#define BR_REFERENCE_MMS_MANUFACTURED_H

#include "solver/field.h"

/* Fills the loads, tip forces and initial data of a scene whose axial.solution or
 * bending.solution is given, so that these solve (1)-(12); a scene without one stays as it
 * is. A load is left as one term f(x, t). Refuses (BR_BAD_INPUT) a scene of which only one
 * modelled part has a solution, a solution beside what it determines, and what check.h
 * refuses; *culprit is then the part whose solution it is about. Fails with BR_NO_MEMORY;
 * br_scene_clear releases what was made until then. */
enum br_status br_manufactured_apply(struct br_scene *scene, enum br_field_kind *culprit,
                                     struct br_error *err);

#endif
