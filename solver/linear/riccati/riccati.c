/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The row of the registry: its kernels, how the beam is cut, what that costs and loses. No function
 * here calls br_kernel_best: a program may replace it when it is linked (tests/golden). */
#include <float.h>
#include <math.h>

#include "solver/linear/riccati/panels.h"

/* ---- kernels ---- */

#define LOOPS(set) extern const struct br_loops br_loops_##set##_1, br_loops_##set##_2;
BR_INSTRUCTION_SETS(LOOPS)

#define KERNEL(set)                                \
    static const struct br_kernel kernel_##set = { \
        #set, br_has_##set, {&br_loops_##set##_1, &br_loops_##set##_2}};
BR_INSTRUCTION_SETS(KERNEL)

#define ROW(set) &kernel_##set,
const struct br_kernel *const br_kernels[] = {BR_INSTRUCTION_SETS(ROW) NULL};

const struct br_kernel *br_kernel_best(void)
{
    return br_kernels[br_instruction_set_best()];
}

const struct br_kernel *br_kernel_find(const char *name)
{
    return br_kernels[br_instruction_set_find(name)];
}

/* ---- the cut ---- */

enum {
    MOST_LENGTH = 32,  /* elements of a panel: two of them fit the first level of the cache */
    JOIN_COST = 2,     /* of a panel in its segment, in element loops */
    SEGMENT_COST = 16, /* of all segments */
};

/* Element loops of a step. An element of the odd rest costs as much as an element loop of all
 * segments. */
static double cost_of(const struct br_cut *cut)
{
    return (double)(cut->panels * (cut->length + JOIN_COST) + cut->odd) +
           (cut->panels ? SEGMENT_COST : 0);
}

struct br_cut br_choose_cut(size_t n)
{
    struct br_cut best = {.odd = n};
    for (size_t length = 1; length <= MOST_LENGTH && length * BR_LANES <= n; length++) {
        struct br_cut cut = {.panels = n / (length * BR_LANES), .length = length};
        cut.odd = n - cut.panels * length * BR_LANES;
        if (cost_of(&cut) < cost_of(&best))
            best = cut;
    }
    return best;
}

/* ns, of an AMD EPYC with AVX-512 at about 3 GHz: of a step, of an element of all segments, of the
 * odd rest and of its elements; and, as another struct, what a pass over the states adds to each.
 */
struct cost {
    double step, loop, rest, odd;
};

/* A beam that is only an odd rest has no joins. */
static double price(const struct cost *of, const struct br_cut *cut)
{
    const double joins = cut->panels ? of->step : 0, rest = cut->odd ? of->rest : 0;
    return joins + of->loop * (double)(cut->panels * cut->length) + rest +
           of->odd * (double)cut->odd;
}

/* See linear_solver.h. */
static double panels_cost(const struct br_field *field, double sums)
{
    if (br_field_is_quadratic(field))
        return br_linear_solver_cost(&br_plain, field, sums);
    static const struct cost axial = {260, 6.5, 55, 2.75}, axial_sum = {70, 1.6, 8, 3.1};
    static const struct cost bending = {450, 22, 115, 10.9}, bending_sum = {55, 7, 14, 6.5};
    static const double march = 140; /* of a step that has an odd rest alone */
    const struct br_cut cut = br_choose_cut(field->n);
    const bool rod = field->kind == BR_AXIAL;
    return (cut.panels ? 0 : march) + price(rod ? &axial : &bending, &cut) +
           sums * price(rod ? &axial_sum : &bending_sum, &cut);
}

/* ---- the row ---- */

/* Where a wave does not cross an element in a step, only the mass matters in the step. Its
 * condition number in strains, n for a rod and n^2 for a beam, bounds the loss. Measured for n = 40
 * to 3200 and rho / (c k) up to 1e25. */
static double most_excess(const struct br_field *f)
{
    const double n = (double)f->n;
    return f->kind == BR_AXIAL ? 1e4 + 64 * n : 1e5 + 4 * n * n;
}

/* In the lowest mode of free vibration the strain g is larger than the increment that it leads to,
 * by the factor br_field_inertia. The joins add the round-off of their sums: where inertia
 * dominates, panels that are free at one end respond by far more than the joined beam. Short beams
 * are one panel. */
static double riccati_round_off(const struct br_field *field)
{
    const double joined = field->n <= 20 ? 0 : field->kind == BR_AXIAL ? 0.25 : 4;
    const double excess = fmin(br_field_inertia(field), most_excess(field));
    return DBL_EPSILON * (8 * ((double)field->n + 1024) + joined * excess);
}

const struct br_linear_solver br_riccati = {
    .name = "riccati",
    .title =
        "flexibility form: Riccati recursions on segments of the beam, side by side in vectors",
    .citation =
        "discrete linear-quadratic problem in substructures, see solver/linear/riccati/panels.h",
    .takes_kernel = true,
    .axial = &br_panels,
    .axial_quadratic = &br_plain_form,
    .bending = &br_panels,
    .round_off = riccati_round_off,
    .bytes = {40, 62, 141},
    .state_bytes = {28, 44, 32},
    .cost = panels_cost,
};
