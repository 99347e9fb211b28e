/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/work.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "orders/line/line_order.h"
#include "orders/reading/roles.h"

/* ---- fronts ---- */

/* Errors that differ by less count as equal: those of two linear solvers differ in the last bits.
 */
static const double tie = 1e-6;

static bool counts(const struct br_point *p)
{
    return isfinite(p->error) && isfinite(p->cost);
}

static bool is_cheaper(const struct br_point *a, const struct br_point *b)
{
    return a->cost < b->cost || (!(a->cost > b->cost) && a->effort < b->effort);
}

size_t br_work_cheapest(const struct br_point *p, size_t count, double target, size_t program,
                        size_t other)
{
    size_t best = count;
    for (size_t i = 0; i < count; i++)
        if ((program == SIZE_MAX || p[i].program == program) && p[i].program != other &&
            p[i].error <= target && counts(&p[i]) && (best == count || is_cheaper(&p[i], &p[best])))
            best = i;
    return best;
}

/* Whether b is better than a; of equals the earlier is better. */
static bool is_beaten(const struct br_point *a, const struct br_point *b)
{
    if (b->cost < a->cost)
        return b->error <= (1 + tie) * a->error;
    return b->cost <= a->cost && (b->error < a->error || (b->error <= a->error && b < a));
}

void br_work_front(struct br_point *p, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        p[i].front = p[i].own = counts(&p[i]);
        for (size_t j = 0; j < count && p[i].own; j++)
            if (j != i && is_beaten(&p[i], &p[j])) {
                p[i].front = false;
                p[i].own = p[j].program != p[i].program;
            }
    }
}

size_t br_work_next(const struct br_point *p, size_t count, size_t last)
{
    const double after = last < count ? p[last].cost : -INFINITY;
    size_t next = count;
    for (size_t i = 0; i < count; i++)
        if (p[i].front && p[i].cost > after && (next == count || p[i].cost < p[next].cost))
            next = i;
    return next;
}

/* ---- what a program has ---- */

/* The name of a file without folders (out) and, but for endings like ".2", without its ending;
 * returns its length. */
static int stem_of(const char *path, const char **stem)
{
    const char *slash = strrchr(path, '/');
    *stem = slash && slash[1] ? slash + 1 : path;
    const char *dot = strrchr(*stem, '.');
    const bool cut =
        dot > *stem && dot[1] && !dot[1 + strspn(dot + 1, "abcdefghijklmnopqrstuvwxyz")];
    return cut ? (int)(dot - *stem) : (int)strlen(*stem);
}

void br_work_name_sources(struct br_work_source *s, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const char *stem, *other;
        const int length = stem_of(s[i].path, &stem);
        snprintf(s[i].name, sizeof s[i].name, "%.*s", length, stem);
        for (size_t k = 0; k < count; k++)
            if (k != i && stem_of(s[k].path, &other) == length &&
                strncmp(stem, other, (size_t)length) == 0)
                snprintf(s[i].name, sizeof s[i].name, "%s", s[i].path);
    }
}

/* A program: the columns of its error and of its cost. */
struct member {
    const struct br_work_source *source;
    const char *of;            /* " [method = P1]" */
    size_t error, cost, costs; /* costs: how many columns may be the cost */
    enum br_cost kind;
    double factor;
    const char *unit;
};

struct members {
    struct member *list; /* owned */
    size_t count;
    const char *cost; /* of --cost */
};

enum { NAME = 200 };

static const char *case_of(const struct br_quantity *q)
{
    return q->case_at ? q->name + q->case_at : "";
}

/* Whether column i is of this program; its name without the case (out). */
static bool has(const struct member *m, size_t i, char name[NAME])
{
    const struct br_quantity *q = &m->source->numbers.quantity[i];
    const size_t length = q->case_at ? q->case_at : strlen(q->name);
    snprintf(name, NAME, "%.*s", (int)(length < NAME ? length : NAME - 1), q->name);
    return strcmp(case_of(q), m->of) == 0;
}

/* The error of that name; SIZE_MAX: there is none. */
static size_t find_error(const struct member *m, const char *name, const char *cost)
{
    const struct br_numbers *n = &m->source->numbers;
    char text[NAME];
    for (size_t i = 0; i < n->quantities; i++)
        if (has(m, i, text) && !n->quantity[i].is_value && strcasecmp(text, name) == 0 &&
            br_kind_of(text) != BR_KIND_COST && strcmp(text, cost) != 0)
            return i;
    return SIZE_MAX;
}

/* Takes the column of a name; else those of a kind, before which a time goes that does not say
 * which. */
static bool find_cost(struct member *m, const char *name, enum br_cost kind)
{
    enum { NONE, A_TIME, KIND, NAMED } fits, best = NONE;
    const struct br_numbers *n = &m->source->numbers;
    char text[NAME];
    m->costs = 0;
    for (size_t i = 0; i < n->quantities + n->costs && best < NAMED; i++) {
        const char *unit = n->quantity[i].unit;
        double factor;
        if (!has(m, i, text))
            continue;
        const enum br_cost is = br_cost_of(text, unit, &factor);
        fits = *name && strcmp(text, name) == 0                    ? NAMED
               : is == BR_COSTS                                    ? NONE
               : is == (kind == BR_COST_TIME ? BR_COST_CPU : kind) ? KIND
               : is == BR_COST_TIME && kind <= BR_COST_TIME        ? A_TIME
                                                                   : NONE;
        if (fits == NONE || fits < best)
            continue;
        m->costs = fits > best ? 1 : m->costs + 1;
        best = fits;
        m->cost = i;
        m->kind = is;
        m->factor = factor;
        m->unit = is < BR_COSTS ? br_costs[is].unit : unit ? unit : "";
    }
    return best > NONE;
}

static enum br_status refuse_cost(const struct member *m, const char *name, struct br_error *err)
{
    enum { MOST = 16 };
    const struct br_numbers *n = &m->source->numbers;
    const char *names[MOST];
    char expected[BR_EXPECTED];
    size_t count = 0;
    for (; count < n->costs && count < MOST; count++)
        names[count] = n->quantity[n->quantities + count].name;
    return br_fail(
        err, BR_BAD_INPUT, "%s%s: --cost: found no cost '%s', %s", m->source->path, m->of, name,
        count ? br_expected(name, names, count, expected) : "expected the name of a column");
}

static enum br_status choose_cost(struct members *all, struct br_error *err)
{
    static const enum br_cost usual[] = {BR_COST_CPU, BR_COST_WALL, BR_COST_DOFS,
                                         BR_COST_ITERATIONS, BR_COST_MEMORY};
    const bool named = *all->cost;
    double factor;
    const enum br_cost kind = br_cost_of(all->cost, NULL, &factor);
    bool found = false;
    for (size_t i = 0; i < (named ? 1 : sizeof usual / sizeof *usual) && !found; i++) {
        found = true;
        for (struct member *m = all->list; m < all->list + all->count; m++)
            found &= find_cost(m, all->cost, named ? kind : usual[i]);
    }
    for (const struct member *m = all->list; m < all->list + all->count; m++) {
        const struct br_numbers *n = &m->source->numbers;
        if (named && !m->costs)
            return refuse_cost(m, all->cost, err);
        if (!named && !n->costs)
            return br_fail(err, BR_BAD_INPUT,
                           "%s%s: found no column of a cost, expected one like seconds, cpu, wall, "
                           "dofs, iterations or memory; --cost NAME names another one",
                           m->source->path, m->of);
        if (found && br_is_logarithm(n->quantity[m->cost].name))
            return br_fail(err, BR_BAD_INPUT, "%s: %s has logarithms: give the numbers themselves",
                           m->source->path, n->quantity[m->cost].name);
        if (found && m->costs > 1)
            return br_fail(err, BR_BAD_INPUT,
                           "%s: several columns may be the cost, one of them is %s: --cost NAME "
                           "chooses one",
                           m->source->path, n->quantity[m->cost].name);
        if (found && strcmp(m->unit, all->list->unit) != 0)
            return br_fail(err, BR_BAD_INPUT, "%s: %s has the unit '%s', that of %s has '%s'",
                           m->source->path, all->cost, m->unit, all->list->source->path,
                           all->list->unit);
    }
    return found ? BR_OK
                 : br_fail(err, BR_BAD_INPUT,
                           "found no cost that all programs have: --cost NAME names one");
}

/* ---- what all have ---- */

static enum br_status list_members(const struct br_work_source *source, size_t sources,
                                   struct members *all, struct br_error *err)
{
    size_t most = 0;
    for (size_t s = 0; s < sources; s++)
        most += source[s].numbers.quantities;
    if (!(all->list = br_allocate(most + 1, sizeof *all->list)))
        return br_no_memory(err, "the programs");
    for (size_t s = 0; s < sources; s++)
        for (size_t i = 0; i < source[s].numbers.quantities; i++) {
            const char *of = case_of(&source[s].numbers.quantity[i]);
            const struct member *m = all->list;
            while (m < all->list + all->count &&
                   (strcmp(m->source->name, source[s].name) || strcmp(m->of, of)))
                m++;
            if (m == all->list + all->count)
                all->list[all->count++] = (struct member){.source = &source[s], .of = of};
            else if (m->source != &source[s])
                return br_fail(err, BR_BAD_INPUT,
                               "two programs are called '%s', expected files of different names",
                               source[s].name);
        }
    return BR_OK;
}

/* "fd measures max; fem measures l2, h1: ..." */
static enum br_status refuse_errors(const struct members *all, struct br_error *err)
{
    char text[700] = "", name[NAME];
    for (const struct member *m = all->list; m < all->list + all->count; m++) {
        size_t said = 0;
        br_append(text, sizeof text, "%s%s%s", m == all->list ? "" : "; ", m->source->name, m->of);
        for (size_t i = 0; i < m->source->numbers.quantities; i++)
            if (has(m, i, name) && find_error(m, name, all->cost) == i)
                br_append(text, sizeof text, "%s%s", said++ ? ", " : " measures ", name);
        if (!said)
            br_append(text, sizeof text, " measures no error");
    }
    return br_fail(err, BR_BAD_INPUT,
                   "%s: expected an error of one name that all measure ('read:' of a study file "
                   "names it, 'column:' that of a table)",
                   text);
}

static const char *or_none(const char *unit)
{
    return unit && *unit ? unit : "none";
}

/* Whether all measure an error; two units refuse, and percent beside none. */
static bool all_measure(struct members *all, const char *name, struct br_work_precision *w,
                        struct br_error *err)
{
    w->unit = NULL;
    for (struct member *m = all->list; m < all->list + all->count; m++) {
        if ((m->error = find_error(m, name, all->cost)) == SIZE_MAX)
            return false;
        const char *unit = m->source->numbers.quantity[m->error].unit;
        if (m > all->list && strcmp(or_none(unit), or_none(w->unit)) != 0 &&
            ((unit && w->unit) || strcmp(or_none(unit), "%") == 0 ||
             strcmp(or_none(w->unit), "%") == 0))
            br_fail(err, BR_BAD_INPUT,
                    "%s: the unit of %s is %s, and %s in another program; expected one unit",
                    m->source->path, name, or_none(unit), or_none(w->unit));
        w->unit = unit ? unit : w->unit;
    }
    snprintf(w->quantity, sizeof w->quantity, "%s", name);
    return true;
}

/* ---- points ---- */

static double cost_at(const struct member *m, const struct br_numbers_row *row, double *half)
{
    static const double scatter = 0.1; /* of a clock that was read once */
    const double cost = row->number[m->cost] * m->factor;
    const double deviation = row->deviation[m->cost] * m->factor;
    *half = isfinite(deviation) ? 2 * deviation : m->kind <= BR_COST_TIME ? scatter * cost : 0;
    return cost > 0 ? cost : (double)NAN;
}

/* The axis along which the rows are one line; BR_AXES: they are none. */
static enum br_axis line_of(const struct br_numbers *n)
{
    for (enum br_axis axis = 0; axis < BR_AXES; axis++) {
        bool line = n->column[axis];
        for (size_t i = 1; i < n->rows && line; i++)
            line = n->row[i].z[axis] < n->row[i - 1].z[axis];
        if (line)
            return axis;
    }
    return BR_AXES;
}

static void take_points(struct br_work_precision *w, const struct member *m)
{
    const struct br_numbers *n = &m->source->numbers;
    struct br_work_program *p = &w->program[w->programs];
    const enum br_axis axis = p->axis = line_of(n);
    p->point = w->point + w->points;
    snprintf(p->name, sizeof p->name, "%s%.99s", m->source->name, m->of);
    for (const struct br_numbers_row *row = n->row; row < n->row + n->rows; row++) {
        if (row->out[m->error] == BR_FLAG_ABSENT)
            continue;
        struct br_point *at = &w->point[w->points];
        *at = (struct br_point){.row = (size_t)(row - n->row),
                                .z = axis < BR_AXES ? row->z[axis] : (double)NAN,
                                .error = row->number[m->error],
                                .program = w->programs};
        at->cost = cost_at(m, row, &at->cost_half);
        at->is_start =
            isfinite(row->seconds) && at->cost <= at->cost_half; /* no more is left of it */
        br_numbers_name_cell(n, row, at->label);
        if (isfinite(at->error) && at->error > 0 && isfinite(at->cost)) {
            w->points++;
            p->points++;
        } else if (!p->failed++) {
            strcpy(p->first, at->label);
            p->failure = row->failure       ? row->failure
                         : isnan(at->error) ? "no error"
                         : !(at->error > 0) ? "an error of 0"
                         : m->kind == BR_COST_MEMORY
                             ? "no peak memory is known, as of a small program"
                             : "no cost";
        }
    }
    w->programs++;
}

/* The exponent of the costs between a point and the next finer one. */
static double exponent(const struct br_point *p)
{
    return log(p[1].cost / p[0].cost) / log(p[0].z / p[1].z);
}

/* Coarse sizes whose cost hardly grows: a run there is mostly its start. */
static void find_starts(struct br_work_program *program)
{
    static const double hardly = 0.5;
    struct br_point *p = program->point;
    double most = 0;
    for (size_t i = 0; i + 1 < program->points; i++)
        most = fmax(most, exponent(&p[i]));
    for (size_t i = 0; i + 1 < program->points && exponent(&p[i]) < fmin(hardly, most / 2); i++)
        p[i].is_start = true;
    for (size_t i = 0; i < program->points; i++)
        if (p[i].is_start)
            program->start = program->start > 0 ? fmin(program->start, p[i].cost) : p[i].cost;
}

static enum br_status check_growth(const struct br_work_precision *w, const struct member *m,
                                   const struct br_work_program *program, struct br_error *err)
{
    static const double clearly = 0.9;
    const struct br_point *p = program->point, *last = p + program->points - 1;
    if (!program->points || !(last->cost + last->cost_half < clearly * (p->cost - p->cost_half)))
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT,
                   "%s: %s falls from %.3g at %s to %.3g%s%s at %s, expected a cost that grows "
                   "with finer sizes; --cost NAME names another one",
                   m->source->path, w->cost, p->cost, p->label, last->cost,
                   *w->cost_unit ? " " : "", w->cost_unit, last->label);
}

/* ---- how costs grow ---- */

enum line { COST_OVER_SIZE, ERROR_OVER_SIZE, ERROR_OVER_COST };

/* The order along the points of a program. Costs are without its start, and without the sizes that
 * are mostly that; over costs, of the points of its own front. */
static enum br_status find_order(struct br_work_program *program, enum line what,
                                 struct br_estimate *order, struct br_error *err)
{
    static const double least = 0.05; /* of the finest error, a floor that a forecast would miss */
    struct br_point *at = br_allocate(program->points + 1, sizeof *at);
    struct br_line_order found;
    size_t taken = 0;
    if (!at)
        return br_no_memory(err, "the costs");
    for (const struct br_point *p = program->point; p < program->point + program->points; p++) {
        const double cost = p->cost - program->start;
        const bool small = p->is_start || cost <= 2 * p->cost_half;
        at[taken] = *p;
        if (what == COST_OVER_SIZE) {
            at[taken].error = 1 / cost;
            at[taken].deviation = p->cost_half / 2 / pow(cost, 2);
        } else if (what == ERROR_OVER_COST)
            at[taken].z = 1 / cost;
        taken += !isnan(at[taken].z) && (what == ERROR_OVER_SIZE || !small) &&
                 (what != ERROR_OVER_COST || p->own);
    }
    qsort(at, taken, sizeof *at, br_by_size);
    const enum br_status status = br_line_order_find(at, taken, &found, err);
    *order = br_order_determined(&found.order) ? found.order : (struct br_estimate){NAN, NAN, NAN};
    if (!status && what == COST_OVER_SIZE && found.outlier < taken && found.outlier <= found.last)
        strcpy(program->odd, at[found.outlier].label);
    if (!status && what == ERROR_OVER_SIZE && isfinite(found.order.value)) {
        const enum br_flag flag = br_line_order_flag(&found, at, taken - 1);
        program->stalls = found.floor > least * at[taken - 1].error ||
                          (flag != BR_FLAG_NONE && flag != BR_FLAG_OUTLIER);
    }
    free(at);
    return status;
}

/* What the wanted error costs, if the order of the error and the growth of the cost stay. */
static void foresee(struct br_work_program *p, const struct br_numbers *n,
                    const struct br_estimate *order)
{
    static const double most = 100; /* times finer: nobody knows more */
    const struct br_point *finest = &p->point[p->points - 1];
    const double next = pow(10, ceil(log10(finest->error)) - 1);
    p->wanted = finest->error > 1e-6 ? 1e-6 : next;
    if (!(pow(finest->error / p->wanted, 1 / order->value) <= most))
        p->wanted = next;
    const double less = finest->error / p->wanted, finer = pow(less, 1 / order->value);
    if (!(finer <= most && p->growth.low > 0))
        return;
    const struct br_resolution_column *c = n->column[p->axis];
    const double given = br_numbers_given(c, finest->z / finer, n->dimension);
    const double cost = finest->cost - p->start;
    p->needed.value = p->start + cost * pow(less, p->growth.value / order->value);
    p->needed.low = p->start + (cost - finest->cost_half) * pow(less, p->growth.low / order->high);
    p->needed.high = p->start + (cost + finest->cost_half) * pow(less, p->growth.high / order->low);
    snprintf(p->at, sizeof p->at, c->is_size ? "%s = %.3g" : "%s = %.0f", c->name, given);
}

static enum br_status study_program(struct br_work_program *p, const struct br_numbers *n,
                                    struct br_error *err)
{
    struct br_estimate order, over;
    if (find_order(p, COST_OVER_SIZE, &p->growth, err) ||
        find_order(p, ERROR_OVER_SIZE, &order, err) || find_order(p, ERROR_OVER_COST, &over, err))
        return err->status;
    if (p->stalls)
        over = order = (struct br_estimate){NAN, NAN, NAN};
    p->tenth = (struct br_estimate){pow(10, 1 / over.value), pow(10, 1 / over.high),
                                    pow(10, 1 / over.low)};
    for (size_t i = 0; i < p->points && p->point[i].is_start; i++)
        strcpy(p->starts, p->point[i].label);
    p->needed = (struct br_estimate){NAN, NAN, NAN};
    p->wanted = NAN;
    if (p->points)
        foresee(p, n, &order);
    return BR_OK;
}

/* ---- all ---- */

static const char *name_cost(const struct members *all)
{
    enum br_cost kind = all->list->kind;
    for (size_t i = 0; i < all->count; i++) /* a column may not say which time it has */
        kind = all->list[i].kind == BR_COST_TIME ? BR_COST_TIME : kind;
    return kind == BR_COSTS ? all->cost : br_costs[kind].name;
}

static enum br_status fill(struct br_work_precision *w, const struct members *all,
                           struct br_error *err)
{
    size_t rows = 0;
    for (size_t i = 0; i < all->count; i++)
        rows += all->list[i].source->numbers.rows;
    w->program = br_allocate(all->count, sizeof *w->program);
    w->point = br_allocate(rows + 1, sizeof *w->point);
    if (!w->program || !w->point)
        return br_no_memory(err, "the programs");
    snprintf(w->cost, sizeof w->cost, "%s", name_cost(all));
    w->cost_unit = all->list->unit;
    w->is_time = all->list->kind <= BR_COST_TIME;
    for (const struct member *m = all->list; m < all->list + all->count; m++) {
        struct br_work_program *p = &w->program[w->programs];
        take_points(w, m);
        if (p->axis == BR_AXES)
            continue;
        if (check_growth(w, m, p, err))
            return err->status;
        if (w->is_time)
            find_starts(p);
    }
    if (!w->points)
        return br_fail(err, BR_NOT_FINITE,
                       "no run has an error %s above 0 and a cost; the first: %s", w->quantity,
                       w->program->failure);
    br_work_front(w->point, w->points);
    for (size_t i = 0; i < w->programs; i++)
        if (study_program(&w->program[i], &all->list[i].source->numbers, err))
            return err->status;
    return BR_OK;
}

/* One for each error of the first program that all measure. */
static enum br_status find_all(struct members *all, struct br_work_precision *works, size_t *count,
                               struct br_error *err)
{
    const struct member *first = all->list;
    char name[NAME];
    err->status = BR_OK;
    for (size_t i = 0; i < first->source->numbers.quantities; i++)
        if (has(first, i, name) && all_measure(all, name, &works[*count], err) && !err->status &&
            fill(&works[(*count)++], all, err))
            return err->status;
    return err->status || *count ? err->status : refuse_errors(all, err);
}

enum br_status br_work_find(const struct br_work_source *source, size_t sources, const char *cost,
                            struct br_work_precision **works, size_t *count, struct br_error *err)
{
    struct members all = {.cost = cost};
    *count = 0;
    *works = br_allocate(source->numbers.quantities + 1, sizeof **works);
    bool failed = !*works && br_no_memory(err, "the programs");
    failed = failed || list_members(source, sources, &all, err) || choose_cost(&all, err) ||
             find_all(&all, *works, count, err);
    free(all.list);
    return failed ? err->status : BR_OK;
}

void br_work_sources_clear(struct br_work_source *source, size_t count)
{
    for (size_t i = 0; i < count; i++)
        br_numbers_clear(&source[i].numbers);
    free(source);
}

void br_work_clear(struct br_work_precision *works, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        free(works[i].program);
        free(works[i].point);
    }
    free(works);
}

size_t br_work_targets(const struct br_work_precision *w, double target[BR_WORK_DIGITS])
{
    double most = 0, least = INFINITY;
    for (size_t i = 0; i < w->points; i++) {
        most = fmax(most, w->point[i].error);
        least = fmin(least, w->point[i].error);
    }
    size_t count = 0;
    int digit = (int)floor(log10(most));
    digit += least > pow(10, digit); /* no power of ten lies between them */
    for (; count < BR_WORK_DIGITS && (target[count] = pow(10, digit)) >= least; digit--)
        count++;
    return count;
}
