/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/fields_file.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "study/scene/quote.h"

const struct br_field_variable br_field_variables[BR_FIELD_VARIABLES] = {
    {"u", "m", "axial displacement"},
    {"u_t", "m/s", "axial velocity"},
    {"w", "m", "bending displacement"},
    {"w_slope", "1", "slope w_x of the bending displacement"},
    {"w_t", "m/s", "bending velocity"},
    {"w_t_slope", "1/s", "slope of the bending velocity"},
    {"u_middle", "m", "axial displacement in the middle of the element to the left of the node"},
    {"u_t_middle", "m/s", "axial velocity there"},
};

size_t br_field_variable_count(int axial_degree)
{
    return axial_degree == 2 ? BR_FIELD_VARIABLES : BR_FIELD_VARIABLES - 2;
}

/* The values at the nodes and, for quadratic elements, those in their middles (else NULL). */
static void axial_values(const double *nodal, size_t nodes, double *at_node, double *middle)
{
    const size_t unknowns = middle ? 2 : 1;
    for (size_t i = 0; i < nodes; i++)
        at_node[i] = nodal[i * unknowns];
    for (size_t i = 0; i < nodes && middle; i++)
        middle[i] = i == 0 ? NAN : (at_node[i - 1] + at_node[i]) / 2 - nodal[2 * i + 1] / 4;
}

/* Sets `count` variables to NaN. */
static void blank(size_t first, size_t count, size_t nodes, double *values)
{
    for (size_t i = 0; i < count * nodes; i++)
        values[first * nodes + i] = NAN;
}

void br_field_values(const struct br_march *march, double *values, double *work)
{
    const struct br_field *field = br_march_field(march, BR_BENDING);
    const size_t nodes = field->n + 1;
    double *const displacement = work, *const velocity = work + 2 * nodes;
    br_march_get(march, BR_AXIAL, displacement, velocity);
    const bool quadratic = br_field_is_quadratic(br_march_field(march, BR_AXIAL));
    axial_values(displacement, nodes, values, quadratic ? values + 6 * nodes : NULL);
    axial_values(velocity, nodes, values + nodes, quadratic ? values + 7 * nodes : NULL);
    br_march_get(march, BR_BENDING, displacement, velocity);
    for (size_t i = 0; i < nodes; i++) {
        values[2 * nodes + i] = displacement[2 * i];
        values[3 * nodes + i] = displacement[2 * i + 1] / field->h;
        values[4 * nodes + i] = velocity[2 * i];
        values[5 * nodes + i] = velocity[2 * i + 1] / field->h;
    }
    if (!br_march_models(march, BR_AXIAL))
        blank(0, 2, nodes, values);
    if (!br_march_models(march, BR_AXIAL) && quadratic)
        blank(6, 2, nodes, values);
    if (!br_march_models(march, BR_BENDING))
        blank(2, 4, nodes, values);
}

/* ---- the history ---- */

void br_history_csv_head(FILE *out)
{
    fprintf(out, "step,t,u,w,u_t,w_t,contact_force,friction_force,friction_bound\n");
}

void br_history_csv_row(FILE *out, const struct br_history_row *row)
{
    const double values[] = {
        row->time,
        row->displacement[BR_AXIAL],
        row->displacement[BR_BENDING],
        row->velocity[BR_AXIAL],
        row->velocity[BR_BENDING],
        row->contact_force,
        row->friction_force,
        row->friction_bound,
    };
    fprintf(out, "%zu", row->step);
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        if (isfinite(values[i]))
            fprintf(out, ",%.17g", values[i]);
        else
            fputc(',', out);
    fputc('\n', out);
}

void br_history_csv_stopped(FILE *out, const char *message)
{
    fprintf(out, "# stopped: ");
    br_quote(out, &br_for_text, message);
    fputc('\n', out);
}

/* ---- CSV: one line for each node and time: t, x and the variables, in SI units ---- */

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

static enum br_status append_csv(struct br_fields_file *f, const struct br_march *march,
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
    if (f->out && stopped)
        br_history_csv_stopped(f->out, stopped);
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

static const struct br_fields_format csv = {
    .name = "csv",
    .file_name = "fields.csv",
    .title = "one line a node and time",
    .open = open_csv,
    .append = append_csv,
    .close = close_csv,
};

#ifdef BR_HAVE_HDF5
extern const struct br_fields_format br_fields_hdf5;
#endif

const struct br_fields_format *const br_fields_formats[] = {
#ifdef BR_HAVE_HDF5
    &br_fields_hdf5,
#endif
    &csv, NULL};
