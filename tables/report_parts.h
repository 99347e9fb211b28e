/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What several reports have: a method, and a trial of one. */
#ifndef BR_TABLES_REPORT_PARTS_H
#define BR_TABLES_REPORT_PARTS_H

#include "study/scene/method_fields.h"
#include "study/trade/trial.h"
#include "tables/reports.h"

/* All that a method is (br_method_fields), for programs: as facts, each a member of the object
 * `key`, and as cells of a row. What the method does not heed is nothing. Facts have what the
 * linear solver was on the meshes, too. */
void br_put_method_facts(struct br_document *d, const char *key, const struct br_method *method,
                         const struct br_meshes *on);
void br_put_method_cells(struct br_document *d, const struct br_method *method);

/* Cells: method, n, steps_or_levels, k and tolerance; people see a tolerance in the place of k. */
void br_put_trial(struct br_document *d, const struct br_scene *scene,
                  const struct br_trial *trial);

/* "bdf2, n = 100, k = 0.01 s", or "adaptive, n = 100, tolerance 0.0001"; returns `text`. */
enum { BR_TRIAL_TEXT = 160 };
const char *br_trial_text(const struct br_scene *scene, const struct br_trial *trial,
                          char text[BR_TRIAL_TEXT]);

/* What is said of a failure; nothing of none. */
static inline struct br_value br_failure_text(const struct br_error *failure)
{
    return br_text(failure->status ? failure->message : NULL);
}

#endif
