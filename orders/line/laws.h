/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The one family of laws of an error over a size, and every prior of the search for orders, as two
 * tables. Lines (line_order.c), limits and grids walk them.
 *
 * One power C z^p never fits real errors. Coarse sizes are not asymptotic, fine ones reach a floor,
 * a lower power comes up, a logarithm bends the line. A law is C z^p times a correction, that one
 * parameter sets. In all of it z is the size over the finest one. */
#ifndef BR_ORDERS_LINE_LAWS_H
#define BR_ORDERS_LINE_LAWS_H

#include <stdbool.h>
#include <stddef.h>

/* X(name, text): e(z) of each law. Each a > 0, s > 0. */
#define BR_LAW_LIST(X)                                                                    \
    X(BR_LAW_POWER, "one power")                     /* C z^p */                          \
    X(BR_LAW_NEXT, "a next term")                    /* C z^p (1 +- a z^s), a small */    \
    X(BR_LAW_LOWER, "a lower power comes up")        /* the same, a z^s not small */      \
    X(BR_LAW_CANCEL, "terms that cancel")            /* C z^p |1 - a z^s|, zero inside */ \
    X(BR_LAW_LOCKING, "a slow start")                /* C z^p / (1 + a z^s) */            \
    X(BR_LAW_SQUARES, "two powers in one norm")      /* C z^p sqrt(1 + (a z^s)^2) */      \
    X(BR_LAW_LOGARITHM, "a logarithm")               /* C z^p (a - log z)^s, any s */     \
    X(BR_LAW_FLOOR, "a floor")                       /* C z^p + F */                      \
    X(BR_LAW_FLOOR_SQUARES, "a floor in one norm")   /* sqrt((C z^p)^2 + F^2) */          \
    X(BR_LAW_OFFSET, "an offset")                    /* C z^p - F: of the reference */    \
    X(BR_LAW_KINK, "a change of the order")          /* one power, then another one */    \
    X(BR_LAW_EXPONENTIAL, "exponential convergence") /* C exp(-b / z^g) */

enum br_law {
#define X(name, text) name,
    BR_LAW_LIST(X)
#undef X
        BR_LAWS
};

/* The lab changes priors, and measures what becomes of the answers. */
#ifndef BR_PRIOR_CONST
#define BR_PRIOR_CONST const
#endif

const char *br_law_text(enum br_law law);
bool br_law_is_floor(enum br_law law); /* or an offset */

/* A law with its s, and the parameter: even in its logarithm from low to high. It is a z^s at the
 * finest size; of a logarithm a - log z there; of a floor F over the finest error. */
struct br_family {
    enum br_law law;
    double s, low, high;
    double prior; /* its probability; that of one power is a prior, too (below) */
    double curve; /* of a second correction, b z^curve of either sign, by regression; 0: none */
    const char *why;
};
enum { BR_FAMILIES = 42 };
extern BR_PRIOR_CONST struct br_family br_families[BR_FAMILIES];

/* X(name, value, off, why): all other priors; with the value `off` one does nothing. Each was
 * chosen on seeds that no published table uses. */
#define BR_PRIOR_LIST(X)                                                                          \
    X(power, 0.45, 0, "the probability of one power alone")                                       \
    X(drifts, 0.2, 0, "the constant of one power drifts from row to row, as on adaptive meshes")  \
    X(kink, 0.01, 0, "one power, then another: exact ones alone show it")                         \
    X(kink_coarse, 0.3, 0, "the order is that of the coarse rows of such a line")                 \
    X(exponential, 0.01, 0, "exponential convergence, of each g")                                 \
    X(unexplained, 0.15, 1e-9, "density of the log of an error that nothing explains: 7 units")   \
    X(leaves_coarse, 0.6, 1e-9, "one more row at the coarse end is not asymptotic")               \
    X(leaves_finest, 0.25, 0, "the finest row alone does not count")                              \
    X(leaves_fine, 0.1, 0, "the rows of the fine end, from some row on, show noise")              \
    X(both, 0.1, 1, "beside such rows a law that bends, too: what bends is then the noise")       \
    X(grows, 0.01, 1, "errors fall, then grow: exact ones alone show it, others are round-off")   \
    X(noise_above, 0.4, -1e9, "noise adds to the error of the law: so much, in logarithms")       \
    X(leaves_inside, 0.05, 0, "a row inside is an outlier")                                       \
    X(usual_scatter, 0.15, 1e9, "errors of a computation rarely scatter by more")                 \
    X(least_scatter, 1e-7, 1e-12, "no law describes logarithms of errors better than that")       \
    X(least_curved, 5e-4, 1e-12, "nor one with two corrections: more terms always fit")           \
    X(most_curved, 0.5, 1e9, "a second correction is a next term: so much of the coarsest error") \
    X(absolute, 0.25, 0, "the scatter of values is the same on all rows, not relative")           \
    X(values_stay, 0.1, 1, "differences that stay: the share of the prior of a floor of errors")  \
    X(shared, 1.3, 1, "neighbouring differences share a value: their scatter is not independent") \
    X(few_power, 0.1, 1, "of three values: the share of the prior of one power alone")            \
    X(few_next, 0.01, 0, "of three values: a next term is at least that")                         \
    X(sure, 5e-4, 0, "and none is sure to follow the next rows better than that")                 \
    X(truncation, 0.01, 0, "a correction c is known to this share of c: there is another term")   \
    X(next_term, 0.03, 0, "and to this share of c^2")                                             \
    X(passes_zero, 0.15, 1, "a next term of opposite sign passes zero within the rows")           \
    X(least_order, 0.25, 0, "a smaller order, with a correction, is the law of a floor")

struct br_priors {
#define X(name, value, off, why) double name;
    BR_PRIOR_LIST(X)
#undef X
};
extern BR_PRIOR_CONST struct br_priors br_priors;

/* A size z over the finest one, and the error there, as far as a law needs them. A difference is
 * the error there less that at a finer size. */
struct br_law_place {
    double log_z;
    double power;       /* z^s; of a difference times the next term of it over that of the error */
    double finest;      /* the finest error over this one */
    double finer, lost; /* of a difference: log of the sizes' ratio, the share of one power that is
                           subtracted; 0 */
};

/* The logarithm of the correction there; NaN: the law allows no such error. */
struct br_law_bend {
    double correction;
    double weight; /* of log e - correction, over that of log e: the inverse of a variance */
    double change; /* how large the correction is, 0 to 1 */
    double slope;  /* of the correction over the logarithm of the parameter, its magnitude */
    bool density;  /* whether the density of log e has the weight in it */
};
struct br_law_bend br_law_bend(const struct br_family *family, double parameter,
                               const struct br_law_place *at);

/* The part of the logarithm of its prior that depends on the parameter; z: of the coarsest row. */
double br_law_log_prior(const struct br_family *family, double parameter, double z);

#endif
