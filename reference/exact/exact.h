/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact reference: the continuous problem (3)-(12), solved to nearly all
 * digits by spectral elements in space and Radau IIA between the events at the tip,
 * with an estimate of what is left of the error. It shares the scene with the
 * finite element solver and nothing else.
 *
 * Proofs about the loads and initial data (solver/proof.h) determine where elements and steps end:
 * where the data jump or bend, and where a polynomial would not resolve them. Where fronts of
 * a load f(x, t) move, integrals are cut at them. A function of which nothing can be proved is
 * taken for smooth. The regularisation of friction is ignored: the law is (12) itself. The error
 * handler of GSL has to be off. */
#ifndef BR_REFERENCE_EXACT_EXACT_H
#define BR_REFERENCE_EXACT_EXACT_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "solver/kind.h"

struct br_scene;

struct br_exact;

/* What the tip does. A contact is open or closed; with friction the tip sticks,
 * or slips up (towards positive w) or down; where no law acts it is free. */
/* X(name, what happens when it begins) */
#define BR_PHASE_LIST(X)           \
    X(BR_FREE, "is free")          \
    X(BR_OPEN, "contact opens")    \
    X(BR_CLOSED, "contact closes") \
    X(BR_STICK, "sticks")          \
    X(BR_SLIP_UP, "slips up")      \
    X(BR_SLIP_DOWN, "slips down")

enum br_phase {
#define X(name, text) name,
    BR_PHASE_LIST(X)
#undef X
};

/* Zeros mean the defaults. Tolerances are relative to the largest value over time. */
struct br_exact_options {
    double tolerance;  /* 1e-10: of displacements, 2e-11 to 1e-3; ten times that of velocities and
                          forces */
    double acceptable; /* the tolerance. Where max_modes are not enough for the tolerance, errors up
                          to this, 1e-3 at most, are accepted; the report has what was reached */
    size_t max_modes;  /* 256 per field, 18 to 1000; on several elements six times as many in
                          all */
    size_t max_steps;  /* 20000 per field */
    bool (*stop)(void *self); /* called every step; true: give up, with BR_INTERRUPTED */
    void *stop_self;
    /* called every step with the share of the allowed work that is done, 0 to 1; self is stop_self
     */
    void (*progress)(void *self, double share);
};

/* Solves the scene (only read, and not needed afterwards) twice or more, each
 * time with more modes and other steps, until two solutions agree; *out (owned
 * by the caller) is then the last one. Fails with BR_BAD_INPUT, BR_NO_MEMORY,
 * BR_SINGULAR, BR_INTERRUPTED, or BR_NOT_FINITE: the tolerance cannot be
 * promised, and why; at the latest after some 20 s of a core, counted and not measured. */
enum br_status br_exact_create(struct br_exact **out, const struct br_scene *scene,
                               const struct br_exact_options *options, struct br_error *err);
void br_exact_free(struct br_exact *exact);

/* All users of a scene share one exact solution while one of them has it: a fine run's check and
 * the exact reference beside it need the same one. */
/* *out: the solution of br_exact_create with at most max_modes modes (0: its default), or the same
 * one that another user has. Give it back before the scene ends. For any thread. Fails like
 * br_exact_create. */
enum br_status br_exact_borrow(const struct br_exact **out, const struct br_scene *scene,
                               const struct br_exact_options *options, struct br_error *err);

/* The last user to give it back frees it. Accepts NULL. */
void br_exact_give_back(const struct br_exact *exact);

/* The size of a field, or of its error. */
struct br_exact_size {
    double displacement; /* root of the mean square over the beam, or the tip's if larger, m */
    double velocity;     /* the same, m/s */
    double force;        /* at the tip, N */
    double strain_rate; /* root of the mean square over the beam of v_x, 1/s, or w_xxt, 1/(m s); not
                           used for the tolerance */
};

/* What is known about a field, 0 everywhere if it is not modelled. */
struct br_exact_report {
    struct br_exact_size largest; /* over time */
    /* Estimate, over time; at least 1e-13 of the largest displacement, a hundred times that
     * of the others: what rounding does. Velocity, strain rate and force have layers after an
     * event, force like (t - t*)^(1/4): their errors leave out times within 1e-6 T of an event, of
     * a jump of the data, or of a load pulse shorter than that. */
    struct br_exact_size error;
    size_t modes, steps;
};
struct br_exact_report br_exact_report(const struct br_exact *exact, enum br_field_kind field);

/* A phase of the tip begins. */
struct br_exact_event {
    double time;  /* s */
    double error; /* estimate of the time's error, s */
    enum br_field_kind field;
    enum br_phase phase; /* that begins */
};

/* The events in order of time, *count of them; those at t = 0 are the phases
 * in which it begins. Borrowed from exact. */
const struct br_exact_event *br_exact_events(const struct br_exact *exact, size_t *count);
const char *br_phase_text(enum br_phase phase);

/* The solution at one time. Each thread needs a state of its own. */
struct br_exact_state {
    double time; /* s */
    struct {
        double displacement, velocity; /* m, m/s */
    } tip[BR_FIELDS];
    union {
        double force[BR_FIELDS]; /* by br_field_kind, N */
        struct {
            double contact_force;  /* -sigma_H(L), N */
            double friction_force; /* lambda = -sigma_V(L), N */
        };
    };
    double friction_bound;      /* b, N */
    double *mode[BR_FIELDS][2]; /* private: displacement and velocity */
    double memory[];
};

/* *out (owned by the caller) is at t = 0. Fails with BR_NO_MEMORY. */
enum br_status br_exact_state_create(struct br_exact_state **out, const struct br_exact *exact,
                                     struct br_error *err);
void br_exact_state_free(struct br_exact_state *state);

/* Moves state to the time t, which is limited to [0, T]. All times cost the same and are as
 * accurate as the steps' ends. */
void br_exact_at(const struct br_exact *exact, double t, struct br_exact_state *state);

/* The same for one field; the other field may be at another time. */
void br_exact_field_at(const struct br_exact *exact, enum br_field_kind field, double t,
                       struct br_exact_state *state);

/* A function of x: a modelled field's displacement or velocity, derived. */
struct br_exact_quantity {
    enum br_field_kind field;
    bool velocity;
    unsigned order; /* of the derivative in x: axial 0 to 1, bending 0 to 2 */
};

/* L2 projection of a quantity on polynomials of a degree on each of n equal elements. */
struct br_exact_projection;
struct br_exact_mesh {
    size_t elements; /* n */
    size_t degree;   /* at most 8 */
};

/* *out (owned by the caller). Fails with BR_BAD_INPUT (a field that is not modelled, a higher order
 * or degree), BR_NO_MEMORY or BR_SINGULAR. */
enum br_status br_exact_projection_create(struct br_exact_projection **out,
                                          const struct br_exact *exact,
                                          const struct br_exact_quantity *quantity,
                                          const struct br_exact_mesh *mesh, struct br_error *err);
void br_exact_projection_free(struct br_exact_projection *projection);

/* c (out, elements x (degree + 1)): coefficients of the Legendre polynomials
 * that are orthonormal on each element. *rest (out): the square of the L2 norm
 * of what the projection leaves out, found without a difference, so that the
 * square of a distance to a piecewise polynomial d is |c - d|^2 + rest. One
 * projection may be used by one thread at a time. */
void br_exact_projection_apply(struct br_exact_projection *projection,
                               const struct br_exact_state *state, double *c, double *rest);

#endif
