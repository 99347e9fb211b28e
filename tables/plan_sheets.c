/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "tables/plan_emitter.h"

struct column {
    const char *heading;
    bool number;
    void (*cell)(const struct br_plan_page *page, size_t i, char *text);
};

static void put(char *text, const char *format, double value)
{
    if (isfinite(value))
        snprintf(text, BR_CELL, format, value);
    else
        snprintf(text, BR_CELL, "-");
}

/* ---- proposals: i is a trial ---- */

static void round_cell(const struct br_plan_page *page, size_t i, char *text)
{
    snprintf(text, BR_CELL, "%zu", page->plan->forecast[i].round);
}

static void method_cell(const struct br_plan_page *page, size_t i, char *text)
{
    snprintf(text, BR_CELL, "%s", page->plan->trial[i].contender->name);
}

static void n_cell(const struct br_plan_page *page, size_t i, char *text)
{
    snprintf(text, BR_CELL, "%zu", page->plan->trial[i].at.n);
}

static void step_cell(const struct br_plan_page *page, size_t i, char *text)
{
    const struct br_trial *t = &page->plan->trial[i];
    if (br_contender_adaptive(t->contender))
        snprintf(text, BR_CELL, "tol %.3e", t->tolerance);
    else
        snprintf(text, BR_CELL, "T/%zu", t->at.steps);
}

static void predicted_cell(const struct br_plan_page *page, size_t i, char *text)
{
    put(text, "%.3e", page->plan->forecast[i].error);
}

static void achieved_cell(const struct br_plan_page *page, size_t i, char *text)
{
    put(text, "%.3e", br_trial_bound(&page->plan->trial[i], 0));
}

static void expected_seconds_cell(const struct br_plan_page *page, size_t i, char *text)
{
    put(text, "%.3g", page->plan->forecast[i].seconds);
}

static void seconds_cell(const struct br_plan_page *page, size_t i, char *text)
{
    put(text, "%.3g", page->plan->seconds(&page->plan->trial[i]));
}

static void remark_cell(const struct br_plan_page *page, size_t i, char *text)
{
    const struct br_plan *p = page->plan;
    const struct br_trial *t = &p->trial[i];
    snprintf(text, BR_CELL, "%s%s%s", i == p->first ? "first" : "",
             i == p->first && i == p->chosen ? ", " : "", i == p->chosen ? "chosen" : "");
    if (t->end != BR_TRIAL_DONE)
        snprintf(text, BR_CELL, "%s", br_trial_end_name(t->end));
}

static const struct column proposal_columns[] = {
    {"round", true, round_cell},
    {"method", false, method_cell},
    {"n", true, n_cell},
    {"k", true, step_cell},
    {"predicted", true, predicted_cell},
    {"error", true, achieved_cell},
    {"predicted s", true, expected_seconds_cell},
    {"CPU s", true, seconds_cell},
    {"", false, remark_cell},
};

/* Proposals come after the cheap trials. */
static size_t first_proposal(const struct br_plan *p)
{
    size_t i = 0;
    while (i < p->count && p->forecast[i].round == 0)
        i++;
    return i;
}

static const char *proposal_heading(const void *self, size_t column, bool *number)
{
    (void)self;
    *number = proposal_columns[column].number;
    return proposal_columns[column].heading;
}

static void proposal_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    const struct br_plan_page *page = self;
    proposal_columns[column].cell(page, first_proposal(page->plan) + row, text);
}

/* ---- models: i is a contender ---- */

static void contender_cell(const struct br_plan_page *page, size_t i, char *text)
{
    snprintf(text, BR_CELL, "%s", page->plan->contenders.list[i].name);
}

static void points_cell(const struct br_plan_page *page, size_t i, char *text)
{
    snprintf(text, BR_CELL, "%zu", page->plan->model[i].error.points);
}

static void scatter_cell(const struct br_plan_page *page, size_t i, char *text)
{
    const struct br_plan_models *m = &page->plan->model[i];
    put(text, "%.1f %%", m->known ? 100 * expm1(m->error.scatter) : NAN);
}

static void cost_scatter_cell(const struct br_plan_page *page, size_t i, char *text)
{
    const struct br_plan_models *m = &page->plan->model[i];
    put(text, "%.0f %%", m->known ? 100 * expm1(m->cost.scatter) : NAN);
}

static void correlation_cell(const struct br_plan_page *page, size_t i, char *text)
{
    const struct br_plan_models *m = &page->plan->model[i];
    put(text, "%.2f", m->known ? m->error.r : NAN);
}

/* A coefficient of the cost model, in ns. */
static void put_cost(const struct br_plan_page *page, size_t i, int c, char *text)
{
    const struct br_plan_models *m = &page->plan->model[i];
    put(text, "%.3g", m->known ? 1e9 * m->cost.c[c] : NAN);
}

static void solve_cell(const struct br_plan_page *page, size_t i, char *text)
{
    put_cost(page, i, 2, text);
}

static void element_cell(const struct br_plan_page *page, size_t i, char *text)
{
    put_cost(page, i, 3, text);
}

static const struct column model_columns[] = {
    {"method", false, contender_cell},
    {"trials", true, points_cell},
    {"error model off by", true, scatter_cell},
    {"r", true, correlation_cell},
    {"cost model off by", true, cost_scatter_cell},
    {"ns a solve", true, solve_cell},
    {"and element", true, element_cell},
};

static const char *model_heading(const void *self, size_t column, bool *number)
{
    (void)self;
    *number = model_columns[column].number;
    return model_columns[column].heading;
}

static void model_cell(const void *self, size_t row, size_t column, char text[BR_CELL])
{
    model_columns[column].cell(self, row, text);
}

/* ---- the page ---- */

static void say(const void *self, const struct br_writer *w)
{
    br_say_plan(self, w);
}

static void say_notes(const void *self, const struct br_writer *w)
{
    br_say_plan_notes(self, w);
}

void br_plan_fill(const struct br_plan_page *plan, struct br_page *page)
{
    const struct br_plan *p = plan->plan;
    *page = (struct br_page){
        .name = plan->name,
        .caption = plan->caption,
        .tables = 2,
        .self = plan,
        .say = say,
        .say_notes = say_notes,
        .provenance = plan->provenance,
    };
    page->table[0] = (struct br_table){
        .name = "proposals",
        .title = "What was proposed",
        .columns = sizeof proposal_columns / sizeof *proposal_columns,
        .rows = p->count - first_proposal(p),
        .self = plan,
        .heading = proposal_heading,
        .cell = proposal_cell,
    };
    page->table[1] = (struct br_table){
        .name = "models",
        .title = "How good the models are (root mean squares over a method's trials)",
        .columns = sizeof model_columns / sizeof *model_columns,
        .rows = p->contenders.count,
        .self = plan,
        .heading = model_heading,
        .cell = model_cell,
    };
}
