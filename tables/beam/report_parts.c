/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables/beam/report_parts.h"

#include <math.h>

void br_put_method_facts(struct br_document *d, const char *key, const struct br_method *m,
                         const struct br_meshes *on)
{
    struct br_settings settings;
    br_method_settings(on, m, &settings);
    br_put_settings(d, key, &settings);
}

void br_put_method_cells(struct br_document *d, const struct br_method *m)
{
    struct br_settings settings;
    br_method_settings(&(struct br_meshes){0}, m, &settings);
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++)
        br_hide(d, br_method_field_key(&br_method_fields[i]), NULL,
                br_setting_value(&settings.row[i]));
}

/* k, s; NaN where the scheme chooses its steps. */
static double step_of(const struct br_scene *scene, const struct br_trial *t)
{
    return t->named->method.scheme->adaptive ? (double)NAN : br_time_step(scene, t->at.steps);
}

void br_put_trial(struct br_document *d, const struct br_scene *scene, const struct br_trial *t)
{
    const bool adaptive = t->named->method.scheme->adaptive;
    BR_PUT(d, br_text(t->named->name), .key = "method");
    BR_PUT(d, br_count(t->at.n), .key = "n");
    char taken[BR_METHOD_TEXT];
    br_hide(d, "solver_taken", NULL,
            br_text(br_method_taken(&(struct br_meshes){scene, &t->at.n, 1}, &t->named->method,
                                    taken)));
    br_hide(d, "steps_or_levels", NULL, br_count(t->at.steps));
    br_hide(d, "tolerance", NULL, br_if(adaptive, br_number(t->tolerance)));
    BR_PUT(d, br_number(step_of(scene, t)), .key = "k", .unit = "s");
    if (adaptive)
        br_put_shown(d, "tol %.4g", t->tolerance);
}

const char *br_trial_text(const struct br_scene *scene, const struct br_trial *t,
                          char text[BR_TRIAL_TEXT])
{
    if (t->named->method.scheme->adaptive)
        snprintf(text, BR_TRIAL_TEXT, "%s, n = %zu, tolerance %.4g", t->named->name, t->at.n,
                 t->tolerance);
    else
        snprintf(text, BR_TRIAL_TEXT, "%s, n = %zu, k = %.6g s", t->named->name, t->at.n,
                 step_of(scene, t));
    return text;
}
