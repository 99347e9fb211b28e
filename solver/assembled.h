/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The usual way: the assembled stiffness form of (27) and (28),
 *     A v_n = F_n + M v_{n-1}/k - K w_{n-1},    A = M/k + C + kK,
 * factorised once by a library and solved once a step. The libraries differ in the factorisation
 * alone: each is a br_factoriser, and its row of the registry is made of the functions below.
 * A's condition number grows like h^-4 for bending: see each solver's round_off. */
#ifndef BR_SOLVER_ASSEMBLED_H
#define BR_SOLVER_ASSEMBLED_H

#include "solver/linear_solver.h"

/* A without the clamped node: its lower band by columns. Entry (i, j), 0 <= i - j <= band, is
 * value[j * (band + 1) + i - j]; what would lie below the last row is zero. */
struct br_band {
    size_t order; /* unknowns a node times n */
    size_t band;  /* below the diagonal: 1 axial, 3 bending */
    double *value;
};

/* How a library factorises and solves. */
struct br_factoriser {
    const char *name;
    bool refines; /* heeds the option `refinement` by itself, else the assembled form does */

    /* What does not depend on A's values. Fails with BR_BAD_INPUT (an option), BR_NO_MEMORY,
     * BR_SINGULAR; free *factor even then. */
    enum br_status (*create)(const struct br_band *a, const struct br_linear_options *options,
                             void **factor, struct br_error *err);
    void (*free)(void *factor); /* accepts NULL */

    /* Factorises A, whose values are finite, in place of the factors before. Fails with
     * BR_SINGULAR where it meets that A is not positive definite, BR_NO_MEMORY. */
    enum br_status (*factorise)(void *factor, const struct br_band *a, struct br_error *err);

    /* x = A^-1 rhs; in, out: order values each, apart. Fails with BR_SINGULAR, BR_NO_MEMORY. */
    enum br_status (*solve)(void *factor, const double *rhs, double *x, struct br_error *err);
};

/* ---- the elements ---- */

/* The lower band of A (out, a->value: zeroed by the caller). */
void br_band_assemble(const struct br_field *field, struct br_band *a);

/* out += mass (consistent mass over h) v - stiffness (K of unit material) w, clamped node included.
 * Nodal arrays as in field.h: v, w in; out in/out. mass: kg or kg/s; stiffness: N, N m^2, or times
 * s. K w is formed from what deforms each element, which loses less than an assembled K would. */
void br_add_elements(const struct br_field *field, double mass, const double *v, double stiffness,
                     const double *w, double *out);

/* ---- the system A x = b ---- */

struct br_system {
    struct br_field field;
    size_t unknowns; /* a node */
    size_t nodal;    /* length of a nodal array, clamped node included */
    const struct br_factoriser *factoriser;
    void *factor;
    int refinement; /* steps a solve, at most, where the factoriser does not do it */
    struct br_band matrix;
    double *residual, *correction; /* workspace, nodal */
};

/* Prepares what does not depend on the values. Fails with BR_BAD_INPUT, BR_NO_MEMORY, BR_SINGULAR;
 * clear it even then. */
enum br_status br_system_init(struct br_system *s, const struct br_field *field,
                              const struct br_linear_options *options,
                              const struct br_factoriser *factoriser, struct br_error *err);
void br_system_clear(struct br_system *s);

/* Assembles and factorises A for s->field. Fails with BR_SINGULAR, BR_NO_MEMORY. */
enum br_status br_system_factorise(struct br_system *s, struct br_error *err);

/* x = A^-1 rhs; both nodal (in, out), and the clamped node of x stays as it is, zero. Fails with
 * BR_SINGULAR, BR_NO_MEMORY. */
enum br_status br_system_solve(struct br_system *s, const double *rhs, double *x,
                               struct br_error *err);

/* How much of x = A^-1 rhs is wrong, relative to its largest value (out): the correction that one
 * more step of refinement would make. Both nodal (in). Fails as br_system_solve. */
enum br_status br_system_loss(struct br_system *s, const double *rhs, const double *x, double *loss,
                              struct br_error *err);

/* What solves usually make a march lose, relative to the largest displacement, by measurements: an
 * upper estimate, 1 at most. */
double br_system_usual_loss(const struct br_field *field, const struct br_factoriser *factoriser,
                            const struct br_linear_options *options);

/* A march's round-off with that, as br_linear_solver has it. */
double br_system_round_off(const struct br_field *field, const struct br_factoriser *factoriser,
                           const struct br_linear_options *options);

/* What elimination without refinement leaves of the equations, as br_linear_solver's residual. */
double br_system_residual(const struct br_field *field);

/* ---- the functions of a br_field_solver: see there ---- */

/* `create` of a row: with the row's own factoriser. */
enum br_status br_assembled_create(const struct br_field *field,
                                   const struct br_linear_options *options,
                                   const struct br_factoriser *factoriser, void **self,
                                   struct br_error *err);
void br_assembled_free(void *self);
double br_assembled_compliance(const void *self);
double br_assembled_round_off(const void *self, size_t steps);
void br_assembled_set(void *self, const double *displacement, const double *velocity);
void br_assembled_get(const void *self, double *displacement, double *velocity);
void br_assembled_strain_rate(const void *self, double *rate);
enum br_status br_assembled_predict(void *self, const struct br_drive *drive, double *velocity,
                                    struct br_error *err);
double br_assembled_finish(void *self, double force);
double br_assembled_tip_displacement(const void *self);
enum br_status br_assembled_set_step(void *self, double k, struct br_error *err);
enum br_status br_assembled_keep(void *self, size_t count, struct br_error *err);
void br_assembled_exchange(void *self, size_t a, size_t b);
void br_assembled_combine(void *self, size_t into, size_t count, const double *weight);
void br_assembled_size(void *self, size_t state, double size[2]);

/* A br_field_solver of all but `create`. */
#define BR_ASSEMBLED(create_it)                                                                    \
    {                                                                                              \
        .create = create_it, .free = br_assembled_free, .tip_compliance = br_assembled_compliance, \
        .round_off = br_assembled_round_off, .set = br_assembled_set, .get = br_assembled_get,     \
        .strain_rate = br_assembled_strain_rate, .predict = br_assembled_predict,                  \
        .finish = br_assembled_finish, .tip_displacement = br_assembled_tip_displacement,          \
        .set_step = br_assembled_set_step, .keep = br_assembled_keep,                              \
        .exchange = br_assembled_exchange, .combine = br_assembled_combine,                        \
        .size = br_assembled_size,                                                                 \
    }

#endif
