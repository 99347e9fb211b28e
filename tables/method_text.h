/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A method in words. */
#ifndef BR_TABLES_METHOD_TEXT_H
#define BR_TABLES_METHOD_TEXT_H

#include "solver/march.h"

enum { BR_METHOD_TEXT = 320 };

/* "scheme euler, solver riccati on avx2, contact lagged, friction none": what the scene does not
 * model is "none"; what the rows do not heed is left out, and so are axial elements of degree 1. */
const char *br_method_text(const struct br_scene *scene, const struct br_method *method,
                           char text[BR_METHOD_TEXT]);

#endif
