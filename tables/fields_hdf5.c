/* SPDX-License-Identifier: GPL-3.0-or-later */
/* HDF5: x (nodes), t (times) and each variable (times, nodes), with `units` and `long_name` as
 * attributes, as CF names them; x and t are the dimension scales of the variables. The scene's
 * text, version, n, k and, for a march that stopped early, `stopped` are at the root. ParaView and
 * VisIt read the file by fields.xdmf in the same folder. */
#include <errno.h>
#include <hdf5.h>
#include <hdf5_hl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "tables/fields_file.h"

struct br_fields_file {
    char path[2048];
    hid_t file, x, t, variable[BR_FIELD_VARIABLES]; /* H5I_INVALID_HID: not open */
    hsize_t nodes, levels;
    size_t variables;
    double *work; /* values, then workspace */
    double *time; /* of the levels, s */
};

/* ---- memory ---- */

static bool without_memory; /* whether HDF5 has failed for that reason */

static herr_t check_error(unsigned depth, const H5E_error2_t *error, void *self)
{
    (void)depth, (void)self;
    without_memory |= error->min_num == H5E_NOSPACE || error->min_num == H5E_CANTALLOC;
    return 0;
}

/* Replaces the error messages of HDF5: beamrate prints its own. */
static herr_t note_error(hid_t stack, void *self)
{
    without_memory |= errno == ENOMEM;
    return H5Ewalk2(stack, H5E_WALK_UPWARD, check_error, self);
}

static void give_up(void)
{
    static const char message[] = "beamrate: out of memory: HDF5 gave up\n";
    (void)!write(STDERR_FILENO, message, sizeof message - 1);
    _exit(br_status_exit_code(BR_NO_MEMORY));
}

static void meet_signal(int number)
{
    if (without_memory || errno == ENOMEM)
        give_up();
    signal(number, SIG_DFL);
    raise(number);
}

/* HDF5 1.10 does not survive a failed allocation: it calls itself until the stack is full, follows
 * null pointers, or corrupts the heap. So the program ends there, with its own message; the next
 * command removes what stays in the folder. */
struct guard {
    stack_t stack;
    struct sigaction action[2];
};

static void guard_begin(struct guard *g)
{
    static char stack[1 << 16];
    const struct sigaction meet = {.sa_handler = meet_signal, .sa_flags = SA_ONSTACK};
    sigaltstack(&(stack_t){.ss_sp = stack, .ss_size = sizeof stack}, &g->stack);
    sigaction(SIGSEGV, &meet, &g->action[0]);
    sigaction(SIGABRT, &meet, &g->action[1]);
    errno = 0;
}

static enum br_status guard_end(const struct guard *g, enum br_status status)
{
    if (without_memory || errno == ENOMEM) /* even where HDF5 returns success */
        give_up();
    sigaction(SIGSEGV, &g->action[0], NULL);
    sigaction(SIGABRT, &g->action[1], NULL);
    sigaltstack(&g->stack, NULL);
    return status;
}

static enum br_status fail(const struct br_fields_file *f, const char *what, struct br_error *err)
{
    return br_fail(err, BR_IO, "%s: HDF5 could not write %s", f->path, what);
}

/* ---- attributes ---- */

static bool put_attribute(hid_t where, const char *name, hid_t type, hid_t type_here,
                          const void *value)
{
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate2(where, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const bool good = attribute >= 0 && H5Awrite(attribute, type_here, value) >= 0;
    if (attribute >= 0)
        H5Aclose(attribute);
    H5Sclose(space);
    return good;
}

static bool text_attribute(hid_t where, const char *name, const char *text)
{
    const hid_t type = H5Tcopy(H5T_C_S1);
    const bool good = H5Tset_size(type, strlen(text) + 1) >= 0 &&
                      H5Tset_cset(type, H5T_CSET_UTF8) >= 0 &&
                      put_attribute(where, name, type, type, text);
    H5Tclose(type);
    return good;
}

static bool number_attribute(hid_t where, const char *name, double value)
{
    return put_attribute(where, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

/* An attribute is at most 64 kB: a longer text is a data set of its name. */
static bool text_anyhow(hid_t file, const char *name, const char *text)
{
    if (strlen(text) < 60000)
        return text_attribute(file, name, text);
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, strlen(text) + 1);
    const hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const bool good = set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) >= 0;
    if (set >= 0)
        H5Dclose(set);
    H5Sclose(space);
    H5Tclose(type);
    return good;
}

/* ---- data sets ---- */

/* A data set that grows by one time with each level; nodes 0: one value for each time. */
static hid_t create_set(hid_t file, const char *name, hsize_t nodes)
{
    const int rank = nodes ? 2 : 1;
    const hsize_t size[2] = {0, nodes}, most[2] = {H5S_UNLIMITED, nodes};
    const hsize_t chunk[2] = {nodes ? 1 : 256, nodes};
    const hid_t space = H5Screate_simple(rank, size, most);
    const hid_t options = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(options, rank, chunk);
    const hid_t set =
        H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, options, H5P_DEFAULT);
    H5Pclose(options);
    H5Sclose(space);
    return set;
}

static bool append(const struct br_fields_file *f, hid_t set, hsize_t nodes, const double *values)
{
    const int rank = nodes ? 2 : 1;
    const hsize_t size[2] = {f->levels + 1, nodes}, start[2] = {f->levels}, count[2] = {1, nodes};
    if (H5Dset_extent(set, size) < 0)
        return false;
    const hid_t target = H5Dget_space(set), memory = H5Screate_simple(rank, count, NULL);
    const bool good = H5Sselect_hyperslab(target, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
                      H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, target, H5P_DEFAULT, values) >= 0;
    H5Sclose(memory);
    H5Sclose(target);
    return good;
}

static bool write_x(struct br_fields_file *f, double h)
{
    for (hsize_t i = 0; i < f->nodes; i++)
        f->work[i] = h * (double)i;
    const hid_t space = H5Screate_simple(1, &f->nodes, NULL);
    f->x = H5Dcreate2(f->file, "x", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const bool good =
        f->x >= 0 &&
        H5Dwrite(f->x, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, f->work) >= 0 &&
        text_attribute(f->x, "units", "m") && text_attribute(f->x, "long_name", "nodes") &&
        H5DSset_scale(f->x, "x") >= 0;
    H5Sclose(space);
    return good;
}

static bool create_sets(struct br_fields_file *f)
{
    f->t = create_set(f->file, "t", 0);
    bool good = f->t >= 0 && text_attribute(f->t, "units", "s") &&
                text_attribute(f->t, "long_name", "output times") && H5DSset_scale(f->t, "t") >= 0;
    for (size_t v = 0; v < f->variables && good; v++) {
        const struct br_field_variable *variable = &br_field_variables[v];
        f->variable[v] = create_set(f->file, variable->name, f->nodes);
        good = f->variable[v] >= 0 && text_attribute(f->variable[v], "units", variable->unit) &&
               text_attribute(f->variable[v], "long_name", variable->meaning) &&
               H5DSattach_scale(f->variable[v], f->t, 0) >= 0 &&
               H5DSattach_scale(f->variable[v], f->x, 1) >= 0;
    }
    return good;
}

static bool describe(const struct br_fields_file *f, const struct br_fields_request *q)
{
    const struct br_provenance *p = q->provenance;
    return text_attribute(f->file, "program", "beamrate") &&
           text_attribute(f->file, "version", p->version) &&
           text_attribute(f->file, "commit", p->commit) &&
           text_anyhow(f->file, "command_line", p->command_line) &&
           text_attribute(f->file, "scene_name", q->scene->name) &&
           number_attribute(f->file, "n", (double)q->n) &&
           number_attribute(f->file, "k", q->scene->duration / (double)q->steps) &&
           text_anyhow(f->file, "scene", p->scene_text);
}

/* ---- XDMF 2 (xdmf.org), for ParaView and VisIt ---- */

/* The nodes are a line along x; each variable is a number at the nodes, and `displacement` is the
 * vector (u, w, 0), to deform the line. */

/* The file of the description; the numbers stay in HDF5. */
struct description {
    FILE *out;
    const char *heavy; /* the file of numbers, in the same folder */
    size_t levels, nodes;
};

/* The values of a variable at one time: a row of its data set. */
static void print_row(const struct description *d, const char *variable, size_t level)
{
    fprintf(d->out,
            "<DataItem ItemType=\"HyperSlab\" Dimensions=\"1 1 %zu\">"
            "<DataItem Dimensions=\"3 2\" Format=\"XML\">%zu 0 1 1 1 %zu</DataItem>"
            "<DataItem Dimensions=\"%zu %zu\" NumberType=\"Float\" Precision=\"8\" "
            "Format=\"HDF\">%s:/%s</DataItem></DataItem>",
            d->nodes, level, d->nodes, d->levels, d->nodes, d->heavy, variable);
}

static void print_level(const struct description *d, size_t level, double time, size_t variables)
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
    print_row(d, "u", level);
    print_row(d, "w", level);
    fputs("</DataItem></Attribute>\n", d->out);
    for (size_t v = 0; v < variables; v++) {
        const char *name = br_field_variables[v].name;
        fprintf(d->out, "<Attribute Name=\"%s\" AttributeType=\"Scalar\" Center=\"Node\">", name);
        print_row(d, name, level);
        fputs("</Attribute>\n", d->out);
    }
    fputs("</Grid>\n", d->out);
}

static enum br_status write_xdmf(const struct br_fields_file *f, struct br_error *err)
{
    char path[2048];
    const char *slash = strrchr(f->path, '/');
    const char *heavy = slash ? slash + 1 : f->path;
    snprintf(path, sizeof path, "%.*s.xdmf", (int)(strlen(f->path) - strlen(".h5")), f->path);
    const struct description d = {fopen(path, "w"), heavy, f->levels, f->nodes};
    if (!d.out)
        return br_fail(err, BR_IO, "%s: %s", path, strerror(errno));
    fputs("<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\"><Domain>\n"
          "<Grid Name=\"looks\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
          d.out);
    for (size_t level = 0; level < d.levels; level++)
        print_level(&d, level, f->time[level], f->variables);
    fputs("</Grid></Domain></Xdmf>\n", d.out);
    const bool failed = ferror(d.out);
    return fclose(d.out) || failed ? br_fail(err, BR_IO, "%s could not be written", path) : BR_OK;
}

/* ---- the format ---- */

static enum br_status create_file(struct br_fields_file *f, const struct br_fields_request *q,
                                  struct br_error *err)
{
    H5dont_atexit(); /* where a file could not be closed, HDF5 1.10 crashes at exit */
    if (H5Eset_auto2(H5E_DEFAULT, note_error, NULL) < 0) {
        without_memory |= errno == ENOMEM;
        return fail(f, "anything", err);
    }
    f->file = H5Fcreate(q->path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    if (f->file < 0)
        return fail(f, "the file", err);
    if (!describe(f, q))
        return fail(f, "the attributes", err);
    if (!write_x(f, q->scene->length / (double)q->n) || !create_sets(f))
        return fail(f, "the data sets", err);
    return BR_OK;
}

static enum br_status open_hdf5(struct br_fields_file **out, const struct br_fields_request *q,
                                struct br_error *err)
{
    struct br_fields_file *f = *out = br_allocate(1, sizeof *f);
    if (!f)
        return br_no_memory(err, "the fields' file");
    snprintf(f->path, sizeof f->path, "%s", q->path);
    f->file = f->x = f->t = H5I_INVALID_HID;
    for (int v = 0; v < BR_FIELD_VARIABLES; v++)
        f->variable[v] = H5I_INVALID_HID;
    f->nodes = q->n + 1;
    f->variables = br_field_variable_count(q->axial_degree);
    f->work = br_allocate((size_t)(BR_FIELD_VARIABLES + 4) * f->nodes, sizeof *f->work);
    f->time = br_allocate(q->levels, sizeof *f->time);
    if (!f->work || !f->time)
        return br_no_memory(err, "the fields' file");
    struct guard guard;
    guard_begin(&guard);
    return guard_end(&guard, create_file(f, q, err));
}

static enum br_status append_all(struct br_fields_file *f, double time, struct br_error *err)
{
    if (!append(f, f->t, 0, &time))
        return fail(f, "t", err);
    for (size_t v = 0; v < f->variables; v++)
        if (!append(f, f->variable[v], f->nodes, f->work + v * f->nodes))
            return fail(f, br_field_variables[v].name, err);
    f->time[f->levels++] = time;
    return BR_OK;
}

static enum br_status append_hdf5(struct br_fields_file *f, const struct br_march *march,
                                  const struct br_history_row *row, struct br_error *err)
{
    struct guard guard;
    br_field_values(march, f->work, f->work + BR_FIELD_VARIABLES * f->nodes);
    guard_begin(&guard);
    return guard_end(&guard, append_all(f, row->time, err));
}

static enum br_status close_hdf5(struct br_fields_file *f, const char *stopped,
                                 struct br_error *err)
{
    if (!f)
        return BR_OK;
    bool good = true;
    struct guard guard;
    guard_begin(&guard);
    if (stopped && f->file >= 0)
        good = text_attribute(f->file, "stopped", stopped);
    for (int v = 0; v < BR_FIELD_VARIABLES; v++)
        if (f->variable[v] >= 0)
            good = H5Dclose(f->variable[v]) >= 0 && good;
    if (f->x >= 0)
        good = H5Dclose(f->x) >= 0 && good;
    if (f->t >= 0)
        good = H5Dclose(f->t) >= 0 && good;
    if (f->file >= 0)
        good = H5Fclose(f->file) >= 0 && good;
    enum br_status status = guard_end(&guard, good ? BR_OK : fail(f, "the file whole", err));
    if (!status && f->levels > 0)
        status = write_xdmf(f, err);
    free(f->time);
    free(f->work);
    free(f);
    return status;
}

extern const struct br_fields_format br_fields_hdf5;
const struct br_fields_format br_fields_hdf5 = {
    .name = "hdf5",
    .file_name = "fields.h5",
    .title = "HDF5, for Python, Octave, Julia and the like",
    .open = open_hdf5,
    .append = append_hdf5,
    .close = close_hdf5,
};
