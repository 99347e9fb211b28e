/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every time scheme does to the energy: of a free vibration, against its theory, and in scenes
 * with loads, impacts, friction and extreme data, whether each step's balance closes. */
#ifndef BR_STUDY_EXTREMES_ENERGY_BEHAVIOUR_H
#define BR_STUDY_EXTREMES_ENERGY_BEHAVIOUR_H

#include "reference/energy/energy.h"
#include "study/extremes/vibration.h"
#include "study/grid/observer.h"
#include "study/grid/study.h"

enum { BR_VIBRATION_RATES = 6, BR_VIBRATION_DENSITIES = 3 };

/* Free vibration of one field by one scheme, at all numbers of steps a period; what is shown is of
 * the density in the middle. */
struct br_vibration_row {
    const struct br_time_scheme *scheme;
    enum br_field_kind kind;
    double damping;
    struct br_vibration at[BR_VIBRATION_RATES][BR_VIBRATION_DENSITIES];
};

/* A scene that is marched by one scheme, with its balance in each step. */
struct br_balance_row {
    const struct br_time_scheme *scheme;
    size_t scene; /* of br_balance_scenes */
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

/* The scenes, in words. */
extern const char *const br_balance_scenes[];
extern const size_t br_balance_scene_count;

/* Of which steps a period, or of an adaptive scheme the tolerances. */
size_t br_vibration_per_period(size_t rate);
double br_vibration_tolerance(size_t rate);

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
