/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/scan.h"

#include <math.h>

#include "solver/proof.h"

static double value_at(const struct br_function *f, double at)
{
    double value;
    br_function_evaluate(f, 1, &at, at, &value);
    return value;
}

/* By how much a value at a place may differ from those beside it, one number farther: by a jump,
 * and, where the function bends or is zero, by round-off of its values nearby. */
static double usual_difference(const struct br_function *f, const struct br_interval *place,
                               struct br_interval all)
{
    const double near = 1e-9 * (all.high - all.low);
    const double before = value_at(f, nextafter(place->low, -INFINITY));
    const double after = value_at(f, nextafter(place->high, INFINITY));
    const double size = fabs(value_at(f, fmax(all.low, place->low - near))) +
                        fabs(value_at(f, fmin(all.high, place->high + near)));
    return 1e-6 * (fabs(before) + fabs(after) + size) + 4 * fabs(after - before);
}

/* A value that a function of x or of t has at one place alone, as t == 0.5 ? 1 : 0 has: no integral
 * sees it, but a time level or a node may. */
static enum br_status refuse_single_values(const struct br_function *f, enum br_variable along,
                                           struct br_box box, struct br_error *err)
{
    struct br_breaks breaks = {0};
    struct br_error failure;
    enum br_status status = br_breaks_add(f, along, box, &breaks, &failure);
    if (status == BR_NO_MEMORY)
        br_fail(err, status, "%s", failure.message);
    else
        status = BR_OK; /* too many: each user of the function tells */
    for (size_t i = 0; i < breaks.count && !status; i++) {
        const double places[] = {breaks.at[i].low, breaks.at[i].high};
        const double before = value_at(f, nextafter(places[0], -INFINITY));
        const double usual = usual_difference(f, &breaks.at[i], along == BR_X ? box.x : box.t);
        for (size_t k = 0; k < 2 && !status; k++)
            if (!(fabs(value_at(f, places[k]) - before) <= usual))
                status =
                    br_fail(err, BR_BAD_INPUT, "found %g at %s = %.17g %s alone, and %g beside it",
                            value_at(f, places[k]), along == BR_X ? "x" : "t", places[k],
                            along == BR_X ? "m" : "s", before);
    }
    br_breaks_free(&breaks);
    return status;
}

static enum br_status scan(const struct br_scene *s, const struct br_function *f,
                           struct br_error *err)
{
    const struct br_box box = {{0, s->length}, {0, s->duration}};
    struct br_error inner;
    enum br_status status = br_must_be_finite(f, box, &inner);
    if (!status && f->uses_x != f->uses_t && br_function_guard(f, 0))
        status = refuse_single_values(f, f->uses_x ? BR_X : BR_T, box, &inner);
    if (!status)
        return BR_OK;
    return br_fail(err, status, "%.500s, expected a finite number everywhere in %s", inner.message,
                   !f->uses_t   ? "[0, L]"
                   : !f->uses_x ? "[0, T]"
                                : "[0, L] and [0, T]");
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
