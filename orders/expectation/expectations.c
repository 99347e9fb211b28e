/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Expected orders, as options, study files and scenes state them, and the verdicts on them. */
#include "orders/orders.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/words.h"

/* ---- an order ---- */

double br_expectation_low(const struct br_expectation *e)
{
    return e->order - e->tolerance;
}

double br_expectation_high(const struct br_expectation *e)
{
    return e->tolerance == 0 ? INFINITY : fmax(e->order, e->highest) + e->tolerance;
}

char *br_expectation_text(const struct br_expectation *e, char text[BR_EXPECTATION_TEXT])
{
    enum { SIZE = BR_EXPECTATION_TEXT };
    char order[64];
    snprintf(text, SIZE, "%s%s%s", e->exponential ? "exponential " : "",
             e->tolerance == 0 ? ">= " : "",
             br_range_text(e->order, e->highest, order, sizeof order));
    if (e->tolerance != 0)
        br_append(text, SIZE, " +- %g", e->tolerance);
    return e->down_to > 0 ? br_append(text, SIZE, " down to %g", e->down_to) : text;
}

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

/* Whether a number between these is next. */
static bool take_number(const char **at, double low, double high, double *value)
{
    const char *end = br_read_number(*at, value);
    if (!end || !(*value > low && *value < high))
        return false;
    *at = br_skip_word(end, "");
    return true;
}

enum br_status br_expectation_check(const struct br_expectation *e, struct br_error *err)
{
    if (e->order > 0 && e->tolerance >= 0 && e->tolerance < e->order && isfinite(e->order) &&
        e->down_to >= 0)
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT,
                   "found order %g +- %g down to %g, expected an order above 0, a tolerance above "
                   "0 (0: the order is the least) and below it, since a band with the order 0 "
                   "accepts errors that do not fall, and an error of at least 0",
                   e->order, e->tolerance, e->down_to);
}

static bool is_tolerance(const char *at)
{
    return br_skip_word(at, "+-") || br_skip_word(at, "\u00b1");
}

/* "2 to 4 +- 0.1", "2", ">= 1.8" */
static enum br_status take_band(const char **at, struct br_expectation *e, struct br_error *err)
{
    if (takes(at, "<=") || takes(at, "\u2264"))
        return refuse(*at, "'>=' or a band: errors that do not fall have an order below any limit",
                      err);
    const bool least = takes(at, ">=") || takes(at, "\u2265") || takes(at, "at least");
    if (!take_number(at, e->exponential ? 1 : 0, INFINITY, &e->order))
        return refuse(
            *at, e->exponential ? "a factor above 1" : "an order above 0, perhaps behind h or k",
            err);
    if (least)
        return is_tolerance(*at) ? refuse(*at, "nothing: a least order has no tolerance", err)
                                 : BR_OK;
    if (takes(at, "to") && !take_number(at, e->order, INFINITY, &e->highest))
        return refuse(*at, "an order above the first", err);
    e->tolerance = e->order / 10;
    const bool given = takes(at, "+-") || takes(at, "\u00b1");
    if (!given && **at == '+')
        return refuse(*at, "'+-'", err);
    if (given && !take_number(at, 0, e->order, &e->tolerance))
        return refuse(*at,
                      "a tolerance above 0 and below the order, since the order 0 is that of "
                      "errors that do not fall",
                      err);
    return BR_OK;
}

static enum br_status take_constant(const char **at, const char *unit, struct br_expectation *e,
                                    struct br_error *err)
{
    const char *next = *at;
    const bool comma = takes(&next, ","), most = comma && takes(&next, "at most");
    if (!most && !(comma && takes(&next, "constant")))
        return BR_OK;
    *at = next;
    if (e->tolerance == 0)
        return refuse(*at, "no constant of a least order: it belongs to one order", err);
    if (!most && !(take_number(at, 0, INFINITY, &e->floor) && takes(at, "to")))
        return refuse(*at, "a range of the constant, 'constant 2e-4 to 3e-4'", err);
    if (!take_number(at, most ? 0 : e->floor, INFINITY, &e->ceiling))
        return refuse(*at, "a constant above 0, and above the first", err);
    if (!takes(at, unit))
        return br_fail(err, BR_BAD_INPUT,
                       "found '%.30s' behind the constant, expected its unit, %s", *at, unit);
    return BR_OK;
}

enum br_status br_expectation_read(const char **at, const char *unit, enum br_axis *axis,
                                   struct br_expectation *e, struct br_error *err)
{
    *at = br_skip_word(*at, "");
    *axis = BR_AXES;
    e->floor = e->ceiling = NAN;
    for (int a = 0; a < BR_AXES && *axis == BR_AXES; a++)
        if (takes(at, br_axis_letters[a]))
            *axis = (enum br_axis)a;
    e->exponential = takes(at, "exponential");
    if (take_band(at, e, err))
        return err->status;
    if (takes(at, "down to") && !take_number(at, 0, INFINITY, &e->down_to))
        return refuse(*at, "an error above 0", err);
    return take_constant(at, unit, e, err);
}

/* ---- a list ---- */

enum { MOST = 2000 }; /* more than two for each column of a table */

/* Whether an order stands there, and nothing else before the next one; also ">= 2 +- 0.1", which
 * is refused where it is read. */
static bool is_order(const char *at)
{
    struct br_error ignored = {0};
    struct br_expectation e = {0};
    enum br_axis axis;
    const bool reads = !br_expectation_read(&at, "", &axis, &e, &ignored);
    return reads ? !*at || strchr(",;", *at) : is_tolerance(at);
}

/* Takes "l2:", or "l2 =", or "l2" before ">= 1.8", or nothing where an order stands. In quotes a
 * name may have all of these; quotes may be a part of a name, too. */
static enum br_status take_name(const char **at, char name[64], struct br_error *err)
{
    const char *name_at = *at, *quoted = br_list_quoted(&name_at);
    const char *end = quoted ? br_skip_word(quoted, "") : NULL;
    size_t length = quoted ? (size_t)(quoted - 1 - name_at) : 0;
    *name = '\0';
    const bool is_word = **at && strchr("hk", **at) && isdigit((unsigned char)(*at)[1]); /* h1 */
    if ((is_order(*at) && !is_word) || br_skip_word(*at, "<="))
        return BR_OK;
    if (!end || !*end || !strchr(":=><", *end)) {
        name_at = end = *at;
        while (*end && !strchr(":;", *end) && !(*end == '=' && is_order(end + 1)) &&
               !br_skip_word(end, "<=") && !(strchr(">\xe2", *end) && is_order(end)))
            end++;
        if ((!*end || *end == ';') && strchr(*at, '=') && strchr(*at, '=') < end)
            end = strchr(*at, '=');
        for (length = (size_t)(end - *at); length && strchr(" \t\n", (*at)[length - 1]);)
            length--;
    }
    if (!*end || *end == ';' || length == 0)
        return refuse(*at, "an error's name and ':'", err);
    if (length > 63)
        return refuse(*at, "a name of at most 63 bytes", err);
    snprintf(name, 64, "%.*s", (int)length, name_at);
    *at = strchr(":=", *end) ? br_skip_word(end + 1, "") : end;
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
                       "expected an order, as in 'l2: h 2 +- 0.1', 'L2 >= 1.8' or, of one error, "
                       "'2'; found nothing");
    char name[64] = "";
    for (bool more = true, comma = false; more;) {
        struct br_order_expectation *e = &all[(*count)++];
        const bool same = comma && (is_order(at) || !strpbrk(at, ":=<>"));
        if ((!same && take_name(&at, name, err)) ||
            br_expectation_read(&at, "", &e->axis, &e->band, err))
            return err->status;
        strcpy(e->quantity, name);
        e->band.line = line;
        for (const struct br_order_expectation *f = all; f < e; f++)
            if (f->axis == e->axis && strcmp(f->quantity, name) == 0)
                return br_fail(err, BR_BAD_INPUT, "the order of %s%s%s is given twice",
                               *name ? name : "the errors", e->axis < BR_AXES ? " in " : "",
                               e->axis < BR_AXES ? br_axis_letters[e->axis] : "");
        comma = takes(&at, ",");
        more = comma || takes(&at, ";");
    }
    return *at ? refuse(at, "',' or ';' or the end", err) : BR_OK;
}

enum br_status br_expectation_find(const struct br_numbers *n, struct br_order_expectation *e,
                                   size_t *quantity, struct br_error *err)
{
    const size_t none = n->quantities;
    size_t exact = none, similar = none, count = 0;
    for (size_t i = none; i-- > 0;) {
        const char *name = n->quantity[i].name;
        exact = strcmp(name, e->quantity) == 0 ? i : exact;
        if (!*e->quantity || strcasecmp(name, e->quantity) == 0)
            similar = i, count++;
    }
    *quantity = exact < none ? exact : similar;
    if (exact == none && count > 1)
        return br_fail(err, BR_BAD_INPUT,
                       "an order%s%s is expected, and %zu columns may be meant: expected the name "
                       "of one before it, as in '%.60s: h 2 +- 0.1'",
                       *e->quantity ? " of " : "", e->quantity, count, n->quantity[similar].name);
    if (!*e->quantity && n->other_error && count == 1)
        return br_fail(err, BR_BAD_INPUT,
                       "an order is expected, and two columns may be meant, of which %.60s is left "
                       "aside: expected the name of one before it, as in '%.60s: h 2 +- 0.1'",
                       n->other_error, n->quantity[similar].name);
    const bool in_h = n->column[BR_AXIS_SPACE], in_k = n->column[BR_AXIS_TIME];
    if (e->axis == BR_AXES && in_h && in_k)
        return br_fail(err, BR_BAD_INPUT,
                       "an order is expected, and h and k are refined: expected one of the two "
                       "before it, as in 'h 2 +- 0.1'");
    e->axis = e->axis < BR_AXES ? e->axis : in_k ? BR_AXIS_TIME : BR_AXIS_SPACE;
    return BR_OK;
}

/* ---- verdicts ---- */

/* Takes what is expected, and the points of a line as their source has them: what was left out on
 * it is sought again, without errors that are expected not to fall. */
static enum br_status observe(const struct br_orders *o, const struct br_quantity_orders *of,
                              const struct br_orders_line *line, const struct br_expectation *e,
                              struct br_case *c, struct br_error *err)
{
    *c = line->observed;
    c->expected = *e;
    c->point = br_allocate(c->points + 1, sizeof *c->point);
    if (!c->point)
        return br_no_memory(err, "the verdict");
    memcpy(c->point, line->observed.point, c->points * sizeof *c->point);
    for (size_t i = 0; i < c->points; i++) {
        struct br_point *p = &c->point[i];
        const enum br_flag out = o->numbers->row[p->row].out[of->quantity];
        if (p->flag != BR_FLAG_FAILED && p->error > 0)
            p->flag = out ? out : p->error <= e->down_to ? BR_FLAG_STALLED : BR_FLAG_NONE;
    }
    return br_orders_observe(o->numbers->column[line->axis], BR_VERIFY_LEAST_POINTS, c, err);
}

/* No order passes where the finest run failed, unless a window leaves that out. The rows are
 * sorted, so the last one of the finest size has the finest other size. */
static void need_finest(const struct br_numbers *n, size_t quantity, enum br_axis axis,
                        struct br_case *c)
{
    const struct br_numbers_row *finest = NULL;
    char name[BR_CELL_NAME];
    for (const struct br_numbers_row *row = n->row; row < n->row + n->rows; row++)
        if (br_has_part(row->out[quantity]) && (!finest || row->z[axis] <= finest->z[axis]))
            finest = row;
    if (c->verdict != BR_PASS || (!finest->failure && isfinite(finest->number[quantity])))
        return;
    br_numbers_name_cell(n, finest, name);
    c->verdict = BR_INCONCLUSIVE;
    snprintf(c->reason, sizeof c->reason,
             "the finest row, %s, %s%.300s; without it the others pass (--without leaves it out)",
             name, finest->failure ? "failed: " : "has no number",
             finest->failure ? finest->failure : "");
}

/* The order of a grid of errors is the answer for the axis, as far as the joint fit has one. */
enum br_status br_orders_decide(const struct br_orders *o, const struct br_quantity_orders *of,
                                const struct br_order_expectation *e, struct br_check *check,
                                struct br_error *err)
{
    const struct br_orders_line *line = br_orders_finest(of, e->axis);
    const struct br_orders_answer *answer = &of->answer[e->axis];
    const bool joint =
        br_joint_describes(&of->joint) || (!line && of->flag); /* of a grid without lines */
    if (!line && !joint)
        return br_fail(err, BR_BAD_INPUT,
                       "%s: an order of %s in %s is expected, and there are no three sizes of one "
                       "line",
                       check->path, br_quantity_of(o, of)->name, br_axis_letters[e->axis]);
    if (!br_grow(&check->cases, check->count, &check->room, sizeof *check->cases))
        return br_no_memory(err, "the verdicts");
    struct br_case *c = &check->cases[check->count++];
    if (joint ? br_orders_joint_case(o, of, e->axis, c, err)
              : observe(o, of, line, &e->band, c, err))
        return err->status;
    c->expected = e->band;
    if (!joint && answer->open)
        br_case_take_order(c, answer->order, NAN);
    c->open = answer->open;
    br_case_decide(c);
    need_finest(o->numbers, of->quantity, e->axis, c);
    if (isnan(c->order.value)) /* of too few errors for a verdict */
        c->order = answer->order;
    return BR_OK;
}

enum br_status br_orders_check(const struct br_orders *o, const struct br_order_expectation *e,
                               size_t count, struct br_check *check, struct br_error *err)
{
    for (size_t i = 0; i < count; i++) {
        struct br_order_expectation found = e[i];
        struct br_error inner = {0};
        size_t quantity;
        if (br_expectation_find(o->numbers, &found, &quantity, &inner))
            return br_fail(err, inner.status, "%s: %s", check->path, inner.message);
        if (quantity == o->count)
            return br_fail(err, BR_BAD_INPUT,
                           "%s: an order of '%s' is expected, and there is no such column",
                           check->path, found.quantity);
        if (br_orders_decide(o, &o->of[quantity], &found, check, err))
            return err->status;
    }
    return BR_OK;
}
