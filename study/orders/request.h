/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is asked of a study of any program: by options, or by a study file. */
#ifndef BR_STUDY_ORDERS_REQUEST_H
#define BR_STUDY_ORDERS_REQUEST_H

#include "study/grid/observer.h"
#include "study/orders/orders.h"
#include "study/orders/program.h"

/* Begins as br_orders_request_default. Texts and arrays are owned. */
struct br_orders_request {
    char *path;            /* of the table or the study file, for messages */
    char *title;           /* one line; NULL: the path */
    char *table;           /* text of a table; NULL: none */
    char *table_path;      /* of a table that a study file names; NULL: it is `path` */
    char *command;         /* that is run; NULL: none */
    char *folder;          /* of the study file; NULL: none */
    char *errors, *values; /* columns of the table, or readings that are values */
    struct br_program_axis axis[BR_AXES];
    struct br_reading *reading; /* readings */
    size_t readings;
    struct br_order_expectation *expectation; /* expectations */
    size_t expectations;
    double dimension; /* of the mesh, for unknowns */
    double formal;    /* order of values that theory gives */
    double seconds;   /* limit of a run */
    /* borrowed, and not of a study file */
    int jobs;
    const char *kept;
    bool anew; /* as br_program has it */
    const struct br_observer *observer;
};
struct br_orders_request br_orders_request_default(void);
void br_orders_request_clear(struct br_orders_request *request);

/* Where numbers come from: const records. */
struct br_orders_source {
    const char *name;  /* one word */
    const char *title; /* one line for a person */
    bool (*applies)(const struct br_orders_request *request);
    /* Fails with BR_BAD_INPUT, BR_NO_MEMORY, BR_IO or BR_INTERRUPTED. */
    enum br_status (*read)(const struct br_orders_request *request, struct br_numbers *numbers,
                           struct br_error *err);
};
extern const struct br_orders_source *const br_orders_sources[]; /* NULL-terminated */

/* Reads the numbers from the source that applies (out; clear them even after a failure). Fails as
 * the source does, or with BR_BAD_INPUT where none applies. */
enum br_status br_orders_read(const struct br_orders_request *request, struct br_numbers *numbers,
                              struct br_error *err);

/* ---- parts of a request, as options and study files write them ---- */

/* The list of an axis: "10,20,40", of the column n, h, dofs, k, dt or steps. */
enum br_status br_orders_request_axis(struct br_orders_request *request, const char *column,
                                      const char *list, struct br_error *err);

/* A reading: NAME and REGEX, json:POINTER or csv:COLUMN. */
enum br_status br_orders_request_reading(struct br_orders_request *request, const char *name,
                                         const char *what, struct br_error *err);

/* Expectations of one text (br_expectations_read); line: of a study file, or 0. */
enum br_status br_orders_request_expect(struct br_orders_request *request, const char *where,
                                        const char *text, size_t line, struct br_error *err);

/* ---- study files ---- */

/* Whether a YAML text is a study file: it has 'run' or 'table' at the top; a scene has neither. */
bool br_is_study_file(const char *text);

/* Reads a study file's text; its table is looked for in its folder. Every refusal names path, line
 * and key. Fails with BR_BAD_INPUT or BR_NO_MEMORY. */
enum br_status br_orders_request_read(const char *path, const char *text,
                                      struct br_orders_request *request, struct br_error *err);

/* What is run or read, and expected, as a hash (out). */
void br_orders_problem(const struct br_orders_request *request, char problem[40]);

#endif
