/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What numbers say for and against a reading, in log odds. Each evidence has one row in a table. */
#include <math.h>
#include <string.h>

#include "orders/reading/roles.h"

/* A candidate, its rows from coarse to fine, and what its sizes make of the rates. */
struct view {
    const struct br_roles *roles;
    const struct br_candidate *candidate;
    const size_t *sorted;
    struct {
        size_t columns, compared;
        bool all, exact, near; /* of the columns */
    } rates;
};

/* Two neighbours of a line, from coarse to fine. */
struct pair {
    size_t coarse, fine;
    double ratio; /* log of coarse over fine size */
};

/* Takes the next two neighbours from *at on. */
static bool next_pair(const struct view *v, size_t *at, struct pair *pair)
{
    const double *log_z = v->candidate->log_z;
    for (; v->sorted[*at] != BR_NO_ROW && v->sorted[*at + 1] != BR_NO_ROW; ++*at) {
        *pair = (struct pair){v->sorted[*at], v->sorted[*at + 1], 0};
        pair->ratio = log_z[pair->coarse] - log_z[pair->fine];
        if (v->roles->line[pair->coarse] == v->roles->line[pair->fine] && pair->ratio > 1e-9)
            return ++*at;
    }
    return false;
}

static const struct br_role_column *own(const struct view *v)
{
    static const struct br_role_column none = {.is_whole = true}; /* h halves from row to row */
    return v->candidate->size.column == BR_NO_ROW ? &none
                                                  : &v->roles->column[v->candidate->size.column];
}

static bool has_name(const struct view *v, const char *name)
{
    return strcmp(v->candidate->size.states->name, name) == 0;
}

/* ---- rates ---- */

/* Whether a column may have errors, or values. */
static bool may_have_errors(const struct view *v, size_t i)
{
    const struct br_role_column *c = &v->roles->column[i];
    return i != v->candidate->size.column && c->role != BR_ROLE_CASE && c->numbers > c->words &&
           c->numbers >= 2 && c->most > 0 && c->kind != BR_KIND_RATE && c->kind != BR_KIND_COST &&
           c->kind != BR_KIND_FACTOR && c->kind != BR_KIND_DEVIATION &&
           c->kind != BR_KIND_LOGARITHM;
}

struct residual {
    size_t compared;
    double worst; /* that is beyond the digits */
    double whole; /* largest */
    double sum;
};

/* Compares rates with those of a column of errors; finer: rates stand at the finer of two sizes. */
static struct residual compare_rates(const struct view *v, const struct br_role_column *rate,
                                     const struct br_role_column *e, bool finer)
{
    const double most = 0.06, least = 0.006; /* of a printed rate */
    const double coarse = 0.15;              /* of the rate of two errors with few digits */
    const struct br_role_column *z = own(v);
    struct residual found = {0};
    struct pair p;
    double sign = 0; /* of rates over a count, which some print */
    for (size_t i = 0; i < v->roles->rows; i++)
        sign += isnan(rate->number[i]) ? 0 : rate->number[i];
    for (size_t at = 0; next_pair(v, &at, &p);) {
        const size_t row = finer ? p.fine : p.coarse;
        const double observed = log(fabs(e->number[p.coarse] / e->number[p.fine])) / p.ratio;
        const double of_sizes =
            z->is_whole ? 0 : fabs(observed) * (z->rounding[p.coarse] + z->rounding[p.fine]);
        const double digits =
            -log1p(-e->rounding[p.coarse]) - log1p(-e->rounding[p.fine]) + of_sizes;
        if (isnan(rate->number[row]) || !isfinite(observed))
            continue;
        const double off = fabs(observed - (sign < 0 ? -1 : 1) * rate->number[row]);
        const double beyond =
            off - fmin(most, fmax(least, fabs(rate->rounding[row] * rate->number[row])));
        if (beyond > coarse && beyond <= digits / p.ratio) /* too few digits to tell */
            continue;
        found.worst = fmax(found.worst, beyond - fmin(coarse, digits / p.ratio));
        found.compared++;
        found.sum += off;
        found.whole = fmax(found.whole, off);
    }
    return found;
}

/* What a column of errors makes of a column of rates. They stand at the finer of two sizes, unless
 * more of them stand at the coarser one. */
static struct residual compare_column(const struct view *v, const struct br_role_column *rate,
                                      size_t column)
{
    const struct br_role_column *e = &v->roles->column[column];
    const struct residual at_finer = compare_rates(v, rate, e, true);
    const struct residual at_coarser = compare_rates(v, rate, e, false);
    return at_coarser.compared > at_finer.compared ? at_coarser : at_finer;
}

/* The best that any column of errors makes of a column of rates. */
static struct residual best_of_rates(const struct view *v, const struct br_role_column *rate)
{
    struct residual best = {0, INFINITY, INFINITY, INFINITY};
    for (size_t i = 0; i < v->roles->columns; i++) {
        if (!may_have_errors(v, i))
            continue;
        const struct residual found = compare_column(v, rate, i);
        if (found.compared && found.whole <= best.whole)
            best = found;
    }
    return best;
}

/* Whether a column has the ratios of two errors each, within its digits: it says nothing of sizes.
 */
static bool has_ratios(const struct view *v, const struct br_role_column *c)
{
    for (size_t i = 0; i < v->roles->columns; i++) {
        const double *const e = v->roles->column[i].number;
        size_t compared = 0;
        bool are = may_have_errors(v, i);
        struct pair p;
        for (size_t at = 0; are && next_pair(v, &at, &p);) {
            if (isnan(c->number[p.fine]))
                continue;
            const double ratio = fabs(e[p.coarse] / e[p.fine]);
            const double digits = c->rounding[p.fine] + v->roles->column[i].rounding[p.coarse] +
                                  v->roles->column[i].rounding[p.fine];
            are = fabs(c->number[p.fine] / ratio - 1) <= 2 * digits;
            compared++;
        }
        if (are && compared)
            return true;
    }
    return false;
}

/* Whether the table has the rates of a column, within their digits: it has errors. */
static bool has_rates(const struct view *v, size_t column)
{
    const enum br_kind kind = v->roles->column[column].kind;
    bool has = false;
    for (size_t i = 0; i < v->roles->columns && !has; i++) {
        const struct br_role_column *c = &v->roles->column[i];
        if (c->kind != BR_KIND_RATE || !c->name || c->role == BR_ROLE_CASE ||
            (kind != BR_KIND_UNKNOWN && kind != BR_KIND_ERROR))
            continue;
        const struct residual found = compare_column(v, c, column);
        has = found.compared > 1 && found.worst <= 0 && found.whole <= 0.006 && c->least >= 0;
    }
    return has;
}

static void find_rates(struct view *v)
{
    v->rates.all = v->rates.exact = v->rates.near = true;
    for (size_t i = 0; i < v->roles->columns; i++) {
        const struct br_role_column *c = &v->roles->column[i];
        if (c->kind != BR_KIND_RATE || i == v->candidate->size.column || c->numbers == 0 ||
            c->role == BR_ROLE_CASE)
            continue;
        const struct residual best = best_of_rates(v, c);
        if (!best.compared || (!c->name && (best.worst > 0 || has_ratios(v, c))))
            continue; /* without a name it may be a factor */
        v->rates.columns++;
        v->rates.compared = best.compared > v->rates.compared ? best.compared : v->rates.compared;
        v->rates.all &= best.worst <= 0;
        v->rates.exact &= best.worst <= 0 && best.whole <= 0.006;
        v->rates.near &= best.whole <= 0.15 || best.sum <= 0.1 * (double)best.compared;
    }
}

/* ---- growth ---- */

/* Whether a number and `more` grow by this factor from each mesh to the next: within 2 %, or
 * steadily to it. */
static bool grows_by(const struct view *v, double more, double factor, bool steadily)
{
    const double *number = own(v)->number;
    size_t pairs = 0;
    double before = steadily ? 0.25 : 0.02, off = 1;
    struct pair p;
    for (size_t at = 0; number && next_pair(v, &at, &p); pairs++) {
        off = fabs((number[p.fine] + more) / (number[p.coarse] + more) / factor - 1);
        if (!(off <= before + 1e-9))
            return false;
        before = steadily ? off : before;
    }
    return pairs >= 2 && off <= 0.08;
}

static bool is_power(double number, double power)
{
    return isnan(number) || pow(round(pow(number, 1 / power)), power) == number;
}

/* Whether all numbers are squares or all are cubes, 11^3, 13^3, 17^3, and not both, as 64 is. */
static bool are_powers(const struct view *v, double power)
{
    const struct br_role_column *c = own(v);
    bool are = power > 1 && c->number && c->is_whole && c->least >= 1, also = are;
    for (size_t i = 0; i < v->roles->rows && are; i++) {
        are = is_power(c->number[i], power);
        also &= is_power(c->number[i], power == 2 ? 3 : 2);
    }
    return are && !also;
}

static bool grows_in(const struct view *v, double dimension)
{
    const bool dofs = has_name(v, "dofs");
    return grows_by(v, 0, pow(2, dimension), dofs) ||
           (dimension > 1 && (grows_by(v, 0, pow(3, dimension), dofs) ||
                              grows_by(v, 0, pow(1.5, dimension), false)));
}

static double grows(const struct view *v)
{
    const struct br_resolution_column *c = v->candidate->size.states;
    /* without a usual name of a size it may be anything */
    const double odds = own(v)->by_hand || own(v)->named > BR_ANY_NAME ? 1 : 0.25;
    if (c->is_volume)
        return odds * grows_in(v, v->candidate->size.dimension);
    return 2 * odds * (c->more && grows_by(v, c->more, 2, false));
}

/* Whether all sizes fall by one factor. */
static bool falls_by(const struct view *v, double ratio)
{
    size_t pairs = 0;
    struct pair p;
    for (size_t at = 0; next_pair(v, &at, &p); pairs++)
        if (!(fabs(p.ratio - ratio) <= 2e-3))
            return false;
    return pairs >= 2;
}

/* Whether a number doubles, as that of points almost does. */
static bool doubles(const struct view *v)
{
    const double *number = own(v)->number;
    struct pair p;
    for (size_t at = 0; number && next_pair(v, &at, &p);)
        if (!(fabs(log(number[p.fine] / number[p.coarse]) - log(2)) <= 2e-3))
            return false;
    return true;
}

/* ---- errors ---- */

/* How a column changes from coarse to fine: the mean of logs, for each e-fold of the size. */
static double fall_of(const struct view *v, size_t column)
{
    const double *e = v->roles->column[column].number;
    double fall = 0, size = 0;
    struct pair p;
    for (size_t at = 0; next_pair(v, &at, &p);) {
        const double by = log(fabs(e[p.coarse] / e[p.fine]));
        if (!isfinite(by))
            continue;
        fall += by;
        size += p.ratio;
    }
    return size > 0 ? fall / size : 0;
}

/* Whether a column falls below what it is at the coarsest size of a line, also where round-off lets
 * it grow again. */
static bool dips(const struct view *v, size_t column)
{
    const double *e = v->roles->column[column].number;
    double first = NAN;
    size_t line = BR_NO_ROW;
    struct pair p;
    for (size_t at = 0; next_pair(v, &at, &p);) {
        first = line == v->roles->line[p.coarse] && !isnan(first) ? first : fabs(e[p.coarse]);
        line = v->roles->line[p.coarse];
        if (fabs(e[p.fine]) < 0.95 * first)
            return true;
    }
    return false;
}

bool br_evidence_falls(const struct br_roles *roles, const struct br_candidate *candidate,
                       const size_t *sorted, size_t column)
{
    static const double least = 0.3; /* rate */
    const struct view v = {roles, candidate, sorted, {0}};
    const double *e = roles->column[column].number;
    struct pair p;
    for (size_t at = 0; next_pair(&v, &at, &p);)
        if (!(log(fabs(e[p.coarse] / e[p.fine])) >= least * p.ratio))
            return false;
    return true;
}

/* Whether a column grows from each size to the next finer one, as far as it changes. */
static bool climbs(const struct view *v, size_t column)
{
    const double *e = v->roles->column[column].number;
    size_t pairs = 0;
    struct pair p;
    for (size_t at = 0; next_pair(v, &at, &p); pairs++)
        if (fabs(e[p.fine]) < 0.999 * fabs(e[p.coarse]))
            return false;
    return pairs > 1 && fall_of(v, column) < -0.05;
}

static bool hardly_changes(const struct br_role_column *c)
{
    return c->most - c->least <= 0.2 * fabs(c->most);
}

/* Whether a column changes by less than a factor of two, and hardly from its begin to its end: it
 * comes to a limit. */
static bool stays(const struct view *v, size_t column)
{
    const struct br_role_column *c = &v->roles->column[column];
    return c->most < 2 * c->least && fabs(fall_of(v, column)) < 0.02;
}

/* 1: no error falls with these sizes, and one grows from each to the next; 0.5: only what has no
 * name of an error does. */
static double grow_all(const struct view *v)
{
    double grow = 0;
    for (size_t i = 0; i < v->roles->columns; i++) {
        const struct br_role_column *c = &v->roles->column[i];
        if (!may_have_errors(v, i) || c->least < 0 || c->is_value ||
            (c->is_whole && c->kind != BR_KIND_ERROR) ||
            (hardly_changes(c) && (c->kind != BR_KIND_ERROR || v->roles->wishes->values)) ||
            (c->by_hand && c->role != BR_ROLE_ERROR))
            continue;
        if (dips(v, i))
            return 0;
        if (climbs(v, i))
            grow = fmax(grow, c->kind == BR_KIND_ERROR ? 1 : 0.5);
    }
    return grow;
}

static bool some_fall(const struct view *v)
{
    bool falls = false;
    for (size_t i = 0; i < v->roles->columns && !falls; i++)
        falls = may_have_errors(v, i) && !v->roles->column[i].is_whole &&
                !v->roles->column[i].is_value && v->roles->column[i].least >= 0 && dips(v, i);
    return falls;
}

/* ---- other columns ---- */

bool br_evidence_same(const struct br_roles *r, const double *a, const double *b, double tolerance)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < r->rows; i++) {
        const double by = a[i] - b[i];
        if (isnan(by))
            continue;
        low = fmin(low, by);
        high = fmax(high, by);
    }
    return high - low <= tolerance;
}

/* Whether another column states the same sizes in a usual way, to a tolerance. */
static bool agrees(const struct view *v, size_t column, const struct br_resolution_column *states,
                   double dimension, double tolerance)
{
    const struct br_role_column *c = &v->roles->column[column];
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; v->sorted[i] != BR_NO_ROW; i++) {
        const size_t row = v->sorted[i];
        const double by =
            log(br_numbers_z(states, c->number[row], dimension)) - v->candidate->log_z[row];
        if (!isfinite(by))
            return false;
        low = fmin(low, by);
        high = fmax(high, by);
    }
    return high - low <= tolerance;
}

static bool has_a_second(const struct view *v)
{
    for (size_t i = 0; i < v->roles->columns; i++) {
        const struct br_role_column *c = &v->roles->column[i];
        if (i == v->candidate->size.column || c->kind == BR_KIND_COST || c->kind == BR_KIND_RATE ||
            c->kind == BR_KIND_ERROR || c->words || !(c->least < c->most))
            continue;
        for (const struct br_resolution_column *s = br_resolution_columns; s->name; s++) {
            const bool named = br_odds(c, s) > 1.5;
            if (!named && br_odds(own(v), v->candidate->size.states) <= 0.5)
                continue; /* of two unknown columns one may have errors of order one */
            if (s->axis != BR_AXIS_SPACE || strcmp(s->name, "dofs") == 0 ||
                !(named || (br_odds(c, br_resolution_columns) < BR_USUAL_NAME && c->is_whole &&
                            !s->is_size && c->least >= 1)))
                continue;
            for (int d = 1; d <= (s->is_volume ? 3 : 1); d++)
                if (agrees(v, i, s, d, 0.01))
                    return true;
        }
    }
    return 0;
}

/* Whether the root of a column is a line over the sizes of the candidate. */
static bool has_root_on_a_line(const struct view *v, size_t column, double dimension)
{
    static const double little = 0.005;
    const double *const n = own(v)->number, *const count = v->roles->column[column].number;
    double first = NAN, slope = NAN;
    bool is = v->sorted[0] != BR_NO_ROW && v->sorted[1] != BR_NO_ROW;
    size_t i = 0;
    for (; v->sorted[i] != BR_NO_ROW && is; i++) {
        const double root = pow(count[v->sorted[i]], 1 / dimension);
        const double along = n[v->sorted[i]] - n[v->sorted[0]];
        first = i == 0 ? root : first;
        slope = i == 1 ? (root - first) / along : slope;
        is = i < 2 || fabs(root - first - slope * along) <= little * root;
    }
    return is && i > 2 && slope > 0;
}

/* Whether unknowns or cells are of a mesh of so many along each side: (n + 1)^2, (2n + 1)^3. */
static bool counts_a_mesh(const struct view *v)
{
    const struct br_resolution_column *s = v->candidate->size.states;
    bool counts = false;
    if (s->is_size || s->is_power || s->is_volume || s->axis != BR_AXIS_SPACE)
        return false;
    for (size_t i = 0; i < v->roles->columns && !counts; i++) {
        const struct br_role_column *c = &v->roles->column[i];
        const bool named = br_odds(c, br_resolution_column_find("dofs")) >= BR_USUAL_NAME ||
                           br_odds(c, br_resolution_column_find("cells")) >= BR_USUAL_NAME;
        for (int d = 2; d <= 3 && named && i != v->candidate->size.column && !counts; d++)
            counts = has_root_on_a_line(v, i, d);
    }
    return counts;
}

/* Unknowns and cells, beside a column that is called h, n or level; a level beside an h that is
 * almost its. */
static bool is_beside_a_size(const struct view *v)
{
    static const double almost = 0.15; /* of logs */
    const bool level = v->candidate->size.states->is_power;
    for (size_t i = 0; i < v->roles->columns && (level || v->candidate->size.states->is_volume);
         i++) {
        const struct br_role_column *c = &v->roles->column[i];
        for (const struct br_resolution_column *s = br_resolution_columns; s->name; s++)
            if (i != v->candidate->size.column && !s->is_volume && s->axis == BR_AXIS_SPACE &&
                (!level || (s->is_size && agrees(v, i, s, 1, almost))) && c->least < c->most &&
                c->numbers == v->roles->rows && br_odds(c, s) >= BR_USUAL_NAME)
                return true;
    }
    return false;
}

/* Whether a column without the name of an error falls far less than one that has it. */
static bool falls_less(const struct br_roles *r, const struct br_role_column *c)
{
    static const double little = 2, far = 8;
    bool less = false;
    for (size_t i = 0; i < r->columns && c->most < little * c->least; i++)
        less |= r->column[i].kind == BR_KIND_ERROR && r->column[i].least > 0 &&
                r->column[i].most > far * r->column[i].least;
    return less;
}

/* Whether a column is equally spaced within its digits, which parameters are and errors are not. */
static bool is_even(const struct view *v, size_t column)
{
    static const double most = 0.05; /* of a step, by the digits */
    const struct br_role_column *c = &v->roles->column[column];
    const double *e = c->number;
    size_t count = 0;
    double step = NAN, first = NAN;
    struct pair p;
    for (size_t at = 0; next_pair(v, &at, &p); count++) {
        const double by = e[p.coarse] - e[p.fine];
        const double digits = fabs(e[p.coarse]) * c->rounding[p.coarse] +
                              fabs(e[p.fine]) * c->rounding[p.fine] + 1e-9 * fabs(by);
        step = count ? step : by;
        first = count ? first : digits;
        if (!(fabs(by - step) <= fmin(digits + first, most * fabs(step))))
            return false;
    }
    return count > 2;
}

/* ---- the tables ---- */

void br_evidence_weigh(const struct br_roles *roles, struct br_candidate *candidate,
                       const size_t *sorted)
{
    static const double few_cells = 1e5; /* of a line */
    struct view v = {roles, candidate, sorted, {0}};
    const struct br_role_column *c = own(&v);
    const struct br_resolution_column *s = candidate->size.states;
    const double d = candidate->size.dimension;
    find_rates(&v);
    const double grow = grow_all(&v);
    const bool rates = v.rates.columns, several = v.rates.compared > 1,
               gives = rates && v.rates.all, contradicts = rates && !v.rates.all && !v.rates.near,
               grown = grows_in(&v, 1) || grows_in(&v, 2) || grows_in(&v, 3),
               powers = s->is_volume && !grown && !are_powers(&v, d) &&
                        (are_powers(&v, 2) || are_powers(&v, 3)),
               plane = has_name(&v, "dofs") && d == 2 && !grown && !are_powers(&v, 3),
               many =
                   s->is_volume && d == 1 && !(roles->wishes->dimension > 0) && c->most > few_cells,
               fractions = !s->is_size && !c->is_whole && !strpbrk(c->name ? c->name : "", "/");
    const struct {
        double holds; /* 0: no, 1: yes */
        double log_odds;
    } evidence[] = {
        {c->stated == s, 99},                   /* --column says so */
        {br_odds(c, s), 1},                     /* its heading */
        {gives ? several ? 1 : 0.5 : 0, 6},     /* the table has its rates, within their digits */
        {gives && v.rates.exact && several, 3}, /* to the last digit */
        {contradicts, -4},                      /* the table has other rates */
        {grows(&v), 2},               /* it grows as a number of this kind does where h halves */
        {c->of_sides && !s->more, 3}, /* "8x8": cells along each side, or points */
        {c->of_sides && s->more && br_odds(c, br_resolution_column_find("cells")) < BR_USUAL_NAME,
         2},
        {powers, -1.5},               /* it counts a square or a cube of another dimension */
        {plane, 1.5},                 /* most meshes with unknowns are 2-D */
        {many, -3},                   /* few meshes are 1-D and have so many cells */
        {falls_by(&v, log(2)), 0.75}, /* its sizes halve */
        {has_a_second(&v) || counts_a_mesh(&v), 3}, /* another column states the same sizes */
        {is_beside_a_size(&v), -4},                 /* another column is called h, n or level */
        {some_fall(&v), 0.5},                       /* something falls with its sizes */
        {grow, -3},      /* all that may be errors grows where its sizes fall */
        {fractions, -3}, /* a count is whole */
    };
    candidate->odds = 0;
    for (size_t i = 0; i < sizeof evidence / sizeof *evidence; i++)
        candidate->odds += evidence[i].log_odds * evidence[i].holds;
    candidate->agrees_with_rates = gives;
    candidate->misses_rates = rates && !gives;
    candidate->contradicts_rates = contradicts;
    candidate->wrong_way = grow > 0;
    candidate->halves = s->more && falls_by(&v, log(2)) && !doubles(&v);
}

double br_evidence_of_errors(const struct br_roles *roles, const struct br_candidate *candidate,
                             const size_t *sorted, size_t column)
{
    static const double falls_further = 20; /* the error of a coefficient does */
    const struct view v = {roles, candidate, sorted, {0}};
    const struct br_role_column *c = &roles->column[column];
    const bool named = c->kind == BR_KIND_ERROR,
               norm_of_values =
                   named && !br_says_error(c->name) && hardly_changes(c) && !dips(&v, column),
               of_another_kind = !named && c->kind != BR_KIND_UNKNOWN &&
                                 !(c->kind == BR_KIND_DEGREE && !c->is_whole),
               has_a_limit =
                   c->name && br_is_coefficient(c->name) && c->most < falls_further * c->least;
    const struct {
        bool holds;
        double log_odds;
    } evidence[] = {
        {named, 3.5},          /* its heading */
        {norm_of_values, -3},  /* "L2" of what comes to a limit */
        {of_another_kind, -5}, /* its heading is of a rate, a cost, a deviation or a degree */
        {dips(&v, column) && (named || !stays(&v, column)), 1.5}, /* it falls with the sizes */
        {climbs(&v, column) && c->is_whole && c->most > 1, -4},   /* it counts */
        {hardly_changes(c), -2.5},                                /* it hardly changes */
        {!named && is_even(&v, column), -4},                      /* it is a parameter */
        {!named && falls_less(roles, c), -3},                     /* it is a value beside errors */
        {has_rates(&v, column), 6},                               /* the table has its rates */
        {has_a_limit, -4},             /* it is a coefficient, and does not fall far */
        {c->least < 0 && !named, -9},  /* it has both signs */
        {c->numbers <= c->words, -99}, /* it has words */
    };
    double odds = 0;
    for (size_t i = 0; i < sizeof evidence / sizeof *evidence; i++)
        odds += evidence[i].holds ? evidence[i].log_odds : 0;
    return odds;
}

double br_evidence_order(const struct br_roles *roles, const struct br_candidate *candidate,
                         const size_t *sorted, size_t column)
{
    const struct view v = {roles, candidate, sorted, {0}};
    return fall_of(&v, column);
}

bool br_evidence_halves(const struct br_roles *roles, const struct br_candidate *candidate,
                        const size_t *sorted)
{
    return falls_by(&(struct view){roles, candidate, sorted, {0}}, log(2));
}
