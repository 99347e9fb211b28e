/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "orders/orders.h"
#include "tables/report_cells.h"
#include "tables/reports.h"

enum {
    MOST_NAMED = BR_MOST_ANSWERS - 6, /* quantities with an answer; the tables have all */
    MOST_BESIDE = 4                   /* in one table of rows */
};

/* An order that follows from a number of unknowns or cells says for which mesh. */
static void say_dimension(struct br_document *d, const struct br_orders *o, double order)
{
    const int assumed = (int)o->numbers->dimension;
    const char *name = o->numbers->column[BR_AXIS_SPACE]->name;
    const char *format = "; --dimension %d gives %.2f";
    br_put_more(d, " (%d-D assumed", assumed);
    if (assumed == 1)
        br_put_more(d, ", or %s along one side", name);
    for (int other = 1; other <= 3; other++)
        if (other != assumed) {
            br_put_more(d, format, other, order * other / o->numbers->dimension);
            format = ", %d gives %.2f";
        }
    br_put_more(d, ")");
}

/* What the order means: "half the mesh size, a quarter of the error". */
static void say_meaning(struct br_document *d, const struct br_orders *o,
                        const struct br_quantity_orders *of, enum br_axis axis, double order)
{
    static const char *const parts[] = {"half", "a quarter", "an eighth", "a sixteenth"};
    const char *finer = o->numbers->column[axis]->is_degree ? "twice the degree"
                        : o->numbers->samples               ? "twice the samples"
                        : axis == BR_AXIS_SPACE             ? "half the mesh size"
                                                            : "half the time step";
    const bool joint = br_joint_describes(&of->joint);
    const char *number = br_quantity_of(o, of)->is_value ? "distance to the limit" : "error";
    const double factor = exp2(order), whole = round(order);
    const bool is_part = whole >= 1 && whole <= 4 && fabs(factor / exp2(whole) - 1) < 0.02;
    br_put_more(d, ": %s, ", finer);
    if (is_part)
        br_put_more(d, "%s%s the %s", parts[(int)whole - 1], whole > 1 ? " of" : "", number);
    else
        br_put_more(d, factor < 10 ? "the %s divided by %.2g" : "the %s divided by %.0f", number,
                    factor);
    if (joint)
        br_put_more(d, " in %s", br_axis_letters[axis]);
}

/* "exponential: each degree divides the error by 8.1 [7.9, 8.3]"; false: it is not, or not known.
 */
static bool say_exponential(struct br_document *d, const struct br_orders *o,
                            const struct br_orders_line *line)
{
    const struct br_resolution_column *size = o->numbers->column[line->axis];
    const struct br_estimate *factor = &line->observed.factor;
    if (!(isfinite(factor->low) && isfinite(factor->high)))
        return false;
    const bool counts = !size->is_size && !size->is_volume && !size->is_power;
    br_put_item(d, "exponential: %s %s%s divides the error by %s",
                size->is_degree ? "each" : "one more of", counts ? "" : "1/",
                counts ? size->name : br_axis_letters[line->axis], br_order_shown(d, factor));
    return true;
}

static bool are_zero(const struct br_case *c)
{
    bool zero = c->points > 0;
    for (size_t i = 0; i < c->points; i++)
        zero = zero && c->point[i].error == 0;
    return zero;
}

static void say_order(struct br_document *d, const struct br_orders *o,
                      const struct br_quantity_orders *of, const struct br_orders_line *line,
                      enum br_axis axis)
{
    const bool joint = br_joint_describes(&of->joint), value = br_quantity_of(o, of)->is_value;
    const struct br_estimate *order = &of->answer[axis].order;
    const bool none = !isfinite(order->value) || order->value <= 0 || order->low <= 0;
    if (value && isnan(order->value))
        return; /* of three values, whose p is said */
    if (none && line && say_exponential(d, o, line))
        return;
    if (none && line && !value && o->numbers->column[axis]->is_degree &&
        !are_zero(&line->observed)) {
        br_put_item(d, "exponential convergence not measurable, and errors over degrees have no "
                       "order");
        return;
    }
    const bool alone = !none && (!o->numbers->column[!axis] || o->tied);
    br_put_item(d, "order %s%s%s%s%s%s", alone ? "" : "in ", alone ? "" : br_axis_letters[axis],
                alone ? "" : " ", none ? "not measurable" : br_order_shown(d, order),
                !joint && *line->at ? " at " : "", joint ? "" : line->at);
    if (!none && !br_order_determined(order))
        br_put_more(d, " (not determined)");
    else if (!none)
        say_meaning(d, o, of, axis, order->value);
    else if (line && are_zero(&line->observed))
        br_put_more(d, value ? ", since all values are the same" : ", since all errors are 0");
    if (!none && o->numbers->assumed && axis == BR_AXIS_SPACE)
        say_dimension(d, o, order->value);
    if (none && line && !value && br_orders_stays(line))
        br_put_more(d, " (--value, if its limit is not known)");
}

static void say_orders(struct br_document *d, const struct br_orders *o,
                       const struct br_quantity_orders *of)
{
    const bool joint = br_joint_describes(&of->joint);
    const char *said = NULL; /* of both axes at once */
    for (int axis = 0; axis < BR_AXES; axis++) {
        const struct br_orders_line *line = br_orders_finest(of, (enum br_axis)axis);
        const struct br_orders_answer *answer = &of->answer[axis];
        if (answer->open && isnan(answer->order.value)) {
            if (answer->open != said)
                br_put_item(d, "%s", answer->open);
            said = answer->open;
        } else if (line || joint)
            say_order(d, o, of, line, (enum br_axis)axis);
    }
    if (joint)
        br_put_item(d, "by the joint fit of %zu rows, misfit %.2g %%", of->joint.points,
                    100 * of->joint.misfit);
    if (joint && isfinite(of->joint.floor))
        br_put_item(d, "with a floor of %.1e", of->joint.floor);
}

/* What the next finer size would give. */
static void say_next(struct br_document *d, const struct br_orders *o,
                     const struct br_quantity_orders *of)
{
    const struct br_orders_forecast f = br_orders_forecast_of(o, of);
    double given;
    const double next = f.line ? br_orders_next(o, &f, &given) : (double)NAN;
    if (!f.line)
        return;
    const struct br_resolution_column *column = o->numbers->column[f.line->axis];
    br_put_item(d, "%s = %s would give ", column->name,
                br_numbers_text(column, given, (char[32]){0}));
    if (br_quantity_of(o, of)->is_value)
        br_put_more(d, "a GCI of %.2g %%", 100 * next);
    else
        br_put_more(d, "%.1e", next);
}

enum { MOST_CELLS = 4 }; /* that an answer names */

/* Names a cell by a row of its h and one of its k. found: so many were named before. */
static void name_cell(struct br_document *d, const struct br_orders *o,
                      const struct br_numbers_row *of_h, const struct br_numbers_row *of_k,
                      size_t found)
{
    char h[64], k[64];
    if (found >= MOST_CELLS) {
        br_put_more(d, "%s", found == MOST_CELLS ? ", ..." : "");
        return;
    }
    br_numbers_name(o->numbers, of_h, BR_AXIS_SPACE, h);
    br_numbers_name(o->numbers, of_k, BR_AXIS_TIME, k);
    br_put_more(d, "%s%s, %s", found ? "; " : "", h, k);
}

/* The cells that a joint fit leaves out. */
static void say_cells_left_out(struct br_document *d, const struct br_orders *o,
                               const struct br_quantity_orders *of)
{
    size_t found = 0;
    br_put_more(d, " %zu of %zu cells left out: ", of->joint.left_out,
                of->joint.points + of->joint.left_out);
    for (size_t i = 0; i < o->numbers->rows; i++) {
        const struct br_numbers_row *row = &o->numbers->row[i];
        if (of->flag[i] == BR_FLAG_NONE || !br_has_part(of->flag[i]))
            continue;
        name_cell(d, o, row, row, found);
        if (found++ < MOST_CELLS)
            br_put_more(d, " (%s, %.1e)", br_flag_name(of->flag[i]), row->number[of->quantity]);
    }
    br_put_more(d, ".");
}

/* The first row of this size; NULL: there is none before row `end`. */
static const struct br_numbers_row *first_of(const struct br_orders *o, int axis, size_t end)
{
    for (size_t i = 0; i < end; i++)
        if (o->numbers->row[i].z[axis] == o->numbers->row[end].z[axis])
            return &o->numbers->row[i];
    return NULL;
}

static bool has_cell(const struct br_orders *o, double h, double k)
{
    bool has = false;
    for (size_t i = 0; i < o->numbers->rows; i++)
        has |= o->numbers->row[i].z[BR_AXIS_SPACE] == h && o->numbers->row[i].z[BR_AXIS_TIME] == k;
    return has;
}

/* The cells that a nearly full grid does not have: at most a quarter of all. */
static void say_missing(struct br_document *d, const struct br_orders *o)
{
    const struct br_numbers *n = o->numbers;
    size_t sizes[BR_AXES] = {0}, found = 0;
    for (size_t i = 0; i < n->rows; i++)
        for (int axis = 0; axis < BR_AXES; axis++)
            sizes[axis] += !first_of(o, axis, i);
    const size_t all = sizes[BR_AXIS_SPACE] * sizes[BR_AXIS_TIME];
    if (!br_orders_is_grid(o) || all <= n->rows || 4 * (all - n->rows) > all)
        return;
    br_put_answer(d, "%zu of %zu cells missing: ", all - n->rows, all);
    for (size_t i = 0; i < n->rows; i++)
        for (size_t j = 0; j < n->rows && !first_of(o, BR_AXIS_SPACE, i); j++)
            if (!first_of(o, BR_AXIS_TIME, j) &&
                !has_cell(o, n->row[i].z[BR_AXIS_SPACE], n->row[j].z[BR_AXIS_TIME]))
                name_cell(d, o, &n->row[i], &n->row[j], found++);
    br_put_more(d, ".");
}

/* Puts the number of rows that are left out, the first reason and where it begins. */
static void say_left_out(struct br_document *d, const struct br_quantity_orders *of)
{
    size_t count = 0, points = 0;
    const struct br_point *first = NULL;
    for (size_t l = 0; l < of->lines; l++)
        for (size_t i = 0; i < of->line[l].observed.points; i++) {
            const struct br_point *p = &of->line[l].observed.point[i];
            if (of->line[l].axis != of->line[0].axis)
                continue;
            points++;
            count += p->flag != BR_FLAG_NONE;
            first = !first && p->flag ? p : first;
        }
    if (!count)
        return;
    br_put_more(d, " %zu of %zu left out, the first at %s (%s", count, points, first->label,
                br_flag_name(first->flag));
    if (isfinite(first->error))
        br_put_more(d, ", %.1e", first->error);
    br_put_more(d, ").");
}

/* The limit of a value. On a line also its grid convergence index. */
static void say_limit(struct br_document *d, const struct br_orders *o,
                      const struct br_quantity_orders *of)
{
    const struct br_grid_limit *limit = &of->limit;
    const struct br_gci *g = &of->line[0].limits.gci;
    if (isfinite(limit->value.low))
        br_put_item(d, "limit %s", br_interval_shown(d, &limit->value));
    else
        br_put_item(d, "no limit");
    if (br_quantity_of(o, of)->is_value && of->lines == 1 && isfinite(g->fine.index)) {
        br_put_more(d, ", p = %.2f", g->order);
        if (o->numbers->assumed && of->line[0].axis == BR_AXIS_SPACE)
            say_dimension(d, o, g->order);
        br_put_more(d, ", GCI %.2g %% of the finest value, asymptotic %.3f", 100 * g->fine.index,
                    g->asymptotic);
    }
    if (limit->sequence != BR_SEQUENCE_UNKNOWN)
        br_put_more(d, ": %s", br_sequence_text(limit->sequence));
    const enum br_axis axis = of->line[0].axis;
    /* Of three values, whose p is all that is known. */
    if (of->lines == 1 && isnan(of->answer[axis].order.value) && !o->numbers->assumed &&
        limit->sequence == BR_MONOTONE_CONVERGENCE && isfinite(limit->value.low) &&
        isfinite(g->order))
        say_meaning(d, o, of, axis, g->order);
}

/* ---- what may help where there is no order ---- */

/* The errors of a line that are numbers, from coarse to fine; returns how many. */
static size_t numbers_of(const struct br_orders_line *line, const struct br_point **point)
{
    size_t count = 0;
    for (size_t i = 0; i < line->observed.points; i++)
        if (line->observed.point[i].error > 0 && isfinite(line->observed.point[i].error))
            point[count++] = &line->observed.point[i];
    return count;
}

/* Errors that fall and then grow, or rise and fall. */
static void say_uneven(struct br_document *d, const struct br_orders_line *line)
{
    static const char *const meant[BR_AXES] = {
        "an explicit scheme whose time step stays does that (refine both), and so does round-off",
        "a scheme that is not stable for small steps does that, and so does round-off"};
    const struct br_point *p[BR_MOST_SIZES];
    const size_t count = numbers_of(line, p);
    size_t least = 0, rises = 0;
    for (size_t i = 1; i < count; i++) {
        least = p[i]->error < p[least]->error ? i : least;
        rises += p[i]->error > p[i - 1]->error;
    }
    if (count < BR_ORDERS_LEAST)
        br_put_more(d, " An order needs three numbers.");
    else if (rises && rises == count - 1 - least && p[count - 1]->error > 2 * p[least]->error)
        br_put_more(d, " From %s on the errors grow, to %.1e: %s.", p[least]->label,
                    p[count - 1]->error, meant[line->axis]);
    else if (rises)
        br_put_more(d, " The errors rise and fall: converge each run further, or measure them over "
                       "the whole domain and time.");
}

/* Coarse errors that fall faster than any order are those of steps that are too large. */
static void say_unstable(struct br_document *d, const struct br_orders_line *line)
{
    static const double most = 10; /* an order above it is none */
    const struct br_point *p[BR_MOST_SIZES], *last = NULL;
    const size_t count = numbers_of(line, p);
    for (size_t i = 1; i < count && p[i - 1]->flag == BR_FLAG_COARSE; i++)
        last = br_point_rate(p[i - 1], p[i]) > most ? p[i] : last;
    if (last && line->axis == BR_AXIS_TIME)
        br_put_more(d, " The errors above %s are those of steps beyond a limit of stability.",
                    last->label);
}

/* Values that go up and down, or whose differences grow. */
static void say_restless(struct br_document *d, const struct br_orders_line *line)
{
    const enum br_sequence sequence = line->limits.limit.sequence;
    const struct br_point *point = line->observed.point;
    double v[BR_MOST_SIZES + 1];
    size_t count = 0, turns = 0;
    for (const struct br_point *p = point; p <= point + line->observed.points; p++) {
        v[count] = p->value;
        count += isfinite(p->value) ? 1 : 0;
    }
    for (size_t i = 2; i < count; i++)
        turns += (v[i] - v[i - 1]) * (v[i - 1] - v[i - 2]) < 0;
    const double *finest = &v[count < 3 ? 0 : count - 3];
    if (sequence == BR_MONOTONE_DIVERGENCE)
        br_put_more(d, " The differences grow: the sizes are too coarse, or there is no limit, as "
                       "at a singularity.");
    else if (turns && (sequence == BR_SEQUENCE_UNKNOWN || sequence == BR_SEQUENCE_ANOMALOUS ||
                       sequence == BR_OSCILLATORY_DIVERGENCE))
        br_put_more(d,
                    " The values go up and down, the finest three between %.6g and %.6g: converge "
                    "each run further, or average over time.",
                    fmin(finest[0], fmin(finest[1], finest[2])),
                    fmax(finest[0], fmax(finest[1], finest[2])));
}

static void say_advice(struct br_document *d, const struct br_orders *o,
                       const struct br_quantity_orders *of, const struct br_orders_line *line)
{
    const struct br_estimate *order = &of->answer[line->axis].order;
    const bool none = !isfinite(order->value) || order->low <= 0;
    if (br_orders_is_grid(o) || isfinite(line->observed.factor.low))
        return;
    if (br_quantity_of(o, of)->is_value)
        say_restless(d, line);
    else if (!none)
        say_unstable(d, line);
    else if (!br_orders_stays(line))
        say_uneven(d, line);
}

/* What follows from the formal order: an index that trusts it. */
static void say_formal(struct br_document *d, const struct br_orders *o,
                       const struct br_quantity_orders *of)
{
    const struct br_orders_line *line = &of->line[0];
    if (!br_quantity_of(o, of)->is_value || of->lines != 1)
        return;
    if (br_gci_is_far(&line->limits.gci, o->formal))
        br_put_more(d,
                    " p is far from the formal order %g%s: with the limits of Oberkampf and Roy "
                    "(2010) the GCI is %.2g %%.",
                    o->formal, o->assumed_formal ? " (assumed)" : "",
                    100 * br_gci_limited(&line->limits.gci, o->formal));
}

static void put_given(struct br_document *d, const struct br_numbers *numbers, size_t row)
{
    for (int axis = 0; axis < BR_AXES; axis++)
        if (numbers->column[axis])
            BR_PUT(d, br_number(numbers->row[row].given[axis]), .key = numbers->column[axis]->name,
                   .unit = numbers->unit[axis],
                   .format = numbers->column[axis]->is_size ? "%.6g" : "%.15g");
}

/* Puts a number, its rates, and why the row is left out. number: of the quantity, where several
 * stand in a row; else 0. */
static void put_number(struct br_document *d, const struct br_orders *o,
                       const struct br_quantity_orders *of, size_t row, size_t number)
{
    const struct br_numbers *n = o->numbers;
    const struct br_numbers_row *r = &n->row[row];
    const struct br_quantity *q = br_quantity_of(o, of);
    const enum br_axis lost = isnan(r->given[BR_AXIS_SPACE]) ? BR_AXIS_SPACE : BR_AXIS_TIME;
    const bool both = n->column[BR_AXIS_SPACE] && n->column[BR_AXIS_TIME] && !o->tied;
    const double found = r->number[of->quantity];
    const enum br_flag out = r->out[of->quantity];
    const bool failed = r->failure || (isnan(found) && out != BR_FLAG_ABSENT);
    const char *left_out = br_flag_name(failed             ? BR_FLAG_FAILED
                                        : br_has_part(out) ? BR_FLAG_NONE
                                                           : out);
    char prefix[24] = "", name[64]; /* prefix: of the keys, which are unique in a table */
    if (number)
        snprintf(prefix, sizeof prefix, "%zu ", number);
    BR_PUT(d, br_number(found),
           .key = br_format(d, "%s%s", prefix, q->is_value ? "value" : "error"),
           .heading = number ? q->name : NULL, .unit = q->unit,
           .format = q->is_value ? "%.9g" : "%.3e");
    if (r->repeat)
        BR_PUT(d, br_number(r->deviation[of->quantity]), .key = br_format(d, "%sdeviation", prefix),
               .heading = "deviation", .unit = q->unit, .format = "%.1e");
    for (int axis = 0; axis < BR_AXES; axis++) {
        const struct br_row_point *at = of->point[axis] ? &of->point[axis][row] : NULL;
        const struct br_orders_line *line = at ? at->line : NULL; /* NULL: the row is on none */
        const enum br_flag flag = line ? line->observed.point[at->index].flag : BR_FLAG_NONE;
        const char *letter = br_axis_letters[axis];
        if (n->column[axis] && !n->column[axis]->is_degree && !(o->tied && axis == BR_AXIS_TIME))
            BR_PUT(d, br_number(line ? br_orders_rate(line, at->index) : (double)NAN),
                   .key = br_format(d, "%srate_%s", prefix, letter),
                   .heading = both ? br_format(d, "rate in %s", letter) : "rate", .format = "%.2f");
        if (flag && flag != BR_FLAG_FAILED) /* the next finer one may have failed */
            left_out = br_flag_name(flag);
    }
    if (r->failure && n->column[lost] && isnan(r->given[lost])) {
        br_numbers_name(n, r, lost, name);
        left_out = br_format(d, "failed, %s", name);
    }
    BR_PUT(d, br_text(left_out), .key = br_format(d, "%sleft_out", prefix), .heading = "left out");
}

/* Puts each row with some quantities: for programs one, for people the rates beside each number. */
static void put_rows(struct br_document *d, const struct br_orders *o, size_t from, size_t to,
                     unsigned flags)
{
    const bool people = flags & BR_FOR_PEOPLE, all = to - from == o->count;
    const char *first = br_quantity_of(o, &o->of[from])->name;
    const char *last = br_quantity_of(o, &o->of[to - 1])->name;
    br_put_table(d, people ? "" : br_format(d, "rows-%zu", from + 1),
                 people && all ? "Row by row"
                 : people      ? br_format(d, "Row by row, %s to %s", first, last)
                               : br_format(d, "%s, row by row", first),
                 flags);
    for (size_t row = 0; row < o->numbers->rows; row++) {
        br_put_row(d);
        if (!people)
            BR_PUT(d, br_text(first), .key = "quantity");
        put_given(d, o->numbers, row);
        for (size_t i = from; i < to; i++)
            put_number(d, o, &o->of[i], row, people ? i + 1 : 0);
        BR_PUT(d, br_text(o->numbers->row[row].failure), .key = "failure",
               .flags = BR_FILES_ONLY | BR_WRAP);
        for (int axis = 0; axis < BR_AXES && !people; axis++)
            if (o->numbers->column[axis])
                BR_PUT(d, br_number(o->numbers->row[row].z[axis]),
                       .key = axis == BR_AXIS_SPACE ? "size_h" : "size_k");
    }
}

static void put_costs(struct br_document *d, const struct br_numbers *numbers)
{
    br_put_table(d, "costs", "What each run costs", 0);
    for (size_t i = 0; i < numbers->rows; i++) {
        const struct br_numbers_row *row = &numbers->row[i];
        br_put_row(d);
        put_given(d, numbers, i);
        BR_PUT(d, br_number(row->seconds), .key = "cpu_seconds", .heading = "processor time",
               .unit = "s", .format = "%.3g");
        BR_PUT(d, br_number(row->wall), .key = "wall_seconds", .heading = "wall time", .unit = "s",
               .format = "%.3g");
        BR_PUT(d, br_number(row->bytes / 1e6), .key = "peak_memory", .heading = "peak memory",
               .unit = "MB", .format = "%.3g");
        BR_PUT(d, br_truth(row->cached), .key = "cached", .flags = BR_FILES_ONLY);
    }
}

/* Begins a row of a line. flags: of the quantity. */
static void put_line(struct br_document *d, const struct br_orders *o,
                     const struct br_quantity_orders *of, const struct br_orders_line *line,
                     unsigned flags)
{
    br_put_row(d);
    BR_PUT(d, br_text(br_quantity_of(o, of)->name), .key = "quantity", .flags = flags);
    BR_PUT(d, br_text(line ? br_axis_letters[line->axis] : "h and k"), .key = "in",
           .flags = BR_VARIES);
    BR_PUT(d, br_text(line ? line->at : ""), .key = "at", .flags = BR_VARIES);
}

static void put_sequence(struct br_document *d, enum br_sequence sequence)
{
    BR_PUT(d, br_text(br_sequence_text(sequence)), .key = "sequence", .flags = BR_VARIES);
}

static void put_order(struct br_document *d, const struct br_orders *o,
                      const struct br_quantity_orders *of, const struct br_orders_line *line)
{
    const struct br_case *c = &line->observed;
    put_line(d, o, of, line, BR_VARIES);
    BR_PUT_ESTIMATE(d, "", &c->order, br_order_shown(d, &c->order), .key = "order",
                    .heading = "order [95 %]");
    BR_PUT(d, br_count(c->points), .key = "points", .flags = BR_VARIES);
    BR_PUT(d, br_count(c->used), .key = "used", .flags = BR_VARIES);
    BR_PUT(d, br_text(br_case_note(c, (char[BR_CASE_NOTE]){0})), .key = "note",
           .flags = BR_FILES_ONLY | BR_WRAP);
}

static void put_joint_fit(struct br_document *d, const struct br_orders *o,
                          const struct br_quantity_orders *of)
{
    const struct br_joint_fit *f = &of->joint;
    br_put_row(d);
    BR_PUT(d, br_text(br_quantity_of(o, of)->name), .key = "quantity");
    for (int axis = 0; axis < BR_AXES; axis++) {
        const char *key = axis == BR_AXIS_SPACE ? "order_h" : "order_k";
        BR_PUT_ESTIMATE(d, br_format(d, "%s_", key), &f->order[axis],
                        br_order_shown(d, &f->order[axis]), .key = key,
                        .heading = br_format(d, "order in %s [95 %%]", br_axis_letters[axis]));
    }
    BR_PUT(d, br_number(f->c[BR_AXIS_SPACE].value), .key = "c_h", .heading = "C_h",
           .format = "%.3e");
    BR_PUT(d, br_number(f->c[BR_AXIS_TIME].value), .key = "c_k", .heading = "C_k",
           .format = "%.3e");
    BR_PUT(d, br_count(f->points), .key = "rows");
    BR_PUT(d, br_number(f->misfit), .key = "misfit", .format = "%.2e");
    BR_PUT(d, br_number(f->floor), .key = "floor", .format = "%.1e", .flags = BR_FILES_ONLY);
}

/* The limit of a value. line: NULL, of a grid, which has no index. */
static void put_limit(struct br_document *d, const struct br_orders *o,
                      const struct br_quantity_orders *of, const struct br_orders_line *line)
{
    const struct br_grid_limit *limit = line ? &line->limits.limit : &of->limit;
    const struct br_gci *g = line ? &line->limits.gci : NULL;
    put_line(d, o, of, line, 0);
    put_sequence(d, limit->sequence);
    BR_PUT_ESTIMATE(d, "", &limit->value, br_interval_shown(d, &limit->value), .key = "limit");
    BR_PUT(d, br_text("mixture of laws"), .key = "method", .flags = BR_FILES_ONLY);
    if (!g)
        return;
    BR_PUT(d, br_number(g->order), .key = "p", .heading = "p of three", .format = "%.4f");
    BR_PUT(d, br_number(g->fine.index), .key = "gci_fine", .heading = "GCI fine", .format = "%.3e");
    BR_PUT(d, br_number(g->coarse.index), .key = "gci_coarse", .heading = "GCI coarse",
           .format = "%.3e");
    BR_PUT(d, br_number(g->asymptotic), .key = "asymptotic", .heading = "asymptotic ratio",
           .format = "%.4f");
    BR_PUT(d, br_number(g->fine.ratio), .key = "r21", .format = "%.4g", .flags = BR_FILES_ONLY);
    BR_PUT(d, br_number(g->coarse.ratio), .key = "r32", .format = "%.4g", .flags = BR_FILES_ONLY);
    BR_PUT(d, br_number(g->fine.limit), .key = "phi_ext", .format = "%.9g", .flags = BR_FILES_ONLY);
    BR_PUT(d, br_number(g->fine.relative), .key = "e_a", .format = "%.3e", .flags = BR_FILES_ONLY);
    BR_PUT(d, br_number(g->fine.relative_extrapolated), .key = "e_ext", .format = "%.3e",
           .flags = BR_FILES_ONLY);
    br_hide(d, "of_three", NULL, br_text(br_sequence_text(g->sequence)));
    BR_PUT(d, br_number(br_gci_limited(g, o->formal)), .key = "gci_limited",
           .heading = "GCI, p limited", .format = "%.3e", .flags = BR_FILES_ONLY);
}

/* The limits of values. The grid convergence index is that of the three finest rows, relative as
 * Celik et al. print it. */
static void put_limits(struct br_document *d, const struct br_orders *o)
{
    const struct br_quantity_orders *end = o->of + o->count;
    br_put_table(d, "limits", "Limits of values, and the grid convergence index", 0);
    for (const struct br_quantity_orders *of = o->of; of < end; of++)
        for (size_t l = 0; l < of->lines && br_quantity_of(o, of)->is_value; l++)
            put_limit(d, o, of, &of->line[l]);
    for (const struct br_quantity_orders *of = o->of; of < end; of++)
        if (br_quantity_of(o, of)->is_value && of->lines > 1) /* one line has its limit above */
            put_limit(d, o, of, NULL);
    br_put_across(d);
}

/* The grid convergence index of three neighbouring sizes. */
static void put_triple(struct br_document *d, const struct br_orders *o,
                       const struct br_quantity_orders *of, const struct br_orders_line *line,
                       size_t triple)
{
    const struct br_gci *g = &line->limits.triple[triple];
    const double finest = o->numbers->row[g->row].given[line->axis];
    put_line(d, o, of, line, BR_VARIES);
    BR_PUT(d, br_number(finest), .key = "finest", .heading = "finest of three");
    br_put_shown(d, "%s", br_numbers_text(o->numbers->column[line->axis], finest, (char[32]){0}));
    BR_PUT(d, br_number(g->order), .key = "p", .format = "%.4f");
    BR_PUT(d, br_number(g->fine.index), .key = "gci_fine", .heading = "GCI fine", .format = "%.3e");
    BR_PUT(d, br_number(g->asymptotic), .key = "asymptotic", .heading = "asymptotic ratio",
           .format = "%.4f");
    BR_PUT(d, br_number(br_gci_limited(g, o->formal)), .key = "gci_limited",
           .heading = "GCI, p limited", .format = "%.3e");
    put_sequence(d, g->sequence);
}

/* The sizes that the next digits need. */
static void put_needed(struct br_document *d, const struct br_orders *o,
                       const struct br_quantity_orders *of)
{
    enum { DIGITS = 3 };
    const struct br_orders_forecast f = br_orders_forecast_of(o, of);
    const bool value = br_quantity_of(o, of)->is_value;
    double wanted = f.line ? pow(10, ceil(log10(f.number)) - 1) : 0;
    for (int digit = 0; digit < DIGITS && f.line; digit++, wanted /= 10) {
        const struct br_resolution_column *column = o->numbers->column[f.line->axis];
        const double size = br_orders_needed(o, &f, wanted);
        if (isnan(size))
            break;
        br_put_row(d);
        BR_PUT(d, br_text(br_quantity_of(o, of)->name), .key = "quantity", .flags = BR_VARIES);
        br_hide(d, "what", NULL, br_text(value ? "GCI" : "error"));
        BR_PUT(d, br_number(wanted), .key = "wanted", .heading = "at most", .format = "%.0e");
        br_put_shown(d, value ? "GCI %.0e" : "%.0e", wanted);
        br_hide(d, "column", NULL, br_text(column->name));
        BR_PUT(d, br_number(size), .key = "size", .heading = "needs");
        if (column->is_size) /* foretold: no more digits are known */
            br_put_shown(d, "%s = %.4g", column->name, size);
        else
            br_put_shown(d, "%s = %s", column->name, br_numbers_text(column, size, (char[32]){0}));
    }
}

/* What has no part in the numbers. */
static void put_left_aside(struct br_document *d, const struct br_numbers *numbers)
{
    br_put_table(d, "left_aside", "What was left aside", BR_FILES_ONLY);
    for (size_t i = 0; i < numbers->lefts; i++) {
        br_put_row(d);
        BR_PUT(d, br_text(numbers->left[i].what), .key = "what");
        BR_PUT(d, br_text(numbers->left[i].why), .key = "why");
    }
}

void br_report_orders(const struct br_orders *o, const struct br_estimate *growth,
                      const char *caption, struct br_document *d)
{
    br_document_begin(d, "orders", "beamrate orders", 2, caption);

    const struct br_quantity_orders *end = o->of + o->count;
    size_t cached = 0;
    for (size_t i = 0; i < o->count && i < MOST_NAMED; i++) {
        const struct br_quantity_orders *of = &o->of[i];
        const struct br_orders_line *line =
            of->lines ? br_orders_finest(of, of->line[0].axis) : NULL;
        br_put_list(d, " ", "; ");
        br_put_answer(d, "%s:", br_quantity_of(o, of)->name);
        if (!line && !of->flag) /* of a grid the answer says so */
            br_put_item(d, "no order: fewer than three sizes");
        if (line && br_quantity_of(o, of)->is_value)
            say_limit(d, o, of);
        say_orders(d, o, of);
        say_next(d, o, of);
        if (br_quantity_of(o, of)->window)
            br_put_item(d, "rows by hand: %s", br_quantity_of(o, of)->window);
        br_put_more(d, ".");
        if (br_joint_describes(&of->joint) && of->joint.left_out)
            say_cells_left_out(d, o, of);
        else
            say_left_out(d, of);
        if (line) {
            say_formal(d, o, of);
            say_advice(d, o, of, line);
        }
    }
    if (o->numbers->taken)
        br_put_answer(d, "Read: %s.", o->numbers->taken);
    if (o->count > MOST_NAMED)
        br_put_answer(d, "%zu more columns are in the tables only.", o->count - MOST_NAMED);
    for (int axis = 0; axis < BR_AXES; axis++)
        if (br_orders_costs_differ(o) && growth[axis].value >= 0.1 && growth[axis].low > 0 &&
            br_order_determined(&growth[axis]))
            br_put_answer(d, "Processor time grows like %s^-%s.", br_axis_letters[axis],
                          br_order_shown(d, &growth[axis]));
    say_missing(d, o);
    if (o->tied)
        br_put_answer(d,
                      "h and k are refined together: the order in h is that of the whole error.");
    for (size_t i = 0; i < o->numbers->rows; i++)
        cached += o->numbers->row[i].cached;
    if (cached) /* their numbers are those of the program at that time */
        br_put_answer(d, "%zu of %zu runs are from an earlier start, and were not run again.",
                      cached, o->numbers->rows);

    for (size_t i = 0; i < o->count; i += MOST_BESIDE)
        put_rows(d, o, i, i + MOST_BESIDE < o->count ? i + MOST_BESIDE : o->count,
                 BR_FOR_PEOPLE | BR_LONG);

    const bool told = !br_orders_is_grid(o) && o->count <= MOST_NAMED; /* by the answers */
    bool any = false;
    for (const struct br_quantity_orders *of = o->of; of < end; of++)
        for (size_t l = 0; l < of->lines; l++)
            any |= isfinite(of->line[l].observed.order.value);
    br_put_table(d, "orders", "Orders along lines",
                 BR_MAIN | (any ? told ? BR_FILES_ONLY : 0 : BR_FOR_PROGRAMS));
    for (const struct br_quantity_orders *of = o->of; of < end; of++)
        for (size_t l = 0; l < of->lines; l++)
            put_order(d, o, of, &of->line[l]);
    br_put_across(d);

    br_put_table(d, "joint", "Joint fit of the signed errors C_h h^p and C_k k^q", 0);
    for (const struct br_quantity_orders *of = o->of; of < end; of++)
        if (of->joint.converged)
            put_joint_fit(d, o, of);
    br_put_across(d);

    put_limits(d, o);

    br_put_table(d, "triples", "Grid convergence index of three neighbouring sizes", 0);
    for (const struct br_quantity_orders *of = o->of; of < end; of++)
        for (size_t l = 0; l < of->lines; l++)
            for (size_t t = 0; of->line[l].limits.triples > 1 && t < of->line[l].limits.triples;
                 t++)
                put_triple(d, o, of, &of->line[l], t);

    br_put_table(d, "needed", "Needed for smaller errors, if the order stays", 0);
    for (const struct br_quantity_orders *of = o->of; of < end; of++)
        put_needed(d, o, of);
    if (br_orders_costs_differ(o))
        put_costs(d, o->numbers);
    for (size_t i = 0; i < o->count; i++)
        put_rows(d, o, i, i + 1, BR_FOR_PROGRAMS);
    if (o->numbers->lefts)
        put_left_aside(d, o->numbers);
}
