/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What several reports of the beam have: a method. */
#ifndef BR_TABLES_BEAM_REPORT_PARTS_H
#define BR_TABLES_BEAM_REPORT_PARTS_H

#include "study/grid/study.h"
#include "study/scene/method_fields.h"
#include "tables/beam/reports.h"
#include "tables/report_cells.h"

/* All fields of a method (br_method_fields), for programs: as facts, each a member of the object
 * `key`, and as cells of a row. A field that the method does not use is nothing. Facts also have
 * the linear solver that is taken on the meshes. */
void br_put_method_facts(struct br_document *d, const char *key, const struct br_method *method,
                         const struct br_meshes *on);
void br_put_method_cells(struct br_document *d, const struct br_method *method);

/* ---- of a study (report_study.c, report_answers.c) ---- */

/* k of a cell, s. */
static inline double br_step_of(const struct br_study *s, const struct br_cell *c)
{
    return br_time_step(s->scene, c->at.steps);
}

/* An error over the norm of the solution, or of its field; not finite where the norm is not
 * known. */
static inline double br_relative_of(const struct br_study *s, const struct br_cell *c,
                                    enum br_part part)
{
    return c->error[part] /
           (part == BR_PART_TOTAL ? s->reference_scale : s->reference_size[part - BR_PART_AXIAL]);
}

static inline const struct br_cell *br_finest_of(const struct br_study *s)
{
    return &s->cell[s->n_count * s->k_count - 1];
}

/* Whether a component is shown: a scene of one field has the total alone. */
bool br_part_is_shown(const struct br_report *report, enum br_part part);
void br_put_study_answers(struct br_document *d, const struct br_report *report);
void br_put_study_fits(struct br_document *d, const struct br_report *report);
void br_put_study_notes(struct br_document *d, const struct br_report *report);
void br_put_study_facts(struct br_document *d, const struct br_report *report);
/* Puts nothing where no errors are printed in the paper. */
void br_put_triangles(struct br_document *d, const struct br_report *report);

#endif
