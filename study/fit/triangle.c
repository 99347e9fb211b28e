/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/fit/triangle.h"

#include <math.h>

#include "study/grid/sweep.h"

/* A pair with at least this score shows a contradiction plainly. Then the cheapest pair is enough:
 * a finer one costs a hundred times as much and shows the same. */
static const double plain = 1.5;

/* A pair of cells and how plainly it may contradict the printed values. */
struct candidate {
    size_t a, b; /* indices of cells; every level of a is one of b */
    double score;
    double work;   /* element-steps of both */
    bool too_near; /* which inequality: the printed values need a larger distance */
};

/* Half a unit of the last of four printed digits. */
static double half_unit(double printed)
{
    return 0.5 * pow(10, floor(log10(printed)) - 3);
}

/* What the printed values of a pair allow for the distance of its solutions. */
static void allowed(const struct br_cell *a, const struct br_cell *b, double printed_a,
                    double printed_b, double *least, double *most)
{
    const double digits = half_unit(printed_a) + half_unit(printed_b);
    const bool same_levels = a->at.steps == b->at.steps;
    const double gap = same_levels ? fabs(printed_a - printed_b) : printed_a - printed_b;
    *least = fmax(0, gap - digits);
    *most = printed_a + printed_b + digits;
}

static double work_of(const struct br_resolution *at)
{
    return (double)at->n * (double)at->steps;
}

static bool comparable(const struct br_cell *a, const struct br_cell *b)
{
    return a != b && b->at.n % a->at.n == 0 && b->at.steps % a->at.steps == 0;
}

/* Our own errors bound the distance, |Ea - Eb| <= D <= Ea + Eb, so they show which pair to
 * try; the distance itself is then marched. */
static struct candidate rate(const struct br_study *s, const double *printed, size_t i, size_t j)
{
    struct candidate c = {.a = i, .b = j, .score = 0};
    const struct br_cell *a = &s->cell[i], *b = &s->cell[j];
    if (!comparable(a, b) || !(printed[i] > 0) || !(printed[j] > 0))
        return c;
    const double ours_a = a->error[BR_PART_TOTAL], ours_b = b->error[BR_PART_TOTAL];
    double least, most;
    allowed(a, b, printed[i], printed[j], &least, &most);
    const double near = least / (ours_a + ours_b);
    const double far = fabs(ours_a - ours_b) / most;
    c.too_near = near >= far;
    c.score = fmax(near, far);
    c.work = work_of(&a->at) + work_of(&b->at);
    return isfinite(c.score) ? c : (struct candidate){.a = i, .b = j};
}

static bool better(const struct candidate *c, const struct candidate *best)
{
    const double score = fmin(c->score, plain), best_score = fmin(best->score, plain);
    return score > best_score || (score == best_score && c->work < best->work);
}

/* The best pair of the wanted inequality whose cells are not yet used, from a score on. A score up
 * to 1 shows nothing. */
static struct candidate best_pair(const struct br_study *s, const double *printed, const bool *used,
                                  bool too_near, double least)
{
    const size_t cells = s->n_count * s->k_count;
    struct candidate best = {.score = least, .work = INFINITY};
    for (size_t i = 0; i < cells; i++)
        for (size_t j = 0; j < cells; j++) {
            if (used[i] || used[j])
                continue;
            const struct candidate c = rate(s, printed, i, j);
            if (c.too_near == too_near && c.score > 1 && better(&c, &best))
                best = c;
        }
    return best;
}

static struct br_triangle triangle_of(const struct br_study *s, const double *printed,
                                      const struct candidate *c)
{
    const struct br_cell *a = &s->cell[c->a], *b = &s->cell[c->b];
    struct br_triangle t = {
        .a = a->at, .b = b->at, .printed_a = printed[c->a], .printed_b = printed[c->b]};
    allowed(a, b, t.printed_a, t.printed_b, &t.least, &t.most);
    return t;
}

static size_t choose_pairs(const struct br_study *s, const double *printed, size_t most, bool *used,
                           struct br_triangle *triangles)
{
    size_t count = 0;
    while (count < most) {
        struct candidate c = {0};
        for (size_t attempt = 0; attempt < 4 && c.a == c.b; attempt++)
            c = best_pair(s, printed, used, (count + attempt) % 2 == 0, attempt < 2 ? plain : 1);
        if (c.a == c.b)
            break;
        used[c.a] = used[c.b] = true;
        triangles[count++] = triangle_of(s, printed, &c);
    }
    return count;
}

/* D(a, b) of every pair: a study with one cell, a, and b as its reference. */
static enum br_status march_pairs(const struct br_study *s, struct br_triangle *triangles,
                                  size_t count, int threads, struct br_error *err)
{
    struct br_study *pair = br_allocate(count, sizeof *pair);
    if (!pair)
        return br_no_memory(err, "the pairs of cells");
    for (size_t i = 0; i < count; i++)
        pair[i] = (struct br_study){
            .scene = s->scene,
            .norm = s->norm,
            .method = s->method,
            .reference_kind = &br_reference_fine,
            .reference_method = s->method,
            .reference = triangles[i].b,
            .n_count = 1,
            .k_count = 1,
            .n = &triangles[i].a.n,
            .steps = &triangles[i].a.steps,
        };
    const enum br_status status = br_study_run(pair, count, threads, NULL, err);
    for (size_t i = 0; i < count && !status; i++) {
        struct br_triangle *t = &triangles[i];
        t->distance = pair[i].cell[0].error[BR_PART_TOTAL];
        t->contradiction =
            isfinite(t->distance) && !(t->least <= t->distance && t->distance <= t->most);
    }
    for (size_t i = 0; i < count; i++)
        br_study_clear(&pair[i]);
    free(pair);
    return status;
}

enum br_status br_triangles(const struct br_study *s, const double *printed, size_t most,
                            struct br_triangle *triangles, size_t *count, int threads,
                            struct br_error *err)
{
    *count = 0;
    bool *used = br_allocate(s->n_count * s->k_count, sizeof *used);
    if (!used)
        return br_no_memory(err, "the pairs of cells");
    const size_t chosen = choose_pairs(s, printed, most, used, triangles);
    free(used);
    const enum br_status status = march_pairs(s, triangles, chosen, threads, err);
    *count = status ? 0 : chosen;
    return status;
}
