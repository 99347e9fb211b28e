/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <string.h>

#include "tables/fields_file.h"

/* A file that describes; the numbers stay in HDF5. */
struct description {
    FILE *out;
    const char *heavy; /* the file of numbers, in the same folder */
    size_t looks, nodes;
};

/* The values of a variable at one time: a row of its data set. */
static void print_row(const struct description *d, const char *variable, size_t look)
{
    fprintf(d->out,
            "<DataItem ItemType=\"HyperSlab\" Dimensions=\"1 1 %zu\">"
            "<DataItem Dimensions=\"3 2\" Format=\"XML\">%zu 0 1 1 1 %zu</DataItem>"
            "<DataItem Dimensions=\"%zu %zu\" NumberType=\"Float\" Precision=\"8\" "
            "Format=\"HDF\">%s:/%s</DataItem></DataItem>",
            d->nodes, look, d->nodes, d->looks, d->nodes, d->heavy, variable);
}

static void print_look(const struct description *d, size_t look, double time, size_t variables)
{
    fprintf(d->out,
            "<Grid Name=\"beam\"><Time Value=\"%.17g\"/>\n"
            "<Topology TopologyType=\"3DRectMesh\" Dimensions=\"1 1 %zu\"/>\n"
            "<Geometry GeometryType=\"VXVYVZ\">"
            "<DataItem Dimensions=\"%zu\" NumberType=\"Float\" Precision=\"8\" "
            "Format=\"HDF\">%s:/x</DataItem>"
            "<DataItem Dimensions=\"1\" Format=\"XML\">0</DataItem>"
            "<DataItem Dimensions=\"1\" Format=\"XML\">0</DataItem></Geometry>\n",
            time, d->nodes, d->nodes, d->heavy);
    fprintf(d->out,
            "<Attribute Name=\"displacement\" AttributeType=\"Vector\" Center=\"Node\">"
            "<DataItem ItemType=\"Function\" Function=\"JOIN($0, $1, 0*$0)\" "
            "Dimensions=\"1 1 %zu 3\">",
            d->nodes);
    print_row(d, "u", look);
    print_row(d, "w", look);
    fputs("</DataItem></Attribute>\n", d->out);
    for (size_t v = 0; v < variables; v++) {
        const char *name = br_field_variables[v].name;
        fprintf(d->out, "<Attribute Name=\"%s\" AttributeType=\"Scalar\" Center=\"Node\">", name);
        print_row(d, name, look);
        fputs("</Attribute>\n", d->out);
    }
    fputs("</Grid>\n", d->out);
}

enum br_status br_fields_write_xdmf(const char *hdf5_path, const double *time, size_t looks,
                                    size_t nodes, size_t variables, struct br_error *err)
{
    char path[2048];
    const char *slash = strrchr(hdf5_path, '/');
    const char *heavy = slash ? slash + 1 : hdf5_path;
    snprintf(path, sizeof path, "%.*s.xdmf", (int)(strlen(hdf5_path) - strlen(".h5")), hdf5_path);
    const struct description d = {fopen(path, "w"), heavy, looks, nodes};
    if (!d.out)
        return br_fail(err, BR_IO, "%s: %s", path, strerror(errno));
    fputs("<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\"><Domain>\n"
          "<Grid Name=\"looks\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
          d.out);
    for (size_t look = 0; look < looks; look++)
        print_look(&d, look, time[look], variables);
    fputs("</Grid></Domain></Xdmf>\n", d.out);
    const bool failed = ferror(d.out);
    return fclose(d.out) || failed ? br_fail(err, BR_IO, "%s could not be written", path) : BR_OK;
}
