/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tip's history as CSV, and the fields at the output times in a file: HDF5 where the build has
 * it, CSV otherwise. Each format is a const record. The fields of one output time are written
 * before those of the next, so only one is in memory. */
#ifndef BR_TABLES_FIELDS_FILE_H
#define BR_TABLES_FIELDS_FILE_H

#include "study/run/run.h"
#include "tables/document.h"

/* What is written. Borrowed. */
struct br_fields_request {
    const char *path;                       /* of the file */
    const struct br_scene *scene;           /* as it is marched */
    size_t n, steps, levels;                /* elements; steps; output times */
    int axial_degree;                       /* of the axial elements */
    const struct br_provenance *provenance; /* with its scene */
};

struct br_fields_file; /* each format defines its own */

struct br_fields_format {
    const char *name;      /* "hdf5", "csv" */
    const char *file_name; /* in the folder of results */
    const char *title;     /* one line for a person */
    /* append: adds the fields of a march as it is now. close: stopped is NULL, or why the march
     * stopped before all output times; frees the file in any case, and accepts NULL. Each fails
     * with BR_IO or BR_NO_MEMORY. */
    enum br_status (*open)(struct br_fields_file **file, const struct br_fields_request *request,
                           struct br_error *err);
    enum br_status (*append)(struct br_fields_file *file, const struct br_march *march,
                             const struct br_history_row *row, struct br_error *err);
    enum br_status (*close)(struct br_fields_file *file, const char *stopped, struct br_error *err);
};

/* NULL-terminated, the best first. */
extern const struct br_fields_format *const br_fields_formats[];

/* The variables, in the order of the file; without x and t. Only quadratic elements of the rod have
 * the last two. */
enum { BR_FIELD_VARIABLES = 8 };
struct br_field_variable {
    const char *name, *unit, *meaning;
};
extern const struct br_field_variable br_field_variables[BR_FIELD_VARIABLES];

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
