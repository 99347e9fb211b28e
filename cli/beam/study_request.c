/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/beam/study_request.h"
#include "cli/beam/beam.h"

#include <math.h>
#include <string.h>

#include "solver/scene.h"

/* Reads "fine:N,K"; `arguments` begins after the colon. */
static enum br_status read_fine(const char *text, const char *arguments, struct br_study_request *r,
                                struct br_error *err)
{
    double n = 0, k = 0;
    const char *comma = br_read_number(arguments, &n);
    const char *end = comma && *comma == ',' ? br_read_time(comma + 1, 1, &k) : NULL;
    if (!end || *end || !(n >= 1 && n <= 1e9) || n != floor(n) || !(k > 0))
        return br_fail(
            err, BR_BAD_INPUT,
            "--reference: found '%s', expected fine:N,K with a number of elements N >= 1 "
            "and a time step K > 0 in seconds, like fine:12800,1e-5",
            text);
    r->reference_n = (size_t)n;
    r->reference_k = comma + 1;
    return BR_OK;
}

/* Reads a reference's name, and for a fine run its arguments. */
static enum br_status read_reference(const char *text, struct br_study_request *r,
                                     struct br_error *err)
{
    const char *names[8];
    char name[32], all[256], suggestion[BR_SUGGESTION];
    const size_t length = strcspn(text, ":");
    size_t count = 0;
    for (; br_references[count] && count < 8; count++)
        names[count] = br_references[count]->name;
    snprintf(name, sizeof name, "%.*s", (int)(length < 31 ? length : 31), text);
    r->reference_kind = br_reference_find(name);
    if (!r->reference_kind || (text[length] == ':' && !r->reference_kind->nests))
        return br_fail(err, BR_BAD_INPUT, "--reference: found '%s', expected one of: %s%s", text,
                       br_words_join(&br_reference_words, ", ", all, sizeof all),
                       r->reference_kind ? "" : br_suggestion(name, names, count, suggestion));
    if (!r->reference_kind->nests)
        return BR_OK;
    return read_fine(text, text + length + (text[length] == ':'), r, err);
}

enum br_status br_study_request_read(const struct br_options *o, struct br_study_request *r,
                                     struct br_error *err)
{
    const char *const *given = &o->given[BR_OPT_METHOD];
    const char *reference = br_option_text(o, BR_OPT_REFERENCE);
    const char *methods = br_option_text(o, BR_OPT_METHODS);
    *r = (struct br_study_request){
        .n = o->whole[BR_OPT_N],
        .n_count = o->count[BR_OPT_N],
        .k = o->text[BR_OPT_K],
        .norms = o->count[BR_OPT_NORM],
        .method = br_method_default(),
    };
    for (size_t i = 0; i < r->norms; i++)
        r->norm[i] = br_norms[(size_t)o->number[BR_OPT_NORM][i]];
    const struct br_method *const method = &r->method;
    if (br_method_read(given, BR_METHOD_OPTION, &r->method, err) ||
        br_method_check_used(given, BR_METHOD_OPTION, &method, 1, err) ||
        (reference && read_reference(reference, r, err)))
        return err->status;
    return methods ? br_named_methods_read(methods, &r->methods, err) : BR_OK;
}

enum br_status br_study_request_fine(const struct br_study_request *r, const struct br_scene *scene,
                                     struct br_resolution *fine, struct br_error *err)
{
    fine->n = r->reference_n;
    return br_read_step("--reference", r->reference_k, scene, &fine->steps, err);
}

/* ---- time steps ---- */

enum br_status br_read_step(const char *option, const char *text, const struct br_scene *scene,
                            size_t *steps, struct br_error *err)
{
    double k = NAN;
    struct br_error inner = {0};
    br_read_time(text, scene->duration, &k);
    if (br_steps_of(scene, k, steps, &inner))
        return br_fail(err, BR_BAD_INPUT, "%s: %s", option, inner.message);
    return BR_OK;
}

enum br_status br_steps_read(const char *k, const struct br_scene *scene, size_t **steps,
                             size_t *count, struct br_error *err)
{
    *steps = k ? br_allocate(strlen(k) + 1, sizeof **steps) : NULL;
    *count = 0;
    if (k && !*steps)
        return br_no_memory(err, "the time steps");
    for (const char *rest = k; rest; rest = strchr(rest, ',')) {
        rest += *rest == ',';
        if (br_read_step("--k", rest, scene, &(*steps)[*count], err))
            return err->status;
        for (size_t i = 0; i < *count; i++)
            if ((*steps)[i] == (*steps)[*count])
                return br_fail(err, BR_BAD_INPUT, "--k: %g is given twice",
                               br_time_step(scene, (*steps)[i]));
        ++*count;
    }
    return BR_OK;
}
