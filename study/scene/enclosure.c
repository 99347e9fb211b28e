/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/enclosure.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "study/scene/elementary.h"

typedef struct br_interval iv;

static iv add(iv a, iv b)
{
    return br_interval_add(a, b);
}

static iv multiply(iv a, iv b)
{
    return br_interval_multiply(a, b);
}

static iv scale(double factor, iv a)
{
    return br_interval_multiply(br_point(factor), a);
}

static bool are_equal(const struct br_node *n)
{
    return br_operation_arguments(n->operation) == 2 && n->argument[0] == n->argument[1];
}

/* ---- Taylor coefficients: series of order + 1 intervals ---- */

/* What the series of one operation are made of. Its own first coefficient is known. */
struct recurrence {
    size_t order;
    const iv *a, *b;
    iv *out;
};

/* sum of a_j b_(k-j), j = from .. to */
static iv convolve(const iv *a, const iv *b, size_t k, size_t from, size_t to)
{
    iv sum = {0, 0};
    for (size_t j = from; j <= to; j++)
        sum = add(sum, multiply(a[j], b[k - j]));
    return sum;
}

/* sum of j a_j b_(k-j), j = 1 .. to, over k */
static iv convolve_slope(const iv *a, const iv *b, size_t k, size_t to)
{
    iv sum = {0, 0};
    for (size_t j = 1; j <= to; j++)
        sum = add(sum, scale((double)j, multiply(a[j], b[k - j])));
    return br_interval_divide(sum, br_point((double)k));
}

/* Coefficient k of a^2. */
static iv square_at(const iv *a, size_t k)
{
    if (k == 0)
        return br_interval_square(a[0]);
    const iv pairs = scale(2, convolve(a, a, k, 0, (k - 1) / 2));
    return k % 2 ? pairs : add(pairs, br_interval_square(a[k / 2]));
}

static void square_series(size_t order, const iv *a, iv *out)
{
    for (size_t k = 0; k <= order; k++)
        out[k] = square_at(a, k);
}

static void product_series(size_t order, const iv *a, const iv *b, iv *out)
{
    if (a == b) {
        square_series(order, a, out);
        return;
    }
    for (size_t k = 0; k <= order; k++)
        out[k] = convolve(a, b, k, 0, k);
}

/* b q = a */
static void quotient_series(const struct recurrence *r)
{
    for (size_t k = 1; k <= r->order; k++) {
        const iv known = convolve(r->b, r->out, k, 1, k);
        r->out[k] = br_interval_divide(br_interval_subtract(r->a[k], known), r->b[0]);
    }
}

/* s s = a */
static void root_series(size_t order, const iv *a, iv *s)
{
    for (size_t k = 1; k <= order; k++)
        s[k] = br_interval_divide(br_interval_subtract(a[k], convolve(s, s, k, 1, k - 1)),
                                  scale(2, s[0]));
}

/* y' = a' y */
static void exponential_series(const struct recurrence *r)
{
    for (size_t k = 1; k <= r->order; k++)
        r->out[k] = convolve_slope(r->a, r->out, k, k);
}

/* y' = a' v, v = 1 + sign y^2: tan and tanh */
static void tangent_series(const struct recurrence *r, double sign)
{
    iv v[BR_TREE_WORK] = {add(br_point(1), scale(sign, square_at(r->out, 0)))};
    for (size_t k = 1; k <= r->order; k++) {
        r->out[k] = convolve_slope(r->a, v, k, k);
        v[k] = scale(sign, square_at(r->out, k));
    }
}

/* y' = a' z, z' = sign a' y: sin and cos, sinh and cosh. The partner's first is apply's, too. */
static void pair_series(const struct recurrence *r, enum br_operation partner, double y_sign,
                        double z_sign)
{
    iv z[BR_TREE_WORK] = {br_interval_apply(partner, r->a, false)};
    for (size_t k = 1; k <= r->order; k++) {
        r->out[k] = scale(y_sign, convolve_slope(r->a, z, k, k));
        z[k] = scale(z_sign, convolve_slope(r->a, r->out, k, k));
    }
}

/* w y' = sign a' */
static void integral_series(const struct recurrence *r, const iv *w, double sign)
{
    for (size_t k = 1; k <= r->order; k++) {
        const iv known = convolve_slope(r->out, w, k, k - 1);
        r->out[k] = br_interval_divide(br_interval_subtract(scale(sign, r->a[k]), known), w[0]);
    }
}

/* w = constant + sign a^2 or its root: for the inverse functions */
static void inverse_series(const struct recurrence *r, double constant, double sign, bool root,
                           double slope)
{
    iv square[BR_TREE_WORK], w[BR_TREE_WORK];
    square_series(r->order, r->a, square);
    for (size_t k = 0; k <= r->order; k++)
        square[k] = scale(sign, square[k]);
    square[0] = add(br_point(constant), square[0]);
    w[0] = root ? br_interval_apply(BR_OP_SQRT, square, false) : square[0];
    if (root)
        root_series(r->order, square, w);
    integral_series(r, root ? w : square, slope);
}

/* a^n, n = 2, 3 ...: by squares, so that a may be 0 */
static void whole_power_series(size_t order, const iv *a, double n, iv *out)
{
    iv square[BR_TREE_WORK], next[BR_TREE_WORK];
    const size_t size = (order + 1) * sizeof *a;
    bool begun = false;
    memcpy(square, a, size);
    for (; n >= 1; n = floor(n / 2)) {
        if (fmod(n, 2) == 1) {
            if (begun)
                product_series(order, out, square, next);
            memcpy(out, begun ? next : square, size);
            begun = true;
        }
        square_series(order, square, next);
        memcpy(square, next, size);
    }
}

/* k a_0 p_k = sum of (n j - (k - j)) a_j p_(k-j) */
static void real_power_series(const struct recurrence *r, double n)
{
    for (size_t k = 1; k <= r->order; k++) {
        iv sum = {0, 0};
        for (size_t j = 1; j <= k; j++) {
            const iv factor = br_interval_subtract(multiply(br_point(n), br_point((double)j)),
                                                   br_point((double)(k - j)));
            sum = add(sum, multiply(factor, multiply(r->a[j], r->out[k - j])));
        }
        r->out[k] = br_interval_divide(sum, scale((double)k, r->a[0]));
    }
}

static bool is_constant(size_t order, const iv *a)
{
    for (size_t k = 1; k <= order; k++)
        if (a[k].low != 0 || a[k].high != 0)
            return false;
    return br_is_point(a[0]);
}

/* exp(b log a) */
static void power_of_both(const struct recurrence *r)
{
    iv logarithm[BR_TREE_WORK] = {br_interval_apply(BR_OP_LOG, r->a, false)},
       exponent[BR_TREE_WORK];
    integral_series(&(struct recurrence){r->order, r->a, NULL, logarithm}, r->a, 1);
    product_series(r->order, r->b, logarithm, exponent);
    exponential_series(&(struct recurrence){r->order, exponent, NULL, r->out});
}

static void power_series(const struct recurrence *r)
{
    const iv first = r->out[0];
    const double n = r->b[0].low;
    if (!is_constant(r->order, r->b))
        power_of_both(r);
    else if (n == 0)
        memset(r->out, 0, (r->order + 1) * sizeof *r->out);
    else if (n > 0 && n == floor(n) && (n <= 4 || br_has_zero(r->a[0])))
        whole_power_series(r->order, r->a, n, r->out);
    else
        real_power_series(r, n);
    r->out[0] = first;
}

static void copy_series(size_t order, const iv *a, double sign, iv *out)
{
    for (size_t k = 0; k <= order; k++)
        out[k] = scale(sign, a[k]);
}

/* Of what compares: constant where that is decided, else none. */
static void decided_series(const struct recurrence *r)
{
    for (size_t k = 1; k <= r->order; k++)
        r->out[k] = br_is_point(r->out[0]) ? br_point(0) : br_no_interval;
}

/* The one of both that is less (sign 1) or larger (sign -1), where that is decided. */
static void extreme_series(const struct recurrence *r, double sign)
{
    const iv difference = scale(sign, br_interval_subtract(r->a[0], r->b[0]));
    if (difference.high <= 0 || difference.low >= 0)
        copy_series(r->order, difference.high <= 0 ? r->a : r->b, 1, r->out);
    else
        for (size_t k = 1; k <= r->order; k++)
            r->out[k] = br_no_interval;
}

/* log a, over log unit where that is not 0; the recurrence needs the natural one. */
static void logarithm_series(const struct recurrence *r, double unit)
{
    const iv first = r->out[0], base = br_point(unit);
    r->out[0] = br_interval_apply(BR_OP_LOG, r->a, false);
    integral_series(r, r->a, 1);
    for (size_t k = 1; k <= r->order && unit != 0; k++)
        r->out[k] = br_interval_divide(r->out[k], br_interval_apply(BR_OP_LOG, &base, false));
    r->out[0] = first;
}

/* expm1: exp but for its first coefficient */
static void minus_one_series(const struct recurrence *r)
{
    const iv first = r->out[0];
    r->out[0] = br_interval_apply(BR_OP_EXP, r->a, false);
    exponential_series(r);
    r->out[0] = first;
}

static void absolute_series(const struct recurrence *r)
{
    if (r->a[0].low >= 0 || r->a[0].high <= 0)
        copy_series(r->order, r->a, r->a[0].low >= 0 ? 1 : -1, r->out);
    else
        for (size_t k = 1; k <= r->order; k++)
            r->out[k] = br_no_interval;
}

static void unary_series(enum br_operation o, const struct recurrence *r)
{
    switch (o) {
    case BR_OP_NEGATE:
        return copy_series(r->order, r->a, -1, r->out);
    case BR_OP_SIN:
        return pair_series(r, BR_OP_COS, 1, -1);
    case BR_OP_COS:
        return pair_series(r, BR_OP_SIN, -1, 1);
    case BR_OP_TAN:
        return tangent_series(r, 1);
    case BR_OP_ASIN:
        return inverse_series(r, 1, -1, true, 1);
    case BR_OP_ACOS:
        return inverse_series(r, 1, -1, true, -1);
    case BR_OP_ATAN:
        return inverse_series(r, 1, 1, false, 1);
    case BR_OP_SINH:
        return pair_series(r, BR_OP_COSH, 1, 1);
    case BR_OP_COSH:
        return pair_series(r, BR_OP_SINH, 1, 1);
    case BR_OP_TANH:
        return tangent_series(r, -1);
    case BR_OP_ASINH:
        return inverse_series(r, 1, 1, true, 1);
    case BR_OP_ACOSH:
        return inverse_series(r, -1, 1, true, 1);
    case BR_OP_ATANH:
        return inverse_series(r, 1, -1, false, 1);
    case BR_OP_EXP:
        return exponential_series(r);
    case BR_OP_EXPM1:
        return minus_one_series(r);
    case BR_OP_LOG:
        return logarithm_series(r, 0);
    case BR_OP_LOG2:
        return logarithm_series(r, 2);
    case BR_OP_LOG10:
        return logarithm_series(r, 10);
    case BR_OP_SQRT:
        return root_series(r->order, r->a, r->out);
    case BR_OP_ABS:
        return absolute_series(r);
    default:
        return decided_series(r);
    }
}

static void binary_series(enum br_operation o, const struct recurrence *r)
{
    switch (o) {
    case BR_OP_ADD:
        for (size_t k = 1; k <= r->order; k++)
            r->out[k] = add(r->a[k], r->b[k]);
        break;
    case BR_OP_SUBTRACT:
        for (size_t k = 1; k <= r->order; k++)
            r->out[k] = r->a == r->b ? br_point(0) : br_interval_subtract(r->a[k], r->b[k]);
        break;
    case BR_OP_MULTIPLY:
        return product_series(r->order, r->a, r->b, r->out);
    case BR_OP_DIVIDE:
        return quotient_series(r);
    case BR_OP_POW:
        return power_series(r);
    case BR_OP_MIN:
        return extreme_series(r, 1);
    case BR_OP_MAX:
        return extreme_series(r, -1);
    default:
        return decided_series(r);
    }
}

/* The series of an operation from those of its arguments. */
static void apply_series(enum br_operation o, size_t order, const iv *const argument[3], iv *out)
{
    const struct recurrence r = {order, argument[0], argument[1], out};
    const iv first[3] = {argument[0][0], argument[1][0], argument[2][0]};
    out[0] = br_interval_apply(o, first, argument[0] == argument[1]);
    for (size_t k = 1; k <= order; k++)
        out[k] = br_no_interval;
    if (o == BR_OP_CHOOSE) {
        if (!br_has_zero(first[0]) || br_is_point(first[0])) /* none is neither */
            copy_series(order, argument[br_has_zero(first[0]) ? 2 : 1], 1, out);
    } else if (!br_is_none(out[0])) {
        (br_operation_arguments(o) == 1 ? unary_series : binary_series)(o, &r);
    }
}

static iv variable_of(const struct br_node *n, struct br_box box)
{
    return n->operation == BR_OP_NUMBER ? br_point(n->number)
           : n->operation == BR_OP_X    ? box.x
                                        : box.t;
}

bool br_tree_taylor(const struct br_tree *tree, iv *work, enum br_variable along, struct br_box box,
                    size_t order, iv *coefficient)
{
    const enum br_operation variable = along == BR_X ? BR_OP_X : BR_OP_T;
    const size_t size = order + 1;
    const int rounding = br_round_to_nearest();
    for (size_t i = 0; i < tree->count; i++) {
        const struct br_node *n = &tree->node[i];
        iv *out = work + i * size;
        if (br_operation_arguments(n->operation)) {
            const iv *const argument[] = {work + n->argument[0] * size,
                                          work + n->argument[1] * size,
                                          work + n->argument[2] * size};
            apply_series(n->operation, order, argument, out);
            continue;
        }
        out[0] = variable_of(n, box);
        for (size_t k = 1; k <= order; k++)
            out[k] = br_point(k == 1 && n->operation == variable);
    }
    br_round_as_before(rounding);
    memcpy(coefficient, work + (tree->count - 1) * size, size * sizeof *coefficient);
    bool finite = true;
    for (size_t k = 0; k <= order; k++)
        finite &= br_is_finite(coefficient[k]);
    return finite;
}

/* ---- bounds ---- */

/* A node over a box: its range, its value at the box's centre, its derivatives over the box, and
 * how far its evaluation may be from the truth. Where a derivative jumps: all it may be between. */
struct form {
    iv range, centre, slope[2];
    double error;
};

_Static_assert(sizeof(struct form) <= BR_TREE_WORK * sizeof(iv), "the workspace of a node");

/* Those of abs, min and max where it is not decided which side they are on. */
static bool is_kinked(enum br_operation o, const iv *range, iv partial[2])
{
    const bool extreme = o == BR_OP_MIN || o == BR_OP_MAX;
    const iv side = o == BR_OP_ABS ? (iv){-1, 1} : (iv){0, 1};
    const bool undecided = extreme ? br_has_zero(br_interval_subtract(range[0], range[1]))
                                   : o == BR_OP_ABS && br_has_zero(range[0]);
    partial[0] = partial[1] = side;
    return undecided;
}

/* The derivative of the operation by its argument `which`, at all of its arguments. */
static iv partial_of(enum br_operation o, const iv *range, unsigned which)
{
    iv series[3][2], out[2];
    for (unsigned k = 0; k < 3; k++) {
        series[k][0] = range[k];
        series[k][1] = br_point(k == which);
    }
    apply_series(o, 1, (const iv *const[]){series[0], series[1], series[2]}, out);
    return out[1];
}

/* Slopes and error of what min and max choose from are between those of both. */
static void mix(const struct form *a, const struct form *b, struct form *f)
{
    for (int v = 0; v < 2; v++)
        f->slope[v] = br_interval_hull(a->slope[v], b->slope[v]);
    f->error = a->error >= b->error ? a->error : b->error;
}

static bool is_constant_form(const struct form *f)
{
    return f->error == 0 && f->slope[0].low == 0 && f->slope[0].high == 0 && f->slope[1].low == 0 &&
           f->slope[1].high == 0;
}

static void differentiate(enum br_operation o, const struct form *const argument[3], struct form *f)
{
    iv range[3], partial[2];
    const unsigned arguments = br_operation_arguments(o);
    for (unsigned k = 0; k < 3; k++)
        range[k] = argument[k]->range;
    f->slope[0] = f->slope[1] = br_point(0);
    f->error = 0;
    const bool kinked = is_kinked(o, range, partial);
    if (kinked && arguments == 2)
        mix(argument[0], argument[1], f);
    for (unsigned k = 0; k < arguments && !(kinked && arguments == 2); k++) {
        if (is_constant_form(argument[k]))
            continue;
        const iv p = kinked ? partial[k] : partial_of(o, range, k);
        for (int v = 0; v < 2; v++)
            f->slope[v] = add(f->slope[v], multiply(p, argument[k]->slope[v]));
        f->error += argument[k]->error == 0 ? 0 : br_magnitude(p) * argument[k]->error;
    }
    const bool exact = o == BR_OP_NEGATE || o == BR_OP_ABS || o == BR_OP_MIN || o == BR_OP_MAX;
    if (!exact) /* 2.5 units, and that these sums are rounded, too */
        f->error = f->error * (1 + 8 * DBL_EPSILON) + 3 * DBL_EPSILON * br_magnitude(f->range) +
                   8 * 0x1p-1074;
}

static void choose_form(const struct form *const argument[3], struct form *f)
{
    const iv condition = argument[0]->range;
    if (br_is_none(condition) || (br_has_zero(condition) && !br_is_point(condition))) {
        f->slope[0] = f->slope[1] = br_no_interval;
        f->error = INFINITY;
        return;
    }
    const struct form *taken = argument[br_has_zero(condition) ? 2 : 1];
    memcpy(f->slope, taken->slope, sizeof f->slope);
    f->error = taken->error;
}

/* Cuts the range with centre + slopes * (box - middle) +- error. */
static void cut(struct br_box box, struct br_box middle, struct form *f)
{
    const iv mean =
        add(add(f->centre, multiply(f->slope[0], br_interval_subtract(box.x, middle.x))),
            add(multiply(f->slope[1], br_interval_subtract(box.t, middle.t)),
                (iv){-f->error, f->error}));
    if (!br_is_finite(mean) || mean.low > f->range.high || mean.high < f->range.low)
        return;
    f->range = (iv){fmax(f->range.low, mean.low), fmin(f->range.high, mean.high)};
}

static iv centre_of(iv a)
{
    return br_point(a.low + (a.high - a.low) / 2);
}

static void bound_node(const struct br_node *n, const struct form *forms, bool wide,
                       struct br_box box, struct br_box middle, struct form *f)
{
    const struct form *const argument[] = {&forms[n->argument[0]], &forms[n->argument[1]],
                                           &forms[n->argument[2]]};
    iv range[3], centre[3];
    for (unsigned k = 0; k < 3; k++) {
        range[k] = argument[k]->range;
        centre[k] = argument[k]->centre;
    }
    f->range = br_interval_apply(n->operation, range, are_equal(n));
    if (!wide)
        return;
    f->centre = br_interval_apply(n->operation, centre, are_equal(n));
    if (n->operation == BR_OP_CHOOSE)
        choose_form(argument, f);
    else
        differentiate(n->operation, argument, f);
    if (br_is_finite(f->range) && !br_is_point(f->range))
        cut(box, middle, f);
}

bool br_tree_bound(const struct br_tree *tree, iv *work, struct br_box box, iv *value)
{
    struct form *forms = (struct form *)work;
    const int rounding = br_round_to_nearest();
    const struct br_box middle = {centre_of(box.x), centre_of(box.t)};
    const bool wide = !br_is_point(box.x) || !br_is_point(box.t);
    for (size_t i = 0; i < tree->count; i++) {
        const struct br_node *n = &tree->node[i];
        struct form *f = &forms[i];
        if (br_operation_arguments(n->operation))
            bound_node(n, forms, wide, box, middle, f);
        else
            *f = (struct form){
                .range = variable_of(n, box),
                .centre = variable_of(n, middle),
                .slope = {br_point(n->operation == BR_OP_X), br_point(n->operation == BR_OP_T)}};
    }
    br_round_as_before(rounding);
    *value = forms[tree->count - 1].range;
    return br_is_finite(*value);
}

/* ---- guards ---- */

/* A guard as a function: a tree, and a workspace that may be another's. */
struct guard {
    struct br_tree tree;
    iv *work, *own_work;
};

static void guard_free(void *self)
{
    struct guard *g = self;
    if (!g)
        return;
    br_tree_clear(&g->tree);
    free(g->own_work);
    free(g);
}

static void *guard_clone(const void *self)
{
    const struct br_tree *from = &((const struct guard *)self)->tree;
    struct guard *g = br_allocate(1, sizeof *g);
    if (!g)
        return NULL;
    g->tree = (struct br_tree){br_allocate(from->count, sizeof *from->node), from->count};
    g->work = g->own_work = br_allocate(from->count, BR_TREE_WORK * sizeof *g->work);
    if (!g->tree.node || !g->work) {
        guard_free(g);
        return NULL;
    }
    memcpy(g->tree.node, from->node, from->count * sizeof *from->node);
    return g;
}

static bool guard_bound(const void *self, struct br_box box, iv *value)
{
    const struct guard *g = self;
    return br_tree_bound(&g->tree, g->work, box, value);
}

static bool guard_taylor(const void *self, enum br_variable along, struct br_box box, size_t order,
                         iv *coefficient)
{
    const struct guard *g = self;
    return br_tree_taylor(&g->tree, g->work, along, box, order, coefficient);
}

/* The middle of what is proved of each point. */
static void guard_evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    for (size_t i = 0; i < count; i++) {
        iv at;
        const struct br_box point = {br_point(x[i]), br_point(t)};
        value[i] = guard_bound(self, point, &at) ? at.low + (at.high - at.low) / 2 : NAN;
    }
}

static const struct br_function_ops guard_ops = {
    .evaluate = guard_evaluate,
    .clone = guard_clone,
    .free = guard_free,
    .bound = guard_bound,
    .taylor = guard_taylor,
};

static bool is_truth(enum br_operation o)
{
    return o == BR_OP_NOT || (o >= BR_OP_LESS && o <= BR_OP_OR);
}

/* The guard of a node's argument k; BR_NO_NODE where it has none. */
static unsigned guard_node(struct br_tree_builder *b, const struct br_tree *tree,
                           const struct br_node *n, unsigned k)
{
    const enum br_operation o = n->operation;
    const unsigned a = n->argument[k];
    const bool compares = o >= BR_OP_MIN && o <= BR_OP_NOT_EQUAL;
    const bool itself =
        o == BR_OP_ABS || o == BR_OP_SIGN || o == BR_OP_STEP ||
        (!is_truth(tree->node[a].operation) &&
         (o == BR_OP_NOT || o == BR_OP_AND || o == BR_OP_OR || (o == BR_OP_CHOOSE && k == 0)));
    if ((compares ? k > 0 : !itself) || !(n->uses_x || n->uses_t))
        return BR_NO_NODE;
    const unsigned first = br_tree_graft(b, tree, a);
    return compares
               ? br_tree_node(b, BR_OP_SUBTRACT, first, br_tree_graft(b, tree, n->argument[1]), 0)
               : first;
}

/* Appends the guard, if there is one, as a function. */
static enum br_status add_guard(struct br_proofs *p, const struct br_tree *tree,
                                const struct br_node *n, unsigned k, struct br_error *err)
{
    struct br_tree_builder b = {0};
    const unsigned root = guard_node(&b, tree, n, k);
    if (root == BR_NO_NODE && !b.status)
        return BR_OK;
    struct guard *g = br_allocate(1, sizeof *g);
    if (!g)
        b.status = BR_NO_MEMORY;
    struct br_tree made;
    const enum br_status status = br_tree_finish(&b, root, &made, err);
    if (status) {
        free(g);
        return status;
    }
    *g = (struct guard){made, p->work, NULL};
    const struct br_node *last = &made.node[made.count - 1];
    p->guard[p->guards++] = (struct br_function){
        .ops = &guard_ops, .self = g, .uses_x = last->uses_x, .uses_t = last->uses_t};
    return BR_OK;
}

enum br_status br_proofs_init(struct br_proofs *p, const struct br_tree *tree, struct br_error *err)
{
    /* a guard has at most one node more */
    *p = (struct br_proofs){.work = br_allocate(tree->count + 1, BR_TREE_WORK * sizeof *p->work),
                            .guard = br_allocate(3 * tree->count, sizeof *p->guard)};
    enum br_status status = p->work && p->guard ? BR_OK : br_no_memory(err, "an expression");
    for (size_t i = 0; i < tree->count && !status; i++)
        for (unsigned k = 0; k < br_operation_arguments(tree->node[i].operation) && !status; k++)
            status = add_guard(p, tree, &tree->node[i], k, err);
    return status;
}

void br_proofs_clear(struct br_proofs *p)
{
    for (size_t i = 0; i < p->guards; i++)
        br_function_free(&p->guard[i]);
    free(p->guard);
    free(p->work);
    *p = (struct br_proofs){0};
}
