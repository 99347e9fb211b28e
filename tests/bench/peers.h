/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Other ways to make the same step, as solvers that are not in the registry: the assembled form
 *     (M/k + C + kK) v_n = F_n + M v_{n-1}/k - K w_{n-1},
 * factorised once by a library and solved once a step; the laws at the tip are the march's. */
#ifndef BENCH_PEERS_H
#define BENCH_PEERS_H

#include "solver/linear_solver.h"

enum { PEER_BAND = 3, PEER_ROWS = PEER_BAND + 1 }; /* below the diagonal: 1 axial, 3 bending */

/* The matrix without the clamped node: its lower band by columns, entry (i, j) at
 * value[j * (band + 1) + i - j]. */
struct peer_matrix {
    size_t order, band;
    double *value;
};

/* How a library factorises and solves. */
struct peer_library {
    /* May take the matrix's values for its own use: they outlive it. */
    enum br_status (*create)(const struct peer_matrix *matrix, void **factor, struct br_error *err);
    void (*free)(void *factor);
    /* The solution, order values; rhs is a workspace. NULL: it failed. */
    const double *(*solve)(void *factor, double *rhs);
};

/* Functions of a br_field_solver; `create` is a peer's own, which says its library. */
enum br_status peer_create(const struct br_field *field, const struct peer_library *library,
                           void **self, struct br_error *err);
void peer_free(void *self);
double peer_compliance(const void *self);
void peer_set(void *self, const double *displacement, const double *velocity);
void peer_get(const void *self, double *displacement, double *velocity);
void peer_strain_rate(const void *self, double *rate);
enum br_status peer_predict(void *self, const struct br_drive *drive, double *velocity,
                            struct br_error *err);
double peer_finish(void *self, double force);
double peer_tip_displacement(const void *self);

/* Defines the solver `record` on a library. */
#define PEER(record, label, library)                                                               \
    static enum br_status record##_create(const struct br_field *field,                            \
                                          const struct br_linear_options *options, void **self,    \
                                          struct br_error *err)                                    \
    {                                                                                              \
        (void)options;                                                                             \
        return peer_create(field, &library, self, err);                                            \
    }                                                                                              \
    static const struct br_field_solver record##_field = {                                         \
        record##_create, peer_free,   peer_compliance,       peer_set, peer_get, peer_strain_rate, \
        peer_predict,    peer_finish, peer_tip_displacement,                                       \
    };                                                                                             \
    const struct br_linear_solver record = {                                                       \
        .name = label, .options = "", .axial = &record##_field, .bending = &record##_field};

extern const struct br_linear_solver peer_banded;
extern const struct br_linear_solver peer_cholmod_simplicial, peer_cholmod_supernodal;

#endif
