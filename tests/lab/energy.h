/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every time scheme does to the energy: of a free vibration, against its theory, and in scenes
 * with loads, impacts, friction and extreme data, whether each step's balance closes. */
#ifndef BR_TESTS_LAB_ENERGY_H
#define BR_TESTS_LAB_ENERGY_H

#include <complex.h>

#include "reference/energy/energy.h"
#include "reference/textbook.h"
#include "solver/march.h"

/* ---- the lowest mode of a field on a mesh ---- */

enum { BR_MODE_ELEMENTS = 8, BR_MODE_UNKNOWNS = 2 * BR_MODE_ELEMENTS };

/* Of BR_MODE_ELEMENTS linear (axial) or Hermite (bending) elements: K phi = omega^2 M phi. */
struct br_beam_mode {
    enum br_field_kind kind;
    double omega;                    /* 1/s */
    double phi[BR_MODE_UNKNOWNS];    /* without the clamped node: 1 at the tip */
    double weight[BR_MODE_UNKNOWNS]; /* M phi over phi'M phi: gives the component of the mode in a
                                        state */
};

/* Fails with BR_NO_MEMORY, and with BR_SINGULAR where the eigenvalues are not found. */
enum br_status br_beam_mode_find(struct br_beam_mode *mode, const struct br_scene *scene,
                                 enum br_field_kind kind, struct br_error *err);

/* The component of the mode in nodal values of the field (in: clamped node included), m or m/s. */
double br_beam_mode_component(const struct br_beam_mode *mode, const double *nodal);

/* ---- free vibration of a field in its lowest mode: the energy that a time scheme takes from it,
 * measured and predicted by its stability function ---- */

/* The factor of a step with z = k lambda: the stability function R(z) of a Runge-Kutta method (its
 * last stage is the step's end), of backward differences the principal root r of
 * (1 - beta z) r^q = sum past_j r^(q-1-j), the one that is nearest to e^z for small z. */
double complex br_amplification(const struct br_textbook *textbook, double complex z);

enum br_vibration_end {
    BR_VIBRATION_DONE,
    BR_VIBRATION_REFUSED, /* by the method: see failure */
    BR_VIBRATION_FAILED,  /* the march */
};

struct br_vibration {
    /* In */
    const struct br_time_scheme *scheme;
    enum br_field_kind kind;
    double damping;    /* of the mode, relative to critical */
    double density;    /* kg/m */
    size_t per_period; /* steps; of an adaptive scheme output times, see tolerance */
    double tolerance;

    /* Out */
    enum br_vibration_end end;
    struct br_error failure;
    double measured;     /* share of the energy that the scheme takes per period, in addition to
                            viscosity */
    double predicted;    /* by the amplification; NAN for an adaptive scheme */
    double round_off;    /* of the two, about */
    double worst, limit; /* imbalance of a step */
};

/* Marches. Fails with BR_NO_MEMORY and BR_SINGULAR; a failure of the march is a result. */
enum br_status br_vibration_run(struct br_vibration *vibration, struct br_error *err);

/* Whether the measurement agrees with the prediction, to round-off, and every step's balance
 * closes. A refused vibration is right, a failed one is not. */
bool br_vibration_is_right(const struct br_vibration *vibration);

/* ---- all schemes ---- */

enum { BR_VIBRATION_RATES = 6, BR_VIBRATION_DENSITIES = 3 };

/* Free vibration of one field by one scheme, at all numbers of steps a period. */
struct br_vibration_row {
    const struct br_time_scheme *scheme;
    enum br_field_kind kind;
    double damping;
    struct br_vibration at[BR_VIBRATION_RATES][BR_VIBRATION_DENSITIES];
};

/* A bundled scene, and what is changed in it. */
struct br_balance_scene {
    const char *name, *bundled;
    const char *contact; /* rule; NULL: the scheme's own */
    size_t offset[2];    /* of numbers in struct br_scene that become `value`; 0: none */
    double value;
};

/* A scene that is marched by one scheme, with its balance in each step. */
struct br_balance_row {
    const struct br_time_scheme *scheme;
    const struct br_balance_scene *scene;
    enum br_vibration_end end;
    struct br_error failure; /* why it was refused, or where its march ended */
    double worst, limit;     /* imbalance of a step */
};

struct br_energy_behaviour {
    struct br_vibration_row *vibration;
    struct br_balance_row *balance;
    size_t vibrations, balances;
};

/* On all cores. Fails with BR_NO_MEMORY and as scenes do; clear it even then. */
enum br_status br_energy_behaviour_run(struct br_energy_behaviour *behaviour, struct br_error *err);
void br_energy_behaviour_clear(struct br_energy_behaviour *behaviour);

/* Whether all measurements of the row are right; a refusal is right. */
bool br_vibration_row_is_right(const struct br_vibration_row *row);
bool br_balance_row_is_right(const struct br_balance_row *row);

#endif
