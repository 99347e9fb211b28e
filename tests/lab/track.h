/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Samples of one march at a few times and points, so that marches can be compared: on finer meshes,
 * by smaller steps, and with the exact solution. */
#ifndef BR_TESTS_LAB_TRACK_H
#define BR_TESTS_LAB_TRACK_H

#include "reference/exact/exact.h"
#include "study/run/run.h"

enum {
    BR_TRACK_LEVELS = 8,
    BR_TRACK_EVEN = 16,   /* points at equal distances */
    BR_TRACK_POINTS = 24, /* and others near the tip, where layers are */
    BR_TRACK_SLOPE = 2,
    BR_TRACK_VALUES
};

/* Where a march is sampled: time levels of `steps`, and points on n elements of `parts` parts each,
 * in units of parts. Both ascend and contain the end; the first level is t = 0. */
struct br_track_samples {
    size_t n, steps, parts;
    size_t level[BR_TRACK_LEVELS + 1], levels;
    size_t point[BR_TRACK_POINTS], points;
};
struct br_track_samples br_track_samples(size_t n, size_t steps);

struct br_track {
    struct br_track_samples samples;
    /* Displacements by br_field_kind, and L w_x/4, which is about the bulge of a beam with a fixed
     * tip; m. */
    double value[BR_TRACK_VALUES][BR_TRACK_LEVELS + 1][BR_TRACK_POINTS];
    size_t sampled;              /* sampled levels */
    bool finite;                 /* all nodal values there */
    double largest[2];           /* of all nodal displacements there, m */
    double own_error[2];         /* error that an exact solution states of itself, m */
    struct br_run_report report; /* its scenes are freed */
    struct br_error failure;     /* BR_OK; why it did not begin, or stopped */
    bool begun;
};

/* What is marched. Borrowed. */
struct br_track_request {
    const struct br_scene *scene;
    unsigned wanted;
    const struct br_method *method;
    const struct br_track_samples *samples;
    size_t finer, shorter; /* factors of the elements and steps of `samples` */
    bool check;            /* the certificate of every step */
};

/* Marches; *track (out, large: on the heap). A march that fails is a result: only BR_NO_MEMORY
 * fails. */
enum br_status br_track_march(const struct br_track_request *request, struct br_track *track,
                              struct br_error *err);

/* The same by the exact solution; its failures are in track->failure. steps: most steps and
 * attempts of it. modelled: the fields of the scene that are marched. */
enum br_status br_track_exact(const struct br_scene *modelled,
                              const struct br_track_samples *samples, size_t steps,
                              struct br_track *track, struct br_error *err);

/* The largest difference of a field over the largest of its displacements in `reference`, or where
 * those are all zero over that of the other field's. 0 where there is no difference, NAN where a
 * value is not finite or missing. */
double br_track_distance(const struct br_track *track, const struct br_track *reference,
                         enum br_field_kind kind);

/* The error of a field: the largest root of the mean square over x of all levels, relative to that
 * of `reference` as in br_track_distance. *sure_to (out): the reference's own error, relative to
 * the same. */
double br_track_error(const struct br_track *track, const struct br_track *reference,
                      enum br_field_kind kind, double *sure_to);

#endif
