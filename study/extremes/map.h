/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The map of extremes: many cases, drawn from a seed, judged in parallel, and counted by method and
 * law, by reason, and over planes. What comes out does not depend on the number of threads, nor on
 * how often it was interrupted. */
#ifndef BR_STUDY_EXTREMES_MAP_H
#define BR_STUDY_EXTREMES_MAP_H

#include "study/extremes/extremes.h"
#include "study/foresee/warnings.h"

/* ---- cases ---- */

/* A case is a scene, a method and a resolution, drawn at random from (seed, index) alone, so that
 * neither order nor threads matter. It is kept as numbers, so that it can be shrunk, and written as
 * the text of a scene file. */

/* size * shape * history; size 0: none. */
struct br_extreme_force {
    double size;    /* N/m, N or N m */
    size_t shape;   /* of x, a row of case.c; 0: constant, as the tip's are */
    size_t history; /* of t, likewise */
    double rate;    /* oscillations within T */
};

/* Initial data: size * xi of the rod, size * xi^2 of the beam; or, waved, size * sin(5 pi xi/2) and
 * size * (1 - cos(5 pi xi/2)). */
struct br_extreme_start {
    double size; /* m or m/s */
    bool waved;
};

/* One field. */
struct br_extreme_field {
    bool modelled;
    double stiffness, viscosity; /* N and N s, or N m^2 and N m^2 s */
    struct br_extreme_force load, tip_force, tip_moment;
    struct br_extreme_start displacement, velocity;
};

/* What was changed on purpose after the numbers were drawn. */
enum br_extreme_special {
    BR_SPECIAL_NONE,
    BR_SPECIAL_AT_LIMIT,    /* c_H at the lagged contact's stability limit times 1 +- little */
    BR_SPECIAL_AT_REACTION, /* Tresca's bound is the first step's reaction to the last bit */
    BR_SPECIAL_REVERSAL,    /* forces oscillate within a step */
    BR_SPECIAL_GRAZING,  /* the gap is the tip's largest static displacement to the last digits */
    BR_SPECIAL_DENORMAL, /* loads of about 1e-310 */
    BR_SPECIAL_ZEROS,    /* some numbers that may be 0 are */
    BR_SPECIALS
};
extern const char *const br_extreme_specials[BR_SPECIALS];

struct br_extreme_case {
    uint64_t seed;
    size_t index;
    bool natural; /* dimensionless groups were drawn, not numbers with units */
    enum br_extreme_special special;
    double length, duration, density; /* m, s, kg/m */
    struct br_extreme_field field[2]; /* by br_field_kind */
    bool contact;
    double gap, contact_stiffness; /* m, N/m */
    enum br_friction_law law;
    double friction, regularisation; /* c_V: N or N/m; mu: m/s */
    unsigned wanted;                 /* fields, see study/run/run.h */
    struct br_method method;
    size_t n, steps;
};

/* Draws a case (out). */
void br_extreme_draw(uint64_t seed, size_t index, struct br_extreme_case *drawn);

enum { BR_EXTREME_TEXT = 8192, BR_EXTREME_COMMAND = 1024 };

/* The scene file (out), with a comment of where it comes from, and the command line that marches
 * the scene `name`. */
void br_extreme_scene(const struct br_extreme_case *one, char text[BR_EXTREME_TEXT]);
void br_extreme_command(const struct br_extreme_case *one, const char *name,
                        char text[BR_EXTREME_COMMAND]);

/* ---- who judges ---- */

/* Tests for one case that a march is right, or that the program says that it is not.
 *
 * A case is read, checked for warnings, and marched as `run --check` does. Then
 *   - the certificate of every step, the energy balance and the numbers themselves must be sound;
 *   - the exact solution, or where that cannot be had in time another scheme on a finer mesh by
 *     shorter steps, measures the error of the displacements, which is compared with the error
 *     stated before the march (prediction.h);
 *   - the same scene in other units (metre, second and kilogram each by a random factor) must give
 *     the same answer, to the predicted round-off and the effect of a change of the data by 1e-12,
 *     which is 1000 times the change by the other units.
 * Silently wrong is an answer whose error is larger than the stated one with its interval, or than
 * 5 % where none is stated and no warning says so; or an answer that breaks an equation or a law.
 * Each field counts relative to its own size. */

enum br_extreme_class {
    BR_EXTREME_RIGHT,
    BR_EXTREME_WARNED,   /* inaccurate, and says so */
    BR_EXTREME_UNKNOWN,  /* inaccurate, and says that its error is not known */
    BR_EXTREME_UNSTABLE, /* as predicted */
    BR_EXTREME_REFUSED,
    BR_EXTREME_UNJUDGED, /* given up by the map */
    BR_EXTREME_WRONG,
    BR_EXTREME_CLASSES
};
struct br_extreme_names {
    const char *word;            /* for programs */
    const char *title, *heading; /* for people: of a picture's key, and short */
};
extern const struct br_extreme_names br_extreme_names[BR_EXTREME_CLASSES];

/* What the error is measured by. */
enum br_extreme_by { BR_BY_NOBODY, BR_BY_EXACT, BR_BY_REFINEMENT };
extern const char *const br_extreme_judges[];

struct br_extreme_verdict {
    enum br_extreme_class which;
    enum br_extreme_by by;
    bool known;       /* the run states its error */
    double error;     /* of displacements, over the largest; NaN: not known */
    double stated;    /* the stated bound of the error, of the field that is nearest to its bound or
                         furthest beyond it; INFINITY: no bound; NaN: not compared */
    double units;     /* error between two systems of units; NaN: not compared */
    double round_off; /* predicted */
    unsigned warned;  /* bits: 1 << br_warning_kind */
    char why[200];    /* the reason why it is not right; one line */
};

/* How judging is done; zeros: as the map does. */
struct br_extreme_judging {
    int rounding;          /* of the marches, as fesetround takes it */
    bool quick;            /* without the other units and the exact solution */
    double stated_divisor; /* divides the stated errors, so that tests see what is called wrong; 0:
                              as stated */
};

/* Judges a case; *verdict (out). Fails with BR_NO_MEMORY. */
enum br_status br_extreme_judge(const struct br_extreme_case *one,
                                const struct br_extreme_judging *judging,
                                struct br_extreme_verdict *verdict, struct br_error *err);

/* ---- the map ---- */

enum { BR_EXTREME_MOST_SHRUNK = 20 };

/* A case that is silently wrong, made small. */
struct br_extreme_shrunk {
    struct br_extreme_case one;
    struct br_extreme_verdict verdict;
    char file[64];                    /* name of its scene in the folder */
    char command[BR_EXTREME_COMMAND]; /* that repeats it */
};

/* The cases of a kind. */
struct br_extreme_tally {
    const char *title; /* what they are counted by: "time scheme"; NULL: by class and reason */
    char label[150];   /* "euler", or a reason with # for numbers; "": all cases */
    size_t cases, first, count[BR_EXTREME_CLASSES]; /* first: an index */
};

struct br_extreme_map {
    uint64_t seed;
    size_t cases;
    struct br_extreme_case *one;        /* cases; owned */
    struct br_extreme_verdict *verdict; /* cases; owned */
    size_t count[BR_EXTREME_CLASSES];
    struct br_extreme_shrunk *shrunk; /* owned */
    size_t shrunks;                   /* of the first ones that are wrong */
    struct br_extreme_tally *tally;   /* tallies, all cases first; owned */
    size_t tallies;
    struct br_extreme_tally *reason; /* reasons, of one class each, by that and count; borrows */
    size_t reasons;
};

/* br_extreme_judge, or another. May be called from any thread. */
typedef enum br_status br_extreme_judging_function(const struct br_extreme_case *one,
                                                   const struct br_extreme_judging *judging,
                                                   struct br_extreme_verdict *verdict,
                                                   struct br_error *err);

/* Fills the map (out; clear it even after a failure); what is silently wrong is written to the
 * job's folder. Fails with BR_NO_MEMORY, BR_IO, and with BR_INTERRUPTED. */
enum br_status br_extreme_map_run(struct br_extreme_map *map, const struct br_extremes_job *job,
                                  br_extreme_judging_function *judge, struct br_error *err);
void br_extreme_map_clear(struct br_extreme_map *map);

/* Answers: cases that were marched and judged; and what they state. */
struct br_extreme_rate {
    size_t answers, wrong;
    double low, high; /* of the share that is silently wrong: 95 %, Clopper and Pearson 1934 */
    size_t unstated;  /* whose error is said to be not known */
    size_t unstated_unstable; /* of these, beyond the lagged contact's limit */
};
struct br_extreme_rate br_extreme_rate(const struct br_extreme_map *map);

/* A number of a case: a coordinate of a plane. */
struct br_extreme_coordinate {
    const char *title;                               /* enhanced */
    double (*value)(const struct br_extreme_case *); /* NaN or 0: not in the plane */
    double low, high;                                /* decades of the plane's edges */
    size_t cells;
};

struct br_extreme_plane {
    const char *title;
    struct br_extreme_coordinate x, y;
};
enum { BR_EXTREME_PLANES = 4 };
extern const struct br_extreme_plane br_extreme_planes[BR_EXTREME_PLANES];

/* The class that most cases of each cell have (out, y.cells rows of x.cells; NaN: no case); a cell
 * with a silently wrong case has that class. Cases outside the plane count at its edge. */
void br_extreme_plane_fill(const struct br_extreme_map *map, const struct br_extreme_plane *plane,
                           double *cell);

#endif
