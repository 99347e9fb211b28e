/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/look.h"

void br_look(const struct br_march *march, enum br_field_kind kind, enum br_measure measure,
             double *work, double *values)
{
    const struct br_field *field = br_march_field(march, kind);
    switch (measure) {
    case BR_DISPLACEMENT:
        br_march_get(march, kind, work, NULL);
        br_modes(field, work, values);
        return;
    case BR_VELOCITY:
        br_march_get(march, kind, NULL, work);
        br_modes(field, work, values);
        return;
    case BR_STRAIN_RATE:
        br_march_strain_rate(march, kind, work);
        br_strain_modes(field, work, values);
        return;
    case BR_TIP:
    case BR_MEASURES:
        break;
    }
    *values = br_march_tip_displacement(march, kind);
}
