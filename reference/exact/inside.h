/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inside of the exact reference: elements and their series; what is known of the data; a field on
 * its modes; its march. */
#ifndef BR_REFERENCE_EXACT_INSIDE_H
#define BR_REFERENCE_EXACT_INSIDE_H

#include "reference/exact/exact.h"
#include "reference/exact/legendre.h"
#include "solver/proof.h"
#include "solver/scene.h"

/* ---- elements (spectral.c) ----
 *
 * Elements of a beam, and functions that are a Legendre series on each of them.
 *
 * On element e, of width h in units of L, a function is the sum over k of c_k p_k(xi) / sqrt(h),
 * xi in [0, 1]: these are orthonormal in x / L. A series has terms[e] + extra coefficients there,
 * where `extra` counts how often functions of terms[e] coefficients were integrated. */

struct br_spectral_elements {
    double length; /* L, m */
    size_t count;  /* elements, 1 or more */
    double *end;   /* count + 1, m: 0 = end[0] < ... < end[count] = L */
    size_t *terms; /* count, each 1 or more */
    size_t *first; /* count + 1: sum of the terms before */
};

/* Copies end and terms. After a failure, which the store keeps, the spectral elements are of no
 * use. */
void br_spectral_init(struct br_spectral_elements *spectral, double length, size_t count,
                      const double *end, const size_t *terms, struct br_store *store);

/* Where element e's coefficients begin; with e = count, their number. */
static inline size_t br_spectral_at(const struct br_spectral_elements *p, size_t e, size_t extra)
{
    return p->first[e] + e * extra;
}

/* h of element e, in units of L. */
static inline double br_spectral_width(const struct br_spectral_elements *p, size_t e)
{
    return (p->end[e + 1] - p->end[e]) / p->length;
}

/* Integral over all x / L of a series. */
double br_spectral_integral(const struct br_spectral_elements *spectral, size_t extra,
                            const double *c);

/* c: in, a series with `extra`; out, its integral from x = 0 in x / L, with extra + 1. */
void br_spectral_integrate(const struct br_spectral_elements *spectral, size_t extra, double *c);

/* ---- quadrature ---- */

struct br_quadrature {
    const struct br_spectral_elements *spectral; /* borrowed */
    size_t extra;                                /* of the series */
    size_t *points;                              /* elements: of its rule */
    size_t count;                                /* all points */
    double *x;      /* count, m: inside of the elements, never at their ends */
    double *weight; /* count: of the rule on [0, 1] */
    double **table; /* elements: points x (terms + extra), p_k at the points */
    double *value;  /* count, workspace */
};

/* After a failure, which the store keeps, the quadrature is of no use. */
void br_quadrature_init(struct br_quadrature *q, const struct br_spectral_elements *spectral,
                        size_t extra, struct br_store *store);

/* c (out, with extra): coefficients of the function f(x, t)'s projection: its integrals over x / L
 * against the polynomials. Elements that contain some of `fronts`, points in m where f jumps or
 * bends at t (NULL: none), are cut there. Fails with BR_NO_MEMORY. */
enum br_status br_quadrature_project(const struct br_quadrature *q, const struct br_function *f,
                                     double t, const struct br_breaks *fronts, double *c,
                                     struct br_error *err);

/* c (out, extra 0): the same of the derivative in x / L of a continuous f(x, 0). */
enum br_status br_quadrature_project_slope(const struct br_quadrature *q,
                                           const struct br_function *f, double *c,
                                           struct br_error *err);

/* ---- the L2 projection of a series on polynomials on equal elements (projection.c) ---- */

struct br_piecewise;

/* *out (owned by the store). Series have `extra` more terms. Fails with BR_NO_MEMORY or
 * BR_SINGULAR. */
enum br_status br_piecewise_create(struct br_piecewise **out,
                                   const struct br_spectral_elements *spectral, size_t extra,
                                   const struct br_exact_mesh *mesh, struct br_store *store,
                                   struct br_error *err);

/* c and rest as br_exact_projection_apply has them. For one thread at a time. */
void br_piecewise_apply(struct br_piecewise *piecewise, const double *series, double *c,
                        double *rest);

/* ---- the mesh of the data ----
 *
 * What is known of a field's data before it is solved: on which elements, and at which steps. It
 * comes from what is proved of a scene's functions (solver/proof.h): where they jump, and meshes on
 * whose cells polynomials represent them, in proportion to their size nearby. A function of which
 * nothing is proved is assumed to be smooth. */

/* ---- one function (function_mesh.c) ---- */

/* The allowed error of a polynomial, relative to the largest value in its cell, or to the mean if
 * that is larger. */
#define BR_MESH_TOLERANCE 1e-11

/* Degree of the polynomials on an element, and of those that the rules over a step integrate. */
enum { BR_MESH_DEGREE = 15 };

/* Numbers. */
struct br_list {
    double *at; /* count; of a store */
    size_t count, room;
};

/* After a failure, which the store keeps, the value is missing. */
void br_list_add(struct br_list *list, double value, struct br_store *store);

/* Sorts, and keeps one of equal numbers. */
void br_list_sort(struct br_list *list);

/* A bound on the error of a polynomial along one variable in the box; infinite where f is not
 * smooth. */
double br_function_mesh_error(const struct br_function *f, enum br_variable along,
                              struct br_box box, size_t degree);

/* The mean of |f| over a box of one or two variables, at least half of it where it can be found. */
double br_function_mesh_mean(const struct br_function *f, struct br_box box);

/* A function and the box where it is needed. The box has one value of a variable that the function
 * does not use, or whose other values do not matter. */
struct br_function_mesh {
    const struct br_function *f;
    struct br_box box;
    double mean;   /* br_function_mesh_mean of the box */
    double missed; /* out: share of its integral that cells may hide, in all */
};

/* Adds the ends of cells inside of a part of the box along each of its variables. For a function
 * of both, switching functions may move in the part. Fails with BR_NOT_FINITE: too many,
 * BR_BAD_INPUT where the function is not finite, or BR_NO_MEMORY. */
enum br_status br_function_mesh_add(struct br_function_mesh *function_mesh, struct br_box part,
                                    struct br_list ends[2], struct br_store *store,
                                    struct br_error *err);

/* ---- all data of a field (data_mesh.c) ---- */

/* Of the initial displacement, derived degree - 1 times. */
static inline const struct br_function *br_initial_slope(const struct br_scene_field *field,
                                                         size_t degree)
{
    return degree == 1 ? &field->displacement : &field->displacement_slope;
}

struct br_data_mesh {
    const struct br_scene_field *data; /* borrowed */
    size_t degree;                     /* of the field: 1 axial, 2 bending */
    struct br_list end[2]; /* by br_variable: of the elements, m, from 0 to L; of cells in time, s,
                              that no step may overlook, from 0 to T */
    struct br_breaks jump; /* times inside of (0, T) at which the data jump or bend */
    bool fronts;           /* the load's jumps move */
    double missed;         /* share of the load's integral that proofs could not exclude */
    double proved;         /* likewise, the proved error of polynomials */
    struct br_store store;
};

/* Clear it even after a failure: BR_NOT_FINITE, the data have details that are too fine,
 * BR_BAD_INPUT where they are not finite, or BR_NO_MEMORY. */
enum br_status br_data_mesh_init(struct br_data_mesh *data_mesh, const struct br_scene *scene,
                                 enum br_field_kind kind, struct br_error *err);
void br_data_mesh_clear(struct br_data_mesh *data_mesh);

/* The number of polynomials on element e in a solution that would have `modes` on one element. */
size_t br_data_mesh_terms(const struct br_data_mesh *data_mesh, size_t e, size_t modes);

/* Whether the data change so fast within `width` of t that a cell is shorter than that. */
bool br_data_mesh_is_sharp(const struct br_data_mesh *data_mesh, double t, double width);

/* The length of the cell that contains t, infinite where it is the only one; where two meet the
 * later one. */
double br_data_mesh_cell(const struct br_data_mesh *data_mesh, double t);

/* How long a step from t may be: not longer than any cell that it touches. */
double br_data_mesh_reach(const struct br_data_mesh *data_mesh, double t);

/* ---- a field (field.c) ----
 *
 * One field of the beam, axial or bending, as independent damped oscillators
 *     mass_i q_i'' + damping q_i' + stiffness q_i = load_i(t) - tip_i force,
 * coupled only by the force at the tip: equations (3), (4), (8), (9), (11). */

/* Modes of a clamped-free rod or beam of unit length, by a spectral Galerkin
 * method on elements.
 *
 * Trial functions are the degree-fold integrals (from the clamp) of the elements'
 * orthonormal polynomials, m of them in all; degree 1 gives the rod's space E, 2 the
 * beam's space V, and the elastic energy is the identity. With B the matrix that integrates, the
 * singular value decomposition B = Y diag(s) U' gives modes that are orthogonal
 * in the mass and in the energy: mode i is s_i times the unit function with the
 * coefficients Y_i, and its derivative of order `degree` has the coefficients U_i. */
struct br_modes {
    struct br_spectral_elements spectral;
    size_t count;     /* m, the spectral elements' terms */
    size_t width;     /* m, and zeros up to a multiple of BR_STAGE_LANES */
    size_t degree;    /* 1: axial, 2: bending */
    double *size;     /* s, width: L2 norm of each mode */
    double *shape;    /* Y, br_modes_length(0) x m, by columns */
    double *function; /* B U = Y s, br_modes_length(0) x width, by rows: modes integrated from the
                         clamp */
    double *curve;    /* U, m x m, by columns */
    double *tip;      /* width: value of each mode at the free end */
    double *slope;    /* width: derivative of each there; degree 2 only, else zeros */

    struct br_quadrature quadrature; /* of functions that are tested with shapes */
};

/* modes: in, with its spectral elements, all else zero. Fails with BR_NO_MEMORY or BR_SINGULAR. */
enum br_status br_modes_init(struct br_modes *modes, size_t degree, struct br_store *store,
                             struct br_error *err);

/* Number of Legendre coefficients of a sum of modes derived `order` times,
 * order <= degree. */
size_t br_modes_length(const struct br_modes *modes, size_t order);

/* c (out, br_modes_length) = Legendre coefficients of the order-th derivative of
 * sum_i q_i mode_i in x / L, order <= degree. */
void br_modes_expand(const struct br_modes *modes, size_t order, const double *q, double *c);

/* ---- the field ---- */

struct br_oscillators {
    struct br_modes modes;
    double length;                     /* L, m */
    double *mass;                      /* width, kg; behind the modes 1 */
    double damping, stiffness;         /* N s/m, N/m */
    const struct br_scene_field *data; /* borrowed */
    bool fronts;                       /* the load's jumps move */
    double *load_space;   /* BR_LOAD_TERMS x width: of the terms whose space part is constant
                             in time */
    double *load_series;  /* BR_STAGES x br_modes_length(0), workspace for one that is not */
    double *load_sum;     /* BR_STAGES x width, likewise */
    double *displacement; /* modes: at t = 0, m */
    double *velocity;     /* modes: at t = 0, m/s */
    double tip_displacement, tip_velocity; /* at t = 0, m, m/s */
};

/* *out (owned by the store). The scene (borrowed, with its functions) must model the field. On the
 * data mesh's elements, of as many polynomials as it has for `modes`. Fails with BR_NO_MEMORY or
 * BR_SINGULAR. */
enum br_status br_oscillators_create(struct br_oscillators **out, const struct br_scene *scene,
                                     const struct br_data_mesh *data_mesh, size_t modes,
                                     struct br_store *store, struct br_error *err);

/* out (BR_STAGES x width): load_i(t) at each t, N. *size: out, of loads that no product gives, N:
 * what a mode of size 1 gets of them may be wrong by round-off of that at any t. Fails with
 * BR_NO_MEMORY, or BR_BAD_INPUT: too many fronts. */
enum br_status br_oscillators_load(const struct br_oscillators *field, const double t[BR_STAGES],
                                   double *out, double *size, struct br_error *err);

/* What a step costs in the units of br_effort: its modes, and loads that no product gives. */
double br_oscillators_work(const struct br_oscillators *field);

/* L2 norm over the beam of sum_i q_i mode_i. */
double br_oscillators_norm(const struct br_oscillators *field, const double *q);

/* The work that an exact solution may take, and the functions that stop it and get its progress. */
struct br_effort {
    double done, most; /* units of about 1.4 microseconds of a core: counted, not measured */
    const struct br_exact_options *who;
};

/* Fails with BR_INTERRUPTED, or BR_NOT_FINITE where no work is left. */
enum br_status br_effort_spend(struct br_effort *effort, double work, struct br_error *err);

/* ---- the tip (tip.c) ----
 *
 * The laws (10) and (12), one phase at a time. In each phase the law is linear, and a switching
 * function measures how far the phase is from its end. */

/* The tip along one step; series in p_k((t - start) / length). */
struct br_tip_step {
    double start, length; /* s */
    enum br_phase phase;
    double displacement;        /* at the start, less the gap of a contact, m */
    double velocity[BR_STAGES]; /* m/s */
    double force[BR_STAGES];    /* of the obstacle on the beam, against +displacement, N */
    double *values; /* BR_HISTORY_ROWS x modes: series of the velocity, m/s, and the displacement
                       at the start, m; of a step that is kept */
};
enum { BR_HISTORY_ROWS = BR_STAGES + 1 };

struct br_entry {
    double time;  /* s */
    double error; /* of the time, from round-off alone, s */
    enum br_phase phase;
};

struct br_history {
    size_t modes;
    double gap;           /* m */
    double free_velocity; /* largest root mean square over the beam of a step's mean velocity with a
                             free tip, m/s */
    double impulse;       /* sum over the steps of the velocity that their loads alone give, L2 */
    double blurred;       /* sum of squares of its changes by the rounding of t */
    size_t steps, step_room;
    struct br_tip_step *tip; /* steps */
    size_t entries, entry_room;
    struct br_entry *entry; /* phases in order of time, the first at t = 0 */
    struct br_store *store; /* owns the arrays */
};

/* Values at one time. */
struct br_tip_state {
    double displacement; /* less the gap of a contact, m */
    double velocity;     /* m/s */
    double force;        /* N */
    enum br_phase phase;
};

/* The step that contains t; where two steps meet the later one. */
size_t br_history_find(const struct br_history *track, double t);

/* The tip at the time start + theta length. */
struct br_tip_state br_tip_at(const struct br_tip_step *tip, double theta);

/* q and v (out, modes each, may be NULL): coefficients of displacement and
 * velocity at t. Returns the tip's values. */
struct br_tip_state br_history_at(const struct br_history *track, double t, double *q, double *v);

struct br_exact_law {
    bool contact;                   /* (10), on the axial field; else (12), on the bending field */
    bool obstacle;                  /* whether there is one to be in contact with */
    double stiffness;               /* c_H, N/m; 0 without a contact */
    struct br_friction friction;    /* of the bending field */
    const struct br_history *axial; /* whose tip sets the bound; NULL: it does not; borrowed */
};

/* Whether the exact solution has the bound of a law, in a table of its own, and whether that bound
 * depends on the contact. */
bool br_law_is_known(const struct br_friction *friction);
bool br_law_follows(const struct br_friction *friction);

/* The friction bound b(t), N. */
double br_law_bound(const struct br_exact_law *law, double t);

/* The law at a tip in its phase. */
struct br_law_state {
    double force;       /* on the tip, N; from the series only where the law does not give it */
    double switching;   /* distance to the end of the phase: negative when it is over */
    enum br_phase next; /* the phase that follows when the switching function ends it */
};
struct br_law_state br_law_at(const struct br_exact_law *law, double t,
                              const struct br_tip_state *tip);

/* The phase at t of a tip with this displacement (less the gap) and velocity;
 * `now` is the phase before t, BR_FREE at t = 0. */
enum br_phase br_law_phase(const struct br_exact_law *law, double t, enum br_phase now,
                           double displacement, double velocity);

/* ---- one step (step.c) ---- */

/* A field at one time. The tip's values are sums of increments, and are set when an event fixes
 * them: a sum over modes would lose values that are small just after an event. */
struct br_stepper {
    const struct br_oscillators *field; /* borrowed */
    const struct br_exact_law *law;     /* borrowed */
    struct br_radau radau;

    double time;     /* s */
    double from, to; /* s: the load is taken between these, where it does not jump */
    double blur;     /* relative change of the load by the rounding of t */
    enum br_phase phase;
    double *q, *v;                         /* modes: m, m/s */
    double tip_displacement, tip_velocity; /* less the gap, m, m/s */

    struct br_tip_step tip; /* the last trial step */
    double *series;         /* BR_STAGES x width of the modes: its velocity, m/s */
    double free_size;       /* m^(3/2)/s: mean velocity in L2 as if the tip were free: where a tip
                               force cancels it, its round-off is what remains */

    double work; /* of the trial steps, see br_effort; the reader sets it to zero */

    double length;                 /* s, of the step that the responses are for */
    struct br_stage_system system; /* of this length, over stiffness h */
    double *gain;      /* width: mean velocity in a step over a constant force, m/(N s) */
    double tip_length; /* s, of the step that this is for: only phases that need it have it */
    double tip_response[BR_STAGES][BR_STAGES]; /* velocity over force, m/(N s) */
    double *load;                              /* BR_STAGES x width, at the stages, N */
    double *rest;          /* the same size: series of the load less the forces of the state, N */
    double load_noise;     /* m^(3/2)/s: error of the velocity by a load's round-off, in L2 */
    double impulse;        /* m^(3/2)/s: velocity that the loads alone give in the step, in L2 */
    double noise_response; /* the same of a load of 1 N of every shape */
};

/* s: in, with its field and law, all else zero; gap in m. Starts at t = 0. Fails with
 * BR_NO_MEMORY. */
enum br_status br_stepper_init(struct br_stepper *s, double gap, struct br_store *store,
                               struct br_error *err);

/* Sets tip and series to a step of length h from the current state, which stays.
 * Fails with BR_NO_MEMORY, BR_SINGULAR or BR_NOT_FINITE. */
enum br_status br_stepper_try(struct br_stepper *s, double h, struct br_error *err);

/* Moves the state to the end of the last trial step, called `time`. */
void br_stepper_accept(struct br_stepper *s, double time);

/* Sets exactly what the end of the state's phase fixes: the tip's displacement
 * where a contact opens or closes, its velocity where a slip ends. */
void br_stepper_settle(struct br_stepper *s);

/* ---- the march ---- */

struct br_march_options {
    double duration;                         /* T, s */
    const struct br_data_mesh *data_mesh[2]; /* of this field, and NULL or the one that it depends
                                            on: both limit the steps */
    double gap;                              /* of the contact, m; 0 for friction */
    double tolerance;  /* limit of a step's last coefficients, relative to the largest value */
    double first_step; /* s: length of the first step of a phase, always accepted */
    size_t max_steps;
    struct br_effort *effort;
};

/* *out (owned by the store): the history of the field under the law, both of
 * which are only read. Fails with BR_NO_MEMORY, BR_SINGULAR, BR_INTERRUPTED, or BR_NOT_FINITE
 * where the solution blows up, asks for too many steps, or has phases that
 * follow each other without end. */
enum br_status br_march(const struct br_oscillators *field, const struct br_exact_law *law,
                        const struct br_march_options *options, struct br_store *store,
                        struct br_history **out, struct br_error *err);

/* ---- a solution ---- */

/* One march of each modelled field; the others are NULL. */
struct br_exact_solution {
    struct br_oscillators *field[BR_FIELDS];
    struct br_exact_law law[BR_FIELDS];
    struct br_history *track[BR_FIELDS];
    struct br_store store; /* of the fields */
};

struct br_exact {
    double duration; /* T, s */
    struct br_exact_solution *solution;
    struct br_exact_report report[BR_FIELDS];
    double noise[BR_FIELDS]; /* m/s: where a force at the tip cancels all motion, this much
                                      of the velocity is round-off */
    size_t events;
    struct br_exact_event *event;
};

#endif
