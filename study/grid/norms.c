/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/norms.h"

#include <math.h>

#include "solver/scene.h"

const char *const br_part_names[BR_PARTS] = {"total", "axial", "bending"};

bool br_models(const struct br_scene *scene, enum br_part part)
{
    return (scene->axial.modelled && part != BR_PART_BENDING) ||
           (scene->bending.modelled && part != BR_PART_AXIAL);
}

const struct br_norm br_norm_l2 = {
    .name = "l2",
    .title = "Error (31): the largest |u - u_hk| + |w - w_hk| over all time levels of a cell, L2 "
             "norms, m^(3/2).",
    .symbol = "error, L2 norm",
    .unit = "m^(3/2)",
    .unit_markup = "m^{3/2}",
    .theory = "(26) bounds the error by c (h^(1/2) + k), Remark 2.5 by c (h + k).",
    .level = BR_DISPLACEMENT,
    .printed = true,
};

const struct br_norm br_norm_energy = {
    .name = "energy",
    .title = "Error (25), the root of its left side: the largest |u_t - v_hk|^2 + |w_t - v_hk|^2 "
             "over all time levels of a cell, plus the sum over them of k (L^2 |u_xt - v_hk,x|^2 + "
             "L^4 |w_xxt - v_hk,xx|^2) / T, L2 norms, m^(3/2)/s. (The paper has L = T = 1.)",
    .symbol = "error, energy norm",
    .unit = "m^(3/2)/s",
    .unit_markup = "m^{3/2}/s",
    .theory = "Theorem 2.3 is about this norm: (26) bounds it by c (h^(1/2) + k), Remark 2.5 by "
              "c (h + k).",
    .level = BR_VELOCITY,
    .energy = true,
};

const struct br_norm br_norm_tip = {
    .name = "tip",
    .title = "Error at the tip: the largest |u - u_hk| + |w - w_hk| at x = L over all time levels "
             "of a cell, m.",
    .symbol = "error at the tip",
    .unit = "m",
    .unit_markup = "m",
    .theory = "What (25) bounds also bounds the error at the tip: (26) gives c (h^(1/2) + k), "
              "Remark 2.5 c (h + k).",
    .level = BR_TIP,
};

const struct br_norm *const br_norms[] = {&br_norm_l2, &br_norm_energy, &br_norm_tip, NULL};

bool br_norm_needs(const struct br_norm *norm, enum br_measure measure)
{
    return measure == norm->level || (norm->energy && measure == BR_STRAIN_RATE);
}

/* Weights that give all terms of (25) one unit: |v_x|^2 L^2/T, |v_xx|^2 L^4/T. */
static double energy_weight(const struct br_scene *scene, enum br_field_kind kind)
{
    const double square = scene->length * scene->length;
    return (kind == BR_AXIAL ? square : square * square) / scene->duration;
}

static void spread(const double by_kind[2], double part[BR_PARTS])
{
    part[BR_PART_AXIAL] = by_kind[BR_AXIAL];
    part[BR_PART_BENDING] = by_kind[BR_BENDING];
    part[BR_PART_TOTAL] = by_kind[BR_AXIAL] + by_kind[BR_BENDING];
}

void br_norm_add(const struct br_norm *norm, const struct br_scene *scene,
                 const struct br_sample *sample, struct br_norm_sum *sum)
{
    double level[2], rate[2], part[BR_PARTS];
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const double size = sample->size[kind][norm->level];
        const double strain = norm->energy ? sample->size[kind][BR_STRAIN_RATE] : 0;
        level[kind] = norm->energy ? size * size : size;
        rate[kind] = sample->weight * energy_weight(scene, kind) * (strain * strain);
    }
    spread(level, part);
    for (int p = 0; p < BR_PARTS; p++)
        if (!(part[p] <= sum->most[p]) && !isnan(sum->most[p])) {
            sum->most[p] = part[p];
            sum->time[p] = sample->time;
        }
    spread(rate, part);
    for (int p = 0; p < BR_PARTS; p++)
        sum->sum[p] += part[p];
}

double br_norm_value(const struct br_norm *norm, const struct br_norm_sum *sum, enum br_part part)
{
    return norm->energy ? sqrt(sum->most[part] + sum->sum[part]) : sum->most[part];
}

double br_norm_of_constant(const struct br_norm *norm, const struct br_scene *scene,
                           const double size[2][BR_MEASURES], enum br_part part)
{
    struct br_sample sample = {.weight = scene->duration};
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        for (int measure = 0; measure < BR_MEASURES && scene->field[kind].modelled; measure++)
            sample.size[kind][measure] = size[kind][measure];
    struct br_norm_sum sum = {0};
    br_norm_add(norm, scene, &sample, &sum);
    return br_norm_value(norm, &sum, part);
}
