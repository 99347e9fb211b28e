/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene_scan.h"

#include "solver/proof.h"

static enum br_status scan(const struct br_scene *s, const struct br_function *f,
                           struct br_error *err)
{
    const struct br_box box = {{0, s->length}, {0, s->duration}};
    struct br_error inner;
    const enum br_status status = br_must_be_finite(f, box, &inner);
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
