/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Instead of all of reference/mms where GNU libmatheval is missing. */
#include "reference/mms/manufactured.h"

enum br_status br_manufactured_apply(struct br_scene *s, const struct br_function parsed[2],
                                     enum br_field_kind *culprit, struct br_error *err)
{
    (void)parsed;
    *culprit = s->axial.solution ? BR_AXIAL : BR_BENDING;
    if (!s->axial.solution && !s->bending.solution)
        return BR_OK;
    return br_fail(err, BR_UNSUPPORTED,
                   "a manufactured solution needs GNU libmatheval; this program was built without "
                   "libmatheval");
}
