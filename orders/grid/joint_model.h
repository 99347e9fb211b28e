/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One model of a grid of errors, and its fit; joint_search.c chooses among models. */
#ifndef BR_ORDERS_GRID_JOINT_MODEL_H
#define BR_ORDERS_GRID_JOINT_MODEL_H

#include "orders/grid/joint_fit.h"
#include "orders/line/laws.h"

/* The unknowns of a model: of each axis log C, the order, and of its law the parameter and the
 * place; theta with r = sin(theta); the logarithm of a floor. */
enum { BR_LOG_C, BR_ORDER, BR_SHAPE, BR_PLACE, BR_OF_AXIS };
#define BR_OF(axis, what) (BR_OF_AXIS * (axis) + (what))
enum { BR_THETA = BR_OF_AXIS * BR_AXES, BR_LOG_F, BR_UNKNOWNS };

/* How the errors of both axes are added: r unknown, 1, -1. */
enum br_joint_sum { BR_SUM_ANY, BR_SUM_ADDS, BR_SUM_SUBTRACTS, BR_SUMS };

/* A law along an axis bends its power. The parameter of most is that of laws.h; of a next term
 * C x^p (1 + a x^s), of either sign, it is log(1 + a). Where the order changes (BR_LAW_KINK), the
 * parameter is the order of the coarse sizes less that of the fine ones; `low` and `high` are
 * logarithms of the sizes between which it changes (low = high: at this size), and s is the
 * probability that the order of the coarse sizes counts. */
struct br_joint_law {
    enum br_joint_kind kind;
    enum br_joint_sum sum;                       /* of both errors */
    const struct br_family *of[BR_AXES], *floor; /* NULL: one power; none */
};

/* The observations are scaled so that the largest h and k are one, and an error in the middle. */
struct br_joint_cell {
    size_t at[BR_AXES], against[BR_AXES]; /* of the sizes; against 0: the continuous problem */
    double log_error;
    double weight;  /* of a number that stands in m cells 1/m: it is one */
    double rounded; /* standard deviation of log_error by its printed digits */
};

struct br_joint_size {
    double x, log_x;
    double error, rate[BR_OF_AXIS]; /* of the model that is evaluated */
};

struct br_joint_cells {
    struct br_joint_cell *cell;
    size_t count;
    struct br_joint_size *size[BR_AXES]; /* ascending; size[a][0]: x = 0 */
    size_t sizes[BR_AXES];
    double lowest, log_finest[BR_AXES]; /* the least log_error; the least size of a cell */
    bool priors;
    const struct br_observer *observer; /* may be NULL; where it stops, no fit is found any more */
    double *room;                       /* br_joint_room(count) */
};
size_t br_joint_room(size_t count);

struct br_joint_trial {
    struct br_joint_law law;
    double value[BR_UNKNOWNS]; /* scaled; log C: of the error at the coarsest size */
    double sum, worst;         /* sum of squared residuals (infinite: no fit); largest magnitude */
    double weight;             /* of all cells */
    double freedom;            /* this less the unknowns, and at least 1 */
    double covariance[BR_UNKNOWNS][BR_UNKNOWNS]; /* of the unknowns in their order, over the
                                                    variance of a residual */
    double log_determinant;                      /* of that */
    double bend[BR_AXES];                        /* log of the correction at the coarsest size */
    double open[BR_AXES]; /* what else is not known of an order, as a scale: laws are truncated, and
                             printed digits rounded */
};

/* The unknowns of a law; their number. */
size_t br_joint_unknowns(const struct br_joint_law *law, int unknown[BR_UNKNOWNS]);

/* The number of sizes of an axis; 0: no cell differs from its reference in it. */
size_t br_joint_sizes(const struct br_joint_cells *cells, int axis);

/* Where the search for a law begins: at these orders and this r. */
void br_joint_start(const struct br_joint_cells *cells, const double order[BR_AXES], double r,
                    double value[BR_UNKNOWNS]);
double br_joint_shape_start(const struct br_family *family, double log_finest); /* of the axis */

/* From the values of a trial towards a minimum: roughly, to choose among starts. robust: cells that
 * are off by far more do not count; 0: all do. */
void br_joint_approach(struct br_joint_cells *cells, double robust, struct br_joint_trial *trial);
/* To the minimum, and sets all of the trial. */
void br_joint_descend(struct br_joint_cells *cells, struct br_joint_trial *trial);

/* The residuals log(model/error) of a trial, by cells. */
void br_joint_residuals(struct br_joint_cells *cells, const struct br_joint_trial *trial,
                        double *residual);

/* After br_joint_residuals: the largest share that the error of an axis has of both in one cell. */
double br_joint_share(const struct br_joint_cells *cells, int axis);

/* The logarithm of the prior density of a trial. */
double br_joint_log_prior(const struct br_joint_cells *cells, const struct br_joint_trial *trial);

#endif
