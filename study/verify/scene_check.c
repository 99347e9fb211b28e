/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a check says of its scene: the settings of its studies, and its default expectations as the
 * scene's file would state them. */
#include <stdio.h>

#include "base/text.h"
#include "solver/scene.h"
#include "study/scene/method_fields.h"
#include "study/verify/check.h"

static void write_cells(FILE *out, const struct br_scene *scene, const struct br_verify_study *v)
{
    const size_t last = v->count - 1;
    for (size_t i = 0; i < (v->n[last] != v->n[0] ? v->count : 1); i++)
        fprintf(out, i ? ", %zu" : "    n: %zu", v->n[i]);
    for (size_t i = 0; i < (v->steps[last] != v->steps[0] ? v->count : 1); i++)
        fprintf(out, i ? ", %.10g" : "\n    k: %.10g", br_time_step(scene, v->steps[i]));
    fputs(" s\n", out);
}

static void write_expectation(FILE *out, const struct br_verify_expectation *expected)
{
    const struct br_expectation *e = &expected->band;
    char text[BR_EXPECTATION_TEXT];
    fprintf(out, "    %s%s%s: %s", expected->norm->name, expected->part ? " " : "",
            expected->part ? br_part_names[expected->part] : "", br_expectation_text(e, text));
    if (*e->why)
        fprintf(out, "  # %s", e->why);
    fputc('\n', out);
}

static void write_study(FILE *out, const struct br_scene *scene, const char *name,
                        const struct br_verify_study *v)
{
    if (*v->silent)
        fprintf(out, "  # %s: theory states no order of the %s.\n", name, v->silent);
    if (!v->count)
        return;
    fprintf(out, "  %s:\n", name);
    write_cells(out, scene, v);
    for (size_t i = 0; i < v->expectations; i++)
        write_expectation(out, &v->expectation[i]);
}

static enum br_status write_defaults(struct br_scene_check *c, struct br_error *err)
{
    size_t size;
    FILE *out = br_text_open(&c->defaults, &size);
    if (!out)
        return br_no_memory(err, "the default expectations");
    fputs("verify:\n", out);
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
        write_study(out, c->scene, br_verify_names[kind], &c->verify->study[kind]);
    return fclose(out) == 0 ? BR_OK : br_no_memory(err, "the default expectations");
}

enum br_status br_scene_check_begin(struct br_scene_check *c, const char *path,
                                    struct br_error *err)
{
    if (c->verify->by_default && write_defaults(c, err))
        return err->status;
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        const struct br_verify_study *v = &c->verify->study[kind];
        if (v->count)
            br_method_settings(&(struct br_meshes){c->scene, v->n, v->count}, &v->method,
                               &c->method[kind]);
    }
    *c->check = (struct br_check){.path = path,
                                  .name = c->scene->name,
                                  .data = c->verify->data,
                                  .defaults = c->defaults,
                                  .method = c->method};
    return BR_OK;
}

void br_scene_check_clear(struct br_scene_check *c)
{
    free(c->defaults);
    c->defaults = NULL;
}
