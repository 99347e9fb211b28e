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
    {"u", "m", "axial displacement"},   {"u_t", "m/s", "axial velocity"},
    {"w", "m", "bending displacement"}, {"w_slope", "1", "slope w_x of the bending displacement"},
    {"w_t", "m/s", "bending velocity"}, {"w_t_slope", "1/s", "slope of the bending velocity"},
};

void br_field_values(const struct br_march *march, double *values, double *work)
{
    const struct br_field *field = br_march_field(march, BR_BENDING);
    const size_t nodes = field->n + 1;
    double *const displacement = work, *const velocity = work + 2 * nodes;
    br_march_get(march, BR_AXIAL, displacement, velocity);
    const size_t unknowns = br_field_unknowns(br_march_field(march, BR_AXIAL));
    for (size_t i = 0; i < nodes; i++) {
        values[i] = displacement[i * unknowns];
        values[nodes + i] = velocity[i * unknowns];
    }
    br_march_get(march, BR_BENDING, displacement, velocity);
    for (size_t i = 0; i < nodes; i++) {
        values[2 * nodes + i] = displacement[2 * i];
        values[3 * nodes + i] = displacement[2 * i + 1] / field->h;
        values[4 * nodes + i] = velocity[2 * i];
        values[5 * nodes + i] = velocity[2 * i + 1] / field->h;
    }
    const bool marched[2] = {br_march_models(march, BR_AXIAL), br_march_models(march, BR_BENDING)};
    for (size_t i = 0; i < BR_FIELD_VARIABLES * nodes; i++)
        if (!marched[i < 2 * nodes ? BR_AXIAL : BR_BENDING])
            values[i] = NAN;
}
