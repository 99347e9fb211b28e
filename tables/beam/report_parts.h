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

#endif
