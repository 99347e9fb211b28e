/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene_scan.h"

#include <math.h>

enum { ALONG_ONE = 1024, ALONG_BOTH = 64 };

static enum br_status refuse(const struct br_function *f, double value, double x, double t,
                             struct br_error *err)
{
    if (f->uses_x && f->uses_t)
        return br_fail(err, BR_BAD_INPUT,
                       "found %g at x = %.10g m, t = %.10g s, expected a finite number everywhere "
                       "in [0, L] and [0, T]",
                       value, x, t);
    if (f->uses_x)
        return br_fail(err, BR_BAD_INPUT,
                       "found %g at x = %.10g m, expected a finite number everywhere in [0, L]",
                       value, x);
    return br_fail(err, BR_BAD_INPUT,
                   "found %g at t = %.10g s, expected a finite number everywhere in [0, T]", value,
                   t);
}

static enum br_status scan(const struct br_scene *s, const struct br_function *f,
                           struct br_error *err)
{
    if (!f->ops)
        return BR_OK; /* br_expression has looked */
    const int most = f->uses_x && f->uses_t ? ALONG_BOTH : ALONG_ONE;
    const int places = f->uses_x ? most : 0, times = f->uses_t ? most : 0;
    for (int j = 0; j <= times; j++)
        for (int i = 0; i <= places; i++) {
            const double x = places ? s->length * i / places : 0;
            const double t = times ? s->duration * j / times : 0;
            double value;
            br_function_evaluate(f, 1, &x, t, &value);
            if (!isfinite(value)) /* not "-nan" */
                return refuse(f, isnan(value) ? NAN : value, x, t, err);
        }
    return BR_OK;
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
    const enum br_status status = scan(scene, &load->space, err);
    return status ? status : scan(scene, &load->time, err);
}
