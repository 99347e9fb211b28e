/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What all reports say of a method. */
#ifndef BR_TABLES_REPORT_METHOD_H
#define BR_TABLES_REPORT_METHOD_H

#include "study/scene/method_fields.h"
#include "tables/document.h"

/* A field's value; nothing where the method does not heed it. text (out): where it is a text. */
struct br_value br_method_value(const struct br_method_field *field, const struct br_method *method,
                                char text[BR_METHOD_VALUE]);

/* Facts for programs, each a member of the object `key`: scheme, solver and so on; null where the
 * method does not heed one. */
void br_put_method(struct br_document *d, const char *key, const struct br_method *method);

#endif
