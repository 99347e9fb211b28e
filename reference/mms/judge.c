/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The given solution of a scene as a judge. */
#include <math.h>
#include <string.h>
#include <time.h>

#include "reference/judge.h"
#include "reference/mms/projection.h"
#include "solver/modes.h"

struct mms_judge {
    struct br_projection **projection[2]; /* by br_field_kind, then by mesh */
    char *solution[2];                    /* NULL: not modelled */
    size_t meshes, levels;
    double duration; /* s */
    double time;     /* s */
    double tail[2];  /* the largest of br_projection_rest, m^3 */
    double seconds;
};

static double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void mms_free(void *self)
{
    struct mms_judge *j = self;
    if (!j)
        return;
    for (int kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        for (size_t i = 0; j->projection[kind] && i < j->meshes; i++)
            br_projection_free(j->projection[kind][i]);
        free(j->projection[kind]);
        free(j->solution[kind]);
    }
    free(j);
}

static enum br_status create_part(struct mms_judge *j, enum br_field_kind kind,
                                  const struct br_judge_request *r, struct br_error *err)
{
    const char *text = kind == BR_AXIAL ? r->scene->axial.solution : r->scene->bending.solution;
    if (!text)
        return BR_OK;
    j->solution[kind] = br_allocate(strlen(text) + 1, 1);
    j->projection[kind] = br_allocate(r->mesh_count, sizeof(struct br_projection *));
    if (!j->solution[kind] || !j->projection[kind])
        return br_no_memory(err, "the manufactured solution");
    strcpy(j->solution[kind], text);
    const struct br_projected what = {.order = {0, 0}, .kept = br_mode_count(kind)};
    enum br_status status = BR_OK;
    for (size_t i = 0; i < r->mesh_count && !status; i++) {
        const struct br_projection_mesh mesh = {r->scene->length, r->mesh[i]};
        status = br_projection_create(&j->projection[kind][i], text, &what, &mesh, err);
    }
    return status;
}

static enum br_status mms_create(void **self, const struct br_judge_request *r,
                                 struct br_error *err)
{
    const struct br_scene *scene = r->scene;
    *self = NULL;
    if ((scene->axial.modelled && !scene->axial.solution) ||
        (scene->bending.modelled && !scene->bending.solution))
        return br_fail(err, BR_BAD_INPUT,
                       "--reference mms needs a scene with a manufactured solution: keys "
                       "'solution' in axial and bending");
    struct mms_judge *j = br_allocate(1, sizeof *j);
    *self = j;
    if (!j)
        return br_no_memory(err, "the manufactured solution");
    j->meshes = r->mesh_count;
    j->levels = r->levels;
    j->duration = scene->duration;
    const enum br_status status = create_part(j, BR_AXIAL, r, err);
    return status ? status : create_part(j, BR_BENDING, r, err);
}

static enum br_status mms_advance(void *self, size_t i, struct br_error *err)
{
    struct mms_judge *j = self;
    (void)err;
    j->time = j->duration * (double)i / (double)j->levels;
    return BR_OK;
}

static void mms_look(void *self, enum br_field_kind kind, size_t mesh, double *modes, double *rest)
{
    struct mms_judge *j = self;
    const double start = seconds_now();
    const struct br_projection_rest sums =
        br_projection_apply(j->projection[kind][mesh], j->time, modes);
    *rest = sums.rest;
    j->tail[kind] = fmax(j->tail[kind], sums.tail);
    j->seconds += seconds_now() - start;
}

/* The modes fall quickly: what lies beyond the last ones is no larger than they are. */
static struct br_judge_report mms_report(const void *self)
{
    const struct mms_judge *j = self;
    return (struct br_judge_report){
        .own_error = {sqrt(j->tail[BR_AXIAL]), sqrt(j->tail[BR_BENDING])},
        .seconds = j->seconds,
    };
}

static void mms_tell(const void *self, FILE *out)
{
    const struct mms_judge *j = self;
    const char *u = j->solution[BR_AXIAL], *w = j->solution[BR_BENDING];
    fprintf(out, "Manufactured solution: %s%s%s%s%s.\n", u ? "u = " : "", u ? u : "",
            u && w ? ", " : "", w ? "w = " : "", w ? w : "");
}

const struct br_judge br_judge_mms = {
    .name = "mms",
    .syntax = "mms",
    .title = "the solution that a scene was manufactured from",
    .citation = "Roache 2002; derivatives by GNU libmatheval, checked by quadrature",
    .create = mms_create,
    .free = mms_free,
    .advance = mms_advance,
    .look = mms_look,
    .report = mms_report,
    .tell = mms_tell,
};
