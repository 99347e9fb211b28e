/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files of a march: the tip's history as CSV, and the fields at the output times twice, as CSV
 * and as XDMF. The caller opens and closes them. The fields of one output time are written before
 * those of the next, so only one is in memory. */
#ifndef BR_TABLES_BEAM_FIELDS_FILE_H
#define BR_TABLES_BEAM_FIELDS_FILE_H

#include "study/run/run.h"
#include "tables/document.h"

/* What is written, and where. Borrowed. The rest begins as zeros. */
struct br_fields_file {
    FILE *csv, *xdmf;
    const struct br_scene *scene; /* as it is marched */
    size_t n;                     /* elements */
    int axial_degree;             /* of the axial elements */

    size_t nodes, variables; /* private from here on */
    double h;                /* m */
    double *values;          /* owned: BR_FIELD_VARIABLES nodes, then workspace */
};

/* Writes the heads. Fails with BR_NO_MEMORY. */
enum br_status br_fields_begin(struct br_fields_file *fields,
                               const struct br_provenance *provenance, struct br_error *err);

/* Adds the fields of a march as it is now; write errors stay in the files. */
void br_fields_add(struct br_fields_file *fields, const struct br_march *march,
                   const struct br_history_row *row);

/* Writes the ends, unless nothing was begun. stopped: why the march stopped before all output
 * times; NULL: it did not. Releases what is owned. */
void br_fields_end(struct br_fields_file *fields, const char *stopped);

/* The variables, in the order of the CSV; without t and x. Only quadratic elements of the rod have
 * the last two. */
enum { BR_FIELD_VARIABLES = 8 };
extern const struct br_field_variable {
    const char *name;
    enum br_field_kind kind;
    bool in_middle; /* a value of each element, not of each node */
} br_field_variables[BR_FIELD_VARIABLES];

/* The number of variables of a march with axial elements of this degree. */
size_t br_field_variable_count(int axial_degree);

/* All nodal values of a march as it is now (out): n + 1 values of each variable in turn, in its
 * unit. Slopes are w_x, not the h w_x of solver/field.h. The value in the middle of an element is
 * given at its right node, and is NaN at the clamped one. work: workspace, 4 (n + 1) values. */
void br_field_values(const struct br_march *march, double *values, double *work);

/* The tip's history: a head, one line for each row, SI units; a number that is not known is an
 * empty field (RFC 4180). */
void br_history_csv_head(FILE *out);
void br_history_csv_row(FILE *out, const struct br_history_row *row);

/* The last line of a march that did not reach T: a comment, "# stopped: ...". */
void br_history_csv_stopped(FILE *out, const char *message);

#endif
