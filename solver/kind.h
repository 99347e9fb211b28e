/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The two fields of a scene. */
#ifndef BR_SOLVER_KIND_H
#define BR_SOLVER_KIND_H

enum br_field_kind { BR_AXIAL, BR_BENDING, BR_FIELDS };
extern const char *const br_field_names[BR_FIELDS]; /* "axial", "bending" */

#endif
