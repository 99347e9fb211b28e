/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/beam/fields_file.h"

#include <math.h>

#include "base/quote.h"

const struct br_field_variable br_field_variables[BR_FIELD_VARIABLES] = {
    {"u", BR_AXIAL, false},       {"u_t", BR_AXIAL, false},
    {"w", BR_BENDING, false},     {"w_slope", BR_BENDING, false},
    {"w_t", BR_BENDING, false},   {"w_t_slope", BR_BENDING, false},
    {"u_middle", BR_AXIAL, true}, {"u_t_middle", BR_AXIAL, true},
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
    for (size_t v = 0; v < br_field_variable_count(quadratic ? 2 : 1); v++)
        for (size_t i = 0; i < nodes && !br_march_models(march, br_field_variables[v].kind); i++)
            values[v * nodes + i] = NAN;
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
    br_print(out, &br_for_text, "# stopped: %s\n", message);
}

/* ---- the fields as CSV: one line for each node and time, in SI units ---- */

static void csv_head(const struct br_fields_file *f)
{
    fprintf(f->csv, "t,x");
    for (size_t v = 0; v < f->variables; v++)
        fprintf(f->csv, ",%s", br_field_variables[v].name);
    fputc('\n', f->csv);
}

static void csv_time(const struct br_fields_file *f, double time)
{
    for (size_t i = 0; i < f->nodes; i++) {
        fprintf(f->csv, "%.17g,%.17g", time, f->h * (double)i);
        for (size_t v = 0; v < f->variables; v++) {
            const double value = f->values[v * f->nodes + i];
            fprintf(f->csv, isnan(value) ? "," : ",%.17g", value); /* RFC 4180 */
        }
        fputc('\n', f->csv);
    }
}

/* ---- the fields as XDMF 3 (xdmf.org), for ParaView, VTK and meshio: the mesh, a line of cells
 * along x; then the output times. The numbers stand in the file itself. A variable that is not
 * modelled is left out. `displacement` is the vector (u, w, 0), to deform the line. A longer mesh
 * is in pieces, each from a multiple of PIECE on: libxml2, by which ParaView reads, takes no text
 * of 10 MB. ---- */

enum { PIECE = 150000 }; /* elements: at most 52 bytes a node in a text */

static void xdmf_information(FILE *out, const char *name, const char *text)
{
    br_print(out, &br_for_xml, "<Information Name=\"%s\" Value=\"%s\"/>\n", name, text);
}

/* The last node of the piece that begins at a node. */
static size_t last_node(const struct br_fields_file *f, size_t first)
{
    return f->nodes - 1 - first < PIECE ? f->nodes - 1 : first + PIECE;
}

/* The beginning of an array of `rows` lines with `columns` numbers each. */
static void xdmf_array(FILE *out, const char *type, size_t rows, int columns)
{
    fprintf(out, "<DataItem Dimensions=\"%zu", rows);
    if (columns > 1)
        fprintf(out, " %d", columns);
    fprintf(out, "\" NumberType=\"%s\" Precision=\"8\" Format=\"XML\">\n", type);
}

static void xdmf_mesh(const struct br_fields_file *f, size_t first)
{
    FILE *out = f->xdmf;
    const size_t last = last_node(f, first), count = last - first;
    fprintf(out,
            "<Grid Name=\"mesh%zu\" GridType=\"Uniform\">\n<Topology TopologyType=\"Polyline\" "
            "NumberOfElements=\"%zu\" NodesPerElement=\"2\">",
            first / PIECE + 1, count);
    xdmf_array(out, "Int", count, 2);
    for (size_t i = 0; i < count; i++)
        fprintf(out, "%zu %zu\n", i, i + 1);
    fputs("</DataItem></Topology>\n<Geometry GeometryType=\"XYZ\">", out);
    xdmf_array(out, "Float", count + 1, 3);
    for (size_t i = first; i <= last; i++)
        fprintf(out, "%.17g 0 0\n", f->h * (double)i);
    fputs("</DataItem></Geometry>\n</Grid>\n", out);
}

static void xdmf_head(const struct br_fields_file *f, const struct br_provenance *from)
{
    fputs("<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\" "
          "xmlns:xi=\"http://www.w3.org/2001/XInclude\">\n<Domain>\n",
          f->xdmf);
    xdmf_information(f->xdmf, "version", from->version);
    xdmf_information(f->xdmf, "command_line", from->command_line);
    xdmf_information(f->xdmf, "units", "SI");
    for (size_t first = 0; first < f->nodes - 1; first += PIECE)
        xdmf_mesh(f, first);
    fputs("<Grid Name=\"times\" GridType=\"Collection\" CollectionType=\"Temporal\">\n", f->xdmf);
}

static void xdmf_attribute(const struct br_fields_file *f, size_t variable, size_t first)
{
    const bool in_middle = br_field_variables[variable].in_middle;
    const size_t last = last_node(f, first);
    fprintf(f->xdmf, "<Attribute Name=\"%s\" AttributeType=\"Scalar\" Center=\"%s\">",
            br_field_variables[variable].name, in_middle ? "Cell" : "Node");
    xdmf_array(f->xdmf, "Float", last + 1 - first - in_middle, 1);
    for (size_t i = first + in_middle; i <= last; i++)
        fprintf(f->xdmf, "%.17g\n", f->values[variable * f->nodes + i]);
    fputs("</DataItem></Attribute>\n", f->xdmf);
}

static void xdmf_piece(const struct br_fields_file *f, double time, size_t first)
{
    const double *u = f->values, *w = f->values + 2 * f->nodes;
    const size_t last = last_node(f, first);
    fprintf(f->xdmf,
            "<Grid Name=\"beam\" GridType=\"Uniform\">\n<xi:include xpointer=\"xpointer("
            "//Grid[@Name='mesh%zu']/*[self::Topology or self::Geometry])\"/>\n"
            "<Time Value=\"%.17g\"/>\n"
            "<Attribute Name=\"displacement\" AttributeType=\"Vector\" Center=\"Node\">",
            first / PIECE + 1, time);
    xdmf_array(f->xdmf, "Float", last + 1 - first, 3);
    for (size_t i = first; i <= last; i++)
        fprintf(f->xdmf, "%.17g %.17g 0\n", f->scene->axial.modelled ? u[i] : 0,
                f->scene->bending.modelled ? w[i] : 0);
    fputs("</DataItem></Attribute>\n", f->xdmf);
    for (size_t v = 0; v < f->variables; v++)
        if (f->scene->field[br_field_variables[v].kind].modelled)
            xdmf_attribute(f, v, first);
    fputs("</Grid>\n", f->xdmf);
}

static void xdmf_time(const struct br_fields_file *f, double time)
{
    const bool several = f->nodes - 1 > PIECE;
    if (several)
        fprintf(f->xdmf,
                "<Grid Name=\"pieces\" GridType=\"Collection\" CollectionType=\"Spatial\">\n"
                "<Time Value=\"%.17g\"/>\n",
                time);
    for (size_t first = 0; first < f->nodes - 1; first += PIECE)
        xdmf_piece(f, time, first);
    fputs(several ? "</Grid>\n" : "", f->xdmf);
}

/* ---- both ---- */

enum br_status br_fields_begin(struct br_fields_file *f, const struct br_provenance *from,
                               struct br_error *err)
{
    f->nodes = f->n + 1;
    f->variables = br_field_variable_count(f->axial_degree);
    f->h = f->scene->length / (double)f->n;
    f->values = br_allocate((BR_FIELD_VARIABLES + 4) * f->nodes, sizeof *f->values);
    if (!f->values)
        return br_no_memory(err, "the fields");
    csv_head(f);
    xdmf_head(f, from);
    return BR_OK;
}

void br_fields_add(struct br_fields_file *f, const struct br_march *march,
                   const struct br_history_row *row)
{
    br_field_values(march, f->values, f->values + BR_FIELD_VARIABLES * f->nodes);
    csv_time(f, row->time);
    xdmf_time(f, row->time);
}

void br_fields_end(struct br_fields_file *f, const char *stopped)
{
    if (f->values) {
        if (stopped)
            br_history_csv_stopped(f->csv, stopped);
        fputs("</Grid>\n", f->xdmf);
        if (stopped)
            xdmf_information(f->xdmf, "stopped", stopped);
        fputs("</Domain>\n</Xdmf>\n", f->xdmf);
    }
    free(f->values);
    *f = (struct br_fields_file){0};
}
