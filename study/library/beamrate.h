/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate as a library: scenes, marches, studies, verdicts and orders of convergence.
 *
 * Equations in brackets are those of M. Campo, J. R. Fernandez, G. E. Stavroulakis, J. M. Viano,
 * "Dynamic frictional contact of a viscoelastic beam", ESAIM: M2AN 40, 2006.
 *
 * All quantities are in SI units. Pointers to handles and structs must not be NULL, unless a
 * comment allows it: NULL, a handle of another kind, an index or a number outside of an enum are
 * refused (BEAMRATE_BAD_INPUT), and a function that has no message then fills *out with zeros, NaN
 * and "". A handle that was freed, and a pointer to anything else, are not recognised. A pointer to const that a function returns is borrowed from its handle, and
 * valid as long as the handle.
 *
 * Errors are values. A function that can fail returns a status, and fills *err (out; may be NULL)
 * with a message for a person: what was found and what was expected. If a function fails to make a
 * handle, the handle is NULL. The library prints nothing and does not end the process, also where
 * memory ends: the call fails with BEAMRATE_NO_MEMORY.
 *
 * Threads: different threads may use different handles at the same time, and several calls may use
 * one scene at the same time, so that it serves many marches. Any other handle allows one call at a
 * time. The library keeps no data between calls except handles. One effect concerns the whole
 * process: while a function of the library runs, the error handler of GSL is off, and the last call
 * that ends restores it. A function that takes `threads` (0 to 1024; 0: all cores) starts threads
 * of its own, fewer if the system has none left, and ends them before it returns; so a process may
 * fork between calls. Results depend neither on threads nor on the locale.
 *
 * ABI: libbeamrate.so has the major version in its name. Within a major version functions may be
 * added, but none is removed, and no struct or number below is changed. */
#ifndef BEAMRATE_H
#define BEAMRATE_H

#include <stddef.h>

#include "version.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- common types ---- */

enum beamrate_status {
    BEAMRATE_OK = 0,
    BEAMRATE_BAD_INPUT = 1,   /* the message names file, line and key if there are any */
    BEAMRATE_UNSUPPORTED = 2, /* not in this build */
    BEAMRATE_NO_MEMORY = 3,
    BEAMRATE_SINGULAR = 4,   /* the system of a step is not positive definite */
    BEAMRATE_NOT_FINITE = 5, /* a load, or a march that blows up */
    BEAMRATE_IO = 6,
    BEAMRATE_INTERRUPTED = 7 /* by an observer, or a method's own limit */
};

struct beamrate_error {
    enum beamrate_status status;
    char message[1024];
};

/* A field of the beam: u(x, t) along it, w(x, t) across it. */
enum beamrate_field { BEAMRATE_AXIAL = 0, BEAMRATE_BENDING = 1 };

/* The component of an error: both fields together, or one. Index of arrays of three. */
enum beamrate_part { BEAMRATE_TOTAL = 0, BEAMRATE_OF_AXIAL = 1, BEAMRATE_OF_BENDING = 2 };

/* What is refined. */
enum beamrate_axis { BEAMRATE_SPACE = 0, BEAMRATE_TIME = 1 };

/* A number with its 95 % interval; NaN if it is not known. */
struct beamrate_estimate {
    double value, low, high;
};

/* How a long call reports its progress and is stopped. `progress` gets the completed share of the
 * work, 0 to 1. Any thread may call it, one at a time, perhaps in the locale C. It may call the
 * library. If it returns another value than 0, the call ends soon, with BEAMRATE_INTERRUPTED. */
struct beamrate_observer {
    int (*progress)(void *self, double share);
    void *self;
};

/* A method is a list of keys and values, which ends with NULL:
 *     const char *const method[] = {"scheme", "bdf2", "axial_degree", "2", NULL};
 * Keys and values are those of a scene's `verify` part: scheme, tolerance, axial_degree, solver,
 * kernel, contact, friction, friction_parameter, friction_tolerance.
 * The default of all keys, and of a list that is NULL, is the paper's scheme:
 * implicit Euler with lagged contact, (16) and (17). Unknown keys and keys that the method does not
 * use are refused (BEAMRATE_BAD_INPUT). */

/* The version of the library that is loaded: "1.2.3". BEAMRATE_VERSION is that of the header. */
const char *beamrate_version(void);

/* ---- scenes ---- */

/* A beam, its loads, the obstacle and the friction: the problem (4) to (15). It does not change,
 * and must outlive the marches that are made from it. */
struct beamrate_scene;

enum beamrate_friction { BEAMRATE_FRICTIONLESS = 0, BEAMRATE_TRESCA = 1, BEAMRATE_COULOMB = 2 };

struct beamrate_scene_info {
    const char *name;                /* one word */
    const char *title;               /* one line for a person */
    double length;                   /* L, m */
    double duration;                 /* T, s */
    double density;                  /* rho, kg/m */
    int modelled[2];                 /* by beamrate_field: 1 if the scene has the field; else 0 */
    int contact;                     /* 1: normal compliance (10); else 0 */
    enum beamrate_friction friction; /* (12) */
};

/* Reads a scene, with its `verify` part, from a YAML file; if `name` names no file, from the
 * bundled scene of that name. *scene (out): owned by the caller. Fails with BEAMRATE_BAD_INPUT, and
 * the message names file, line and key; BEAMRATE_IO; BEAMRATE_NO_MEMORY. */
enum beamrate_status beamrate_scene_open(struct beamrate_scene **scene, const char *name,
                                         struct beamrate_error *err);

/* The same from a text, which messages call `name`. */
enum beamrate_status beamrate_scene_parse(struct beamrate_scene **scene, const char *name,
                                          const char *text, struct beamrate_error *err);

void beamrate_scene_free(struct beamrate_scene *scene); /* accepts NULL */

/* The data of a scene (out). */
enum beamrate_status beamrate_scene_info(const struct beamrate_scene *scene,
                                         struct beamrate_scene_info *info);

/* ---- before a march ---- */

enum { BEAMRATE_MOST_WARNINGS = 16 };

/* A warning before a march. */
struct beamrate_warning {
    char kind[24];    /* one word: "unstable", "load-in-time", ... */
    char text[400];   /* what will happen, with numbers */
    char remedy[400]; /* what to do instead, one line each; "": not known */
};

/* The expected errors of a march: the largest L2 norm over all time levels, relative to the largest
 * norm of that field's solution; zeros for a field that is not modelled. */
struct beamrate_forecast {
    int known;                         /* 1: the errors below are predicted; 0: they are NaN */
    char why[200];                     /* why the errors are not known; else "" */
    struct beamrate_estimate error[2]; /* of discretisation, by beamrate_field; high is infinite if
                                          the error may be as large as the solution */
    double round_off;                  /* relative to the exact discrete solution */
    size_t warnings;                   /* the number of warnings */
    struct beamrate_warning warning[BEAMRATE_MOST_WARNINGS];
};

/* Predicts the error of a march of n elements and `steps` time steps, and warns; *forecast (out).
 * It takes some ten milliseconds; for a march that takes longer, it takes less time than the march.
 * Fails as beamrate_march_create, also if the march is refused for its cost. */
enum beamrate_status beamrate_foresee(const struct beamrate_scene *scene, size_t n, size_t steps,
                                      const char *const *method, struct beamrate_forecast *forecast,
                                      struct beamrate_error *err);

/* ---- marches ---- */

/* The fully discrete problem VP^hk, (16) and (17), on n equal elements of h = L/n and `steps` equal
 * steps of k = T/steps, at a time level from t = 0 to T. */
struct beamrate_march;

/* The tip x = L at a time level; values that are not modelled are zero. At step 0 the forces are
 * those of the laws at the initial data. The friction force is NaN there, unless there is no
 * friction: it depends on what follows. */
struct beamrate_tip {
    size_t step;            /* number of steps done */
    double time;            /* t_n = step k, s */
    double displacement[2]; /* u_n(L), w_n(L), m, by beamrate_field */
    double velocity[2];     /* of u and w, m/s */
    double contact_force;   /* c_H (u - g)_+ as the step used it, (10), N */
    double friction_force;  /* lambda = -sigma_V(L), N */
    double friction_bound;  /* h(t_n) of (12), N */
};

/* The size and the cost of a march. */
struct beamrate_march_report {
    size_t n, steps, done;
    size_t accepted, rejected; /* an adaptive scheme's own steps */
    size_t stages;             /* linear solves of each field */
    double round_off;          /* predicted, relative to the exact discrete solution */
    int unstable; /* 1: a lagged contact was closed beyond its stability limit: the tip chatters,
                     and the results are not reliable */
};

/* Sets up a march at t = 0; n and steps >= 1. *march (out): owned by the caller. Fails with
 * BEAMRATE_BAD_INPUT if the method does not go with the scene or the march would take a century,
 * BEAMRATE_NO_MEMORY, also if the machine has too little memory for the march, BEAMRATE_SINGULAR or
 * BEAMRATE_NOT_FINITE. */
enum beamrate_status beamrate_march_create(struct beamrate_march **march,
                                           const struct beamrate_scene *scene, size_t n,
                                           size_t steps, const char *const *method,
                                           struct beamrate_error *err);
void beamrate_march_free(struct beamrate_march *march); /* accepts NULL */

/* Takes `count` steps of (16) and (17). Fails with BEAMRATE_BAD_INPUT if fewer are left, and then
 * does nothing. If it fails with BEAMRATE_NOT_FINITE, BEAMRATE_SINGULAR, BEAMRATE_INTERRUPTED or
 * BEAMRATE_NO_MEMORY, the state is lost, and each later step fails in the same way. */
enum beamrate_status beamrate_march_step(struct beamrate_march *march, size_t count,
                                         struct beamrate_error *err);

/* The tip after the last step (out). */
enum beamrate_status beamrate_march_tip(const struct beamrate_march *march,
                                        struct beamrate_tip *tip);

/* Numbers for each node in beamrate_march_get: axial 1, quadratic elements 2; bending 2; 0 if there
 * is no such march or field. */
size_t beamrate_march_columns(const struct beamrate_march *march, enum beamrate_field field);

/* Displacement and velocity of a field after the last step at the nodes x_i = i h, i = 0 .. n (out,
 * m and m/s; either may be NULL): n + 1 rows of `columns` numbers each. Column 0 is the field
 * itself. Column 1 of bending is the scaled slope h w_x, with which w is the cubic Hermite
 * interpolant. Column 1 of quadratic axial elements is the bubble b of the element that ends at the
 * node: with xi in [0, 1] along it, u = (1 - xi) u_left + xi u_right - xi (1 - xi) b. All numbers
 * are zero if the field is not modelled. */
enum beamrate_status beamrate_march_get(const struct beamrate_march *march,
                                        enum beamrate_field field, double *displacement,
                                        double *velocity);

/* The size of a march and its cost so far (out). */
enum beamrate_status beamrate_march_report(const struct beamrate_march *march,
                                           struct beamrate_march_report *report);

/* ---- studies ---- */

/* The errors of a grid of marches against one reference, and their orders. The paper's Tables 1 and
 * 2 are two studies. */
struct beamrate_study;

/* The request for a study; all borrowed. Zeros are the defaults. */
struct beamrate_study_request {
    const size_t *n; /* n_count meshes, ascending */
    size_t n_count;
    const size_t *steps; /* steps_count numbers of time steps, ascending */
    size_t steps_count;
    const char *const *method; /* of the cells and of a fine reference */
    const char *reference;     /* "exact", "mms", "fine"; NULL: the best one for the scene */
    size_t reference_n, reference_steps; /* of "fine": multiples of all n and all steps */
    const char *norm;                    /* "l2" of (31), "energy" of (25), "tip"; NULL: "l2" */
    int threads;                         /* 0 to 1024; 0: all cores */
    const struct beamrate_observer *observer; /* NULL: none */
};

/* A cell: the march of one n and one number of steps. Arrays of three are by beamrate_part. */
struct beamrate_cell {
    size_t n, steps;
    double error[3]; /* largest over the time levels, in the norm's unit; NaN: the march failed */
    const char *flag[3]; /* why the fits leave it out: "" (they do not), "reference" or "round-off"
                            (the error is as small as these), "failed", "unstable", "stagnation" */
    double tip[2];       /* u(L, T), w(L, T), m, by beamrate_field */
    double seconds;      /* time of the march on one thread */
    const char *failure; /* why the march failed; "": it did not */
};

/* Orders from all cells that are not left out: e^2 = a^2 + 2 r a b + b^2, a = C_h h^p, b = C_k k^q,
 * and the reference's own error. Numbers of an error component that is too small to see are NaN. */
struct beamrate_fit {
    int describes; /* 1: the model describes the errors with a misfit of at most 2 %; else 0 */
    struct beamrate_estimate p, c_h, q, c_k, r;
    double misfit; /* root mean square of log(model/error) */
    size_t points;
};

/* The reference of a study. */
struct beamrate_reference {
    const char *name;    /* "exact", "mms", "fine" */
    size_t n, steps;     /* of a fine run; else n = 0 */
    double own_error[3]; /* its own error, in the norm's unit, by beamrate_part; NaN: not known */
    double size;         /* the norm of the solution itself */
    double tip[2];       /* u(L, T), w(L, T), m */
};

/* Marches all cells and the reference, and fits. *study (out): owned by the caller; it does not
 * need the scene any more. A cell that fails is marked. Fails with BEAMRATE_BAD_INPUT if the grid
 * does not nest in the reference's or the reference refuses the scene, BEAMRATE_NO_MEMORY,
 * BEAMRATE_INTERRUPTED, or as the reference's march does. */
enum beamrate_status beamrate_study_run(struct beamrate_study **study,
                                        const struct beamrate_scene *scene,
                                        const struct beamrate_study_request *request,
                                        struct beamrate_error *err);
void beamrate_study_free(struct beamrate_study *study); /* accepts NULL */

/* Cell (out) of n[i], i < n_count, and steps[j], j < steps_count. */
enum beamrate_status beamrate_study_cell(const struct beamrate_study *study, size_t i, size_t j,
                                         struct beamrate_cell *cell);

/* The joint fit of an error component (out). */
enum beamrate_status beamrate_study_fit(const struct beamrate_study *study, enum beamrate_part part,
                                        struct beamrate_fit *fit);

/* The reference (out). */
enum beamrate_status beamrate_study_reference(const struct beamrate_study *study,
                                              struct beamrate_reference *reference);

/* ---- verdicts ---- */

/* Expected and observed orders, and verdicts from their 95 % intervals. */
struct beamrate_check;

enum beamrate_verdict {
    BEAMRATE_PASS = 0,        /* the interval lies within the band */
    BEAMRATE_FAIL = 1,        /* it lies outside; or the constant does; or an error is missing */
    BEAMRATE_INCONCLUSIVE = 2 /* it straddles an end, or points are too few: fails, too */
};

/* One expectation. */
struct beamrate_case {
    const char *study;          /* "space", "time" or "joint" (h and k together) */
    const char *measure;        /* the norm; of numbers "error", "value", or their column */
    const char *part;           /* "total", "axial", "bending"; "": of numbers */
    double expected, tolerance; /* the interval must lie within expected -+ tolerance */
    struct beamrate_estimate order;
    double
        constant;  /* C of e = C z^order with z = h/L or k/T, or numbers' own h and k; NaN: none */
    double margin; /* from the interval to the nearer end of the band; < 0: it is outside */
    size_t points, used; /* all errors, and those in the fit */
    enum beamrate_verdict verdict;
    const char *reason; /* why it does not pass, and a remedy; "": it passes */
    const char *note;   /* which errors were left out; "": none */
};

/* Checks a scene against its `verify` part, or, if it has none, against the orders of the paper's
 * scheme, on `threads` threads (0: all cores). observer: NULL: none. *check (out): owned by the
 * caller; it does not need the scene any more. Fails with BEAMRATE_BAD_INPUT if the scene cannot be
 * verified, BEAMRATE_NO_MEMORY or BEAMRATE_INTERRUPTED; a march that fails is a verdict. */
enum beamrate_status beamrate_check_run(struct beamrate_check **check,
                                        const struct beamrate_scene *scene, int threads,
                                        const struct beamrate_observer *observer,
                                        struct beamrate_error *err);
void beamrate_check_free(struct beamrate_check *check); /* accepts NULL */

/* The number of expectations, 0 for no check; and expectation i (out). */
size_t beamrate_check_count(const struct beamrate_check *check);
enum beamrate_status beamrate_check_case(const struct beamrate_check *check, size_t i,
                                         struct beamrate_case *c);

/* ---- orders of any numbers ---- */

/* Orders of convergence of another program's numbers. */
struct beamrate_orders;

/* Numbers on a sequence of grids, in any order; copied. */
struct beamrate_numbers {
    const double *h;      /* count sizes of elements > 0; NULL: space is not refined */
    const double *k;      /* count time steps > 0; NULL: time is not refined */
    const double *number; /* count: errors >= 0, or values whose limit is not known; NaN: missing */
    size_t count;
    int values;    /* 1: values; 0: errors */
    double formal; /* theoretical order of values, for the intervals of their limits; 0: 2 */
};

/* The order along one axis, at the finest size of the other axis. */
struct beamrate_order {
    struct beamrate_estimate order;
    double constant;     /* C of e = C h^order, or k^order; of values: of their differences */
    size_t points, used; /* all points, and those that are not at a floor */
    struct beamrate_estimate limit; /* of values: their limit, by the same mixture of laws */
};

/* Finds the orders. *orders (out): owned by the caller. Fails with BEAMRATE_BAD_INPUT if a size is
 * not above 0 or given twice, if there are fewer than three, or if an error is negative
 * ("numbers:2" is the second number), or with BEAMRATE_NO_MEMORY. */
enum beamrate_status beamrate_orders_find(struct beamrate_orders **orders,
                                          const struct beamrate_numbers *numbers,
                                          struct beamrate_error *err);
void beamrate_orders_free(struct beamrate_orders *orders); /* accepts NULL */

/* The order along an axis (out). Returns 1, or 0 with NaN if no line along it has three sizes. If both axes
 * are refined from each number to the next, the line is one of space. */
int beamrate_orders_line(const struct beamrate_orders *orders, enum beamrate_axis axis,
                         struct beamrate_order *order);

/* The joint fit of errors on a grid of h and k (out); for other numbers only NaN. Of a table with
 * several columns of numbers this and beamrate_orders_line are about the first. */
enum beamrate_status beamrate_orders_fit(const struct beamrate_orders *orders,
                                         struct beamrate_fit *fit);

/* The expectation of an order. */
struct beamrate_expectation {
    enum beamrate_axis axis;
    double order, tolerance; /* 0 < tolerance < order */
    double down_to;          /* the errors are expected to stop falling there; 0: nowhere */
};

/* A table, as `beamrate orders FILE` reads it: text or JSON, with any separator. Evidence says which
 * column is what; where it is not enough, the call fails and names the member that decides. */
struct beamrate_table {
    const char *name;    /* of the file, for messages; NULL: "table" */
    const char *text;    /* UTF-8 */
    const char *errors;  /* columns of errors, "l2,h1"; NULL: all where values is NULL, too */
    const char *values;  /* columns of values whose limit is not known; NULL: none */
    double dimension;    /* of the mesh whose unknowns or cells a column counts; 0: not stated */
    double formal;       /* theoretical order of values; 0: 2 */
    const char *columns; /* what columns are, as of --column: "dx=h, 3=l2"; NULL: not stated */
    const char *where;   /* the rows of one case, as of --where: "method=P1"; NULL: each case */
};

/* Reads the table and finds the orders of each of its columns of numbers. *orders (out): owned by
 * the caller. Fails as beamrate_orders_find; the message names table, line and column. */
enum beamrate_status beamrate_orders_read(struct beamrate_orders **orders,
                                          const struct beamrate_table *table,
                                          struct beamrate_error *err);

/* What the numbers show of one column's order. */
struct beamrate_answer {
    const char *quantity; /* the column's name */
    int values;           /* 1: values; 0: errors */
    int refined;          /* 1: there is a line along the axis; else 0, and order is NaN */
    struct beamrate_estimate order; /* by the joint fit if it describes the errors, else by the line
                                       at the finest size of the other axis */
    const char *open; /* why the order is not settled, and what settles it; "": it is */
};

/* The answer (out) for column `quantity`, from 0 on, along an axis. Returns 1, or 0 with NaN and ""
 * if there is no such column. */
int beamrate_orders_answer(const struct beamrate_orders *orders, size_t quantity,
                           enum beamrate_axis axis, struct beamrate_answer *answer);

/* A point of a line. */
struct beamrate_order_point {
    double size;                  /* h or k */
    double error;                 /* or the difference of a value from the next finer one */
    double rate;                  /* the order from the point before it to this one; NaN: none */
    struct beamrate_estimate fit; /* the order's line there, and its band; NaN: none */
    const char *left_out;         /* why the order does not rest on it; "": it does */
};

/* Point i (out), from coarse to fine, of the line of a column along an axis, at the finest size of
 * the other axis. Returns 1, or 0 with NaN and "" if there is no such point. */
int beamrate_orders_point(const struct beamrate_orders *orders, size_t quantity,
                          enum beamrate_axis axis, size_t i, struct beamrate_order_point *point);

/* The whole report, as `beamrate orders --json` writes it: the answer in words, and the tables of
 * orders, joint fits, limits with the grid convergence index, and all rows. *json (out): borrowed
 * from the orders, valid until the next call of this function; NULL after a failure. Fails with
 * BEAMRATE_NO_MEMORY. */
enum beamrate_status beamrate_orders_report(struct beamrate_orders *orders, const char **json,
                                            struct beamrate_error *err);

/* A verdict on each of `count` >= 1 expectations, by the joint fit if it describes the errors, else by
 * the line. *check (out): owned by the caller; it does not need the orders any more. Fails with
 * BEAMRATE_BAD_INPUT if there is no such line or an expectation makes no sense, or with
 * BEAMRATE_NO_MEMORY. */
enum beamrate_status beamrate_orders_check(struct beamrate_check **check,
                                           const struct beamrate_orders *orders,
                                           const struct beamrate_expectation *expectation,
                                           size_t count, struct beamrate_error *err);

/* The same of column `quantity`, from 0 on. Refuses an order in h of a table where the dimension of the
 * mesh is assumed. */
enum beamrate_status beamrate_orders_check_quantity(struct beamrate_check **check,
                                                    const struct beamrate_orders *orders,
                                                    size_t quantity,
                                                    const struct beamrate_expectation *expectation,
                                                    size_t count, struct beamrate_error *err);

#ifdef __cplusplus
}
#endif

#endif
