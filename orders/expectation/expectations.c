/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The expected orders of a program, and the verdicts on them. */
#include "orders/orders.h"

#include <math.h>
#include <string.h>

#include "base/words.h"

/* ---- the text ---- */

enum { MOST = 2000 }; /* more than two for each column of a table */

static enum br_status refuse(const char *at, const char *expected, struct br_error *err)
{
    return br_fail(err, BR_BAD_INPUT, "found '%.30s', expected %s, as in 'l2: h 2 +- 0.1'", at,
                   expected);
}

/* Whether a word is next, which is then skipped with the blanks around it. */
static bool takes(const char **at, const char *word)
{
    const char *behind = br_skip_word(*at, word);
    *at = behind ? behind : *at;
    return behind;
}

/* Whether a number above 0 is next. */
static bool take_number(const char **at, double *value)
{
    const char *end = br_read_number(*at, value);
    if (!end || !(*value > 0))
        return false;
    *at = br_skip_word(end, "");
    return true;
}

/* "h 2 +- 0.1 down to 1e-9", "h exponential 8 +- 0.5" */
static enum br_status take_order(const char **at, struct br_order_expectation *e,
                                 struct br_error *err)
{
    e->axis = BR_AXES;
    for (int axis = 0; axis < BR_AXES && e->axis == BR_AXES; axis++)
        if (takes(at, br_axis_letters[axis]))
            e->axis = (enum br_axis)axis;
    if (e->axis == BR_AXES)
        return refuse(*at, "h or k", err);
    e->exponential = takes(at, "exponential");
    if (!take_number(at, &e->order) || (e->exponential && !(e->order > 1)))
        return refuse(*at, e->exponential ? "a factor above 1" : "an order above 0", err);
    if (!takes(at, "+-") && !takes(at, "\u00b1"))
        return refuse(*at, "'+-'", err);
    if (!take_number(at, &e->tolerance) || !(e->tolerance < e->order))
        return refuse(*at, "a tolerance above 0 and below the order", err);
    if (takes(at, "down to") && !take_number(at, &e->down_to))
        return refuse(*at, "an error above 0", err);
    return BR_OK;
}

static enum br_status take_name(const char **at, char name[64], struct br_error *err)
{
    const char *name_at = *at, *quoted = br_list_quoted(&name_at);
    const char *colon = quoted ? br_skip_word(quoted, "") : NULL;
    size_t length = quoted ? (size_t)(quoted - 1 - name_at) : 0;
    if (!colon || *colon != ':') { /* quotes may be a part of a name, too */
        name_at = *at;
        colon = strchr(*at, ':');
        for (length = colon ? (size_t)(colon - *at) : 0;
             length && strchr(" \t\n", (*at)[length - 1]);)
            length--;
    }
    if (length == 0 || length > 63)
        return refuse(*at, length ? "a name of at most 63 bytes" : "an error's name and ':'", err);
    snprintf(name, 64, "%.*s", (int)length, name_at);
    *at = br_skip_word(colon, ":");
    return BR_OK;
}

enum br_status br_expectations_read(const char *text, size_t line,
                                    struct br_order_expectation **expectations, size_t *count,
                                    struct br_error *err)
{
    size_t most = *count + 1;
    for (const char *c = text; *c; c++)
        most += *c == ',' || *c == ';';
    struct br_order_expectation *all = br_allocate(most, sizeof *all);
    if (!all)
        return br_no_memory(err, "the expectations");
    if (*count)
        memcpy(all, *expectations, *count * sizeof *all);
    free(*expectations);
    *expectations = all;
    if (most > MOST)
        return br_fail(err, BR_BAD_INPUT, "found %zu expected orders, expected at most %d", most,
                       MOST);
    const char *at = br_skip_word(text, "");
    if (!*at)
        return br_fail(err, BR_BAD_INPUT,
                       "expected an error, h or k, its order and a tolerance, as in 'l2: h 2 +- "
                       "0.1'; found nothing");
    char name[64] = "";
    for (bool goes_on = true, named = false; goes_on;) {
        struct br_order_expectation *e = &all[(*count)++];
        if (named && at[strcspn(at, ",;:")] == ':')
            return br_fail(err, BR_BAD_INPUT,
                           "found '%.30s' behind a comma, expected h or k; another error begins "
                           "after a semicolon, as in 'l2: h 2 +- 0.1; h1: h 1 +- 0.1'",
                           at);
        if ((!named && take_name(&at, name, err)) || take_order(&at, e, err))
            return err->status;
        strcpy(e->quantity, name);
        e->line = line;
        for (const struct br_order_expectation *f = all; f < e; f++)
            if (f->axis == e->axis && strcmp(f->quantity, name) == 0)
                return br_fail(err, BR_BAD_INPUT, "the order of %s in %s is given twice", name,
                               br_axis_letters[e->axis]);
        named = takes(&at, ",");
        goes_on = named || takes(&at, ";");
    }
    return *at ? refuse(at, "',' or ';' or the end", err) : BR_OK;
}

/* ---- verdicts ---- */

static void expect(struct br_case *c, const struct br_order_expectation *e)
{
    c->expected.order = e->order;
    c->expected.tolerance = e->tolerance;
    c->expected.line = e->line;
    c->exponential = e->exponential;
    c->down_to = e->down_to;
}

/* Makes the case of an expectation on a line, with a copy of its points. */
static enum br_status observe(const struct br_orders_line *line,
                              const struct br_order_expectation *e, struct br_case *c,
                              struct br_error *err)
{
    *c = line->observed;
    expect(c, e);
    c->point = br_allocate(c->points + 1, sizeof *c->point);
    if (!c->point)
        return br_no_memory(err, "the verdict");
    memcpy(c->point, line->observed.point, c->points * sizeof *c->point);
    for (size_t i = 0; i < c->points; i++)
        if (c->point[i].flag != BR_FLAG_FAILED && c->point[i].error > 0)
            c->point[i].flag = c->point[i].error <= e->down_to ? BR_FLAG_STALLED : BR_FLAG_NONE;
    return br_case_observe(c, BR_VERIFY_LEAST_POINTS, err);
}

/* The order of a grid of errors is the answer for the axis, as far as the joint fit has one. */
static enum br_status find_verdict(const struct br_orders *o, const struct br_order_expectation *e,
                                   const char *path, struct br_case *c, struct br_error *err)
{
    const struct br_quantity_orders *of = NULL;
    for (size_t i = 0; i < o->count && !of; i++)
        if (strcmp(o->numbers->quantity[i].name, e->quantity) == 0)
            of = &o->of[i];
    const struct br_orders_line *line = of ? br_orders_finest(of, e->axis) : NULL;
    const bool joint =
        of && (br_joint_describes(&of->joint) || (!line && of->flag)); /* of a grid without lines */
    if (!of)
        return br_fail(err, BR_BAD_INPUT,
                       "%s: an order of '%s' is expected, and there is no such "
                       "column",
                       path, e->quantity);
    if (!line && !joint)
        return br_fail(err, BR_BAD_INPUT,
                       "%s: an order of %s in %s is expected, and there are no three sizes of one "
                       "line",
                       path, e->quantity, br_axis_letters[e->axis]);
    if (joint ? br_orders_joint_case(o, of, e->axis, c, err) : observe(line, e, c, err))
        return err->status;
    const struct br_orders_answer *answer = &of->answer[e->axis];
    expect(c, e);
    if (!joint && answer->open)
        br_case_take_order(c, answer->order, NAN);
    c->open = answer->open;
    br_case_decide(c);
    if (isnan(c->order.value)) /* of too few errors for a verdict */
        c->order = answer->order;
    return BR_OK;
}

enum br_status br_orders_check(const struct br_orders *o, const struct br_order_expectation *e,
                               size_t count, struct br_check *check, struct br_error *err)
{
    check->cases = br_allocate(count + 1, sizeof *check->cases);
    check->count = 0;
    if (!check->cases)
        return br_no_memory(err, "the verdicts");
    enum br_status status = BR_OK;
    for (size_t i = 0; i < count && !status; i++)
        status = find_verdict(o, &e[i], check->path, &check->cases[check->count++], err);
    return status;
}
