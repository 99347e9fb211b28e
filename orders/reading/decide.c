/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which column states the sizes: the best of all readings, or a question where two are as good. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/quote.h"
#include "base/words.h"
#include "orders/limits/grid_convergence.h"
#include "orders/reading/roles.h"

/* Log odds, measured on tables whose sizes are known. */
static const double least_odds = 1.9; /* less: no reading */
static const double least_lead = 1.4; /* less: a question */
static const double sure_lead = 3.4;  /* less: assumed, without a verdict */
static const double one_size = 0.035; /* log sizes that differ by less are one reading */

enum { MOST_TRIED = 40 }; /* columns, of which those without a usual name are tried, too */

struct contest {
    struct br_roles *roles;
    enum br_axis axis;
    struct br_candidate *candidate;
    size_t candidates;
    size_t *sorted; /* room */
    bool by_hand;   /* a column of the axis is */
};

/* ---- rows in order ---- */

static int by_place(const void *a, const void *b)
{
    const struct br_place *x = a, *y = b;
    const int line = (x->line > y->line) - (x->line < y->line);
    const int size = (x->log_z < y->log_z) - (x->log_z > y->log_z);
    return line ? line : size ? size : (x->row > y->row) - (x->row < y->row);
}

void br_decide_sort(const struct br_roles *r, const struct br_candidate *c, size_t *sorted)
{
    size_t count = 0;
    for (size_t i = 0; i < r->rows; i++)
        if (!r->dropped[i] && !isnan(c->log_z[i]))
            r->place[count++] = (struct br_place){r->line[i], i, c->log_z[i]};
    qsort(r->place, count, sizeof *r->place, by_place);
    for (size_t i = 0; i < count; i++)
        sorted[i] = r->place[i].row;
    sorted[count] = BR_NO_ROW;
}

/* ---- candidates ---- */

static bool has_usual_name(const struct br_role_column *c, const struct br_resolution_column *s)
{
    return c->by_hand ? c->stated == s : br_odds(c, s) > 0.5;
}

/* Whether its heading is a usual one of unknowns or cells. */
static bool counts_volume(const struct br_role_column *c)
{
    bool counts = false;
    for (const struct br_resolution_column *s = br_resolution_columns; s->name; s++)
        counts |= s->is_volume && br_odds(c, s) >= BR_USUAL_NAME;
    return counts;
}

/* Whether steps hardly grow while unknowns or cells do: iterations of a solver. */
static bool hardly_grows(const struct br_roles *r, const struct br_role_column *steps)
{
    bool grow = false;
    for (size_t i = 0; i < r->columns && steps->least > 0; i++)
        grow |= counts_volume(&r->column[i]) && r->column[i].most > 2 * r->column[i].least;
    return grow && steps->most < 1.5 * steps->least;
}

/* Whether a column may state a resolution in this way, before its numbers are weighed. */
static bool may_state(const struct contest *t, const struct br_role_column *c,
                      const struct br_resolution_column *s)
{
    const bool named = has_usual_name(c, s);
    if (s->axis != t->axis || c->words || !c->numbers || c->role != BR_ROLE_ASIDE ||
        (t->by_hand && c->stated != s))
        return false;
    if (c->by_hand)
        return c->stated == s;
    if (c->of_sides)
        return !s->is_size && !s->is_volume && !s->is_power && s->axis == BR_AXIS_SPACE &&
               c->least >= 1 && c->least < c->most;
    if (!s->is_volume && t->roles->wishes->dimension > 0 && counts_volume(c))
        return false; /* whoever states the dimension says what the cells count */
    if (!(c->least < c->most) || (c->kind == BR_KIND_DEGREE && c->is_whole) ||
        (!named && c->kind != BR_KIND_UNKNOWN))
        return false;
    if (s->axis == BR_AXIS_TIME && !s->is_size && hardly_grows(t->roles, c))
        return false;
    if (named)
        return s->axis == BR_AXIS_SPACE || br_odds(c, s) >= BR_USUAL_NAME;
    /* without a usual name */
    if (s->axis == BR_AXIS_TIME || strcmp(s->name, "dofs") == 0 || t->roles->columns > MOST_TRIED)
        return false;
    return s->is_size ||
           (c->is_whole && c->least >= (s->is_power ? 0 : 1) && (!s->is_power || c->most < 40));
}

static bool take_log_sizes(const struct br_roles *r, struct br_candidate *c)
{
    const struct br_role_column *column = &r->column[c->size.column];
    for (size_t i = 0; i < r->rows; i++) {
        const double z = br_numbers_z(c->size.states, column->number[i], c->size.dimension);
        c->log_z[i] = r->dropped[i] ? (double)NAN : log(z);
        if (!r->dropped[i] && !isfinite(c->log_z[i]) && !column->by_hand &&
            br_odds(column, c->size.states) <= 0.5)
            return false;
    }
    return true;
}

static enum br_status add_candidate(struct contest *t, size_t column,
                                    const struct br_resolution_column *states, double dimension,
                                    struct br_error *err)
{
    struct br_candidate *c = &t->candidate[t->candidates];
    *c = (struct br_candidate){.size = {states, column, dimension}};
    c->log_z = br_store_take(&t->roles->store, t->roles->rows + 1, sizeof *c->log_z);
    if (!c->log_z)
        return br_no_memory(err, "the table");
    if (!take_log_sizes(t->roles, c))
        return BR_OK;
    br_decide_sort(t->roles, c, t->sorted);
    br_evidence_weigh(t->roles, c, t->sorted);
    t->candidates++;
    return BR_OK;
}

static enum br_status gather(struct contest *t, struct br_error *err)
{
    struct br_roles *r = t->roles;
    enum { OF_A_COLUMN = 16 };
    const double stated = r->wishes->dimension;
    for (size_t i = 0; i < r->columns; i++)
        t->by_hand |= r->column[i].stated && r->column[i].stated->axis == t->axis;
    t->candidate = br_store_take(&r->store, OF_A_COLUMN * (r->columns + 1), sizeof *t->candidate);
    t->sorted = br_store_take(&r->store, r->rows + 1, sizeof *t->sorted);
    if (!t->candidate || !t->sorted)
        return br_no_memory(err, "the table");
    for (size_t i = 0; i < r->columns; i++)
        for (const struct br_resolution_column *s = br_resolution_columns; s->name; s++) {
            if (!may_state(t, &r->column[i], s))
                continue;
            for (int d = 1; d <= (s->is_volume && !(stated > 0) ? 3 : 1); d++)
                if (add_candidate(t, i, s, stated > 0 ? stated : d, err))
                    return err->status;
        }
    return BR_OK;
}

static const struct br_candidate *best_of(const struct contest *t, const struct br_candidate *but)
{
    const struct br_candidate *best = NULL;
    for (size_t i = 0; i < t->candidates; i++) {
        const struct br_candidate *c = &t->candidate[i];
        if ((!best || c->odds > best->odds) &&
            !(but && br_evidence_same(t->roles, but->log_z, c->log_z, one_size)))
            best = c;
    }
    return best;
}

/* How plainly a candidate states its sizes. */
static double plainness(const struct contest *t, const struct br_candidate *c)
{
    const struct br_role_column *column = &t->roles->column[c->size.column];
    return column->by_hand ? 99
                           : br_odds(column, c->size.states) - (c->size.states->is_volume ? 2 : 0);
}

/* Of the ways in which these sizes are stated the plainest. Of 41, 81, 161 points the intervals
 * halve. */
static const struct br_candidate *plainest(const struct contest *t, const struct br_candidate *best)
{
    const struct br_candidate *found = best;
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < t->candidates; i++) {
            const struct br_candidate *c = &t->candidate[i];
            const struct br_role_column *column = &t->roles->column[c->size.column];
            const bool halves = pass && c->halves && c->size.column == found->size.column &&
                                !column->by_hand && !br_is_no_number_of_points(column->name);
            if ((halves || (!pass && plainness(t, c) > plainness(t, found))) &&
                br_evidence_same(t->roles, best->log_z, c->log_z, one_size))
                found = c;
        }
    return found;
}

/* ---- words ---- */

enum { TEXT = 400 };

static const char *shown_name(const struct br_roles *r, size_t column, char text[80])
{
    const struct br_role_column *c = &r->column[column];
    return br_quoted(text, 80, &br_for_text, c->shown ? c->shown : c->label);
}

/* Whether a count of a volume gives the size only with a dimension that nobody stated. */
static bool lacks_dimension(const struct br_roles *r, const struct br_candidate *c)
{
    return c->size.states->is_volume && !(r->wishes->dimension > 0);
}

/* "h = N^(-1/2)"; with_dimension: else "h = N^(-1/d)" */
static char *say_reading(const struct br_roles *r, const struct br_candidate *c,
                         bool with_dimension, char text[TEXT])
{
    char name[90], shown[80];
    const struct br_resolution_column *s = c->size.states;
    const bool nameless = !r->column[c->size.column].shown; /* then the label is its position */
    snprintf(name, sizeof name, "%s%s", nameless ? "column " : "",
             shown_name(r, c->size.column, shown));
    if (s->is_volume && !with_dimension)
        snprintf(text, TEXT, "h = %s^(-1/d)", name);
    else if (s->is_volume && c->size.dimension > 1)
        snprintf(text, TEXT, "h = %s^(-1/%g)", name, c->size.dimension);
    else if (s->is_size)
        snprintf(text, TEXT, "%s from %s%s", br_axis_letters[s->axis], nameless ? "" : "column ",
                 name);
    else if (s->is_power)
        snprintf(text, TEXT, "h = 2^-%s", name);
    else
        snprintf(text, TEXT, s->more ? "%s = 1/(%s %s 1)" : "%s = 1/%s", br_axis_letters[s->axis],
                 name, s->more > 0 ? "+" : "-");
    return text;
}

/* "--column 'N=cells' --dimension 1, 2 or 3"; of two readings of a usual heading "--dimension 1, 2
 * or 3". other: what else is read, or NULL. */
static char *say_option(const struct br_roles *r, const struct br_candidate *c,
                        const struct br_candidate *other, char text[TEXT])
{
    char name[80], item[120], quoted[160];
    const struct br_role_column *column = &r->column[c->size.column];
    const bool is_clear = lacks_dimension(r, c) && counts_volume(column) &&
                          (!other || other->size.column == c->size.column);
    *text = '\0';
    if (!column->by_hand && !is_clear) {
        snprintf(item, sizeof item, "%s=%s", shown_name(r, c->size.column, name),
                 c->size.states->name);
        br_append(text, TEXT, "--column %s", br_quoted(quoted, sizeof quoted, &br_for_shell, item));
    }
    if (lacks_dimension(r, c))
        br_append(text, TEXT, "%s--dimension 1, 2 or 3", *text ? " " : "");
    return text;
}

/* The column that is an error most clearly; BR_NO_ROW: there is none. */
static size_t clearest_error(const struct contest *t, const struct br_candidate *c)
{
    size_t best = BR_NO_ROW;
    double most = 0.99;
    br_decide_sort(t->roles, c, t->sorted);
    for (size_t i = 0; i < t->roles->columns; i++) {
        if (i == c->size.column)
            continue;
        const double odds = br_evidence_of_errors(t->roles, c, t->sorted, i);
        if (odds > most && !br_lists(t->roles->wishes->values, t->roles->column[i].name)) {
            most = odds;
            best = i;
        }
    }
    return best;
}

/* The column of --value that has numbers on three meshes or more; BR_NO_ROW: there is none. */
static size_t first_value(const struct contest *t, const struct br_candidate *c)
{
    for (size_t i = 0; i < t->roles->columns; i++)
        if (i != c->size.column && t->roles->column[i].is_value && !t->roles->column[i].words)
            return i;
    return BR_NO_ROW;
}

/* The order of the three finest values of the first line; NaN: they have none. */
static double order_of_values(const struct contest *t, const struct br_candidate *c, size_t value)
{
    struct br_point v[3];
    size_t count = 0;
    struct br_gci found;
    for (size_t i = 0; t->sorted[i] != BR_NO_ROW; i++) {
        const size_t row = t->sorted[i];
        const double number = t->roles->column[value].number[row];
        if (t->roles->line[row] != t->roles->line[t->sorted[0]] || isnan(number))
            continue;
        if (count == 3)
            memmove(v, v + 1, --count * sizeof *v);
        v[count++] = (struct br_point){.z = exp(c->log_z[row]), .value = number};
        if (count > 1 && !(v[count - 1].z < v[count - 2].z))
            return NAN;
    }
    if (count < 3)
        return NAN;
    br_gci(v, &found);
    return found.order;
}

/* The order that a candidate gives; NaN: no column shows one. */
static double order_of(const struct contest *t, const struct br_candidate *c, size_t error)
{
    const size_t value = error == BR_NO_ROW ? first_value(t, c) : BR_NO_ROW;
    br_decide_sort(t->roles, c, t->sorted);
    return error != BR_NO_ROW   ? br_evidence_order(t->roles, c, t->sorted, error)
           : value != BR_NO_ROW ? order_of_values(t, c, value)
                                : (double)NAN;
}

/* "h = 1/N gives 2.00"; "h = cells^(-1/d) gives 0.95 for d = 1, 1.89 for 2, 2.84 for 3" */
static char *say_order(const struct contest *t, const struct br_candidate *c, size_t error,
                       char text[TEXT])
{
    char reading[TEXT];
    const bool open = lacks_dimension(t->roles, c);
    const double order = order_of(t, c, error);
    snprintf(text, TEXT, "%.200s", say_reading(t->roles, c, !open, reading));
    if (isnan(order))
        return text;
    br_append(text, TEXT, open ? " gives" : " gives %.2f", order);
    for (int d = 1; d <= 3 && open; d++) /* h^p is N^(-p/d): the order goes with d */
        br_append(text, TEXT, d == 1 ? " %.2f for d = %d" : ", %.2f for %d",
                  d * order / c->size.dimension, d);
    return text;
}

static enum br_status ask(const struct contest *t, const struct br_candidate *best,
                          const struct br_candidate *second, struct br_error *err)
{
    char a[TEXT], b[TEXT], option_a[TEXT], option_b[TEXT];
    const size_t error = clearest_error(t, best);
    const char *path = t->roles->wishes->path;
    best = plainest(t, best);
    second = plainest(t, second);
    say_order(t, best, error, a);
    say_option(t->roles, best, second, option_a);
    if (second->size.column == best->size.column && second->size.states == best->size.states)
        return br_fail(
            err, BR_BAD_INPUT,
            "%s: the sizes are not clear: %s: which dimension does the mesh have? %s decides", path,
            a, option_a);
    return br_fail(err, BR_BAD_INPUT, "%s: the sizes are not clear: %s; %s: %s, or %s, decides",
                   path, a, say_order(t, second, error, b), option_a,
                   say_option(t->roles, second, best, option_b));
}

/* ---- refusals with a hint ---- */

/* A column that is called a count, with numbers below 1. */
static enum br_status check_counts(const struct contest *t, struct br_error *err)
{
    const struct br_roles *r = t->roles;
    for (size_t i = 0; i < t->candidates; i++) {
        const struct br_candidate *c = &t->candidate[i];
        const struct br_role_column *column = &r->column[c->size.column];
        const struct br_resolution_column *s = c->size.states;
        char name[80];
        if (s->is_size || s->is_power || !(column->least < 1) || !(column->least > 0) ||
            !(column->by_hand || br_odds(column, s) >= BR_USUAL_NAME))
            continue;
        return br_fail(err, BR_BAD_INPUT,
                       "%s: %s: found %g, expected a count of at least 1: --column '%s=%s', if it "
                       "is a size; or are two columns swapped?",
                       r->wishes->path, shown_name(r, c->size.column, name), column->least, name,
                       s->axis == BR_AXIS_SPACE ? "h" : "dt");
    }
    return BR_OK;
}

/* What is called a size, and grows with a count. */
static enum br_status check_direction(const struct contest *t, const struct br_candidate *best,
                                      struct br_error *err)
{
    const struct br_roles *r = t->roles;
    const struct br_role_column *column = &r->column[best->size.column];
    char name[80], other[80];
    br_decide_sort(r, best, t->sorted);
    for (size_t i = 0; i < r->columns && best->size.states->is_size && !column->by_hand; i++) {
        const struct br_role_column *c = &r->column[i];
        bool count = false;
        for (const struct br_resolution_column *s = br_resolution_columns; s->name; s++)
            count |=
                !s->is_size && s->axis == t->axis && !c->by_hand && br_odds(c, s) >= BR_USUAL_NAME;
        if (!count || i == best->size.column || !c->is_whole || c->words || !(c->least < c->most) ||
            br_evidence_order(r, best, t->sorted, i) < 0.05)
            continue;
        shown_name(r, best->size.column, name);
        return br_fail(err, BR_BAD_INPUT,
                       "%s: %s grows with %s, so it is no size: --column '%s=n', if it is a number "
                       "of elements along a side",
                       r->wishes->path, name, shown_name(r, i, other), name);
    }
    return BR_OK;
}

/* All errors grow where the sizes fall. */
static enum br_status refuse_growth(const struct contest *t, const struct br_candidate *best,
                                    struct br_error *err)
{
    const struct br_roles *r = t->roles;
    char name[80], rates[120] = "", reading[TEXT];
    size_t error = BR_NO_ROW, said = 0;
    br_decide_sort(r, best, t->sorted);
    for (size_t i = 0; i < r->columns && error == BR_NO_ROW; i++)
        if (i != best->size.column && !r->column[i].words && r->column[i].least > 0 &&
            br_evidence_order(r, best, t->sorted, i) < -0.05 &&
            (r->column[i].kind == BR_KIND_ERROR || r->column[i].kind == BR_KIND_UNKNOWN))
            error = i;
    for (size_t i = 1; error != BR_NO_ROW && t->sorted[i - 1] != BR_NO_ROW &&
                       t->sorted[i] != BR_NO_ROW && said < 4;
         i++) {
        const double *e = r->column[error].number;
        const size_t a = t->sorted[i - 1], b = t->sorted[i];
        const double rate = log(e[a] / e[b]) / (best->log_z[a] - best->log_z[b]);
        if (isfinite(rate) && r->line[a] == r->line[b] && ++said)
            br_append(rates, sizeof rates, " %.2f", rate);
    }
    shown_name(r, best->size.column, name);
    return br_fail(
        err, BR_BAD_INPUT,
        "%s: the errors grow as %s gets finer (%s): rates%s; --column '%s=%s', if %s is %s",
        r->wishes->path, br_axis_letters[t->axis], say_reading(r, best, true, reading), rates, name,
        best->size.states->is_size ? "n" : "h", name,
        best->size.states->is_size ? "a count" : "a size");
}

/* ---- the decision ---- */

static void assume(struct contest *t, const struct br_candidate *best,
                   const struct br_candidate *second)
{
    struct br_roles *r = t->roles;
    char reading[TEXT], other[TEXT], option[TEXT];
    const bool dimension = best->size.states->is_volume && !(r->wishes->dimension > 0);
    const size_t error = clearest_error(t, best);
    r->assumed_dimension |= dimension && t->axis == BR_AXIS_SPACE;
    say_option(r, best, second, option);
    br_append(r->assumed, sizeof r->assumed, "%s%s is assumed", *r->assumed ? "; " : "",
              say_reading(r, best, true, reading));
    if (second)
        br_append(r->assumed, sizeof r->assumed, " (%s)", say_order(t, second, error, other));
    if (best->contradicts_rates)
        br_append(r->assumed, sizeof r->assumed, ", and the table has other rates");
    br_append(r->assumed, sizeof r->assumed, ": %s%s settles it",
              dimension ? "state the dimension of the mesh: " : "",
              *option ? option : "another --column");
}

static enum br_status choose(struct contest *t, const struct br_candidate *best,
                             struct br_error *err)
{
    struct br_roles *r = t->roles;
    const bool by_hand = r->column[best->size.column].by_hand;
    const struct br_candidate *second = best_of(t, best);
    char why[TEXT + 100], reading[TEXT];
    if (best->wrong_way && !by_hand)
        return check_direction(t, best, err) ? err->status : refuse_growth(t, best, err);
    for (size_t i = 0; i < t->candidates && best->odds < least_odds; i++) {
        const struct br_candidate *c = &t->candidate[i];
        if (c->wrong_way && has_usual_name(&r->column[c->size.column], c->size.states))
            return check_direction(t, c, err) ? err->status : refuse_growth(t, c, err);
    }
    if (best->odds < least_odds && best->contradicts_rates) {
        snprintf(why, sizeof why, "the table has other rates than %s gives",
                 say_reading(r, best, true, reading));
        return br_roles_refuse(r, why, NULL, err);
    }
    if (best->odds < least_odds)
        return br_roles_refuse(r, "found no column that is clearly a resolution", NULL, err);
    if (check_direction(t, best, err))
        return err->status;
    if (second && best->odds - second->odds < least_lead)
        return ask(t, best, second, err);
    const double lead = second ? best->odds - second->odds : INFINITY;
    best = plainest(t, best);
    const struct br_role_column *column = &r->column[best->size.column];
    const bool only_sides = column->of_sides && column->named <= BR_ANY_NAME; /* of a matrix? */
    if (lead < sure_lead || ((best->contradicts_rates || only_sides) && !by_hand))
        assume(t, best, lead < 9 ? second : NULL);
    r->size[t->axis] = best->size;
    r->log_z[t->axis] = best->log_z;
    r->column[best->size.column].role = BR_ROLE_SIZE;
    return BR_OK;
}

/* The numbers along the other axis, before they are known: of time those that are chosen, of space
 * those of a column with a usual name. NULL: there are none. */
static const double *other_sizes(const struct br_roles *r, enum br_axis axis)
{
    if (axis == BR_AXIS_SPACE)
        return r->log_z[BR_AXIS_TIME];
    for (size_t i = 0; i < r->columns; i++)
        for (const struct br_resolution_column *s = br_resolution_columns; s->name; s++)
            if (s->axis == BR_AXIS_SPACE && r->column[i].least < r->column[i].most &&
                (r->column[i].by_hand ? r->column[i].stated == s
                                      : br_odds(&r->column[i], s) >= BR_USUAL_NAME))
                return r->column[i].number;
    return NULL;
}

static bool is_near(double a, double b)
{
    return fabs(a - b) <= 1e-9 * fmax(fabs(a), fabs(b));
}

/* Rows on one line: of one case, and of one size along the other axis. */
static void set_lines(struct br_roles *r, enum br_axis axis)
{
    const double *other = other_sizes(r, axis);
    bool repeats = false;
    size_t lines = r->groups;
    for (size_t i = 0; i < r->rows && other; i++)
        for (size_t j = 0; j < i && !repeats; j++)
            repeats = r->group[i] == r->group[j] && is_near(other[i], other[j]);
    for (size_t i = 0; i < r->rows; i++) {
        r->line[i] = r->group[i];
        if (!repeats || r->dropped[i])
            continue;
        r->line[i] = lines++;
        for (size_t j = 0; j < i; j++)
            if (r->group[i] == r->group[j] && is_near(other[i], other[j])) {
                r->line[i] = r->line[j];
                break;
            }
    }
}

static bool has_degrees(const struct br_roles *r)
{
    for (size_t i = 0; i < r->columns; i++)
        if (r->column[i].role == BR_ROLE_DEGREE && r->column[i].kind == BR_KIND_DEGREE)
            return true;
    return false;
}

/* Whether the sizes of two axes are refined together: rows of a case that differ in one differ in
 * the other, to the same side. */
static bool go_together(const struct br_roles *r, const double *log_a, const double *log_b)
{
    size_t pairs = 0;
    for (size_t i = 0; i < r->rows; i++)
        for (size_t j = 0; j < i; j++) {
            const double a = log_a[i] - log_a[j], b = log_b[i] - log_b[j];
            if (isnan(a) || isnan(b) || r->group[i] != r->group[j])
                continue;
            if ((fabs(a) <= 1e-9) != (fabs(b) <= 1e-9) || a * b < 0)
                return false;
            pairs += fabs(a) > 1e-9;
        }
    return pairs > 0;
}

/* The best candidate of an axis; NULL: there is none. The contest keeps all. */
static enum br_status find_best(struct contest *t, const struct br_candidate **best,
                                struct br_error *err)
{
    *best = NULL;
    set_lines(t->roles, t->axis);
    if (gather(t, err) || check_counts(t, err))
        return err->status;
    *best = best_of(t, NULL);
    if (*best && (*best)->odds < least_odds && has_degrees(t->roles)) /* they are the axis */
        *best = NULL;
    return BR_OK;
}

/* Of two axes that are refined together one counts: the one that --column states; the one that the
 * rates of the table are of; h. */
static void leave_one_axis(struct br_roles *r, const struct br_candidate **space,
                           const struct br_candidate **time)
{
    struct br_role_column *h = &r->column[(*space)->size.column],
                          *k = &r->column[(*time)->size.column];
    if ((h->by_hand && k->by_hand) || !go_together(r, (*space)->log_z, (*time)->log_z))
        return;
    const bool of_time =
        k->by_hand || (!h->by_hand && (*time)->agrees_with_rates && (*space)->contradicts_rates);
    *(of_time ? space : time) = NULL;
    (of_time ? h : k)->why = of_time ? "refined together with k" : "refined together with h";
}

/* Whether sizes beside a time step may be those of a mesh, by their name or as "8x8". */
static bool may_be_of_a_mesh(const struct br_role_column *c)
{
    bool may = c->of_sides;
    for (const struct br_resolution_column *s = br_resolution_columns; s->name; s++)
        may |= s->axis == BR_AXIS_SPACE && br_odds(c, s) >= 2;
    return may;
}

enum br_status br_decide_sizes(struct br_roles *r, struct br_error *err)
{
    struct contest of_time = {.roles = r, .axis = BR_AXIS_TIME},
                   of_space = {.roles = r, .axis = BR_AXIS_SPACE};
    const struct br_candidate *time, *space;
    if (find_best(&of_time, &time, err)) /* time first: it is only known by its name */
        return err->status;
    if (time) {
        r->log_z[BR_AXIS_TIME] = time->log_z;
        r->column[time->size.column].role = BR_ROLE_SIZE;
    }
    if (find_best(&of_space, &space, err))
        return err->status;
    const struct br_candidate *plain = space ? plainest(&of_space, space) : NULL;
    const struct br_role_column *c = space ? &r->column[plain->size.column] : NULL;
    if (space && time && !c->by_hand &&
        (!may_be_of_a_mesh(c) || (space->contradicts_rates && time->agrees_with_rates)))
        space = NULL;
    if (space && time) {
        struct br_role_column *k = &r->column[time->size.column];
        leave_one_axis(r, &space, &time);
        k->role = time ? k->role : BR_ROLE_ASIDE;
        r->log_z[BR_AXIS_TIME] = time ? time->log_z : NULL;
    }
    if (time && (set_lines(r, BR_AXIS_TIME), choose(&of_time, time, err)))
        return err->status;
    set_lines(r, BR_AXIS_SPACE);
    return space ? choose(&of_space, space, err) : BR_OK;
}
