/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/sight.h"

#include <math.h>
#include <string.h>

/* ---- lists ---- */

void br_list_free(struct br_list *list)
{
    free(list->at);
    *list = (struct br_list){0};
}

enum br_status br_list_add(struct br_list *list, double value, struct br_error *err)
{
    if (list->count == list->room) {
        const size_t room = 2 * list->room + 32;
        double *bigger = br_allocate(room, sizeof *bigger);
        if (!bigger)
            return br_no_memory(err, "a mesh");
        if (list->count)
            memcpy(bigger, list->at, list->count * sizeof *bigger);
        free(list->at);
        list->at = bigger;
        list->room = room;
    }
    list->at[list->count++] = value;
    return BR_OK;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void br_list_sort(struct br_list *list, double least)
{
    size_t kept = 0;
    if (list->count)
        qsort(list->at, list->count, sizeof *list->at, ascending);
    for (size_t i = 0; i < list->count; i++)
        if (!kept || list->at[i] - list->at[kept - 1] > least)
            list->at[kept++] = list->at[i];
    list->count = kept;
}

/* ---- one variable ---- */

static double magnitude(struct br_interval v)
{
    return fmax(fabs(v.low), fabs(v.high));
}

static struct br_interval *side(struct br_box *box, enum br_variable along)
{
    return along == BR_X ? &box->x : &box->t;
}

enum br_fit br_sight_fit(const struct br_function *f, enum br_variable along, struct br_box box,
                         size_t degree, double size)
{
    struct br_interval coefficient[17];
    const struct br_interval here = *side(&box, along);
    if (!br_function_taylor(f, along, box, degree + 1, coefficient))
        return BR_NOT_SMOOTH;
    const double error = 2 * magnitude(coefficient[degree + 1]) *
                         pow((here.high - here.low) / 4, (double)degree + 1);
    return error <= BR_SIGHT_TOLERANCE * size ? BR_FITS : BR_TOO_WIDE;
}

/* A part is meshed anew where the function is smaller than its scale by this factor. */
static const double much_smaller = 1.0 / 64;

struct survey {
    const struct br_function *f;
    enum br_variable along;
    const struct br_sight *sight;
    double mean; /* of |f| over the whole box, an upper bound; infinite while it is not known */
    struct br_list *ends;
    double missed;
};

/* The largest |f| in the cells first to last - 1. */
static double largest_in(const struct survey *s, struct br_box box, const struct br_mesh *mesh,
                         size_t first, size_t last)
{
    double largest = 0;
    for (size_t i = first; i < last; i++) {
        struct br_interval value;
        *side(&box, s->along) = (struct br_interval){mesh->at[i], mesh->at[i + 1]};
        if (!br_function_bound(s->f, box, &value))
            return INFINITY;
        largest = fmax(largest, magnitude(value));
    }
    return largest;
}

static double mean_of(const struct survey *s, struct br_box box, const struct br_mesh *mesh)
{
    double sum = 0;
    for (size_t i = 0; i < mesh->count; i++)
        sum += (mesh->at[i + 1] - mesh->at[i]) * largest_in(s, box, mesh, i, i + 1);
    return sum / (mesh->at[mesh->count] - mesh->at[0]);
}

static enum br_status mesh_part(struct survey *s, struct br_box box, double scale,
                                struct br_error *err);

/* The cells that need no closer look, and those that do together. */
static enum br_status take_cells(struct survey *s, struct br_box box, const struct br_mesh *mesh,
                                 double scale, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0, j; i < mesh->count && !status; i = j) {
        double largest = 0, next;
        for (j = i; j < mesh->count; j++, largest = fmax(largest, next))
            if (!((next = largest_in(s, box, mesh, j, j + 1)) < much_smaller * scale))
                break;
        largest = fmax(largest, s->mean);
        if (j > i && largest < much_smaller * scale) {
            *side(&box, s->along) = (struct br_interval){mesh->at[i], mesh->at[j]};
            status = mesh_part(s, box, largest, err);
            continue;
        }
        j += j == i;
        for (size_t k = i; k < j && !status; k++)
            status = br_list_add(s->ends, mesh->at[k + 1], err);
    }
    return status;
}

static enum br_status mesh_part(struct survey *s, struct br_box box, double scale,
                                struct br_error *err)
{
    const struct br_resolution resolution = {s->sight->degree, BR_SIGHT_TOLERANCE * scale,
                                             s->sight->least, s->sight->most};
    struct br_mesh mesh = {0};
    enum br_status status = br_resolve(s->f, s->along, box, &resolution, &mesh, err);
    if (!status && isinf(s->mean))
        s->mean = mean_of(s, box, &mesh);
    if (!status)
        status = take_cells(s, box, &mesh, scale, err);
    s->missed += status ? 0 : mesh.missed;
    br_mesh_free(&mesh);
    return status;
}

enum br_status br_sight_along(const struct br_function *f, enum br_variable along,
                              struct br_box box, const struct br_sight *sight, struct br_list *ends,
                              double *missed, struct br_error *err)
{
    struct survey s = {f, along, sight, INFINITY, ends, 0};
    const struct br_interval whole = *side(&box, along);
    struct br_interval value = {f->constant, f->constant};
    struct br_box where;
    *missed = 0;
    enum br_status status = br_list_add(ends, whole.low, err);
    if (!status)
        status = br_list_add(ends, whole.high, err);
    if (status || !f->ops || !f->ops->bound)
        return status;
    if (br_prove_bounded(f, box, 0, &value, &where) != BR_FINITE)
        return br_must_be_finite(f, box, err);
    if (!(magnitude(value) > 0))
        return BR_OK;
    status = mesh_part(&s, box, magnitude(value), err);
    *missed = s.mean > 0 ? s.missed / (s.mean * (whole.high - whole.low)) : 0;
    return status;
}
