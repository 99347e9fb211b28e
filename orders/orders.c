/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/orders.h"

#include <math.h>
#include <string.h>

/* ---- both axes ---- */

static struct br_point *point_on(const struct br_quantity_orders *of, enum br_axis axis, size_t row)
{
    const struct br_row_point *at = of->point[axis] ? &of->point[axis][row] : NULL;
    return at && at->line ? &at->line->observed.point[at->index] : NULL;
}

static bool is_level(enum br_flag flag)
{
    return flag == BR_FLAG_STALLED || flag == BR_FLAG_ROUND_OFF;
}

/* Where neighbours on a grid show a smaller order the error stays. */
static const double hardly_falls = 0.25;

/* Errors below this many times a floor are changed by it. */
static const double floor_margin = 2;

/* Whether the error is at a level of its line, or hardly another one than that of the next coarser
 * size (that of the coarsest size: than that of the next finer one). */
static bool stays(const struct br_row_point *at)
{
    const struct br_point *p = at->line->observed.point;
    const size_t fine = at->index > 0 ? at->index : 1;
    return is_level(p[at->index].flag) || fabs(br_orders_rate(at->line, fine)) < hardly_falls;
}

/* The level of a floor, along both axes and below all other errors; 0: there is none. */
static double floor_of(const struct br_orders *o, const struct br_quantity_orders *of)
{
    double lowest = INFINITY, level = 0;
    for (int turn = 0; turn < 2; turn++)
        for (size_t i = 0; i < o->numbers->rows; i++) {
            const struct br_point *a = point_on(of, BR_AXIS_SPACE, i);
            if (!a || !point_on(of, BR_AXIS_TIME, i) || !(a->error > 0))
                continue;
            if (turn == 0)
                lowest = fmin(lowest, a->error);
            else if (a->error < floor_margin * lowest && stays(&of->point[BR_AXIS_SPACE][i]) &&
                     stays(&of->point[BR_AXIS_TIME][i]))
                level = fmax(level, a->error);
        }
    return level;
}

/* An error that stays along one axis but falls along the other belongs to the other: no flag. One
 * that stays along both is at a floor, also where a line takes that for its order, zero. */
static void flag_corners(const struct br_orders *o, struct br_quantity_orders *of)
{
    const double level = floor_of(o, of);
    for (size_t i = 0; i < o->numbers->rows; i++) {
        struct br_point *a = point_on(of, BR_AXIS_SPACE, i), *b = point_on(of, BR_AXIS_TIME, i);
        if (!a || !b || a->flag == BR_FLAG_FAILED || !(a->error > 0))
            continue;
        if (a->error < floor_margin * level)
            a->flag = b->flag = is_level(a->flag)   ? a->flag
                                : is_level(b->flag) ? b->flag
                                                    : BR_FLAG_STALLED;
        else if (is_level(a->flag) != is_level(b->flag) || a->flag == BR_FLAG_NONE ||
                 b->flag == BR_FLAG_NONE)
            a->flag = b->flag = BR_FLAG_NONE;
    }
}

/* Why no joint fit takes a row, by its number or by its lines; BR_FLAG_NONE: it does. */
static enum br_flag left_out(const struct br_quantity_orders *of, const struct br_point *number)
{
    enum br_flag flag = !number->flag && !isfinite(number->error) ? BR_FLAG_FAILED : number->flag;
    for (enum br_axis axis = 0; axis < BR_AXES; axis++) {
        const struct br_point *p = point_on(of, axis, number->row);
        flag = flag || !p ? flag : p->flag;
    }
    return flag;
}

static enum br_status fit_both(const struct br_orders *o, struct br_quantity_orders *of,
                               struct br_error *err)
{
    const struct br_numbers *numbers = o->numbers;
    struct br_point *point = br_allocate(numbers->rows, sizeof *point);
    size_t count = 0;
    of->flag = of->flag ? of->flag : br_allocate(numbers->rows, sizeof *of->flag);
    enum br_status status = point && of->flag ? BR_OK : br_no_memory(err, "the joint fit");
    for (size_t i = 0; i < numbers->rows && !status; i++) {
        point[count] = br_orders_point(o, of->quantity, i);
        const enum br_flag flag = left_out(of, &point[count]);
        of->flag[i] = flag ? flag : of->flag[i];
        count += !flag;
    }
    /* Rows are only left out, so the same number means the same rows. */
    if (!status && !(count > 0 && count == of->joint.points + of->joint.left_out)) {
        status =
            br_joint_fit_solve(point, count, !numbers->powers, numbers->observer, &of->joint, err);
        for (size_t i = 0; i < count && !status; i++)
            of->flag[point[i].row] = point[i].flag;
    }
    free(point);
    return status;
}

/* Rows that the joint fit leaves out do not count on lines, either. */
static void flag_lines(const struct br_orders *o, struct br_quantity_orders *of)
{
    for (size_t i = 0; i < o->numbers->rows; i++)
        for (int axis = 0; axis < BR_AXES; axis++) {
            struct br_point *p = point_on(of, (enum br_axis)axis, i);
            if (p && of->flag[i] != BR_FLAG_NONE)
                p->flag = of->flag[i];
        }
}

/* ---- all ---- */

bool br_orders_is_grid(const struct br_orders *o)
{
    return o->numbers->column[BR_AXIS_SPACE] && o->numbers->column[BR_AXIS_TIME] && !o->tied;
}

/* Values whose changes are their scatter show no order. */
static bool is_scatter(const struct br_orders_line *line)
{
    return line->limits.limit.sequence == BR_SEQUENCE_SCATTER;
}

/* Whether a line is one of the two finest along an axis whose theory is known: it may be an answer.
 */
static bool is_fine(const struct br_orders *o, const struct br_quantity_orders *of, size_t line)
{
    if (!(br_quantity_of(o, of)->formal[of->line[line].axis] > 0))
        return false;
    return line + 2 >= of->lines || of->line[line + 2].axis != of->line[line].axis;
}

static double width_of(const struct br_estimate *order)
{
    return order->high - order->low;
}

/* Takes exponential convergence from the same errors, as a power of e^-degree, if that is all that
 * they show, and one power of the size does not describe them better. */
static void take_exponential(struct br_case *c, const struct br_case *by)
{
    bool all = !by->law && by->order.low > 0 && width_of(&by->order) <= by->order.value &&
               br_squares_of_power(by, by->points) < br_squares_of_power(c, c->points);
    for (size_t i = 0; i < by->points; i++)
        all &= !by->point[i].lost;
    if (!all)
        return;
    c->factor = (struct br_estimate){exp(by->order.value), exp(by->order.low), exp(by->order.high)};
    c->exponential = 1;
    for (size_t i = 0; i < c->points; i++) {
        c->point[i].flag = by->point[i].flag;
        c->point[i].lost = false;
    }
    c->used = by->used;
    c->order = (struct br_estimate){NAN, NAN, NAN};
    c->low99 = by->low99;
    c->high99 = by->high99;
    c->law = BR_LAW_POWER;
    snprintf(c->note, sizeof c->note, "%s", by->note);
}

enum br_status br_orders_observe(const struct br_resolution_column *size, size_t least,
                                 struct br_case *c, struct br_error *err)
{
    struct br_case by = *c;
    if (!size->is_degree)
        return br_case_observe(c, least, err);
    by.point = br_allocate(c->points + 1, sizeof *by.point);
    if (!by.point)
        return br_no_memory(err, "the orders");
    memcpy(by.point, c->point, c->points * sizeof *by.point);
    for (size_t i = 0; i < by.points; i++)
        by.point[i].z = exp(1 - 1 / by.point[i].z);
    const bool failed = br_case_observe(c, least, err) ||
                        (isnan(c->factor.value) && br_case_observe(&by, least, err));
    if (!failed && isnan(c->factor.value))
        take_exponential(c, &by);
    free(by.point);
    return failed ? err->status : BR_OK;
}

/* Finds the orders of all lines, which leaves out the errors that do not show them. On a grid,
 * errors may stay along one axis since the error of the other axis is larger; where the joint fit
 * describes all errors, none is left out, and of powers no line is needed then. */
static enum br_status observe_lines(const struct br_orders *o, struct br_quantity_orders *of,
                                    bool leave_out, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t l = 0; l < of->lines && !status; l++) {
        struct br_case *c = &of->line[l].observed;
        if (br_observer_check(o->numbers->observer, err))
            return err->status;
        const struct br_resolution_column *size = o->numbers->column[of->line[l].axis];
        if (!o->numbers->powers || (leave_out && is_fine(o, of, l)))
            status = br_orders_observe(size, BR_ORDERS_LEAST, c, err);
        if (!status && (is_scatter(&of->line[l]) || size->is_degree))
            br_case_take_order(c, (struct br_estimate){NAN, NAN, NAN}, NAN);
        else if (!status && !leave_out)
            br_case_take_order(c, c->order, c->constant);
    }
    return status;
}

static enum br_status observe_all(const struct br_orders *o, struct br_quantity_orders *of,
                                  struct br_error *err)
{
    const bool joint = br_orders_is_grid(o) && !br_quantity_of(o, of)->is_value;
    enum br_status status = joint ? fit_both(o, of, err) : BR_OK;
    const bool described = joint && br_joint_describes(&of->joint);
    if (!status)
        status = observe_lines(o, of, !described, err);
    if (!status && described)
        flag_lines(o, of);
    if (status || !joint || described || o->numbers->powers)
        return status;
    flag_corners(o, of);
    return fit_both(o, of, err);
}

static bool holds(const struct br_estimate *interval, const struct br_estimate *order)
{
    return interval->low <= order->value && order->value <= interval->high;
}

/* The last of the points that were not left out before their order was sought; NULL: none. */
static const struct br_point *finest_of(const struct br_case *c)
{
    for (size_t i = c->points; i-- > 0;)
        if (!c->point[i].flag || c->point[i].lost)
            return &c->point[i];
    return NULL;
}

/* Whether two lines show one order. Wide intervals above zero agree about any: then the finest
 * error must be almost the same at both sizes of the other axis, whose error is small beside it. */
static bool show_the_same(const struct br_case *a, const struct br_case *b)
{
    static const double narrow = 0.3, share = 0.1;
    const struct br_point *finest = finest_of(a);
    bool small = fmax(width_of(&a->order), width_of(&b->order)) <= narrow || a->order.low <= 0;
    for (size_t i = 0; i < b->points && finest && !small; i++)
        small = !(b->point[i].z < finest->z) && !(b->point[i].z > finest->z) &&
                fabs(b->point[i].error - finest->error) <= share * finest->error;
    return small && holds(&a->order, &b->order) && holds(&b->order, &a->order);
}

/* The answer of a grid of errors without a joint fit: the order of a line only if the line at the
 * next size shows the same one, else the error of the other axis bends it. */
static struct br_orders_answer answer_of_lines(const struct br_quantity_orders *of,
                                               const struct br_orders_line *finest)
{
    static const char *const bent[BR_AXES] = {
        "the two finest k do not show one order in h, and no joint fit describes the "
        "errors: a finer k, or more sizes of both, would show it",
        "the two finest h do not show one order in k, and no joint fit describes the "
        "errors: a finer h, or more sizes of both, would show it"};
    const struct br_orders_line *next = finest > of->line ? finest - 1 : NULL;
    const struct br_estimate *a = &finest->observed.order;
    if (next && next->axis == finest->axis && show_the_same(&finest->observed, &next->observed))
        return (struct br_orders_answer){*a, NULL, .line = finest};
    return (struct br_orders_answer){{NAN, NAN, NAN}, bent[finest->axis], .line = finest};
}

static struct br_orders_answer answer_of_grid(const struct br_orders *o,
                                              const struct br_quantity_orders *of,
                                              enum br_axis axis)
{
    static const char *const hidden[BR_AXES] = {
        "the order in h is hidden, since the error in k is larger everywhere: a finer k, or a "
        "coarser h, would show it",
        "the order in k is hidden, since the error in h is larger everywhere: a finer h, or a "
        "coarser k, would show it"};
    static const char *const open[BR_AXES] = {
        "the joint fit does not determine the order in h: more sizes of both would",
        "the joint fit does not determine the order in k: more sizes of both would"};
    static const char scatter[] = "no order is seen: coarser sizes, or more runs (--repeat), "
                                  "would show one";
    static const char none[] =
        "no line has three sizes, and no joint fit describes the errors: more "
        "sizes of both would show the order";
    const struct br_orders_line *finest = br_orders_finest(of, axis);
    const struct br_estimate *joint = &of->joint.order[axis];
    const bool both = br_orders_is_grid(o) && !br_quantity_of(o, of)->is_value;
    if (br_joint_describes(&of->joint)) {
        const bool sure = br_order_determined(joint), small = of->joint.share[axis] < 0.5;
        return (struct br_orders_answer){*joint,
                                         sure    ? NULL
                                         : small ? hidden[axis]
                                                 : open[axis],
                                         .joint = true, .line = finest};
    }
    if (!finest || is_scatter(finest))
        return (struct br_orders_answer){{NAN, NAN, NAN},
                                         finest ? scatter
                                         : both ? none
                                                : NULL,
                                         .line = finest};
    return both ? answer_of_lines(of, finest)
                : (struct br_orders_answer){finest->observed.order, NULL, .line = finest};
}

const char br_orders_uneven[] = "the errors do not fall, or fall slowly and unevenly";

/* Whether each error that the order of a line rests on is smaller than the one before it; where
 * there is no order, whether all are. */
static bool falls(const struct br_case *c)
{
    bool smaller = true;
    double before = INFINITY;
    for (size_t i = 0; i < c->points; i++)
        if (!c->point[i].flag || (c->point[i].lost && !br_order_determined(&c->order))) {
            smaller = smaller && c->point[i].error < before;
            before = c->point[i].error;
        }
    return smaller;
}

/* The answer as far as it can be believed of errors whose theory is known: an order far below it
 * must be that of errors that fall evenly. */
static struct br_orders_answer believed(struct br_orders_answer a, double formal)
{
    static const double even = 0.1; /* of an order */
    const bool narrow = !a.joint && width_of(&a.order) <= even * a.order.value;
    if (!(formal > 0))
        return a;
    if (!a.open && !(br_order_determined(&a.order) && (narrow || a.order.value > formal / 2) &&
                     (a.joint || falls(&a.line->observed))))
        a.open = br_orders_uneven;
    if (a.open)
        a.order = (struct br_estimate){NAN, NAN, NAN};
    return a;
}

/* Whether the differences of the other axis show that its error is not small beside the finest one
 * of a line. */
static bool is_hidden(const struct br_orders *o, const struct br_quantity_orders *of,
                      const struct br_orders_line *line)
{
    static const double share = 0.1;
    const int other = !line->axis;
    const struct br_point *finest = finest_of(&line->observed),
                          *alone = finest_of(&of->differences[other].observed);
    const double p = br_quantity_of(o, of)->formal[other];
    return finest && alone &&
           alone->error * pow(o->numbers->row[line->observed.point->row].z[other], p) >
               share * finest->error * (pow(alone->z, p) - pow(alone->z_against, p));
}

/* Whether differences are the answer. They do not depend on the other axis: where they show the
 * order so well, a grid does not show more, and where they contradict it, it is wrong. */
static bool are_better(const struct br_orders_answer *alone, const struct br_orders_answer *grid)
{
    static const double clear = 0.02;
    const struct br_estimate *a = &alone->order, *b = &grid->order;
    return grid->open || width_of(a) <= fmax(clear, width_of(b)) || a->high < b->low ||
           b->high < a->low;
}

static struct br_orders_answer find_answer(const struct br_orders *o,
                                           const struct br_quantity_orders *of, enum br_axis axis)
{
    static const char *const hidden[BR_AXES] = {
        "the error in k hides the order in h: a finer k, or a coarser h, would show it",
        "the error in h hides the order in k: a finer h, or a coarser k, would show it"};
    const struct br_quantity *q = br_quantity_of(o, of);
    const struct br_orders_line *line = &of->differences[axis];
    struct br_orders_answer grid = answer_of_grid(o, of, axis);
    if (!grid.joint && grid.line && is_hidden(o, of, grid.line))
        grid.open = hidden[axis];
    grid = believed(grid, q->formal[axis]);
    if (!line->observed.point)
        return grid;
    const struct br_orders_answer alone = believed(
        (struct br_orders_answer){line->observed.order, NULL, .line = line}, q->formal[axis]);
    return are_better(&alone, &grid) ? alone : grid;
}

/* The finest value of a line; NULL: none is a number. */
static const struct br_point *finest_value(const struct br_orders_line *line)
{
    const struct br_point *p = line->observed.point + line->observed.points;
    while (isnan(p->value) && p > line->observed.point)
        p--;
    return isnan(p->value) ? NULL : p;
}

/* The limit over both axes, from the finest value at which lines of both end. */
static struct br_grid_limit limit_of_grid(const struct br_orders *o,
                                          const struct br_quantity_orders *of)
{
    for (size_t row = o->numbers->rows; row-- > 0;) {
        struct br_limit_along along[BR_AXES];
        double value = NAN;
        int found = 0;
        for (const struct br_orders_line *line = of->line + 1; line < of->line + of->lines;
             line++) {
            const struct br_point *finest = finest_value(line), *next = finest_value(line - 1);
            if (!finest || finest->row != row || !next || line[-1].axis != line->axis)
                continue;
            along[line->axis] =
                (struct br_limit_along){line->limits.limit, line[-1].limits.limit, next->value};
            value = finest->value;
            found |= 1 << line->axis;
        }
        if (found == 3)
            return br_limit_of_grid(value, along);
    }
    return (struct br_grid_limit){.value = {NAN, NAN, NAN}, .order = NAN};
}

static enum br_status find_quantity(const struct br_orders *o, struct br_quantity_orders *of,
                                    struct br_error *err)
{
    const struct br_numbers *numbers = o->numbers;
    of->line = br_allocate(2 * numbers->rows, sizeof *of->line);
    if (!of->line)
        return br_no_memory(err, "the orders");
    enum br_status status = br_observer_check(numbers->observer, err);
    for (int axis = 0; axis < BR_AXES; axis++)
        if (numbers->column[axis] && !(o->tied && axis == BR_AXIS_TIME) && !status)
            status = br_orders_add_lines(o, of, (enum br_axis)axis, err);
    if (!status)
        status = observe_all(o, of, err);
    for (int axis = 0; axis < BR_AXES && !status; axis++)
        of->answer[axis] = find_answer(o, of, (enum br_axis)axis);
    if (!status && numbers->quantity[of->quantity].is_value)
        of->limit = br_orders_is_grid(o) ? limit_of_grid(o, of)
                    : of->lines          ? of->line[of->lines - 1].limits.limit
                                : (struct br_grid_limit){.value = {NAN, NAN, NAN}, .order = NAN};
    return status;
}

/* Whether both axes are refined from each row to the next. */
static bool are_tied(const struct br_orders *o)
{
    const struct br_numbers *numbers = o->numbers;
    bool tied = br_orders_is_grid(o) && numbers->rows > 1;
    for (size_t i = 1; i < numbers->rows; i++)
        for (int axis = 0; axis < BR_AXES; axis++)
            tied &= numbers->row[i].z[axis] < numbers->row[i - 1].z[axis];
    return tied;
}

enum br_status br_orders_find(const struct br_numbers *numbers, double formal, struct br_orders *o,
                              struct br_error *err)
{
    *o = (struct br_orders){
        .numbers = numbers, .formal = formal > 0 ? formal : 2, .assumed_formal = formal == 0};
    if (formal != 0 && !(formal >= 1 && formal <= 10))
        return br_fail(err, BR_BAD_INPUT, "the formal order is %g, expected 1 to 10", formal);
    o->tied = are_tied(o);
    o->of = br_allocate(numbers->quantities, sizeof *o->of);
    if (!o->of)
        return br_no_memory(err, "the orders");
    enum br_status status = BR_OK;
    for (; o->count < numbers->quantities && !status; o->count++) {
        o->of[o->count].quantity = o->count;
        status = find_quantity(o, &o->of[o->count], err);
    }
    return status;
}

enum br_status br_orders_begin_differences(const struct br_orders *o, struct br_quantity_orders *of,
                                           enum br_axis axis, size_t points, struct br_error *err)
{
    struct br_orders_line *line = &of->differences[axis];
    free(line->observed.point);
    *line = (struct br_orders_line){.axis = axis};
    return points ? br_orders_begin_case(o, of->quantity, axis, points, &line->observed, err)
                  : BR_OK;
}

enum br_status br_orders_renew(const struct br_orders *o, struct br_quantity_orders *of,
                               enum br_axis axis, struct br_error *err)
{
    struct br_case *c = &of->differences[axis].observed;
    if (c->point && br_case_observe(c, BR_ORDERS_LEAST, err))
        return err->status;
    of->answer[axis] = find_answer(o, of, axis);
    return BR_OK;
}

void br_orders_clear(struct br_orders *o)
{
    for (size_t i = 0; i < o->count; i++) {
        for (size_t l = 0; l < o->of[i].lines; l++) {
            free(o->of[i].line[l].observed.point);
            br_limits_clear(&o->of[i].line[l].limits);
        }
        free(o->of[i].line);
        free(o->of[i].flag);
        for (int axis = 0; axis < BR_AXES; axis++) {
            free(o->of[i].point[axis]);
            free(o->of[i].differences[axis].observed.point);
        }
    }
    free(o->of);
    *o = (struct br_orders){0};
}

const struct br_orders_line *br_orders_finest(const struct br_quantity_orders *of,
                                              enum br_axis axis)
{
    const struct br_orders_line *finest = NULL; /* lines come from coarse to fine */
    for (size_t i = 0; i < of->lines; i++)
        finest = of->line[i].axis == axis ? &of->line[i] : finest;
    return finest;
}
