/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One field of the beam, axial or bending, as independent damped oscillators
 *     mass_i q_i'' + damping q_i' + stiffness q_i = load_i(t) - tip_i force,
 * held together only by the force at the tip: equations (3), (4), (8), (9), (11). */
#ifndef BR_REFERENCE_EXACT_FIELD_H
#define BR_REFERENCE_EXACT_FIELD_H

#include "reference/exact/modes.h"
#include "reference/exact/outline.h"

struct br_field {
    struct br_modes *modes;
    double length;             /* L, m */
    double *mass;              /* modes, kg */
    double damping, stiffness; /* N s/m, N/m */
    struct br_field_data data; /* borrowed */
    bool fronts;               /* places where the load jumps move */
    double *load_space;        /* BR_LOAD_TERMS * modes: of the terms whose space part is constant
                                  in time; and workspace for one that is not */
    double *displacement;      /* modes: at t = 0, m */
    double *velocity;          /* modes: at t = 0, m/s */
    double tip_displacement, tip_velocity; /* at t = 0, m, m/s */
};

/* The scene (borrowed, with its functions) must model the field: degree 1 is
 * the axial, 2 the bending field. On the outline's elements, of as many polynomials as it has for
 * `modes`. Fails with BR_NO_MEMORY or BR_SINGULAR. */
enum br_status br_field_create(struct br_field **out, const struct br_scene *scene, size_t degree,
                               const struct br_outline *outline, size_t modes,
                               struct br_error *err);
void br_field_free(struct br_field *field);

/* out[i] = load_i(t), N. *size: out, of loads that no product gives, N: what a mode of size 1 gets
 * of them may be wrong by round-off of that. Fails with BR_NO_MEMORY, or BR_BAD_INPUT: too many
 * fronts. */
enum br_status br_field_load(const struct br_field *field, double t, double *out, double *size,
                             struct br_error *err);

/* What a step costs in the units of effort.h: its modes, and loads that no product gives. */
double br_field_work(const struct br_field *field);

/* L2 norm over the beam of sum_i q_i mode_i, with q at every `stride`-th place. */
double br_field_norm(const struct br_field *field, const double *q, size_t stride);

#endif
