/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/verify/verify.h"

#include <math.h>
#include <stdio.h>

#include "base/words.h"
#include "study/fit/theory.h"

/* ---- defaults ---- */

enum { CELLS = 5 };

/* Cells i = 0 .. CELLS - 1 have n r^i elements and steps s^i time steps. */
static const struct {
    size_t n, n_ratio, steps, steps_ratio;
} default_grids[BR_VERIFY_KINDS] = {
    [BR_VERIFY_SPACE] = {10, 2, 100, 1},
    [BR_VERIFY_TIME] = {20, 1, 1000, 2},
    [BR_VERIFY_JOINT] = {10, 2, 100, 4},
};

static enum br_status default_grid(enum br_verify_kind kind, struct br_verify_study *v,
                                   struct br_error *err)
{
    v->method = br_method_default();
    v->n = br_allocate(CELLS, sizeof *v->n);
    v->steps = br_allocate(CELLS, sizeof *v->steps);
    if (!v->n || !v->steps)
        return br_no_memory(err, "what is expected");
    v->count = CELLS;
    size_t n = default_grids[kind].n, steps = default_grids[kind].steps;
    for (size_t i = 0; i < CELLS; i++) {
        v->n[i] = n;
        v->steps[i] = steps;
        n *= default_grids[kind].n_ratio;
        steps *= default_grids[kind].steps_ratio;
    }
    return BR_OK;
}

/* In h or in k, and jointly: where k falls like h^2, an error of h^p is one of k^(p / 2). */
static struct br_theory theory_of(const struct br_scene *scene, const struct br_verify_study *v,
                                  enum br_verify_kind kind, enum br_part part)
{
    const struct br_study study = {.scene = scene,
                                   .norm = br_norms[0],
                                   .method = v->method,
                                   .n_count = 1,
                                   .n = v->n,
                                   .k_count = 1,
                                   .steps = v->steps};
    struct br_theory in_h = br_theory_of(&study, part, BR_AXIS_SPACE);
    const struct br_theory in_k = br_theory_of(&study, part, BR_AXIS_TIME);
    if (kind != BR_VERIFY_JOINT)
        return kind == BR_VERIFY_SPACE ? in_h : in_k;
    in_h.order /= 2;
    in_h.highest = fmin(in_h.highest / 2, in_k.highest);
    return isnan(in_h.order) || in_h.order < in_k.order ? in_h : in_k;
}

static void expect(const struct br_scene *scene, struct br_verify_study *v,
                   enum br_verify_kind kind, enum br_part part)
{
    const struct br_theory t = theory_of(scene, v, kind, part);
    struct br_verify_expectation *e = &v->expectation[v->expectations];
    if (isnan(t.order)) {
        br_append(v->silent, sizeof v->silent, "%s%s: %s", *v->silent ? "; " : "",
                  br_part_names[part], t.reason);
        return;
    }
    *e = (struct br_verify_expectation){
        .norm = br_norms[0],
        .part = part,
        .band = {.order = t.order,
                 .highest = t.highest > t.order ? t.highest : 0,
                 .tolerance = t.order / 10,
                 .floor = NAN,
                 .ceiling = NAN},
    };
    snprintf(e->band.why, sizeof e->band.why, "%s", t.reason);
    v->expectations++;
}

enum br_status br_verify_default(const struct br_scene *scene, struct br_verify *verify,
                                 struct br_error *err)
{
    *verify = (struct br_verify){.by_default = true};
    enum br_status status = BR_OK;
    for (int kind = 0; kind < BR_VERIFY_KINDS && !status; kind++)
        status = default_grid((enum br_verify_kind)kind, &verify->study[kind], err);
    if (!status)
        br_verify_expect_default(scene, verify);
    return status;
}

void br_verify_expect_default(const struct br_scene *scene, struct br_verify *verify)
{
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        struct br_verify_study *v = &verify->study[kind];
        const bool by_field = kind == BR_VERIFY_SPACE;
        v->expectations = 0;
        *v->silent = '\0';
        for (enum br_part part = by_field ? BR_PART_AXIAL : BR_PART_TOTAL;
             part <= (by_field ? BR_PART_BENDING : BR_PART_TOTAL); part++)
            if (br_models(scene, part))
                expect(scene, v, (enum br_verify_kind)kind, part);
        v->count = v->expectations ? CELLS : 0;
    }
}

/* ---- checks ---- */

static enum br_status check_cells(const struct br_scene *scene, enum br_verify_kind kind,
                                  const struct br_verify_study *v, struct br_error *err)
{
    const size_t points = br_verify_points(kind, v->count);
    if (points < BR_VERIFY_LEAST_POINTS)
        return br_fail(
            err, BR_BAD_INPUT,
            "found %zu cells, which give %zu errors, expected at least %d errors: an order "
            "and its interval need as many",
            v->count, points, BR_VERIFY_LEAST_POINTS);
    for (size_t i = 0; i + 1 < v->count; i++) {
        if (v->n[i] == 0 || v->n[i + 1] % v->n[i] != 0)
            return br_fail(err, BR_BAD_INPUT,
                           "n = %zu does not divide n = %zu, the next finer mesh", v->n[i],
                           v->n[i + 1]);
        if (v->steps[i] == 0 || v->steps[i + 1] % v->steps[i] != 0)
            return br_fail(
                err, BR_BAD_INPUT,
                "the time levels of k = %g s are not all among those of k = %g s, the next "
                "smaller step",
                br_time_step(scene, v->steps[i]), br_time_step(scene, v->steps[i + 1]));
        const bool finer = v->n[i + 1] > v->n[i], shorter = v->steps[i + 1] > v->steps[i];
        if (kind == BR_VERIFY_SPACE ? !finer : !shorter)
            return br_fail(err, BR_BAD_INPUT, "two cells have the same %s",
                           kind == BR_VERIFY_SPACE ? "n" : "k");
    }
    return BR_OK;
}

static const struct br_expectation *find(const struct br_verify_study *v,
                                         const struct br_norm *norm, enum br_part part)
{
    for (size_t i = 0; i < v->expectations; i++)
        if (v->expectation[i].norm == norm && v->expectation[i].part == part)
            return &v->expectation[i].band;
    return NULL;
}

/* The total is at most the sum of its components and at least each of them: its order is the lower
 * one of theirs. */
static enum br_status check_total(const struct br_verify_study *v,
                                  const struct br_verify_expectation *expected,
                                  struct br_error *err)
{
    const struct br_expectation *axial = find(v, expected->norm, BR_PART_AXIAL);
    const struct br_expectation *bending = find(v, expected->norm, BR_PART_BENDING);
    const struct br_expectation *total = &expected->band;
    if (!axial || !bending)
        return BR_OK;
    const double low = fmin(br_expectation_low(axial), br_expectation_low(bending));
    const double high = fmin(br_expectation_high(axial), br_expectation_high(bending));
    char text[BR_EXPECTATION_TEXT];
    if (br_expectation_high(total) >= low && br_expectation_low(total) <= high)
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT,
                   "%s contradicts what is expected of the parts: the total has the lower one "
                   "of their orders, %g to %g",
                   br_expectation_text(total, text), low, high);
}

static enum br_status check_study(const struct br_scene *scene, enum br_verify_kind kind,
                                  const struct br_verify_study *v, size_t *line,
                                  struct br_error *err)
{
    *line = v->line;
    enum br_status status = check_cells(scene, kind, v, err);
    if (!status && v->expectations == 0)
        status = br_fail(err, BR_BAD_INPUT,
                         "nothing is expected; expected a line like 'l2 axial: 2 +- 0.1'");
    for (size_t i = 0; i < v->expectations && !status; i++) {
        const struct br_verify_expectation *e = &v->expectation[i];
        *line = e->band.line;
        if (!br_models(scene, e->part))
            status = br_fail(err, BR_BAD_INPUT, "the scene has no %s part", br_part_names[e->part]);
        if (!status && find(v, e->norm, e->part) != &e->band)
            status = br_fail(err, BR_BAD_INPUT, "%s %s is given twice", e->norm->name,
                             br_part_names[e->part]);
        if (!status && e->part == BR_PART_TOTAL)
            status = check_total(v, e, err);
    }
    return status;
}

enum br_status br_verify_check(const struct br_scene *scene, const struct br_verify *verify,
                               size_t *line, struct br_error *err)
{
    enum br_status status = BR_OK;
    size_t studies = 0;
    *line = 0;
    for (int kind = 0; kind < BR_VERIFY_KINDS && !status; kind++) {
        const struct br_verify_study *v = &verify->study[kind];
        if (v->count == 0 && v->line == 0)
            continue;
        studies++;
        status = check_study(scene, (enum br_verify_kind)kind, v, line, err);
    }
    if (!status && studies == 0)
        return br_fail(err, BR_BAD_INPUT,
                       "it is empty, expected at least one of space, time, joint");
    return status;
}

void br_verify_clear(struct br_verify *verify)
{
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        free(verify->study[kind].n);
        free(verify->study[kind].steps);
    }
    free(verify->data);
    *verify = (struct br_verify){0};
}
