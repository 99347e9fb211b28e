/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Everything, for programs, by jansson; a number that is not there is null. */
#include <jansson.h>
#include <math.h>
#include <string.h>

#include "tables/json_value.h"
#include "tables/sentences.h"

static json_t *resolution(const struct br_scene *scene, struct br_resolution at)
{
    return json_pack("{s:I, s:o, s:I, s:o}", "n", (json_int_t)at.n, "h",
                     br_json_number(br_mesh_size(scene, at.n)), "steps", (json_int_t)at.steps, "k",
                     br_json_number(br_time_step(scene, at.steps)));
}

static json_t *cell(const struct br_report *r, size_t index)
{
    const struct br_cell *c = &r->study->cell[index];
    json_t *o = resolution(r->study->scene, c->at);
    static const char *const names[] = {"error", "axial", "bending"};
    for (int part = 0; part < BR_PARTS; part++)
        json_object_set_new(o, names[part], br_json_number(c->error[part]));
    json_object_set_new(o, "printed", br_json_number(r->printed ? r->printed[index] : NAN));
    json_object_set_new(o, "ratio", br_json_number(br_report_ratio(r, index)));
    json_object_set_new(o, "seconds", br_json_number(c->seconds));
    json_object_set_new(o, "flag", json_string(br_flag_name(c->flag[BR_PART_TOTAL])));
    json_object_set_new(o, "axial_flag", json_string(br_flag_name(c->flag[BR_PART_AXIAL])));
    json_object_set_new(o, "bending_flag", json_string(br_flag_name(c->flag[BR_PART_BENDING])));
    json_object_set_new(o, "worst_time", br_json_number(c->worst_time[BR_PART_TOTAL]));
    if (r->exact) {
        const struct br_cell *e = &r->exact->cell[index];
        json_object_set_new(o, "exact",
                            json_pack("{s:o, s:o, s:o, s:s}", "error",
                                      br_json_number(e->error[BR_PART_TOTAL]), "axial",
                                      br_json_number(e->error[BR_PART_AXIAL]), "bending",
                                      br_json_number(e->error[BR_PART_BENDING]), "flag",
                                      br_flag_name(e->flag[BR_PART_TOTAL])));
    }
    if (c->failure.status)
        json_object_set_new(o, "failure", br_json_string(c->failure.message));
    return o;
}

static json_t *cells(const struct br_report *r)
{
    json_t *a = json_array();
    for (size_t i = 0; i < r->study->n_count * r->study->k_count; i++)
        json_array_append_new(a, cell(r, i));
    return a;
}

static json_t *slopes(const struct br_slope *slope, size_t count)
{
    json_t *a = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(a, json_pack("{s:o, s:I}", "order", br_json_estimate(&slope[i].order),
                                           "points", (json_int_t)slope[i].points));
    return a;
}

static json_t *fits(const struct br_report *r, enum br_part part)
{
    static const char *const kinds[] = {"space and time", "time", "space"};
    const struct br_fits *f = &r->fits[part];
    const struct br_joint_fit *j = &f->joint;
    json_t *joint =
        json_pack("{s:b, s:b, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:I, s:I}", "converged",
                  j->converged, "describes_the_errors", br_joint_describes(j), "model",
                  kinds[j->kind], "C_h", br_json_estimate(&j->c_h), "p", br_json_estimate(&j->p),
                  "C_k", br_json_estimate(&j->c_k), "q", br_json_estimate(&j->q), "r",
                  br_json_estimate(&j->r), "misfit", br_json_number(j->misfit), "worst",
                  br_json_number(j->worst), "r_squared", br_json_number(j->r_squared), "points",
                  (json_int_t)j->points, "degrees_of_freedom", (json_int_t)j->freedom);
    return json_pack("{s:o, s:o, s:o, s:o}", "joint", joint, "order_in_k_by_n",
                     slopes(f->by_n, r->study->n_count), "order_in_h_by_k",
                     slopes(f->by_k, r->study->k_count), "reference_error",
                     br_json_number(f->reference_error));
}

static json_t *all_fits(const struct br_report *r)
{
    json_t *o = json_object();
    for (int part = 0; part < BR_PARTS; part++)
        if (br_part_shown(r, (enum br_part)part))
            json_object_set_new(o, br_part_names[part], fits(r, (enum br_part)part));
    return o;
}

static json_t *triangles(const struct br_report *r)
{
    json_t *a = json_array();
    for (size_t i = 0; i < r->triangles; i++) {
        const struct br_triangle *t = &r->triangle[i];
        json_array_append_new(
            a, json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:b}", "a",
                         resolution(r->study->scene, t->a), "b", resolution(r->study->scene, t->b),
                         "printed_a", br_json_number(t->printed_a), "printed_b",
                         br_json_number(t->printed_b), "distance", br_json_number(t->distance),
                         "least", br_json_number(t->least), "most", br_json_number(t->most),
                         "contradiction", t->contradiction));
    }
    return a;
}

static void append(void *self, const char *text)
{
    json_array_append_new(self, br_json_string(text));
}

static json_t *sentences(const struct br_report *r)
{
    json_t *a = json_array();
    const struct br_writer w = {append, a};
    br_say_method(r, &w);
    br_say_flags(r, &w);
    br_say_events(r, &w);
    br_say_orders(r, &w);
    br_say_printed(r, &w);
    return a;
}

static json_t *reference(const struct br_study *s)
{
    json_t *o = json_object();
    json_object_set_new(o, "kind", json_string(s->judge->name));
    json_object_set_new(o, "title", json_string(s->judge->title));
    if (s->judge->nests) {
        json_object_set_new(o, "at", resolution(s->scene, s->reference));
        json_object_set_new(o, "method", br_json_method(&s->reference_method));
    }
    static const char *const own[] = {"own_error", "own_axial_error", "own_bending_error"};
    for (int part = 0; part < BR_PARTS; part++)
        json_object_set_new(o, own[part],
                            br_json_number(br_norm_of_constant(
                                s->norm, s->scene, s->judged_by.own_error, (enum br_part)part)));
    json_object_set_new(o, "audited_error", br_json_number(s->reference_error[BR_PART_TOTAL]));
    json_object_set_new(o, "seconds", br_json_number(s->judged_by.seconds));
    json_object_set_new(o, "scale", br_json_number(s->reference_scale));
    json_object_set_new(o, "round_off", br_json_number(s->judged_by.round_off));
    return o;
}

static json_t *tip(const struct br_report *r, enum br_field_kind kind)
{
    const struct br_study *s = br_report_fitted(r);
    return json_pack("{s:o, s:o}", "extrapolated", br_json_estimate(&r->tip[kind]), "reference",
                     br_json_number(s->judge == &br_judge_none ? NAN : s->reference_tip[kind]));
}

static json_t *document(const struct br_report *r, const struct br_provenance *p)
{
    const struct br_study *s = r->study;
    json_t *o = json_object();
    json_object_set_new(o, "name", br_json_string(r->name));
    json_object_set_new(o, "caption", br_json_string(r->caption));
    json_object_set_new(o, "provenance", br_json_provenance(p));
    json_object_set_new(o, "scene",
                        json_pack("{s:o, s:o, s:o}", "name", br_json_string(s->scene->name), "path",
                                  br_json_string(p->scene_path), "text",
                                  br_json_string(p->scene_text)));
    json_object_set_new(o, "norm",
                        json_pack("{s:s, s:s, s:s}", "name", s->norm->name, "unit", s->norm->unit,
                                  "title", s->norm->title));
    json_object_set_new(o, "method", br_json_method(&s->method));
    json_object_set_new(o, "reference", reference(s));
    if (r->exact)
        json_object_set_new(o, "exact_reference", reference(r->exact));
    json_object_set_new(o, "fitted", br_json_string(br_report_fitted(r)->judge->name));
    json_object_set_new(o, "wall_seconds", br_json_number(r->wall_seconds));
    json_object_set_new(o, "cells", cells(r));
    json_object_set_new(o, "fits", all_fits(r));
    if (s->scene->axial.modelled)
        json_object_set_new(o, "axial_tip", tip(r, BR_AXIAL));
    if (s->scene->bending.modelled)
        json_object_set_new(o, "bending_tip", tip(r, BR_BENDING));
    json_object_set_new(o, "triangle_inequality", triangles(r));
    json_object_set_new(o, "findings", sentences(r));
    return o;
}

static enum br_status emit(FILE *out, const struct br_report *r, const struct br_provenance *p,
                           struct br_error *err)
{
    json_t *o = document(r, p);
    if (!o)
        return br_no_memory(err, "the JSON document");
    json_dumpf(o, out, JSON_INDENT(1) | JSON_ENSURE_ASCII | JSON_REAL_PRECISION(17));
    fputc('\n', out);
    json_decref(o);
    return BR_OK;
}

const struct br_emitter br_emit_json = {"json", ".json", "everything, to repeat the run", emit};
