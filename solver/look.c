/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/look.h"

void br_look(const struct br_march *march, enum br_field_kind kind, enum br_measure measure,
             struct br_view *view)
{
    br_view_field(view, br_march_field(march, kind), measure);
    switch (measure) {
    case BR_DISPLACEMENT:
        br_march_get(march, kind, view->values, NULL);
        return;
    case BR_VELOCITY:
        br_march_get(march, kind, NULL, view->values);
        return;
    case BR_STRAIN_RATE:
        br_march_strain_rate(march, kind, view->values);
        return;
    case BR_TIP:
    case BR_MEASURES:
        break;
    }
    *view->values = br_march_tip_displacement(march, kind);
}
