/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line a node and time: t, x and the variables, in SI units. */
#include <errno.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "study/scene/quote.h"
#include "tables/fields_file.h"

struct br_fields_file {
    FILE *out;
    char path[2048];
    size_t nodes, variables;
    double h;     /* m */
    double *work; /* values, then workspace */
};

static enum br_status open_csv(struct br_fields_file **out, const struct br_fields_request *q,
                               struct br_error *err)
{
    struct br_fields_file *f = *out = br_allocate(1, sizeof *f);
    if (!f)
        return br_no_memory(err, "the fields' file");
    snprintf(f->path, sizeof f->path, "%s", q->path);
    f->nodes = q->n + 1;
    f->variables = br_field_variable_count(q->axial_degree);
    f->h = q->scene->length / (double)q->n;
    f->work = br_allocate((BR_FIELD_VARIABLES + 4) * f->nodes, sizeof *f->work);
    if (!f->work)
        return br_no_memory(err, "the fields' file");
    f->out = fopen(q->path, "w");
    if (!f->out)
        return br_fail(err, BR_IO, "%s: %s", q->path, strerror(errno));
    fprintf(f->out, "t,x");
    for (size_t v = 0; v < f->variables; v++)
        fprintf(f->out, ",%s", br_field_variables[v].name);
    fputc('\n', f->out);
    return BR_OK;
}

static enum br_status look_csv(struct br_fields_file *f, const struct br_march *march,
                               const struct br_history_row *row, struct br_error *err)
{
    br_field_values(march, f->work, f->work + BR_FIELD_VARIABLES * f->nodes);
    for (size_t i = 0; i < f->nodes; i++) {
        fprintf(f->out, "%.17g,%.17g", row->time, f->h * (double)i);
        for (size_t v = 0; v < f->variables; v++) {
            const double value = f->work[v * f->nodes + i];
            fprintf(f->out, isnan(value) ? "," : ",%.17g", value); /* RFC 4180 */
        }
        fputc('\n', f->out);
    }
    return ferror(f->out) ? br_fail(err, BR_IO, "%s could not be written", f->path) : BR_OK;
}

static enum br_status close_csv(struct br_fields_file *f, const char *stopped, struct br_error *err)
{
    if (!f)
        return BR_OK;
    bool failed = false;
    if (f->out && stopped) {
        fprintf(f->out, "# stopped: ");
        br_quote(f->out, &br_for_text, stopped);
        fputc('\n', f->out);
    }
    if (f->out) {
        failed = fflush(f->out) != 0 || ferror(f->out) || fsync(fileno(f->out)) != 0;
        failed = fclose(f->out) != 0 || failed;
    }
    const enum br_status status =
        failed ? br_fail(err, BR_IO, "%s could not be written whole", f->path) : BR_OK;
    free(f->work);
    free(f);
    return status;
}

extern const struct br_fields_format br_fields_csv;
const struct br_fields_format br_fields_csv = {
    .name = "csv",
    .file_name = "fields.csv",
    .title = "one line a node and time",
    .open = open_csv,
    .look = look_csv,
    .close = close_csv,
};
