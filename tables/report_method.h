/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What all reports say of a method. */
#ifndef BR_TABLES_REPORT_METHOD_H
#define BR_TABLES_REPORT_METHOD_H

#include "solver/march.h"
#include "tables/document.h"

/* Facts for programs, each a member of the object `key`: scheme, solver and so on; null where the
 * method does not heed one. */
void br_put_method(struct br_document *d, const char *key, const struct br_method *method);

#endif
