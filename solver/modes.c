/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/modes.h"

#include <math.h>

#include "solver/field.h"

size_t br_mode_count(struct br_elements elements, enum br_measure measure)
{
    const size_t derived = measure == BR_STRAIN_RATE;
    const size_t rod = elements.degree == 2 ? 3 : 2;
    return elements.kind == BR_AXIAL ? rod - derived : 4 - 2 * derived;
}

size_t br_measure_size(struct br_elements elements, enum br_measure measure, size_t n)
{
    const struct br_field field = {.kind = elements.kind, .n = n, .degree = elements.degree};
    const size_t modes = n * br_mode_count(elements, measure), nodal = br_field_size(&field);
    if (measure == BR_TIP)
        return 1;
    return measure == BR_STRAIN_RATE || modes > nodal ? modes : nodal;
}

void br_view_modes(struct br_view *view, size_t modes)
{
    view->layout = BR_BY_ELEMENT;
    view->modes = modes;
    view->rest = 0;
    for (size_t i = 0; i < BR_MOST_MODES; i++)
        view->scale[i] = 1;
}

void br_view_field(struct br_view *view, const struct br_field *field, enum br_measure measure)
{
    const bool axial = field->kind == BR_AXIAL;
    const double h = field->h, root = sqrt(h);
    const struct br_elements elements = {field->kind, field->degree};
    br_view_modes(view, measure == BR_TIP ? 0 : br_mode_count(elements, measure));
    if (measure == BR_TIP)
        return;
    /* u_x = (elongation + b (2 xi - 1))/h;  w_xx = (kappa0 + kappa1 (2 xi - 1))/h^2,
     * P_1 = sqrt(3) (2 xi - 1). */
    if (measure == BR_STRAIN_RATE) {
        view->scale[0] = axial ? root / h : root / (h * h);
        view->scale[1] = view->scale[0] / sqrt(3);
        return;
    }
    /* A bubble is b (P_2/6 - 1/6). The two highest modes of bending follow from the curvature:
     * P_2'' = 12 sqrt(5), P_3'' = 60 sqrt(7) (2x - 1). */
    view->layout = BR_BY_NODE;
    view->scale[0] = root / 2;
    view->scale[1] = axial ? root / (2 * sqrt(3)) : root * sqrt(3) / 5;
    view->scale[2] = axial ? root / (6 * sqrt(5)) : root / (12 * sqrt(5));
    view->scale[3] = axial ? 1 : root / (20 * sqrt(7));
}
