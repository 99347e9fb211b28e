/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/reading/roles.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/words.h"

/* deal.II prints rates in columns without a heading, which begin or end with a gap. */
static void find_rates_without_a_name(struct br_roles *r)
{
    for (size_t i = 0; i < r->columns && r->rows > 2; i++) {
        struct br_role_column *c = &r->column[i];
        const bool gap = isnan(c->number[0]) || isnan(c->number[r->rows - 1]);
        if (r->fields->heading_line && !c->name && gap && c->numbers + 1 >= r->rows - 1 &&
            !c->words)
            c->kind = BR_KIND_RATE;
    }
}

/* Rows without a field are none. MOOSE writes a row of zeros before the first solution. */
static void drop_zeros(struct br_roles *r)
{
    for (size_t i = 0; i < r->rows; i++) {
        bool empty = true;
        for (size_t k = 0; k < r->columns && empty; k++)
            empty = !br_role_field(r, i, k);
        if (empty)
            r->dropped[i] = "an empty row";
    }
    bool zeros = r->columns > 2 && r->rows > 0;
    for (size_t i = 0; i < r->columns; i++)
        zeros = zeros && r->column[i].number[0] == 0;
    if (!zeros)
        return;
    r->dropped[0] = "a first row of zeros";
    for (size_t i = 0; i < r->columns; i++)
        br_roles_read_column(r, i);
}

/* Rows without a size that say what they are, "Richardson extrapolated", are no runs. */
static void drop_summaries(struct br_roles *r)
{
    bool dropped = false;
    for (size_t i = 0; i < r->rows; i++) {
        bool sizes = false, says = false;
        for (int axis = 0; axis < BR_AXES; axis++)
            sizes |= r->size[axis].states &&
                     !br_field_is_missing(br_role_field(r, i, r->size[axis].column));
        for (size_t k = 0; k < r->columns && !sizes && !says; k++)
            says = br_is_summary(br_role_text(r, i, k));
        if (r->dropped[i] || !says)
            continue;
        r->dropped[i] = "a summary";
        dropped = true;
    }
    for (size_t i = 0; i < r->columns && dropped; i++)
        br_roles_read_column(r, i);
}

/* Refuses words among the numbers of a column that is called a size. */
static enum br_status check_sizes(const struct br_roles *r, struct br_error *err)
{
    for (size_t i = 0; i < r->columns; i++) {
        const struct br_role_column *c = &r->column[i];
        const bool size = c->stated || c->named >= BR_USUAL_NAME;
        if (size && (c->stated || c->numbers > c->words) && br_roles_check_words(r, i, err))
            return err->status;
    }
    return BR_OK;
}

/* ---- no column of a resolution ---- */

/* Whether rates stand without sizes, and nothing else may count: then h halves from row to row. */
static bool may_halve(const struct br_roles *r)
{
    bool rates = false;
    for (size_t i = 0; i < r->columns; i++) {
        const struct br_role_column *c = &r->column[i];
        rates |= c->kind == BR_KIND_RATE && c->numbers;
        if ((c->words && !c->numbers) || c->role == BR_ROLE_DEGREE ||
            (c->is_whole && !c->words && c->least < c->most && c->kind != BR_KIND_RATE &&
             c->kind != BR_KIND_COST))
            return false;
    }
    return rates && r->groups == 1;
}

/* Takes a degree as the axis, if its heading or the user says that it is one. */
static enum br_status take_degree(struct br_roles *r, size_t i, struct br_error *err)
{
    struct br_role_column *c = &r->column[i];
    if (c->kind != BR_KIND_DEGREE)
        return br_fail(err, BR_BAD_INPUT,
                       "%s: %s is a degree, and errors over a degree have no order in h: "
                       "--column '%s=degree' gives the factor of a degree, '%s=n' an order",
                       r->wishes->path, c->name, c->name, c->name);
    double *log_z = br_store_take(&r->store, r->rows + 1, sizeof *log_z);
    if (!log_z)
        return br_no_memory(err, "the table");
    for (size_t row = 0; row < r->rows; row++)
        log_z[row] =
            r->dropped[row] ? (double)NAN : log(br_numbers_z(&br_degree_column, c->number[row], 1));
    c->role = BR_ROLE_SIZE;
    r->size[BR_AXIS_SPACE].states = &br_degree_column;
    r->size[BR_AXIS_SPACE].column = i;
    r->size[BR_AXIS_SPACE].dimension = 1;
    r->log_z[BR_AXIS_SPACE] = log_z;
    return BR_OK;
}

/* Takes sizes that halve from row to row (*c, out), if the rates of the table are theirs. */
static enum br_status try_halves(struct br_roles *r, struct br_candidate *c, struct br_error *err)
{
    *c = (struct br_candidate){.size = {br_resolution_column_find("level"), BR_NO_ROW, 1}};
    c->log_z = br_store_take(&r->store, r->rows + 1, sizeof *c->log_z);
    size_t *sorted = br_store_take(&r->store, r->rows + 1, sizeof *sorted);
    if (!c->log_z || !sorted)
        return br_no_memory(err, "the table");
    for (int up = 0; up < 2 && !c->agrees_with_rates;
         up++) { /* the last row is the finest, or the first */
        for (size_t i = 0; i < r->rows; i++)
            c->log_z[i] =
                r->dropped[i] ? (double)NAN : -log(2) * (double)(up ? r->rows - 1 - i : i);
        br_decide_sort(r, c, sorted);
        br_evidence_weigh(r, c, sorted);
    }
    return BR_OK;
}

/* Says that the rates of the table are not those of its sizes. */
static enum br_status compare_rates(struct br_roles *r, const struct br_candidate *over,
                                    struct br_error *err)
{
    struct br_candidate halves;
    if (r->halves || !over->misses_rates || strstr(r->assumed, "other rates"))
        return BR_OK;
    if (try_halves(r, &halves, err))
        return err->status;
    r->of_rates = halves.agrees_with_rates
                      ? "the rates of the table are those of an h that halves from row to row"
                      : "the rates of the table are not those of these sizes";
    return BR_OK;
}

static enum br_status halve_by_row(struct br_roles *r, struct br_error *err)
{
    struct br_candidate c;
    for (size_t i = 0; i < r->columns; i++)
        if (r->column[i].role == BR_ROLE_DEGREE)
            return take_degree(r, i, err);
    for (size_t i = 0; i < r->columns; i++)
        if (r->column[i].named >= BR_USUAL_NAME && br_roles_check_words(r, i, err))
            return err->status;
    if (!may_halve(r))
        return br_roles_refuse(r, "found no column of a resolution", NULL, err);
    if (try_halves(r, &c, err))
        return err->status;
    if (!c.agrees_with_rates)
        return br_roles_refuse(r,
                               "found no column of a resolution, and the rates of the table do "
                               "not show that h halves from row to row",
                               NULL, err);
    r->halves = true;
    r->size[BR_AXIS_SPACE] = c.size;
    r->log_z[BR_AXIS_SPACE] = c.log_z;
    return BR_OK;
}

/* ---- errors, values and the rest ---- */

static bool is_asked(const struct br_roles *r, const struct br_role_column *c)
{
    return br_lists(r->wishes->errors, c->name) || br_lists(r->wishes->values, c->name);
}

static const char *why_aside(const struct br_roles *r, size_t i)
{
    static const char *const of_kinds[] = {
        [BR_KIND_RATE] = "a rate",
        [BR_KIND_FACTOR] = "a factor",
        [BR_KIND_COST] = "a cost or an index",
        [BR_KIND_DEVIATION] = "deviations of no column",
        [BR_KIND_DEGREE] = "a degree",
        [BR_KIND_REPEAT] = "the number of a run",
        [BR_KIND_LOGARITHM] = "logarithms: the numbers themselves are expected",
    };
    const struct br_role_column *c = &r->column[i];
    if (c->why)
        return c->why;
    if (!c->numbers)
        return c->words ? "words" : "no numbers";
    if (of_kinds[c->kind] && !c->by_hand)
        return of_kinds[c->kind];
    if (c->words)
        return "words among numbers";
    if (!(c->least < c->most))
        return "one number only";
    if (c->named >= BR_USUAL_NAME)
        return "another size";
    return r->wishes->errors || r->wishes->values ? "not asked for"
           : c->least < 0                         ? "both signs: --value, if it is studied"
           : c->is_whole                          ? "a count"
                         : "no error by its numbers: --error or --value, if "
                           "it is studied";
}

/* The column whose deviations these are: it has the same words, or is the only one. */
static size_t find_of(const struct br_roles *r, size_t deviations)
{
    size_t found = BR_NO_ROW, count = 0;
    for (size_t i = 0; i < r->columns; i++) {
        const struct br_role_column *c = &r->column[i];
        if (!br_role_is_studied(c))
            continue;
        if (c->name && r->column[deviations].name && strstr(r->column[deviations].name, c->name))
            return i;
        if (i < deviations || found == BR_NO_ROW)
            found = i;
        count++;
    }
    return count == 1 ? found : BR_NO_ROW;
}

/* Whether a column is that power of the size which its name says: "h^2" beside h. */
static bool is_power_of_size(const struct br_roles *r, size_t i)
{
    char base[20];
    const struct br_role_column *c = &r->column[i];
    const int power = c->name && !c->by_hand ? br_power_in(c->name, base) : 0;
    for (int axis = 0; power && axis < BR_AXES; axis++) {
        const struct br_resolution_column *size = br_resolution_column_find(axis ? "dt" : "h");
        double low = INFINITY, high = -INFINITY;
        for (size_t row = 0; r->log_z[axis] && row < r->rows; row++) {
            const double off = log(c->number[row]) - power * r->log_z[axis][row];
            low = fmin(low, off); /* that of a gap is none */
            high = fmax(high, off);
        }
        if (br_name_odds(base, NULL, size) >= BR_USUAL_NAME &&
            (strchr(c->name, '^') || high - low <= 0.02)) /* "h2" may be a norm */
            return true;
    }
    return false;
}

/* Whether another column of errors has these numbers without their signs. */
static bool has_magnitudes(const struct br_roles *r, size_t i)
{
    bool has = false;
    for (size_t k = 0; k < r->columns && !has && r->column[i].least < 0; k++) {
        has = k != i && br_role_is_studied(&r->column[k]);
        for (size_t row = 0; row < r->rows && has; row++)
            has = r->dropped[row] || fabs(r->column[i].number[row]) == r->column[k].number[row];
    }
    return has;
}

/* Whether a column has round-off beside errors, of which `most` is the greatest. One that is called
 * an error may be small. */
static bool is_round_off(const struct br_roles *r, const struct br_candidate *over,
                         const size_t *sorted, size_t i, double most)
{
    static const double small = 1e-6, always = 1e-12, perhaps = 1e-8;
    const struct br_role_column *c = &r->column[i];
    const bool is_error = br_says_error(c->name);
    return c->most <= small * most &&
           ((c->most <= always && !is_error) ||
            (c->most <= (is_error ? always : perhaps) && !br_evidence_falls(r, over, sorted, i)));
}

/* Whether a column has the name of another one and says that it is what is expected of it. */
static bool is_predicted(const struct br_roles *r, size_t i)
{
    bool is = false;
    const char *const name = r->column[i].name;
    for (size_t k = 0; k < r->columns && !is && br_is_prediction(name); k++) {
        const char *const other = r->column[k].name;
        is = k != i && other && br_role_is_studied(&r->column[k]) && !br_is_prediction(other) &&
             strncmp(name, other, strlen(other)) == 0;
    }
    return is;
}

/* Why a column of errors shows no order; NULL: it may. most: of the greatest error. */
static const char *why_idle(const struct br_roles *r, const struct br_candidate *over,
                            const size_t *sorted, size_t i, double most, bool errors)
{
    const struct br_role_column *c = &r->column[i];
    return c->least == 0 && c->most == 0            ? "zeros"
           : !(c->least < c->most)                  ? "one number only"
           : errors && br_is_residual(c->name)      ? "a residual: --error, if it is studied"
           : has_magnitudes(r, i)                   ? "an error with its sign"
           : is_predicted(r, i)                     ? "what is expected of another column"
           : is_round_off(r, over, sorted, i, most) ? "round-off beside the errors"
                                                    : NULL;
}

static bool may_be_idle(const struct br_role_column *c)
{
    return c->role == BR_ROLE_ERROR && !c->by_hand && c->name;
}

/* Leaves columns aside that show no order, beside one that may. */
static void leave_idle(struct br_roles *r, const struct br_candidate *over, const size_t *sorted)
{
    double most = 0;
    bool errors = false, others = false;
    for (size_t i = 0; i < r->columns; i++) {
        const struct br_role_column *c = &r->column[i];
        if (!br_role_is_studied(c))
            continue;
        most = fmax(most, c->most);
        errors |= c->kind == BR_KIND_ERROR && !br_is_residual(c->name);
    }
    for (size_t i = 0; i < r->columns; i++)
        others |= br_role_is_studied(&r->column[i]) &&
                  !(may_be_idle(&r->column[i]) && why_idle(r, over, sorted, i, most, errors));
    for (size_t i = 0; i < r->columns && others; i++) {
        struct br_role_column *c = &r->column[i];
        c->why = may_be_idle(c) ? why_idle(r, over, sorted, i, most, errors) : c->why;
        if (may_be_idle(c) && c->why)
            c->role = BR_ROLE_ASIDE;
    }
}

static void take_errors(struct br_roles *r, const struct br_candidate *over, const size_t *sorted)
{
    const bool asked = r->wishes->errors || r->wishes->values;
    for (size_t i = 0; i < r->columns; i++) {
        struct br_role_column *c = &r->column[i];
        if (!is_asked(r, c) && is_power_of_size(r, i))
            c->why = "a power of the size";
        if (c->role == BR_ROLE_SIZE || c->role == BR_ROLE_CASE || c->stated || c->why)
            continue;
        const bool by_hand = c->by_hand && c->kind == BR_KIND_UNKNOWN;
        const bool named_size = c->named >= BR_USUAL_NAME;
        const bool studied =
            asked ? is_asked(r, c) && !named_size
                  : by_hand || (!named_size && c->numbers && c->role != BR_ROLE_DEGREE &&
                                br_evidence_of_errors(r, over, sorted, i) >= 1);
        c->role = !studied      ? c->role == BR_ROLE_DEGREE ? BR_ROLE_DEGREE : BR_ROLE_ASIDE
                  : c->is_value ? BR_ROLE_VALUE
                                : BR_ROLE_ERROR;
    }
    if (!asked)
        leave_idle(r, over, sorted);
    for (size_t i = 0; i < r->columns; i++) {
        struct br_role_column *c = &r->column[i];
        if (c->role == BR_ROLE_ASIDE && c->kind == BR_KIND_DEVIATION && c->numbers && !c->words &&
            (c->of = find_of(r, i)) != BR_NO_ROW)
            c->role = BR_ROLE_DEVIATION;
    }
    for (size_t i = 0; i < r->columns; i++)
        if (r->column[i].role == BR_ROLE_ASIDE || r->column[i].role == BR_ROLE_DEGREE)
            r->column[i].why = why_aside(r, i);
}

/* Names errors of one heading apart: "l2", "l2 (2)". */
static enum br_status number_names(struct br_roles *r, struct br_error *err)
{
    char text[220];
    for (size_t i = r->columns; i-- > 0;) {
        struct br_role_column *c = &r->column[i];
        size_t count = 1;
        for (size_t k = 0; k < i && c->name; k++)
            count += br_role_is_studied(&r->column[k]) && r->column[k].name &&
                     strcmp(r->column[k].name, c->name) == 0;
        if (count == 1 || !br_role_is_studied(c))
            continue;
        snprintf(text, sizeof text, "%.190s (%zu)", c->name, count);
        if (!(c->label = c->name = br_store_copy(&r->store, text)))
            return br_no_memory(err, "the table");
    }
    return BR_OK;
}

/* An error that halves exactly beside sizes that do not is a size, more likely. */
static enum br_status check_swap(struct br_roles *r, const struct br_candidate *over,
                                 size_t *sorted, struct br_error *err)
{
    const struct br_role_column *size =
        over->size.column == BR_NO_ROW ? NULL : &r->column[over->size.column];
    struct br_candidate c = {.size = {br_resolution_column_find("h"), 0, 1}};
    size_t *order = br_store_take(&r->store, r->rows + 1, sizeof *order);
    bool swapped = false;
    size_t i = 0;
    c.log_z = br_store_take(&r->store, r->rows + 1, sizeof *c.log_z);
    if (!c.log_z || !order)
        return br_no_memory(err, "the table");
    const bool count = size && size->is_whole && !over->size.states->is_size; /* errors are none */
    for (; size && !count && !size->by_hand && !r->halves && i < r->columns && !swapped; i++) {
        if (r->column[i].role != BR_ROLE_ERROR || r->column[i].by_hand || over->agrees_with_rates ||
            br_evidence_halves(r, over, sorted))
            continue;
        for (size_t row = 0; row < r->rows; row++)
            c.log_z[row] = r->dropped[row] ? (double)NAN : log(r->column[i].number[row]);
        br_decide_sort(r, &c, order);
        swapped = br_evidence_halves(r, &c, order);
    }
    if (!swapped)
        return BR_OK;
    return br_fail(err, BR_BAD_INPUT,
                   "%s: %s halves exactly, and the sizes in %s do not: are the two swapped? "
                   "--column '%s=%s' says that they are not",
                   r->wishes->path, r->column[i - 1].label, size->label, size->label,
                   over->size.states->name);
}

/* Below a title that says rates, columns that stay between them are no errors. */
static enum br_status check_rates_alone(const struct br_roles *r, struct br_error *err)
{
    const double least = 0.2, most = 12, falls = 2;
    bool rates = false;
    for (size_t i = 0; i < r->fields->lefts; i++)
        rates |= strcasestr(r->fields->left[i].text, "rates") ||
                 strcasestr(r->fields->left[i].text, "orders of convergence");
    for (size_t i = 0; i < r->columns && rates; i++) {
        const struct br_role_column *c = &r->column[i];
        rates = !br_role_is_studied(c) || (!is_asked(r, c) && !c->by_hand && c->least >= least &&
                                           c->most <= most && c->most < falls * c->least);
    }
    return rates
               ? br_roles_refuse(r,
                                 "found rates and no errors: --error NAME says which column is one",
                                 NULL, err)
               : BR_OK;
}

/* Beside the iterations of a solver, an error that does not fall from mesh to mesh is one of the
 * solver. */
static enum br_status check_residuals(const struct br_roles *r, const size_t *sorted,
                                      struct br_error *err)
{
    const struct br_resolution_column *steps = br_resolution_column_find("steps");
    if (sorted[0] == BR_NO_ROW)
        return BR_OK;
    const char *iterations = NULL, *error = NULL;
    for (size_t i = 0; i < r->columns; i++) {
        const struct br_role_column *c = &r->column[i];
        bool rises = false;
        if (c->role == BR_ROLE_ASIDE && c->name && c->numbers && !c->by_hand &&
            (strcasestr(c->name, "iter") || br_odds(c, steps) >= BR_USUAL_NAME))
            iterations = c->name;
        if (!br_role_is_studied(c))
            continue;
        size_t last = 0;
        for (; sorted[last + 1] != BR_NO_ROW; last++)
            rises |= c->number[sorted[last + 1]] >= c->number[sorted[last]];
        if (c->by_hand || c->is_value || r->wishes->errors || !rises ||
            4 * c->number[sorted[last]] < c->number[sorted[0]])
            return BR_OK;
        error = c->label;
    }
    return iterations && error && r->groups == 1
               ? br_fail(err, BR_BAD_INPUT,
                         "%s: %s does not fall from mesh to mesh, beside iterations (%s): is it a "
                         "residual of the solver? --error '%s' says that it is an error",
                         r->wishes->path, error, iterations, error)
               : BR_OK;
}

/* A column that is called an error, and counts, beside errors that have other names. */
static enum br_status check_counting_errors(const struct br_roles *r, struct br_error *err)
{
    const struct br_role_column *counts = NULL, *other = NULL;
    bool named = r->wishes->errors || r->wishes->values;
    for (const struct br_role_column *c = r->column; c < r->column + r->columns; c++) {
        const bool is_error = c->kind == BR_KIND_ERROR;
        named |= br_role_is_studied(c) && (is_error || c->by_hand);
        other = br_role_is_studied(c) ? c : other;
        counts =
            !br_role_is_studied(c) && is_error && c->is_whole && c->least < c->most && !c->by_hand
                ? c
                : counts;
    }
    return !named && counts && other
               ? br_fail(err, BR_BAD_INPUT,
                         "%s: %s counts, and %s falls: which one is the error? --error '%s', or "
                         "--error '%s', decides",
                         r->wishes->path, counts->label, other->label, other->label, counts->label)
               : BR_OK;
}

/* ---- all ---- */

/* Whether a column may count unknowns or cells, or there is none of the mesh. */
static bool counts_volume(const struct br_roles *r)
{
    const struct br_resolution_column *chosen = r->size[BR_AXIS_SPACE].states;
    bool counts = !chosen || chosen->is_volume;
    for (size_t i = 0; i < r->columns && !counts; i++)
        for (const struct br_resolution_column *s = br_resolution_columns; s->name; s++)
            counts |= s->is_volume && (r->column[i].stated == s || br_odds(&r->column[i], s) > 1);
    return counts;
}

static enum br_status find_roles(struct br_roles *r, struct br_error *err)
{
    if (br_roles_take_headings(r, err) || br_roles_take_numbers(r, err))
        return err->status;
    drop_zeros(r);
    find_rates_without_a_name(r);
    if (br_roles_take_where(r, err) || check_sizes(r, err) || br_roles_find_cases(r, err) ||
        br_decide_sizes(r, err))
        return err->status;
    if (r->wishes->dimension > 0 && !counts_volume(r))
        return br_roles_refuse(r, "--dimension: found no numbers of unknowns or cells", NULL, err);
    const bool sizes = r->size[BR_AXIS_SPACE].states || r->size[BR_AXIS_TIME].states;
    if (!sizes && halve_by_row(r, err))
        return err->status;
    if (sizes)
        drop_summaries(r);
    const enum br_axis axis = r->size[BR_AXIS_SPACE].states ? BR_AXIS_SPACE : BR_AXIS_TIME;
    struct br_candidate over = {.size = r->size[axis], .log_z = r->log_z[axis]};
    size_t *sorted = br_store_take(&r->store, r->rows + 1, sizeof *sorted);
    if (!sorted)
        return br_no_memory(err, "the table");
    br_decide_sort(r, &over, sorted);
    if (!r->halves)
        br_evidence_weigh(r, &over, sorted);
    take_errors(r, &over, sorted);
    return compare_rates(r, &over, err) || number_names(r, err) ||
                   check_swap(r, &over, sorted, err) || check_residuals(r, sorted, err) ||
                   check_counting_errors(r, err) || check_rates_alone(r, err) ||
                   br_roles_take_repeats(r, err)
               ? err->status
               : BR_OK;
}

enum br_status br_roles_find(const struct br_fields *fields, const struct br_orders_request *wishes,
                             struct br_roles *r, struct br_error *err)
{
    *r = (struct br_roles){
        .fields = fields, .wishes = wishes, .columns = fields->columns, .rows = fields->rows};
    err->status = BR_OK;
    r->column = br_store_take(&r->store, r->columns + 1, sizeof *r->column);
    r->dropped = br_store_take(&r->store, r->rows + 1, sizeof *r->dropped);
    r->group = br_store_take(&r->store, r->rows + 1, sizeof *r->group);
    r->line = br_store_take(&r->store, r->rows + 1, sizeof *r->line);
    r->place = br_store_take(&r->store, r->rows + 1, sizeof *r->place);
    if (!r->column || !r->dropped || !r->group || !r->line || !r->place)
        return br_no_memory(err, "the table");
    return find_roles(r, err);
}

void br_roles_clear(struct br_roles *r)
{
    br_store_clear(&r->store);
    *r = (struct br_roles){0};
}
