/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the error of a cell is: a registry. A norm is built from measures (solver/modes.h) of the
 * difference at a cell's time levels: the largest over time of one measure and, in the energy norm,
 * a sum over time of another. It is measured for each field and for both. */
#ifndef BR_STUDY_GRID_NORMS_H
#define BR_STUDY_GRID_NORMS_H

#include "solver/modes.h"

struct br_scene;

/* The error and its components, each with its own maximum over the time levels. */
enum br_part { BR_PART_TOTAL, BR_PART_AXIAL, BR_PART_BENDING, BR_PARTS };

static inline enum br_part br_part_of(enum br_field_kind kind)
{
    return kind == BR_AXIAL ? BR_PART_AXIAL : BR_PART_BENDING;
}

/* Whether a field belongs to a part. */
static inline bool br_part_has(enum br_part part, enum br_field_kind kind)
{
    return part == BR_PART_TOTAL || part == br_part_of(kind);
}

/* Whether a scene models a field of a part. */
bool br_models(const struct br_scene *scene, enum br_part part);

extern const char *const br_part_names[BR_PARTS];

struct br_norm {
    const char *name;               /* as on the command line, and in file names */
    const char *title;              /* a sentence for a person: what the error is */
    const char *symbol;             /* a few words, for the axis of a plot: error, and which */
    const char *unit, *unit_markup; /* plain, for gnuplot */
    const char *theory;             /* a sentence: what is proved of it */
    enum br_measure level;          /* its largest value over the time levels counts */
    bool energy;                    /* squares add up, and the strain rates' are summed over time */
    bool printed;                   /* the norm of the paper's tables */
};

extern const struct br_norm br_norm_l2, br_norm_energy, br_norm_tip;

/* NULL-terminated, at most BR_MOST_NORMS; the first is the default. */
enum { BR_MOST_NORMS = 8 };
extern const struct br_norm *const br_norms[];

/* Whether a norm is built from a measure. */
bool br_norm_needs(const struct br_norm *norm, enum br_measure measure);

/* A difference at one time level. */
struct br_sample {
    double time;                 /* s */
    double weight;               /* time since the last sample, s; 0 at t = 0 */
    double size[2][BR_MEASURES]; /* by br_field_kind */
};

/* A norm accumulated over the time levels; starts as zeros. */
struct br_norm_sum {
    double most[BR_PARTS]; /* squared in the energy norm; a NaN stays */
    double time[BR_PARTS]; /* of the largest, s */
    double sum[BR_PARTS];
};

/* Adds a sample. */
void br_norm_add(const struct br_norm *norm, const struct br_scene *scene,
                 const struct br_sample *sample, struct br_norm_sum *sum);

/* The norm of one component so far. */
double br_norm_value(const struct br_norm *norm, const struct br_norm_sum *sum, enum br_part part);

/* The norm of a difference whose sizes, by br_field_kind, are constant in time. NaN if a size is
 * NaN that the norm needs of a modelled field. */
double br_norm_of_constant(const struct br_norm *norm, const struct br_scene *scene,
                           const double size[2][BR_MEASURES], enum br_part part);

#endif
