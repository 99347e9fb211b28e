/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "made_report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "solver/linear/linear_solver.h"
#include "solver/linear/riccati/kernel.h"

static const size_t meshes[BR_MADE_N] = {10, 20, 40}, steps[BR_MADE_K] = {25, 50, 100, 200};

static void fill_cells(struct br_cell *cell, double first)
{
    for (size_t i = 0; i < BR_MADE_CELLS; i++) {
        cell[i] = (struct br_cell){.at = {meshes[i / BR_MADE_K], steps[i % BR_MADE_K]},
                                   .seconds = 0.001 * (double)(i + 1)};
        for (int part = 0; part < BR_PARTS; part++) {
            cell[i].error[part] = (first + 0.123456789012 * (double)i) * pow(10, -2 - part);
            cell[i].worst_time[part] = 0.01 * (double)(i + 1) + 0.2 * part;
        }
    }
}

static void flag(struct br_cell *cell, enum br_flag flag)
{
    for (int part = 0; part < BR_PARTS; part++)
        cell->flag[part] = flag;
}

static void fail_cell(struct br_cell *cell)
{
    flag(cell, BR_FLAG_FAILED);
    br_fail(&cell->failure, BR_NOT_FINITE, "it blew up at 50%% & {more}");
    for (int part = 0; part < BR_PARTS; part++)
        cell->error[part] = cell->worst_time[part] = NAN;
}

/* The same on every processor. */
static struct br_method make_method(void)
{
    struct br_method method = br_method_default();
    method.kernel = br_kernel_find("portable");
    return method;
}

static struct br_study make_study(const struct br_scene *scene, struct br_cell *cell)
{
    return (struct br_study){
        .scene = scene,
        .norm = br_norms[0],
        .method = make_method(),
        .reference_kind = &br_reference_fine,
        .reference_method = make_method(),
        .reference = {640, 3200},
        .n_count = BR_MADE_N,
        .k_count = BR_MADE_K,
        .n = meshes,
        .steps = steps,
        .cell = cell,
        .reference_report = {.own_error = {{NAN}, {NAN}}, .round_off = 1e-13, .seconds = 2.5},
        .reference_scale = 0.5,
        .reference_error = {1.5e-3, 1e-3, 5e-4},
    };
}

static struct br_estimate interval(double value, double half)
{
    return (struct br_estimate){value, value - half, value + half};
}

static void fill_fits(struct br_fits *f, int part)
{
    f->joint = (struct br_joint_fit){
        .kind = (enum br_joint_kind)part,
        .c = {interval(0.0716, 0.001), interval(0.0845, 0.001)},
        .order = {interval(2.03, 0.02), interval(1.013, 0.004)},
        .r = interval(-0.987, 0.003),
        .misfit = 0.002,
        .worst = 0.004,
        .r_squared = 0.99998,
        .points = 9,
        .freedom = 4,
        .converged = true,
    };
    const struct br_estimate none = {NAN, NAN, NAN};
    if (f->joint.kind == BR_JOINT_TIME)
        f->joint.c[0] = f->joint.order[0] = f->joint.r = none;
    if (f->joint.kind == BR_JOINT_SPACE)
        f->joint.c[1] = f->joint.order[1] = f->joint.r = none;
    f->reference_error = 3.25e-7 * (part + 1);
}

static void fill_printed(struct br_report *r)
{
    r->printed = br_allocate(BR_MADE_CELLS, sizeof *r->printed);
    assert_non_null(r->printed);
    for (int i = 0; i < BR_MADE_CELLS; i++)
        r->printed[i] = i == 3 || i == 8 ? (double)NAN : (7.001 - 0.3 * i) * 1e-3;
    r->triangles = 2;
    r->triangle[0] =
        (struct br_triangle){{10, 25}, {20, 25}, 1e-2, 2e-3, 1e-5, 7.99e-3, 0.012, true};
    r->triangle[1] = (struct br_triangle){{10, 50}, {40, 50}, 1e-2, 2e-2, 2e-2, 9e-3, 0.031, false};
}

void br_made_report(struct br_made_report *m, bool with_exact)
{
    *m = (struct br_made_report){.scene = br_test_bundled("example1")};
    fill_cells(m->cell[0], 1.5);
    fill_cells(m->cell[1], 4.25);
    struct br_cell *fitted = m->cell[with_exact];
    flag(&fitted[1], BR_FLAG_REFERENCE);
    flag(&fitted[6], BR_FLAG_ROUND_OFF);
    fitted[2].flag[BR_PART_TOTAL] = BR_FLAG_REFERENCE;
    fitted[7].flag[BR_PART_TOTAL] = BR_FLAG_UNSTABLE;
    fitted[9].flag[BR_PART_TOTAL] = BR_FLAG_STALLED;
    if (with_exact)
        flag(&m->cell[0][4], BR_FLAG_REFERENCE);
    fail_cell(&m->cell[0][11]);
    fail_cell(&m->cell[1][11]);
    m->study = make_study(&m->scene, m->cell[0]);
    m->exact = make_study(&m->scene, m->cell[1]);
    struct br_study *by_exact = with_exact ? &m->exact : &m->study;
    by_exact->reference_kind = &br_reference_exact;
    by_exact->reference = (struct br_resolution){0, 3200};
    by_exact->reference_report.own_error[BR_AXIAL][BR_DISPLACEMENT] = 1e-14;
    by_exact->reference_report.own_error[BR_BENDING][BR_DISPLACEMENT] = 2e-14;
    if (with_exact)
        m->study.reference_check = &br_reference_exact;
    m->report = (struct br_report){.name = "made",
                                   .caption = BR_MADE_CAPTION,
                                   .study = &m->study,
                                   .exact = with_exact ? &m->exact : NULL,
                                   .fitted = by_exact,
                                   .wall_seconds = 12.5};
    for (int part = 0; part < BR_PARTS; part++)
        fill_fits(&m->report.fits[part], part);
    fill_printed(&m->report);
}

void br_made_report_clear(struct br_made_report *m)
{
    br_report_clear(&m->report);
    br_scene_clear(&m->scene);
}
