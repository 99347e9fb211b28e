/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate study SCENE --vary: the finest error and the orders of a study at each value. */
#include <stdio.h>
#include <string.h>

#include "cli/studies.h"

enum { ERROR, RELATIVE, OWN, P, P_LOW, P_HIGH, Q, Q_LOW, Q_HIGH, MISFIT, POINTS, SWEPT };

static const struct br_variation_column *name_columns(const struct br_norm *norm)
{
    static char axis[160];
    static struct br_variation_column column[SWEPT];
    snprintf(axis, sizeof axis, "%s of the finest cell (%s)", norm->symbol, norm->unit_markup);
    const struct br_variation_column columns[SWEPT] = {
        [ERROR] = {"error", "error of the finest cell", norm->unit, "%.3e", .axis = axis,
                   .logarithmic = true},
        [RELATIVE] = {"relative", "relative", .format = "%.2e"},
        [OWN] = {"reference_error", .unit = norm->unit, .for_programs = true},
        [P] = {"p", "order in h", .format = "%.3f", .axis = "order"},
        [P_LOW] = {"p_low", .for_programs = true},
        [P_HIGH] = {"p_high", .for_programs = true},
        [Q] = {"q", "order in k", .format = "%.3f", .axis = "order"},
        [Q_LOW] = {"q_low", .for_programs = true},
        [Q_HIGH] = {"q_high", .for_programs = true},
        [MISFIT] = {"misfit", "misfit", .format = "%.2g"},
        [POINTS] = {"points", "cells used", .format = "%.0f"},
    };
    memcpy(column, columns, sizeof column);
    return column;
}

/* Takes an order by the rule of a study's report for claiming it. */
static void take_order(double *value, const struct br_joint_fit *fit, const struct br_estimate *e)
{
    if (!br_joint_describes(fit) || !br_order_determined(e))
        return;
    value[0] = e->value;
    value[1] = e->low;
    value[2] = e->high;
}

static void take_point(const struct br_studies *r, struct br_variation *found, size_t i)
{
    double *value = &found->value[i * SWEPT];
    const struct br_report *report = r->work->report;
    const struct br_study *s = report->study;
    const struct br_joint_fit *fit = &report->fits[BR_PART_TOTAL].joint;
    const struct br_cell *finest = &s->cell[br_study_cells(s) - 1];
    value[ERROR] = finest->error[BR_PART_TOTAL];
    value[RELATIVE] = value[ERROR] / s->reference_scale;
    value[OWN] = report->fits[BR_PART_TOTAL].reference_error;
    take_order(&value[P], fit, &fit->order[BR_AXIS_SPACE]);
    take_order(&value[Q], fit, &fit->order[BR_AXIS_TIME]);
    value[MISFIT] = fit->misfit;
    value[POINTS] = (double)fit->points;
    if (finest->flag[BR_PART_TOTAL])
        found->remark[i] = br_flag_name(finest->flag[BR_PART_TOTAL]);
    found->unstable[i] = finest->unstable;
}

static enum br_status read_request(const struct br_options *o, const void **out,
                                   struct br_error *err)
{
    static struct br_study_request request;
    *out = &request;
    if (br_study_request_read(o, &request, err))
        return err->status;
    return request.norms == 1
               ? BR_OK
               : br_fail(err, BR_BAD_INPUT, "--norm: found %zu norms, expected one with --vary",
                         request.norms);
}

static enum br_status prepare_value(struct br_vary *v, size_t i, void *self, struct br_error *err)
{
    struct br_studies *r = self;
    const struct br_study_job job = {.vary = v, .value = i};
    *r = (struct br_studies){v->request, v->session, .jobs = 1};
    if (br_studies_prepare(r, &job, false, err) || br_studies_check_memory(r, err))
        return err->status;
    v->column = name_columns(r->request->norm[0]);
    return BR_OK;
}

static enum br_status march_value(struct br_vary *v, size_t i, void *self, struct br_error *failure,
                                  struct br_error *err)
{
    struct br_studies *r = self;
    struct br_study named = *r->study;
    struct br_scene scene = *named.scene;
    static char what[64];
    char text[BR_VARIED_TEXT];
    named.scene = &scene;
    scene.name = (char *)br_varied_text(&v->varied, i, text);
    snprintf(what, sizeof what, "marching (value %zu of %zu)", i + 1, v->points);
    r->what = what;
    if (br_studies_keep(r, err))
        return err->status;
    if ((v->session->writes && br_warn_of_studies(&named, 1, failure)) ||
        br_studies_compute(r, true, failure))
        return BR_OK;
    take_point(r, &v->found, i);
    br_studies_check_cells(r, failure);
    return BR_OK;
}

const struct br_vary_command br_study_varied = {
    .format = "beamrate study variation",
    .size = sizeof(struct br_studies),
    .columns = SWEPT,
    .read = read_request,
    .prepare = prepare_value,
    .foresee = br_studies_foresee,
    .march = march_value,
    .clear = br_studies_clear,
};
