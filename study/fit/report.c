/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/fit/report.h"

#include <math.h>

struct br_study *br_report_fitted(const struct br_report *r)
{
    return r->exact ? r->exact : r->study;
}

static enum br_status extrapolate_tips(struct br_report *r, struct br_error *err)
{
    struct br_tips own = {0};
    const enum br_status status = r->tips ? BR_OK : br_tips_of_study(&own, r->study, err);
    for (int kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
        r->tip[kind] = br_extrapolate(r->tips ? r->tips : &own, (enum br_field_kind)kind);
    br_tips_clear(&own);
    return status;
}

enum br_status br_report_finish(struct br_report *r, int threads, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (int part = 0; part < BR_PARTS && !status; part++)
        status = br_fit(br_report_fitted(r), (enum br_part)part, &r->fits[part], err);
    if (!status)
        status = br_report_see_orders(r, err);
    if (!status)
        status = extrapolate_tips(r, err);
    if (!status && r->exact)
        br_flag_beside(r->study);
    if (!status && r->printed)
        status = br_triangles(r->study, r->printed, BR_MOST_TRIANGLES, r->triangle, &r->triangles,
                              threads, err);
    return status;
}

void br_report_clear(struct br_report *r)
{
    for (int part = 0; part < BR_PARTS; part++)
        br_fits_clear(&r->fits[part]);
    free(r->printed);
    r->printed = NULL;
}

double br_report_ratio(const struct br_report *r, size_t cell)
{
    return r->printed ? r->study->cell[cell].error[BR_PART_TOTAL] / r->printed[cell] : NAN;
}
