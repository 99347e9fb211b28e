/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a march costs: its bytes, and its seconds of one thread. All who announce, plan, cut or
 * refuse work ask here. The costs of a step are the registry's (solver/method.h), those of one
 * machine; br_march_pace measures this one. They decide who does what, and what is said before it,
 * not the results. */
#ifndef BR_STUDY_GRID_COSTS_H
#define BR_STUDY_GRID_COSTS_H

#include "study/grid/study.h"

struct br_prediction;

/* A march that is planned. All borrowed. The scene has only the fields that are marched
 * (study/run/run.h). */
struct br_planned_march {
    const struct br_scene *scene;
    const struct br_method *method;
    size_t n, steps;
    struct br_prediction *prediction; /* out: the predicted errors; NULL: not wanted */
    double budget; /* work of a prediction, elements times solves; 0: as prediction.h says */
};

static inline struct br_planned_march br_planned(const struct br_scene *scene,
                                                 const struct br_method *method,
                                                 struct br_resolution at)
{
    return (struct br_planned_march){scene, method, at.n, at.steps, NULL, 0};
}

/* ---- one march ---- */

/* An upper bound of the bytes, from measured bytes an element. */
double br_march_bytes(const struct br_planned_march *planned);

/* Approximate seconds of the steps on the registry's machine. An adaptive scheme is taken to need
 * as many steps as is usual for its tolerance: its growth with n and the tolerance alone is right.
 */
double br_march_seconds(const struct br_planned_march *planned);

/* Measured seconds over br_march_seconds (out): of some steps on few elements, in some
 * milliseconds; 1 where they cannot be marched. Of an adaptive scheme it includes how many steps it
 * makes. Fails with BR_NO_MEMORY. */
enum br_status br_march_pace(const struct br_planned_march *planned, double *pace,
                             struct br_error *err);

/* Seconds to find the errors of a march on n elements at so many time levels. */
double br_measure_seconds(const struct br_scene *scene, size_t n, size_t levels);

/* ---- studies ---- */

/* Of a cell with its error, and of the reference. */
double br_cell_seconds(const struct br_study *study, size_t cell);
double br_reference_seconds(const struct br_study *study);

/* ---- the work of a command ---- */

/* Its marches, with their forecast time and memory. Begins as zeros, but for the first two members.
 */
struct br_costs {
    bool together;  /* all are in memory at once, not one after the other */
    bool alone;     /* one thread marches, however many there are */
    size_t marches; /* cells and fine references are marches, too */
    size_t untimed; /* of these, those that choose their steps: their time is not known */
    double seconds; /* of one thread, where known */
    double steps;   /* of these, what steps take: without errors and references */
    double longest; /* march or reference, s */
    double bytes;   /* at one time */
    struct br_planned_march dearest; /* the longest march; borrows */
};

/* Adds the cells of a study and its reference; the study need not be prepared. */
void br_costs_add_study(struct br_costs *work, const struct br_study *study);

void br_costs_add_march(struct br_costs *work, const struct br_planned_march *planned);

/* Corrects the seconds by the pace of the dearest march. */
void br_costs_measure(struct br_costs *work);

/* Approximate seconds on so many threads, where known. */
double br_costs_seconds(const struct br_costs *work, int threads);

/* ---- memory (resources.c) ---- */

/* Bytes that are still available: the least of MemAvailable of /proc/meminfo and of the remaining
 * limits of the address space (RLIMIT_AS) and of the control group; INFINITY: not known. */
double br_memory_available(void);

/* Refuses (BR_NO_MEMORY) a march that does not fit into a memory of so many bytes, with the
 * figures. */
enum br_status br_fits_memory(const struct br_planned_march *planned, double available,
                              struct br_error *err);

/* The same of studies whose cells, fine references and lists of time levels are in memory at once;
 * br_march_studies asks. They need not be prepared. */
enum br_status br_fit_together(const struct br_study *studies, size_t count, double available,
                               struct br_error *err);

#endif
