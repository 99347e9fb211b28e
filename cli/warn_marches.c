/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/warn_marches.h"

#include "cli/warn.h"

static enum br_status look_at_cells(const struct br_study *study, struct br_warnings *warnings,
                                    struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < study->n_count; i++)
        for (size_t j = 0; j < study->k_count && !status; j++) {
            const struct br_outlook outlook = {.scene = study->scene,
                                               .method = &study->method,
                                               .n = study->n[i],
                                               .steps = study->steps[j]};
            status = br_look_ahead_cheaply(&outlook, warnings, err);
        }
    return status;
}

enum br_status br_warn_of_studies(const struct br_study *studies, size_t count,
                                  struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < count && !status; i++) {
        struct br_warnings warnings = {0};
        status = look_at_cells(&studies[i], &warnings, err);
        br_print_warnings_of(studies[i].scene->name, &warnings);
    }
    return status;
}

static void look_at_check(const struct br_check *check, const struct br_verify_study *study,
                          struct br_warnings *warnings)
{
    for (size_t i = 0; i < study->count; i++) {
        struct br_error refusal = {0};
        const struct br_outlook outlook = {.scene = check->scene,
                                           .method = &study->method,
                                           .n = study->n[i],
                                           .steps = study->steps[i]};
        br_look_ahead_cheaply(&outlook, warnings, &refusal);
    }
}

void br_warn_of_checks(const struct br_check *checks, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        struct br_warnings warnings = {0};
        for (int kind = 0; kind < BR_VERIFY_KINDS; kind++)
            look_at_check(&checks[i], &checks[i].verify->study[kind], &warnings);
        br_print_warnings_of(checks[i].scene->name, &warnings);
    }
}

void br_warn_of_trade(const struct br_trade *trade)
{
    const struct br_scene *scene = trade->request.scene;
    struct br_warnings warnings = {0};
    for (size_t i = 0; i < trade->count; i++) {
        const struct br_trial *t = &trade->trial[i];
        struct br_error refusal = {0};
        const struct br_outlook outlook = {
            .scene = scene, .method = &t->contender->method, .n = t->at.n, .steps = t->at.steps};
        br_look_ahead_cheaply(&outlook, &warnings, &refusal);
    }
    br_print_warnings_of(scene->name, &warnings);
}
