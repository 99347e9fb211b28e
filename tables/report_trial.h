/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the reports of trade, split and plan share: rows that are built together with their columns,
 * so that a value stands beside its key, and what they have of a trial and of a method. */
#ifndef BR_TABLES_REPORT_TRIAL_H
#define BR_TABLES_REPORT_TRIAL_H

#include "study/scene/method_fields.h"
#include "study/trade/trial.h"
#include "tables/document.h"

/* A row on its way into a table; begins as zeros. Strings are borrowed until it is put. */
enum { BR_MOST_COLUMNS = 40 };
struct br_row {
    struct br_column column[BR_MOST_COLUMNS];
    struct br_value value[BR_MOST_COLUMNS];
    char shown[BR_MOST_COLUMNS][32]; /* to people instead of the value; "": the value */
    char text[2 * BR_METHOD_FIELDS][BR_METHOD_VALUE]; /* keys and values of a method */
    size_t cells;
    bool full; /* more were added: the report is then refused */
};

/* Adds a value under its column: BR_ADD(&row, br_count(n), .key = "n"). */
#define BR_ADD(row, value, ...) br_row_add((row), &(struct br_column){__VA_ARGS__}, (value))
void br_row_add(struct br_row *row, const struct br_column *column, struct br_value value);

/* Adds a value that people do not see. unit: NULL, none. */
void br_row_hide(struct br_row *row, const char *key, const char *unit, struct br_value value);

/* What people see instead of the value that was added last. */
__attribute__((format(printf, 2, 3))) void br_row_shown(struct br_row *row, const char *format,
                                                        ...);

/* Makes the cells from `first` on nothing. */
void br_row_empty(struct br_row *row, size_t first);

/* Puts the row into the document's last table. The first row brings the table's columns, so all
 * rows of a table are built alike. */
void br_put_whole_row(struct br_document *d, const struct br_row *row);

/* Adds method, n, steps_or_levels, k and tolerance; people see a tolerance in the place of k. */
void br_row_add_trial(struct br_row *row, const struct br_scene *scene,
                      const struct br_trial *trial);

/* Adds all that a method is, for programs: scheme, tolerance and so on (br_method_fields). What it
 * does not heed is nothing. */
void br_row_add_method(struct br_row *row, const struct br_method *method);

/* "bdf2, n = 100, k = 0.01 s", or "adaptive, n = 100, tolerance 0.0001"; returns `text`. */
enum { BR_TRIAL_TEXT = 160 };
const char *br_trial_text(const struct br_scene *scene, const struct br_trial *trial,
                          char text[BR_TRIAL_TEXT]);

/* Puts a fact that people do not see. */
void br_put_hidden_fact(struct br_document *d, const char *key, struct br_value value);

#endif
