/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene_scan.h"

#include <math.h>
#include <stdio.h>

#include "study/pole.h"

enum { ALONG_ONE = 1024, ALONG_BOTH = 64 };

/* "found inf", or "grows without bounds", and where. */
static enum br_status refuse(const struct br_line *l, double at, double value, struct br_error *err)
{
    const struct br_function *f = l->function;
    const double x = l->along_x ? at : l->other, t = l->along_x ? l->other : at;
    char found[80], place[80];
    if (isfinite(value))
        snprintf(found, sizeof found, "it has a pole: found %g", value);
    else /* not "-nan" */
        snprintf(found, sizeof found, "found %g", isnan(value) ? NAN : value);
    if (f->uses_x && f->uses_t)
        snprintf(place, sizeof place, "x = %.10g m, t = %.10g s", x, t);
    else
        snprintf(place, sizeof place, f->uses_x ? "x = %.10g m" : "t = %.10g s", at);
    return br_fail(err, BR_BAD_INPUT, "%s at %s, expected a finite number everywhere in %s", found,
                   place,
                   !f->uses_t   ? "[0, L]"
                   : !f->uses_x ? "[0, T]"
                                : "[0, L] and [0, T]");
}

/* Lines along one of both, at equidistant places of the other. */
static enum br_status scan_lines(struct br_line line, double other_end, size_t lines, size_t parts,
                                 struct br_error *err)
{
    for (size_t i = 0; i <= lines; i++) {
        double at, value;
        line.other = lines ? other_end * (double)i / (double)lines : 0;
        if (br_find_pole(&line, parts, &at, &value))
            return refuse(&line, at, value, err);
    }
    return BR_OK;
}

static enum br_status scan(const struct br_scene *s, const struct br_function *f,
                           struct br_error *err)
{
    if (!f->ops)
        return BR_OK; /* br_expression has looked */
    const struct br_line in_x = {f, true, 0, s->length}, in_t = {f, false, 0, s->duration};
    const bool both = f->uses_x && f->uses_t;
    const size_t parts = both ? ALONG_BOTH : ALONG_ONE, lines = both ? ALONG_BOTH : 0;
    const enum br_status status =
        f->uses_x ? scan_lines(in_x, s->duration, lines, parts, err) : BR_OK;
    return status || !f->uses_t ? status : scan_lines(in_t, s->length, lines, parts, err);
}

enum br_status br_scene_scan(const struct br_scene *scene, const struct br_scene_key *key,
                             struct br_error *err)
{
    const void *at = (const char *)scene + key->offset;
    if (key->kind == BR_KEY_INITIAL || key->kind == BR_KEY_HISTORY)
        return scan(scene, at, err);
    if (key->kind != BR_KEY_LOAD)
        return BR_OK;
    const struct br_load *load = at;
    enum br_status status = BR_OK;
    for (size_t i = 0; i < BR_LOAD_TERMS && !status; i++) {
        status = scan(scene, &load->term[i].space, err);
        if (!status)
            status = scan(scene, &load->term[i].time, err);
    }
    return status;
}
