/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every time scheme does to the energy: of a free vibration, against its theory, and in scenes
 * with loads, impacts, friction and extreme data, whether each step's balance closes. */
#ifndef BR_STUDY_EXTREMES_ENERGY_BEHAVIOUR_H
#define BR_STUDY_EXTREMES_ENERGY_BEHAVIOUR_H

#include <complex.h>

#include "reference/energy/energy.h"
#include "reference/textbook.h"
#include "solver/march.h"
#include "study/grid/observer.h"
#include "study/grid/study.h"

/* ---- the lowest mode of a field on a mesh, as its elements have it, to start with ---- */

enum { BR_MODE_ELEMENTS = 8, BR_MODE_UNKNOWNS = 2 * BR_MODE_ELEMENTS };

/* Of BR_MODE_ELEMENTS linear (axial) or Hermite (bending) elements: K phi = omega^2 M phi. */
struct br_beam_mode {
    enum br_field_kind kind;
    double length, omega;            /* m, 1/s */
    double phi[BR_MODE_UNKNOWNS];    /* without the clamped node: 1 at the tip */
    double weight[BR_MODE_UNKNOWNS]; /* M phi over phi'M phi: the part of the mode in a state */
};

/* Fails with BR_NO_MEMORY, and with BR_SINGULAR where the eigenvalues are not found. */
enum br_status br_beam_mode_find(struct br_beam_mode *mode, const struct br_scene *scene,
                                 enum br_field_kind kind, struct br_error *err);

/* How much of the mode is in nodal values of the field (in: clamped node included), m or m/s. */
double br_beam_mode_part(const struct br_beam_mode *mode, const double *nodal);

/* ---- free vibration of a field in its lowest mode: what a time scheme takes from its energy, as
 * measured and as its stability function tells ---- */

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
    size_t per_period; /* steps; of an adaptive scheme looks, see tolerance */
    double tolerance;

    /* Out */
    enum br_vibration_end end;
    struct br_error failure;
    double steps;        /* a period, the scheme's own */
    double measured;     /* share of the energy that the scheme takes a period, beside viscosity */
    double predicted;    /* by the amplification; NAN for an adaptive scheme */
    double round_off;    /* of the two, about */
    double worst, limit; /* imbalance of a step */
    size_t gaining, all; /* steps that add, of all */
};

/* Marches. Fails with BR_NO_MEMORY and BR_SINGULAR; what a march does is a result. */
enum br_status br_vibration_run(struct br_vibration *vibration, struct br_error *err);

/* Whether what was measured is as predicted, to round-off, and every step's balance closes; what
 * was refused is neither. */
bool br_vibration_is_right(const struct br_vibration *vibration);

/* ---- all schemes ---- */

enum { BR_VIBRATION_RATES = 6, BR_VIBRATION_DENSITIES = 3 };

/* Free vibration of one field by one scheme, at all numbers of steps a period; what is shown is of
 * the density in the middle. */
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
    size_t place[2];     /* of numbers in struct br_scene; 0: it is as it is */
    double value;
};

/* A scene that is marched by one scheme, with its balance in each step. */
struct br_balance_row {
    const struct br_time_scheme *scheme;
    const struct br_balance_scene *scene;
    enum br_vibration_end end;
    struct br_error failure; /* why it was refused, or where its march ended */
    size_t marched;          /* steps until then */
    struct br_energy start, now;
    struct br_work work;
    double worst, limit; /* imbalance of a step */
};

struct br_energy_behaviour {
    struct br_vibration_row *vibration;
    struct br_balance_row *balance;
    size_t vibrations, balances;
};

/* Computes on `threads` threads (0: all cores); the result does not depend on them. Fails with
 * BR_NO_MEMORY, BR_INTERRUPTED and as scenes do; clear it even then. */
enum br_status br_energy_behaviour_run(struct br_energy_behaviour *behaviour, int threads,
                                       const struct br_observer *observer, struct br_error *err);
void br_energy_behaviour_clear(struct br_energy_behaviour *behaviour);

/* Whether all that was measured of the row is right; what was refused is. */
bool br_vibration_row_is_right(const struct br_vibration_row *row);
bool br_balance_row_is_right(const struct br_balance_row *row);

/* The largest difference of measured and predicted loss a period in a row; NAN: nothing predicted.
 */
double br_vibration_difference(const struct br_vibration_row *row);

#endif
