/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A march: the fully discrete problem VP^hk, equations (16) and (17), on n equal elements from t =
 * 0 to T. The method says how it goes on in time (scheme.h): by implicit Euler in velocity form, as
 * the paper, or by another scheme, each a sum of Euler's stages; in `steps` equal steps of
 * k = T/steps or, with an adaptive scheme, in steps of its own. */
#ifndef BR_SOLVER_MARCH_H
#define BR_SOLVER_MARCH_H

#include "base/status.h"
#include "solver/modes.h"

struct br_method;
struct br_scene;

/* What a march has cost so far. */
struct br_counts {
    size_t steps;      /* accepted ones; an adaptive scheme's own */
    size_t rejected;   /* rejected steps of an adaptive scheme */
    size_t stages;     /* linear solves a field */
    size_t iterations; /* of friction rules that iterate */
    size_t set_ups;    /* changes of the linear solvers' step after the first set-up */
};

struct br_march;

/* Which branch of its law a field's tip is on: contact (axial) or friction (bending). */
enum br_regime {
    BR_REGIME_NONE, /* no law, or a friction bound of 0 */
    BR_REGIME_OPEN,
    BR_REGIME_CLOSED,
    BR_REGIME_STICK,
    BR_REGIME_FORWARD,  /* lambda = h: towards +w */
    BR_REGIME_BACKWARD, /* lambda = -h: towards -w */
};
const char *br_regime_name(enum br_regime regime); /* "", "open", ... "slip towards +w" */

/* A switch that an adaptive scheme has found. */
struct br_switch {
    double time; /* s */
    enum br_field_kind kind;
    enum br_regime from, to;
};

/* The tip after a step; what is not modelled is zero. */
struct br_tip {
    double displacement; /* axial, u_n(L), m */
    double velocity[2];  /* axial and bending, by br_field_kind, m/s */
    union {
        double force[2]; /* by br_field_kind, N */
        struct {
            double contact_force;  /* c_H (u - g)_+ as this step used it, N */
            double friction_force; /* lambda = -sigma_V(L), N */
        };
    };
    double friction_bound; /* h(t_n), N */
};

/* Whether a march can be set up: its scene, mesh, steps and method. Fails with BR_BAD_INPUT. */
enum br_status br_march_check(const struct br_scene *scene, size_t n, size_t steps,
                              const struct br_method *method, struct br_error *err);

/* Sets up the march at t = 0. The scene must outlive it; its functions are
 * cloned, so that marches of one scene may run in different threads. Fails with
 * BR_BAD_INPUT, BR_SINGULAR, BR_NOT_FINITE or BR_NO_MEMORY, *march then NULL. */
enum br_status br_march_create(struct br_march **march, const struct br_scene *scene, size_t n,
                               size_t steps, const struct br_method *method, struct br_error *err);
void br_march_free(struct br_march *march); /* accepts NULL */

/* One step, from t_{n-1} to t_n = n T/steps. Fails with BR_NOT_FINITE (a load, or
 * a march that blows up), BR_SINGULAR; the state is then lost. */
enum br_status br_march_step(struct br_march *march, struct br_error *err);

/* One step of one field. The bending field does not act on the axial one, so the axial field may be
 * ahead, by up to the number of steps that br_march_allow_lead sets (1 at first). The fields may be
 * in two threads; then the caller makes each field wait for the other one. Fails as br_march_step.
 */
enum br_status br_march_step_field(struct br_march *march, enum br_field_kind kind,
                                   struct br_error *err);
enum br_status br_march_allow_lead(struct br_march *march, size_t steps, struct br_error *err);

/* Steps of one field done so far. */
size_t br_march_field_steps(const struct br_march *march, enum br_field_kind kind);

/* Steps of both fields done so far, and the time reached, s. */
size_t br_march_steps_done(const struct br_march *march);
double br_march_time(const struct br_march *march);

/* The tip after the last step; at step 0 it has only its displacement. */
const struct br_tip *br_march_tip(const struct br_march *march);

/* The tip at t = 0: the laws at the initial data. The friction force is NaN, unless there is no
 * friction: it depends on what follows. */
const struct br_tip *br_march_start(const struct br_march *march);
struct br_counts br_march_counts(const struct br_march *march);

enum { BR_MOST_SWITCHES = 1000 }; /* kept; all are counted */

/* How many switches the scheme has found, and in *first (out, borrowed until the next step) the
 * first BR_MOST_SWITCHES of them; 0: the scheme does not search for switches, or there was none. */
size_t br_march_switches(const struct br_march *march, const struct br_switch **first);

/* The tip's displacement in one field, m. */
double br_march_tip_displacement(const struct br_march *march, enum br_field_kind kind);

/* Nodal displacement and velocity of one field (out, br_field_size values each, m
 * and m/s; either may be NULL). All zero where the field is not modelled. */
void br_march_get(const struct br_march *march, enum br_field_kind kind, double *displacement,
                  double *velocity);

/* The elements' strain rates (out, n * br_field_unknowns values, m/s), as
 * br_field_solver's strain_rate gives them. All zero where the field is not modelled. */
void br_march_strain_rate(const struct br_march *march, enum br_field_kind kind, double *rate);

/* The mesh and operator of one field; whether it is modelled. */
const struct br_field *br_march_field(const struct br_march *march, enum br_field_kind kind);
bool br_march_models(const struct br_march *march, enum br_field_kind kind);

/* The load vector F_n of the last step (out, br_field_size values). */
void br_march_load(const struct br_march *march, enum br_field_kind kind, double *load);

/* z_tip of the field, m/s per N. */
double br_march_compliance(const struct br_march *march, enum br_field_kind kind);

/* Whether the march is beyond the stability limit of the lagged contact (laws.h), and the contact
 * has been closed in a step. Then errors grew in that step, and the tip chatters; the chatter may
 * stay bounded, since the contact opens. A contact that has never closed is not affected. */
bool br_march_contact_unstable(const struct br_march *march);

/* From now on an adaptive scheme calls `stop` between its own steps, of which one step of the march
 * may need very many; true ends the march with BR_INTERRUPTED. May be NULL. */
void br_march_stop_when(struct br_march *march, bool (*stop)(void *self), void *self);

/* ---- watching ---- */

/* A stage of a step of one field (scheme.h) that has ended. */
struct br_march_stage {
    enum br_field_kind kind;
    int index, count; /* of the stages of this step */
    double from, k;   /* t_{n-1} and the step's length, s */
    double time, tau; /* of the stage, s */
};

/* Functions that are called after each stage and each step of a march. */
struct br_march_watcher {
    void *self;
    /* br_march_get, br_march_load and br_march_tip then give the values of the stage. An adaptive
     * scheme may reject a step, and begin again with index 0. */
    void (*stage)(void *self, const struct br_march_stage *stage);
    /* The field has accepted the step whose stages were the last ones. switched: the scheme
     * restarts with the next step. */
    void (*step)(void *self, enum br_field_kind kind, bool switched);
};

enum { BR_MOST_WATCHERS = 4 };

/* Adds a watcher; false: there are BR_MOST_WATCHERS already. */
bool br_march_watch(struct br_march *march, const struct br_march_watcher *watcher);

/* Removes the watchers with that `self`. */
void br_march_unwatch(struct br_march *march, const void *self);

/* Predicted round-off of the displacements relative to the exact discrete solution, for all steps,
 * with the accumulation over equal steps: the larger of the modelled fields' values. */
double br_march_round_off(const struct br_march *march);

/* Samples a march in one of the measures of modes.h. view: out; its `values` point to room for
 * br_measure_size numbers; the tip has one, in m. */
void br_march_sample(const struct br_march *march, enum br_field_kind kind, enum br_measure measure,
                     struct br_view *view);

#endif
