/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/expectation/check.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"
#include "orders/line/line_order.h"

const char *const br_verify_names[BR_VERIFY_KINDS] = {"space", "time", "joint"};
const char *const br_verdict_names[] = {"PASS", "FAIL", "INCONCLUSIVE"};

__attribute__((format(printf, 3, 4))) static void conclude(struct br_case *c,
                                                           enum br_verdict verdict,
                                                           const char *format, ...)
{
    c->verdict = verdict;
    va_list args;
    va_start(args, format);
    vsnprintf(c->reason, sizeof c->reason, format, args);
    va_end(args);
}

/* ---- the observation ---- */

static void count_used(struct br_case *c)
{
    c->used = 0;
    for (size_t i = 0; i < c->points; i++)
        c->used += !c->point[i].flag;
}

/* A point that is not a number must fail, whatever its flag, unless points may miss. */
static const struct br_point *first_failed(const struct br_case *c)
{
    for (size_t i = 0; i < c->points && !c->may_miss; i++) {
        const struct br_point *p = &c->point[i];
        if (p->failure[0] || p->flag == BR_FLAG_FAILED || !(p->error >= 0 && isfinite(p->error)))
            return p;
    }
    return NULL;
}

/* The note begins with the window. */
static void begin_note(struct br_case *c)
{
    snprintf(c->note, sizeof c->note, "%s%s", c->window ? "rows by hand: " : "",
             c->window ? c->window : "");
}

static void list_left_out(struct br_case *c)
{
    const char *between = c->note[0] ? "; left out: " : "left out: ";
    for (size_t i = 0; i < c->points; i++) {
        const struct br_point *p = &c->point[i];
        if (!p->flag)
            continue;
        br_append(c->note, sizeof c->note, "%s%s (%s", between, p->label, br_flag_name(p->flag));
        between = ", ";
        if (isfinite(p->error))
            br_append(c->note, sizeof c->note, ", error %.1e", p->error);
        br_append(c->note, sizeof c->note, ")");
    }
}

/* Whether constants are those of the observed order, since none is expected, or a least one. */
static bool of_observed(const struct br_case *c)
{
    return isnan(c->expected.order) || c->expected.tolerance == 0;
}

static void find_constants(struct br_case *c)
{
    const bool none = isnan(c->order.value) && isfinite(c->factor.value); /* exponential */
    const double order = of_observed(c) && !none ? c->order.value : c->expected.order;
    size_t finest = 0;
    c->constant = NAN;
    for (size_t i = c->points; i-- > 0;) {
        struct br_point *p = &c->point[i];
        p->constant = p->error / (pow(p->z, order) - pow(p->z_against, order));
        if (!p->flag && finest++ < BR_VERIFY_MOST_POINTS && !(p->constant <= c->constant))
            c->constant = p->constant; /* also where there was none yet */
    }
}

/* The order with its intervals, from the points that are not left out; those that do not show it
 * are left out then. */
static enum br_status find_order(struct br_case *c, struct br_error *err)
{
    struct br_line_order found;
    const enum br_status status = br_line_order_find(c->point, c->points, &found, err);
    c->order = found.order;
    c->low99 = found.low99;
    c->high99 = found.high99;
    c->factor = br_exponential_factor(&found);
    c->exponential = found.law[BR_LAW_EXPONENTIAL];
    for (enum br_law law = BR_LAW_LOWER; law < BR_LAWS; law++)
        c->law = found.law[law] > 0.5 ? law : c->law;
    const bool known = isfinite(found.order.value) || isfinite(found.rate.value);
    for (size_t i = 0; i < c->points && known; i++)
        if (!c->point[i].flag) {
            c->point[i].flag = br_line_order_flag(&found, c->point, i);
            c->point[i].lost = c->point[i].flag != BR_FLAG_NONE;
        }
    for (size_t i = 0; i < c->points; i++)
        c->point[i].fit = br_line_fit(c->point, c->points, i, &c->order);
    return status;
}

/* ---- the verdict ---- */

/* The order that the point shows with the used one before it; NaN: there is none. */
static double rate_to(const struct br_case *c, size_t i)
{
    size_t before = i;
    while (before > 0 && c->point[before - 1].flag)
        before--;
    return !c->point[i].flag && before ? br_point_rate(&c->point[before - 1], &c->point[i]) : NAN;
}

/* The orders that the two coarsest points and the two finest ones show by themselves, used or not.
 */
static void end_rates(const struct br_case *c, double *first, double *last)
{
    *first = *last = NAN;
    for (size_t i = 1; i < c->points; i++) {
        const double rate = br_point_rate(&c->point[i - 1], &c->point[i]);
        *first = isnan(*first) ? rate : *first;
        *last = isnan(rate) ? *last : rate;
    }
}

/* Whether orders from size to size, less the order, still change: they go away from it or, by more
 * than its interval is wide, more slowly than a next term h^0.7 lets them. */
static bool drifts(const struct br_case *c, const double off[3], double log_ratio)
{
    static const double slow = 0.7;
    const double sign = off[2] < 0 ? -1 : 1, d = off[1] - off[0], e = off[2] - off[1];
    const bool away = sign * d > 0 && sign * e > 0 && fabs(off[2]) > 0.03;
    return away || (d * e > 0 && fabs(d + e) > c->order.high - c->order.low &&
                    log(d / e) < slow * log_ratio);
}

/* Says so where the last three orders from size to size drift. */
static void note_drift(struct br_case *c)
{
    enum { LAST = 3 };
    double off[LAST] = {NAN, NAN, NAN}, rate = NAN, log_ratio = NAN;
    for (size_t i = 0; i < c->points; i++) {
        const double next = rate_to(c, i);
        if (isnan(next))
            continue;
        rate = next;
        log_ratio = log(c->point[i - 1].z / c->point[i].z);
        off[0] = off[1], off[1] = off[2], off[2] = rate - c->order.value;
    }
    if (drifts(c, off, log_ratio))
        br_append(c->note, sizeof c->note, "%sthe order from row to row still %s, the last is %.2f",
                  c->note[0] ? "; " : "", off[2] < off[1] ? "falls" : "rises", rate);
}

/* The least tolerance, rounded up, that would contain the interval. */
static double enough(const struct br_case *c)
{
    const double expected = c->expected.order;
    const double off = fmax(fabs(c->order.low - expected), fabs(c->order.high - expected));
    return c->expected.tolerance > 0 ? ceil(100 * off + 1e-9) / 100 : INFINITY;
}

/* Where the orders from size to size go. */
struct trend {
    double first, last;
    bool nearer;  /* the last ones are nearer to what is expected */
    bool stays;   /* they are not, and out of the band: finer grids do not help */
    bool outside; /* the interval lies outside the band */
};

static struct trend trend_of(const struct br_case *c)
{
    const struct br_expectation *e = &c->expected;
    struct trend t;
    end_rates(c, &t.first, &t.last);
    const double first = c->of_grid ? NAN : t.first, last = c->of_grid ? NAN : t.last;
    const double high = e->tolerance > 0 ? fmax(e->order, e->highest) : INFINITY;
    const double off = fabs(last - fmin(fmax(last, e->order), high));
    const double before = fabs(first - fmin(fmax(first, e->order), high));
    t.outside = c->order.high < br_expectation_low(e) || c->order.low > br_expectation_high(e);
    t.nearer = off < 0.75 * before;
    t.stays = !t.nearer && off > e->tolerance && off >= (t.outside ? 0.9 : 1) * before;
    return t;
}

/* Says that errors without an order do not fall from size to size; false: they do. */
static bool advise_uneven(struct br_case *c)
{
    size_t rises = 0;
    for (size_t i = 1; i < c->points; i++)
        rises += c->point[i].error > c->point[i - 1].error;
    if (!rises || c->of_grid || br_order_determined(&c->order))
        return false;
    br_append(c->reason, sizeof c->reason, "; the %s %s",
              c->point[0].z_against > 0 ? "differences" : "errors",
              rises + 1 == c->points ? "grow with each finer size: there is no convergence"
                                     : "rise and fall: converge each run further, or measure over "
                                       "the whole domain and time");
    return true;
}

/* Says what would settle the verdict: which way the orders from size to size go decides it. */
static void advise(struct br_case *c)
{
    const struct br_expectation *e = &c->expected;
    const struct trend t = trend_of(c);
    const double few = 0.05 * e->order; /* errors of few digits leave an order so far off */
    static const double no_order = 10;  /* errors that fall faster are those of unstable steps */
    if (advise_uneven(c))
        return;
    if (t.nearer)
        br_append(
            c->reason, sizeof c->reason,
            "; the two finest show %.2f, the two coarsest %.2f: the coarse ones are %s. Start "
            "finer, or refine further",
            t.last, t.first,
            t.first > no_order && c->kind == BR_VERIFY_TIME ? "beyond a limit of stability"
                                                            : "not asymptotic");
    else if (t.stays && !t.outside && enough(c) < few)
        br_append(
            c->reason, sizeof c->reason,
            "; finer grids do not help: the two finest show %.4g, the two coarsest %.4g. Take "
            "a tolerance of %.4g, or give errors with more digits",
            t.last, t.first, enough(c));
    else if (t.stays)
        br_append(c->reason, sizeof c->reason,
                  "; finer grids do not help: the two finest show %.2f, the two coarsest %.2f. "
                  "Find what lowers the order, or expect another order",
                  t.last, t.first);
    else if (!(c->of_grid && t.outside)) {
        br_append(c->reason, sizeof c->reason, "; %s",
                  c->order.high - c->order.low > br_expectation_high(e) - br_expectation_low(e)
                      ? "the interval is wider than the band: finer grids would narrow it"
                      : "finer grids would decide");
        if (enough(c) < e->order / 4) /* a wider one would accept any order */
            br_append(c->reason, sizeof c->reason, ", a tolerance of %.4g would include it",
                      enough(c));
    }
    if (*e->why)
        br_append(c->reason, sizeof c->reason, " (expected: %s)", e->why);
}

static void decide_too_few(struct br_case *c)
{
    bool unstable = false, missing = false;
    for (size_t i = 0; i < c->points; i++) {
        unstable |= c->point[i].flag == BR_FLAG_UNSTABLE;
        missing |= c->point[i].flag == BR_FLAG_FAILED;
    }
    conclude(c, BR_INCONCLUSIVE, "%zu of %zu errors can be used, an order needs %d: %s", c->used,
             c->points, BR_VERIFY_LEAST_POINTS,
             unstable  ? "use smaller time steps, or contact at u_n (contact: implicit), which is "
                         "stable"
             : missing ? "add the missing numbers, or more rows"
                       : "use coarser grids, whose errors are above the limits");
}

static const struct br_point *finest_used(const struct br_case *c)
{
    const struct br_point *last = c->point + c->points - 1;
    while (last > c->point && last->flag)
        last--;
    return last;
}

/* Whether an error is zero where the order shows one above the digits: the reference is the
 * solution itself, or terms cancel. Values that are the same may have no more digits. */
static bool vanishes(const struct br_case *c, const struct br_point *p)
{
    const struct br_point *last = finest_used(c);
    return p->error == 0 && p->z_against == 0 &&
           last->error * pow(p->z / last->z, c->order.value) > fmax(p->rounding, last->rounding);
}

/* The first error at the fine end that the search for the order left out. It shows another
 * solution, round-off, the error of a reference or tolerance, or terms that cancel: without it the
 * order of the coarse errors proves nothing, unless such errors are expected (`down to`). */
static const struct br_point *first_beyond(const struct br_case *c)
{
    const struct br_point *first = NULL, *last = finest_used(c);
    for (const struct br_point *p = c->point + c->points; p-- > last + 1;)
        if (vanishes(c, p) ? !(c->expected.down_to > 0)
                           : p->lost && !(p->error <= c->expected.down_to))
            first = p;
    return first;
}

/* Whether errors from a row on scatter, as round-off does while it grows: their orders from size to
 * size rise, and fall again. */
static bool scatters(const struct br_case *c, size_t from)
{
    static const double much = 0.5;
    double least = INFINITY, top = -INFINITY;
    for (size_t i = from + 1; i < c->points; i++) {
        const double rate = br_point_rate(&c->point[i - 1], &c->point[i]);
        least = fmin(least, rate);
        top = rate > least + much ? fmax(top, rate) : top;
        if (top > rate + much)
            return true;
    }
    return false;
}

/* Whether the finest error is larger than all that show the order: the errors fall, then grow. */
static bool blows_up(const struct br_case *c, const struct br_point *first)
{
    double largest = 0;
    for (size_t i = 0; i < c->points; i++)
        largest = !c->point[i].flag ? fmax(largest, c->point[i].error) : largest;
    return largest > 0 && c->point[c->points - 1].lost && c->point[c->points - 1].error > largest &&
           !scatters(c, (size_t)(first - c->point));
}

/* The errors fall, then grow; without an order from the smallest one on. */
static void conclude_growth(struct br_case *c, const struct br_point *from)
{
    char text[64], order[96] = "the errors fall";
    const struct br_point *last = c->point + c->points - 1;
    const bool known = br_order_determined(&c->order);
    if (known)
        snprintf(order, sizeof order, "the order is %s",
                 br_order_text(&c->order, text, sizeof text));
    while (!known && from > c->point && from[-1].error > 0 && from->error > from[-1].error)
        from--;
    conclude(c, BR_FAIL, "%s, but from %s on %s grow, to %.2e", order, from->label,
             known ? "the errors" : "they", last->error);
    if (c->may_miss) /* all schemes of the beam are implicit */
        br_append(c->reason, sizeof c->reason, ": %s does that, and so does round-off",
                  c->kind == BR_VERIFY_TIME ? "a scheme that is not stable for small steps"
                                            : "an explicit scheme whose time step stays");
}

/* Enough errors must be left above that. */
static void advise_down_to(struct br_case *c, double error)
{
    size_t left = 0;
    for (size_t i = 0; i < c->points; i++)
        left += !c->point[i].flag && c->point[i].error > error;
    br_append(c->reason, sizeof c->reason,
              ": if that is round-off, or the reference's own error, expect the order 'down to "
              "%.0e'",
              error);
    if (left < BR_VERIFY_LEAST_POINTS)
        br_append(c->reason, sizeof c->reason, ", and add %d coarser than %s",
                  BR_VERIFY_LEAST_POINTS - (int)left, c->point[0].label);
}

static void decide_beyond(struct br_case *c, const struct br_point *first)
{
    char text[64];
    const struct br_point *before = first > c->point ? &first[-1] : first;
    const double falls_to = before->error * pow(first->z / before->z, c->order.value);
    const bool below = first->error < falls_to, small = first->error < 0.5 * falls_to;
    const bool falls = first->error < before->error;
    br_order_text(&c->order, text, sizeof text);
    if (blows_up(c, first)) {
        conclude_growth(c, first);
        return;
    }
    conclude(c, BR_INCONCLUSIVE, "the order is %s, but from %s on the errors %s, %.2e", text,
             first->label,
             small   ? "are far smaller than that"
             : below ? "are smaller than that"
             : falls ? "fall more slowly"
                     : "do not fall",
             first->error);
    if (below)
        br_append(c->reason, sizeof c->reason, ": finer grids would show whether terms cancel");
    else if (c->may_miss)
        advise_down_to(c, 4 * first->error);
    else
        br_append(c->reason, sizeof c->reason,
                  ": this is another solution, or the reference's own error; errors of coarser "
                  "grids are larger");
}

/* Says which row would settle the verdict; a source whose numbers are all needed says more itself.
 */
static void name_row(struct br_case *c)
{
    if (!c->points)
        return;
    const struct br_point *last = &c->point[c->points - 1];
    const bool lost =
        !vanishes(c, last) && (last->flag == BR_FLAG_ROUND_OFF || last->flag == BR_FLAG_REFERENCE ||
                               last->error <= c->expected.down_to);
    if (c->window && !trend_of(c).stays)
        br_append(c->reason, sizeof c->reason, "; leave out fewer rows");
    else if (c->may_miss && !c->open && !trend_of(c).stays)
        br_append(c->reason, sizeof c->reason, "; add a row %s than %s", lost ? "coarser" : "finer",
                  lost                  ? c->point[0].label
                  : last->z_against > 0 ? "all others" /* the finest value has no difference */
                                        : last->label);
}

/* "1.9 to 2.1", "at least 1.8" */
static const char *band_text(const struct br_expectation *e, char text[64])
{
    const double high = br_expectation_high(e);
    snprintf(text, 64, isfinite(high) ? "%.4g to %.4g" : "at least %.4g", br_expectation_low(e),
             high);
    return text;
}

static void straddle(struct br_case *c, const char *order, double low, double high)
{
    const bool below = c->order.low<low, above = c->order.high> high;
    if (below && above)
        conclude(c, BR_INCONCLUSIVE,
                 "the order's interval, %s, contains both ends of the band, %.4g and %.4g", order,
                 low, high);
    else
        conclude(c, BR_INCONCLUSIVE, "the order's interval, %s, contains the band's %s end, %.4g",
                 order, below ? "lower" : "upper", below ? low : high);
}

/* Whether the errors fall as A z^order + B z^highest with A, B >= 0 do: from size to size by orders
 * between the two, which fall. One power does not fit them, so its interval says nothing. */
static bool falls_by_two(const struct br_case *c, double low, double high)
{
    double last = high;
    size_t rates = 0;
    for (size_t i = 1; i < c->points; i++) {
        const double rate = rate_to(c, i);
        if (c->point[i].flag)
            continue;
        rates += isfinite(rate) ? 1 : 0;
        if (isnan(rate) && rates == 0) /* the first used point has none before it */
            continue;
        if (!(rate >= low && rate <= fmin(high, last + c->expected.tolerance)))
            return false;
        last = rate;
    }
    return rates >= 2 && c->expected.highest > c->expected.order;
}

/* "one more of 1/h" */
static const char *one_more(const struct br_case *c)
{
    return c->of_degree                ? "each degree"
           : c->kind == BR_VERIFY_TIME ? "one more of 1/k"
                                       : "one more of 1/h";
}

/* As of an interval, 95 % pass a verdict and 99 % fail it. */
static const double passes = 0.95, fails = 0.99;

/* Neither exponential convergence nor an order is sure. */
static void conclude_either(struct br_case *c)
{
    conclude(c, BR_INCONCLUSIVE,
             "the errors may fall exponentially, with a probability of %.0f %%, or by an order: "
             "finer grids would show which",
             100 * c->exponential);
}

/* Exponential convergence has no order, and an order is no such convergence: another factor fails,
 * whichever of the two there is. */
static void decide_factor(struct br_case *c)
{
    const double low = br_expectation_low(&c->expected), high = br_expectation_high(&c->expected);
    const struct br_estimate *f = &c->factor;
    const bool other = isfinite(f->value) && (exp(c->high99) < low || exp(c->low99) > high);
    char text[64], band[64];
    c->margin = fmin(f->low - low, high - f->high);
    if (f->low >= low && f->high <= high && c->exponential >= passes)
        conclude(c, BR_PASS, "%s", "");
    else if (c->exponential > 1 - fails && c->exponential < passes && !other)
        conclude_either(c);
    else if (isfinite(f->value))
        conclude(c, other ? BR_FAIL : BR_INCONCLUSIVE, "%s divides the errors by %s, expected %s",
                 one_more(c), br_order_text(f, text, sizeof text), band_text(&c->expected, band));
    else if (c->of_degree)
        conclude(c, br_order_determined(&c->order) ? BR_FAIL : BR_INCONCLUSIVE, "%s",
                 "the errors do not fall exponentially");
    else
        conclude(c, br_order_determined(&c->order) ? BR_FAIL : BR_INCONCLUSIVE,
                 "the errors do not fall exponentially; their order is %s",
                 br_order_text(&c->order, text, sizeof text));
}

/* Says why the case passes though its interval is wider than the band. */
static void note_two(struct br_case *c)
{
    const char *between =
        c->note[0] ? "; the orders from row to row, " : "the orders from row to row, ";
    for (size_t i = 1; i < c->points; i++)
        if (isfinite(rate_to(c, i))) {
            br_append(c->note, sizeof c->note, "%s%.2f", between, rate_to(c, i));
            between = ", ";
        }
    br_append(c->note, sizeof c->note, ", fall from %g to %g, as those of a sum of two powers do",
              c->expected.highest, c->expected.order);
}

/* Whether the two finest errors that are used show at least the least order that is expected. */
static bool is_fast(const struct br_case *c)
{
    return isinf(br_expectation_high(&c->expected)) &&
           rate_to(c, (size_t)(finest_used(c) - c->point)) >= br_expectation_low(&c->expected);
}

static void decide_order(struct br_case *c)
{
    const struct br_expectation *e = &c->expected;
    const double low = br_expectation_low(e), high = br_expectation_high(e);
    char text[64], band[64];
    double first, last;
    end_rates(c, &first, &last);
    br_order_text(&c->order, text, sizeof text);
    c->margin = fmin(c->order.low - low, high - c->order.high);
    const bool within = c->order.low >= low && c->order.high <= high;
    if (within || falls_by_two(c, low, high)) {
        conclude(c, BR_PASS, "%s", "");
        if (!within)
            note_two(c);
    } else if (isfinite(c->order.value) && (c->high99 < low || c->low99 > high)) {
        conclude(c, BR_FAIL, "the order, %s, lies %s the band, %s", text,
                 c->high99 < low ? "below" : "above", band_text(e, band));
        advise(c);
    } else if (isfinite(c->margin)) {
        straddle(c, text, low, high);
        advise(c);
    } else if (c->factor.low > 1 && is_fast(c) && c->exponential >= passes)
        conclude(c, BR_PASS, "%s", ""); /* exponential: faster than any order */
    else if (first < last && last <= high)
        conclude(c, BR_INCONCLUSIVE,
                 "the orders from size to size rise to %.2f: finer grids would show "
                 "whether they stop there",
                 last);
    else if (c->exponential > 0.5 && c->exponential < fails)
        conclude_either(c);
    else if (isfinite(c->factor.value))
        conclude(c, BR_FAIL, "the errors fall exponentially, by no order: %s divides them by %s",
                 one_more(c), br_order_text(&c->factor, text, sizeof text));
    else
        conclude(c, BR_FAIL, "no order fits the errors, %.2e to %.2e from coarse to fine",
                 c->point[0].error, c->point[c->points - 1].error);
}

/* An order can be right while the errors have doubled; errors that have become small mean another
 * scheme, too. */
static void decide_constant(struct br_case *c)
{
    const struct br_expectation *e = &c->expected;
    const bool high = !isnan(e->ceiling) && !(c->constant <= e->ceiling);
    const bool low = !isnan(e->floor) && !(c->constant >= e->floor);
    if (!high && !low)
        return;
    const enum br_verdict so_far = c->verdict;
    char before[sizeof c->reason];
    snprintf(before, sizeof before, "%s", c->reason);
    conclude(c, BR_FAIL, "the constant, %.4g%s%s, is %s, %.4g", c->constant, *c->unit ? " " : "",
             c->unit, high ? "above its upper limit" : "below its lower limit",
             high ? e->ceiling : e->floor);
    if (so_far != BR_PASS)
        br_append(c->reason, sizeof c->reason, "; and %s", before);
}

enum br_status br_case_observe(struct br_case *c, size_t least, struct br_error *err)
{
    c->order = (struct br_estimate){NAN, NAN, NAN};
    c->margin = NAN;
    c->reason[0] = '\0';
    begin_note(c);
    c->low99 = c->high99 = NAN;
    c->factor = (struct br_estimate){NAN, NAN, NAN};
    c->exponential = 0;
    c->law = BR_LAW_POWER;
    for (size_t i = 0; i < c->points; i++) {
        c->point[i].fit = (struct br_estimate){NAN, NAN, NAN};
        c->point[i].lost = false;
    }
    count_used(c);
    find_constants(c);
    const bool known = !first_failed(c) && c->used >= least;
    const enum br_status status = known ? find_order(c, err) : BR_OK;
    count_used(c);
    if (of_observed(c))
        find_constants(c);
    list_left_out(c);
    if (isfinite(c->factor.value)) {
        char text[64];
        br_append(c->note, sizeof c->note, "%s%s divides the errors by %s", c->note[0] ? "; " : "",
                  one_more(c), br_order_text(&c->factor, text, sizeof text));
    }
    note_drift(c);
    return status;
}

char *br_case_note(const struct br_case *c, char text[BR_CASE_NOTE])
{
    snprintf(text, BR_CASE_NOTE, "%s", c->note);
    if (c->law)
        br_append(text, BR_CASE_NOTE, "%sthe errors also show %s", *text ? "; " : "",
                  br_law_text(c->law));
    return text;
}

void br_case_take_order(struct br_case *c, struct br_estimate order, double constant)
{
    c->order = order;
    c->low99 = order.low;
    c->high99 = order.high;
    c->constant = constant;
    c->law = BR_LAW_POWER;
    for (size_t i = 0; i < c->points; i++) {
        c->point[i].fit = (struct br_estimate){NAN, NAN, NAN};
        c->point[i].lost = false;
        if (c->point[i].flag != BR_FLAG_FAILED && c->point[i].error > 0)
            c->point[i].flag = BR_FLAG_NONE;
    }
    begin_note(c);
    count_used(c);
}

void br_case_decide(struct br_case *c)
{
    /* The points of a joint fit are at the finest k that their h has, which may be another k. */
    const struct br_point *failed = first_failed(c), *beyond = first_beyond(c),
                          *turns = c->of_grid ? NULL : br_turning_point(c);
    if (failed)
        conclude(c, BR_FAIL, "at %s %s", failed->label,
                 failed->failure[0] ? failed->failure : "the error is not a number");
    else if (c->points < BR_VERIFY_LEAST_POINTS && c->points > 1 &&
             c->point[0].z_against == c->point[1].z)
        conclude(c, BR_INCONCLUSIVE, "%zu values have %zu differences; a verdict needs %d sizes",
                 c->points + 1, c->points, BR_VERIFY_LEAST_POINTS + 1);
    else if (c->points < BR_VERIFY_LEAST_POINTS)
        conclude(c, BR_INCONCLUSIVE, "the study has %zu errors, expected at least %d", c->points,
                 BR_VERIFY_LEAST_POINTS);
    else if (c->open)
        conclude(c, BR_INCONCLUSIVE, "%s", c->open);
    else if (turns)
        conclude_growth(c, turns);
    else if (beyond) {
        decide_beyond(c, beyond);
        decide_constant(c);
    } else if (isnan(c->order.value) && c->used < BR_VERIFY_LEAST_POINTS)
        decide_too_few(c);
    else {
        (c->expected.exponential ? decide_factor : decide_order)(c);
        decide_constant(c);
    }
    if (c->verdict == BR_INCONCLUSIVE)
        name_row(c);
    if (c->verdict != BR_PASS && c->window)
        br_append(c->reason, sizeof c->reason, " (rows by hand: %s)", c->window);
}

/* ---- all of a check ---- */

void br_check_clear(struct br_check *check)
{
    for (size_t i = 0; i < check->count; i++)
        free(check->cases[i].point);
    free(check->cases);
    check->cases = NULL;
    check->count = check->room = 0;
}

size_t br_check_failures(const struct br_check *checks, size_t count, const struct br_check **first)
{
    size_t failures = 0;
    *first = NULL;
    for (size_t i = 0; i < count; i++)
        if (checks[i].failure.status) {
            *first = *first ? *first : &checks[i];
            failures++;
        }
    return failures;
}

size_t br_check_tally(const struct br_check *checks, size_t count, enum br_verdict verdict)
{
    size_t tally = 0;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < checks[i].count; c++)
            tally += checks[i].cases[c].verdict == verdict;
    return tally;
}
