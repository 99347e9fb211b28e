/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/fields_file.h"

#include <math.h>

extern const struct br_fields_format br_fields_csv;
#ifdef BR_HAVE_HDF5
extern const struct br_fields_format br_fields_hdf5;
#endif

const struct br_fields_format *const br_fields_formats[] = {
#ifdef BR_HAVE_HDF5
    &br_fields_hdf5,
#endif
    &br_fields_csv, NULL};

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

/* The nodes' values and, of quadratic elements, those in their middles (else NULL). */
static void axial_values(const double *nodal, size_t nodes, double *at_node, double *middle)
{
    const size_t unknowns = middle ? 2 : 1;
    for (size_t i = 0; i < nodes; i++)
        at_node[i] = nodal[i * unknowns];
    for (size_t i = 0; i < nodes && middle; i++)
        middle[i] = i == 0 ? NAN : (at_node[i - 1] + at_node[i]) / 2 - nodal[2 * i + 1] / 4;
}

/* No number, for `count` variables. */
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
