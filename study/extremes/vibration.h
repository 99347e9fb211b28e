/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Free vibration of a field in its lowest mode: what a time scheme takes from its energy, as
 * measured and as its stability function tells. */
#ifndef BR_STUDY_EXTREMES_VIBRATION_H
#define BR_STUDY_EXTREMES_VIBRATION_H

#include "solver/march.h"

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

#endif
