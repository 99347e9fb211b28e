/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a digit costs: several programs beside each other. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>

#include "orders/work.h"
#include "tables/report_cells.h"
#include "tables/reports.h"

/* "0.12 s"; a cost without a unit is a number of something: "4225 dofs". */
static const char *cost_text(struct br_document *d, const struct br_work_precision *w, double cost)
{
    return br_format(d, *w->cost_unit ? "%.3g %.30s" : "%.8g %.30s", cost,
                     *w->cost_unit ? w->cost_unit : w->cost);
}

/* "1e-3": a power of ten. */
static const char *power_text(struct br_document *d, double power)
{
    return br_format(d, "1e%.0f", log10(power));
}

static const char *tie_text(const struct br_work_precision *w)
{
    return w->is_time ? "alike by the clock" : "equal";
}

/* ---- the cheapest ---- */

/* The two cheapest programs to an error; `points`: there is none. */
struct cheapest {
    size_t best, next;
    bool tied; /* the scatter of the clock may change which one is less */
};

static struct cheapest find_cheapest(const struct br_work_precision *w, double target)
{
    struct cheapest c = {.best = br_work_cheapest(w->point, w->points, target, SIZE_MAX, SIZE_MAX)};
    const struct br_work_point *a = &w->point[c.best];
    c.next = br_work_cheapest(w->point, w->points, target, SIZE_MAX, a->program);
    const struct br_work_point *b = &w->point[c.next];
    c.tied = c.next < w->points && fabs(a->cost - b->cost) <= hypot(a->half, b->half);
    return c;
}

static void answer_digit(struct br_document *d, const struct br_work_precision *w, bool several,
                         double target)
{
    const struct cheapest c = find_cheapest(w, target);
    const struct br_work_point *best = &w->point[c.best], *next = &w->point[c.next];
    br_put_answer(d, "%s%s to %s%s%s: %s, %s, %s", several ? w->quantity : "",
                  several ? ": cheapest" : "Cheapest", power_text(d, target), c.tied ? ", " : "",
                  c.tied ? tie_text(w) : "", w->program[best->program].name, best->label,
                  cost_text(d, w, best->cost));
    if (c.next < w->points)
        br_put_more(d, "; %s: %s, %s%s%s.", c.tied ? "and" : "next", w->program[next->program].name,
                    c.tied ? next->label : "", c.tied ? ", " : "", cost_text(d, w, next->cost));
    else
        br_put_more(d, w->programs > 1 ? "; no other one reaches it." : ".");
}

/* The digits from the last one back, every second or third where there are many. */
static void answer_digits(struct br_document *d, const struct br_work_precision *w, size_t works)
{
    const size_t most = works > 4 ? 1 : 4 / works;
    double target[BR_WORK_DIGITS];
    const size_t count = br_work_targets(w, target), step = (count + most - 1) / most;
    for (size_t i = count ? (count - 1) % step : 0; i < count; i += step)
        answer_digit(d, w, works > 1, target[i]);
}

/* next: the cheapest of the other programs; there may be none. */
static void put_point(struct br_document *d, const struct br_work_precision *w, size_t i, bool next)
{
    const struct br_work_point *p = &w->point[i < w->points ? i : 0];
    const char *prefix = next ? "next_" : "";
    br_put_blank(d, i >= w->points);
    BR_PUT(d, br_text(w->program[p->program].name), .key = next ? "next" : "program");
    BR_PUT(d, br_text(p->label), .key = br_format(d, "%ssize", prefix), .heading = "size");
    if (!next)
        BR_PUT(d, br_number(p->error), .key = "error", .unit = w->unit, .format = "%.2e");
    BR_PUT(d, br_number(p->cost), .key = br_format(d, "%scost", prefix), .heading = w->cost,
           .unit = w->cost_unit, .format = *w->cost_unit ? "%.3g" : "%.8g");
    br_hide(d, br_format(d, "%shalf", prefix), w->cost_unit, br_number(p->half));
    if (!next)
        BR_PUT(d, br_text(p->is_start ? "mostly start" : NULL), .key = "remark",
               .flags = BR_VARIES);
    br_put_blank(d, false);
}

static void put_digits(struct br_document *d, const struct br_work_precision *w)
{
    double target[BR_WORK_DIGITS];
    const size_t count = br_work_targets(w, target);
    bool ties = false;
    for (size_t i = 0; i < count; i++)
        ties |= find_cheapest(w, target[i]).tied;
    for (size_t i = 0; i < count; i++) {
        const struct cheapest c = find_cheapest(w, target[i]);
        br_put_row(d);
        BR_PUT(d, br_text(w->quantity), .key = "quantity", .flags = BR_VARIES);
        BR_PUT(d, br_number(target[i]), .key = "to_error", .heading = "to error", .format = "%.0e");
        put_point(d, w, c.best, false);
        put_point(d, w, c.next, true);
        BR_PUT(d, br_text(c.tied ? tie_text(w) : NULL), .key = "tie",
               .flags = ties ? 0 : BR_FILES_ONLY);
    }
}

/* ---- how costs grow, and what failed ---- */

static void answer_program(struct br_document *d, const struct br_work_precision *w,
                           const struct br_work_program *p)
{
    const bool grows = isfinite(p->growth.value), tenth = isfinite(p->tenth.value);
    if (!grows && !tenth && isnan(p->needed.value))
        return;
    br_put_answer(d, "%s:", p->name);
    br_put_list(d, " ", ", ");
    if (grows)
        br_put_item(d, "%s grows like %s^-%s", w->cost, br_axis_letters[p->axis],
                    br_order_shown(d, &p->growth));
    if (tenth)
        br_put_item(d, "a tenth of the error costs %s times as much",
                    br_interval_shown(d, &p->tenth));
    if (isfinite(p->needed.value))
        br_put_item(d, "%s would cost %s %s (%s)", power_text(d, p->wanted),
                    br_interval_shown(d, &p->needed), *w->cost_unit ? w->cost_unit : w->cost,
                    p->at);
    br_put_more(d, ".");
}

static void put_growth(struct br_document *d, const struct br_work_precision *w)
{
    for (const struct br_work_program *p = w->program; p < w->program + w->programs; p++) {
        br_put_row(d);
        BR_PUT(d, br_text(w->quantity), .key = "quantity", .flags = BR_VARIES);
        BR_PUT(d, br_text(p->name), .key = "program");
        BR_PUT(d, br_text(p->axis < BR_AXES ? br_axis_letters[p->axis] : NULL), .key = "in",
               .flags = BR_VARIES);
        BR_PUT_ESTIMATE(d, "growth_", &p->growth, br_order_shown(d, &p->growth), .key = "growth",
                        .heading = "cost grows like 1/size to the power");
        BR_PUT_ESTIMATE(d, "tenth_", &p->tenth, br_interval_shown(d, &p->tenth), .key = "tenth",
                        .heading = "a tenth of the error costs, times");
        BR_PUT(d, br_number(p->wanted), .key = "wanted", .format = "%.0e");
        BR_PUT_ESTIMATE(d, "needed_", &p->needed, br_interval_shown(d, &p->needed), .key = "needed",
                        .heading = "which would cost", .unit = w->cost_unit);
        BR_PUT(d, br_text(*p->at ? p->at : NULL), .key = "at");
        BR_PUT(d, br_text(*p->starts ? p->starts : NULL), .key = "mostly_start_up_to",
               .heading = "mostly start up to", .flags = BR_VARIES);
    }
}

static void say_troubles(struct br_document *d, const struct br_work_precision *w)
{
    for (const struct br_work_program *p = w->program; p < w->program + w->programs; p++) {
        if (p->failed)
            br_put_answer(d, "%s: %zu of %zu runs without a result, the first at %s: %s.", p->name,
                          p->failed, p->failed + p->points, p->first, p->failure);
        if (*p->starts)
            br_put_answer(d, "%s: up to %s its %s is mostly its start, %s.", p->name, p->starts,
                          w->cost, cost_text(d, w, p->start));
        if (*p->odd)
            br_put_answer(d,
                          "%s: the %s at %s is far from the line of the others: no part of the "
                          "growth.",
                          p->name, w->cost, p->odd);
        if (p->stalls)
            br_put_answer(d, "%s: its finest errors no longer fall: no forecast.", p->name);
    }
}

static void put_runs(struct br_document *d, const struct br_work_precision *w)
{
    for (size_t i = 0; i < w->points; i++) {
        br_put_row(d);
        BR_PUT(d, br_text(w->quantity), .key = "quantity");
        put_point(d, w, i, false);
        br_hide(d, "z", NULL, br_number(w->point[i].z));
        BR_PUT(d, br_truth(w->point[i].front), .key = "front");
        BR_PUT(d, br_truth(w->point[i].own), .key = "own_front", .heading = "its own front");
    }
}

void br_report_work(const struct br_work_precision *works, size_t count, const char *machine,
                    struct br_document *d)
{
    br_document_begin(d, "trade", "beamrate trade of programs", 1, "What a digit costs");
    for (size_t i = 0; i < count; i++)
        answer_digits(d, &works[i], count);
    say_troubles(d, works);
    for (size_t i = 0; i < works->programs && count == 1; i++)
        answer_program(d, works, &works->program[i]);
    br_put_table(d, "cheapest", br_format(d, "Cheapest to an error, by %.100s", works->cost), 0);
    for (size_t i = 0; i < count; i++)
        put_digits(d, &works[i]);
    br_put_table(d, "growth", "How costs grow, and what more digits cost if both orders stay", 0);
    for (size_t i = 0; i < count; i++)
        put_growth(d, &works[i]);
    br_put_table(d, "runs", "All runs", BR_FILES_ONLY | BR_MAIN);
    for (size_t i = 0; i < count; i++)
        put_runs(d, &works[i]);
    br_hide_fact(d, br_text(works->cost), NULL, "cost");
    br_hide_fact(d, br_text(works->cost_unit), NULL, "cost_unit");
    if (machine)
        br_put_note(d,
                    "Times of programs that were run: medians of runs after one that warms up, "
                    "until they are known to 5 %% or have taken 10 s, one run at a time, without "
                    "the time of a process that does nothing. On %s.",
                    machine);
    br_put_note(d,
                "Alike by the clock: the scatter of the times may change which one is less. A time "
                "that was read once is known to 10 %%.");
}
