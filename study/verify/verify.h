/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a scene is expected to show: its section `verify`. Three separate studies, so that
 * no error hides behind another. Each is a list of cells in order of refinement; an expectation
 * is an order with a tolerance, and a range for the error constant. */
#ifndef BR_STUDY_VERIFY_VERIFY_H
#define BR_STUDY_VERIFY_VERIFY_H

#include "orders/expectation/case.h"
#include "study/grid/study.h"

/* What is expected of one component in one norm. */
struct br_verify_expectation {
    const struct br_norm *norm;
    enum br_part part;
    struct br_expectation band; /* of C in the norm's unit */
};

enum { BR_MOST_EXPECTATIONS = BR_MOST_NORMS * BR_PARTS };

struct br_verify_study {
    size_t line;       /* in the scene's file; 0: a default */
    size_t count;      /* of cells; 0: this study is not done */
    size_t *n, *steps; /* count each, from coarse to fine; owned */
    struct br_method method;
    struct br_verify_expectation expectation[BR_MOST_EXPECTATIONS];
    size_t expectations;
    char silent[512]; /* of defaults: of which components theory states no order, and why; or "" */
};

struct br_verify {
    bool by_default; /* the scene has no section `verify` */
    char *data;      /* what the scene's file says (br_scene_data); owned */
    struct br_verify_study study[BR_VERIFY_KINDS];
};

/* How many errors a study with so many cells gives: one less where neighbours are compared. */
static inline size_t br_verify_points(enum br_verify_kind kind, size_t cells)
{
    return kind == BR_VERIFY_JOINT || cells == 0 ? cells : cells - 1;
}

/* The default expectations of a scene: what theory states (study/fit/theory.h) of the default
 * method, in the norm of (31). Fails with BR_NO_MEMORY. */
enum br_status br_verify_default(const struct br_scene *scene, struct br_verify *verify,
                                 struct br_error *err);

/* Sets the orders that theory states of the methods, and `silent` where it states none. A study of
 * which it states none is not done. */
void br_verify_expect_default(const struct br_scene *scene, struct br_verify *verify);

/* Refuses (BR_BAD_INPUT) what cannot be verified: too few cells, meshes or time levels that do not
 * nest, a field that is not modelled, a band that contains 0, expectations that are given twice or
 * contradict each other. *line: out, where. */
enum br_status br_verify_check(const struct br_scene *scene, const struct br_verify *verify,
                               size_t *line, struct br_error *err);

void br_verify_clear(struct br_verify *verify);

/* Reads a scene as br_scene_read_text does, and its expectations: its part `verify`
 * (an example is in study/scenes/example1.yaml), or else the default. The caller clears both, even
 * after a failure. set: keys of --set, as in struct br_scene_asked; NULL: none. */
enum br_status br_verify_read(const char *name, const char *text, const char *set,
                              struct br_scene *scene, struct br_verify *verify,
                              struct br_error *err);

#endif
