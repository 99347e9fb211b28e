/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A source of numbers: a table. Its fields become columns with roles (orders/reading/), and these
 * become rows of numbers. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/quote.h"
#include "orders/reading/roles.h"
#include "orders/request.h"

/* A table that is made into numbers. */
struct source {
    const struct br_orders_request *request;
    struct br_fields fields;
    struct br_roles roles;
    size_t *cell; /* rows of the table: the row of the numbers; owned */
    struct br_numbers *numbers;
    char *text; /* what is said; owned */
    bool no_memory;
};

/* ---- rows ---- */

struct key {
    size_t row;
    double z[BR_AXES];
};

static int by_z(const void *a, const void *b)
{
    const struct key *x = a, *y = b;
    for (int i = 0; i < BR_AXES; i++)
        if (x->z[i] != y->z[i])
            return (x->z[i] < y->z[i]) - (x->z[i] > y->z[i]);
    return (x->row > y->row) - (x->row < y->row);
}

/* Gives each row of the table that counts its row of the numbers: rows of one size share it where
 * they are repeated runs, or of several studies. Returns the number of rows. */
static size_t find_cells(struct source *s)
{
    const struct br_roles *r = &s->roles;
    struct key *key = br_allocate(r->rows + 1, sizeof *key);
    const bool shared = r->means || r->groups > 1;
    size_t count = 0, cells = 0;
    s->no_memory |= !key;
    for (size_t i = 0; key && i < r->rows; i++) {
        if (r->dropped[i])
            continue;
        key[count] = (struct key){i, {0, 0}};
        for (int axis = 0; axis < BR_AXES; axis++)
            if (r->log_z[axis] && isfinite(r->log_z[axis][i]))
                key[count].z[axis] = round(r->log_z[axis][i] * 1e9);
        count++;
    }
    if (key && shared)
        qsort(key, count, sizeof *key, by_z);
    for (size_t i = 0; i < count; i++) {
        const bool same =
            shared && i > 0 && key[i].z[0] == key[i - 1].z[0] && key[i].z[1] == key[i - 1].z[1];
        cells += !same;
        s->cell[key[i].row] = cells - 1;
    }
    free(key);
    return cells;
}

/* ---- numbers ---- */

static enum br_status take_sizes(struct source *s, enum br_axis axis, struct br_error *err)
{
    const struct br_roles *r = &s->roles;
    struct br_numbers *n = s->numbers;
    const struct br_size *size = &r->size[axis];
    if (!size->states)
        return BR_OK;
    n->column[axis] = size->states;
    if (axis == BR_AXIS_SPACE) {
        n->dimension = size->dimension;
        n->assumed = r->assumed_dimension;
        n->samples = !r->halves && r->column[size->column].name &&
                     br_is_samples(r->column[size->column].name);
    }
    for (size_t i = 0; i < r->rows; i++) {
        if (r->dropped[i])
            continue;
        struct br_numbers_row *row = &n->row[s->cell[i]];
        row->given[axis] =
            r->halves ? round(-r->log_z[axis][i] / log(2)) : r->column[size->column].number[i];
        row->z[axis] = br_numbers_z(size->states, row->given[axis], size->dimension);
    }
    const char *unit = r->halves ? NULL : r->column[size->column].unit;
    if (unit && !(n->unit[axis] = strdup(unit)))
        return br_no_memory(err, "the table");
    return BR_OK;
}

/* The standard deviation of a number, from its field or from its column. */
static double deviation_at(const struct br_roles *r, size_t row, size_t column)
{
    for (size_t i = 0; i < r->columns; i++)
        if (r->column[i].role == BR_ROLE_DEVIATION && r->column[i].of == column)
            return r->column[i].number[row];
    return r->column[column].deviation[row];
}

/* Puts the mean of repeated runs, with the standard deviation of the mean; NaN: one of them failed.
 */
static void take_means(struct source *s, size_t group, size_t column, size_t quantity)
{
    const struct br_roles *r = &s->roles;
    struct br_numbers *n = s->numbers;
    for (size_t c = 0; c < n->rows; c++) {
        double sum = 0, squares = 0;
        size_t count = 0;
        for (int pass = 0; pass < 2; pass++)
            for (size_t i = 0; i < r->rows; i++) {
                const double number = r->column[column].number[i];
                if (r->dropped[i] || s->cell[i] != c || r->group[i] != group)
                    continue;
                count += !pass;
                sum += pass ? 0 : number;
                squares += pass ? pow(number - sum / (double)count, 2) : 0;
            }
        struct br_numbers_row *row = &n->row[c];
        row->number[quantity] = count ? sum / (double)count : (double)NAN;
        row->repeat = count > row->repeat ? count : row->repeat;
        if (count > 1)
            row->deviation[quantity] = sqrt(squares / (double)(count - 1) / (double)count);
    }
}

static enum br_status take_numbers(struct source *s, size_t group, size_t column, size_t quantity,
                                   struct br_error *err)
{
    const struct br_roles *r = &s->roles;
    struct br_numbers *n = s->numbers;
    if (br_roles_check_words(r, column, err))
        return err->status;
    for (size_t i = 0; i < n->rows && r->groups > 1; i++) {
        n->row[i].out[quantity] = BR_FLAG_ABSENT;
        n->row[i].number[quantity] = NAN;
    }
    for (size_t i = 0; i < r->rows; i++) {
        if (r->dropped[i] || r->group[i] != group)
            continue;
        struct br_numbers_row *row = &n->row[s->cell[i]];
        row->number[quantity] = r->column[column].number[i];
        row->deviation[quantity] = deviation_at(r, i, column);
        row->out[quantity] = BR_FLAG_NONE;
    }
    if (r->means)
        take_means(s, group, column, quantity);
    return BR_OK;
}

static enum br_status take_quantity(struct source *s, size_t group, size_t column,
                                    struct br_error *err)
{
    struct br_numbers *n = s->numbers;
    const struct br_roles *r = &s->roles;
    const struct br_role_column *c = &r->column[column];
    const size_t quantity = n->quantities;
    char *name;
    const char *of = c->label, *group_name = r->group_name[group];
    if (asprintf(&name, *group_name ? "%s [%s]" : "%s", of, group_name) < 0)
        return br_no_memory(err, "the table");
    const enum br_status status =
        br_numbers_add_quantity(n, name, c->unit, c->role == BR_ROLE_VALUE, err);
    n->quantity[quantity].case_at = *group_name ? strlen(of) : 0;
    free(name);
    return status ? status : take_numbers(s, group, column, quantity, err);
}

/* Whether a column has costs, and is not studied. */
static bool is_cost(const struct source *s, const struct br_role_column *c)
{
    double factor;
    return s->request->cost && c->name && c->numbers && !c->words && !br_role_is_studied(c) &&
           (strcmp(c->name, s->request->cost) == 0 ||
            br_cost_of(c->name, c->unit, &factor) != BR_COSTS);
}

/* What is studied, or the costs. */
static enum br_status take_quantities(struct source *s, bool costs, struct br_error *err)
{
    const struct br_roles *r = &s->roles;
    for (size_t i = 0; i < r->columns; i++) {
        const bool is = costs ? is_cost(s, &r->column[i]) : br_role_is_studied(&r->column[i]);
        for (size_t group = 0; group < r->groups && is; group++)
            if (br_observer_check(s->request->observer, err) || take_quantity(s, group, i, err))
                return err->status;
    }
    return BR_OK;
}

/* ---- what is said ---- */

__attribute__((format(printf, 2, 3))) static void say(struct source *s, const char *format, ...)
{
    char *more = NULL, *all = NULL;
    va_list arguments;
    va_start(arguments, format);
    const int length = vasprintf(&more, format, arguments);
    va_end(arguments);
    if (length < 0 || asprintf(&all, "%s%s", s->text ? s->text : "", more) < 0)
        s->no_memory = true;
    else {
        free(s->text);
        s->text = all;
    }
    if (length >= 0)
        free(more);
}

/* Moves what is said into the numbers. */
static const char *keep(struct source *s)
{
    const char *copy = br_store_copy(&s->numbers->store, s->text ? s->text : "");
    s->no_memory |= !copy;
    free(s->text);
    s->text = NULL;
    return copy;
}

static const char *quoted(const char *text, char buffer[200])
{
    return br_quoted(buffer, 200, &br_for_text, text);
}

static void say_sizes(struct source *s, enum br_axis axis)
{
    const struct br_roles *r = &s->roles;
    const struct br_size *size = &r->size[axis];
    char text[200];
    if (!size->states)
        return;
    if (r->halves) {
        say(s, "no column of the mesh, and the rates show that h halves from row to row");
        return;
    }
    say(s, "%s%s from column %s", s->text ? ", " : "", size->states->states,
        quoted(r->column[size->column].label, text));
    if (size->states->is_volume)
        say(s, ", d = %g%s", size->dimension, r->assumed_dimension ? " assumed" : "");
}

/* Which errors are taken without a sign. */
static void say_signs(struct source *s)
{
    char text[200];
    for (size_t i = 0; i < s->roles.columns; i++)
        if (s->roles.column[i].role == BR_ROLE_ERROR && s->roles.column[i].without_sign)
            say(s, "; %s without its sign", quoted(s->roles.column[i].label, text));
}

/* role: BR_ROLE_ASIDE, the costs. */
static void say_columns(struct source *s, enum br_role role, const char *what)
{
    const struct br_roles *r = &s->roles;
    char text[200];
    size_t said = 0;
    for (size_t i = 0; i < r->columns; i++)
        if (role ? r->column[i].role == role : is_cost(s, &r->column[i]))
            say(s, "%s%s", said++ ? ", " : what, quoted(r->column[i].label, text));
}

static void leave(struct source *s, const char *why)
{
    struct br_numbers *n = s->numbers;
    const char *what = keep(s);
    if (what && n->left)
        n->left[n->lefts++] = (struct br_left_aside){what, why};
}

/* Whether a column that is left aside is called an error, and may be one that does not fall. */
static bool may_stagnate(const struct br_role_column *c)
{
    return c->role == BR_ROLE_ASIDE && c->kind == BR_KIND_ERROR && !c->by_hand && c->numbers &&
           !c->is_whole && c->least >= 0 && !br_is_residual(c->name);
}

/* Lists all that is left aside. */
static void list_left(struct source *s)
{
    char text[32];
    const struct br_roles *r = &s->roles;
    const struct br_fields *f = &s->fields;
    s->numbers->left = br_store_take(&s->numbers->store, 3 * r->columns + r->rows + f->lefts + 1,
                                     sizeof *s->numbers->left);
    s->no_memory |= !s->numbers->left;
    for (size_t i = 0; i < r->columns; i++)
        if ((r->column[i].role == BR_ROLE_ASIDE || r->column[i].role == BR_ROLE_DEGREE) &&
            !is_cost(s, &r->column[i])) {
            say(s, r->column[i].name ? "%s" : "column %s", r->column[i].label);
            leave(s, r->column[i].why);
            if (!s->no_memory && may_stagnate(&r->column[i]) && !s->request->errors &&
                !s->request->values)
                s->numbers->other_error = s->numbers->left[s->numbers->lefts - 1].what;
        }
    for (size_t i = 0; i < r->columns; i++)
        if (r->column[i].rates_in_brackets) {
            say(s, "%s: the numbers in brackets", r->column[i].label);
            leave(s, "rates");
        }
    for (size_t i = 0; i < r->columns; i++)
        if (r->column[i].gaps) {
            say(s, "%s: '%s'", r->column[i].label, r->column[i].gap);
            leave(s, "not a number");
        }
    for (size_t i = 0; i < r->rows; i++)
        if (r->dropped[i]) {
            say(s, "%s", br_row_place(f, i, text));
            leave(s, r->dropped[i]);
        }
    for (size_t i = 0; i < f->lefts; i++) {
        if (f->left[i].line) /* else of a source without lines */
            say(s, "line %zu ", f->left[i].line);
        say(s, "'%s'", f->left[i].text);
        leave(s, f->left[i].why);
    }
}

/* What is left aside, in groups of one reason. Of many rows and lines the first are named; the list
 * has all. */
static void say_left(struct source *s)
{
    enum { MOST = 4 };
    const struct br_numbers *n = s->numbers;
    char text[200];
    for (size_t first = 0, end; first < n->lefts; first = end) {
        for (end = first + 1; end < n->lefts && n->left[end].why == n->left[first].why;)
            end++;
        const bool lines = strncmp(n->left[first].what, "line ", 5) == 0 ||
                           strncmp(n->left[first].what, "row ", 4) == 0;
        const size_t named = !lines || end - first <= MOST + 1 ? end : first + MOST;
        for (size_t i = first; i < named; i++)
            say(s, "%s%s",
                i == 0       ? "; left aside: "
                : i == first ? "; "
                             : ", ",
                quoted(n->left[i].what, text));
        if (named < end)
            say(s, ", and %zu more", end - named);
        say(s, " (%s)", n->left[first].why);
    }
}

/* Says what was taken for what. */
static enum br_status state(struct source *s, struct br_error *err)
{
    const struct br_roles *r = &s->roles;
    struct br_numbers *n = s->numbers;
    list_left(s);
    for (int axis = 0; axis < BR_AXES; axis++)
        say_sizes(s, (enum br_axis)axis);
    say_columns(s, BR_ROLE_ERROR, "; errors: ");
    say_signs(s);
    say_columns(s, BR_ROLE_VALUE, "; values: ");
    say_columns(s, BR_ROLE_ASIDE, "; costs: ");
    say_columns(s, BR_ROLE_DEVIATION, "; standard deviations: ");
    say_columns(s, BR_ROLE_CASE, "; a study for each of: ");
    if (r->means)
        say(s, "; of rows of one size the mean");
    if (*r->assumed &&
        (!n->assumed || strstr(r->assumed, "; ") || strstr(r->assumed, "other rates")))
        say(s, "; %s", r->assumed);
    if (r->of_rates)
        say(s, "; %s", r->of_rates);
    say_left(s);
    n->taken = keep(s);
    if (*r->assumed) {
        say(s, "%s", r->assumed);
        n->unsettled = keep(s);
    }
    return s->no_memory ? br_no_memory(err, "the table") : BR_OK;
}

/* ---- all ---- */

static enum br_status check_lists(const struct source *s, struct br_error *err)
{
    const struct br_roles *r = &s->roles;
    const char **known = br_allocate(r->columns + 1, sizeof *known);
    size_t count = 0;
    for (size_t i = 0; i < r->columns && known; i++)
        if (r->column[i].name && r->column[i].role != BR_ROLE_SIZE)
            known[count++] = r->column[i].name;
    const enum br_status status =
        known ? br_orders_check_lists(s->request, s->numbers, known, count, err)
              : br_no_memory(err, "the table");
    free(known);
    return status;
}

static enum br_status make_room(struct source *s, struct br_error *err)
{
    const struct br_roles *r = &s->roles;
    struct br_numbers *n = s->numbers;
    size_t studied = 0;
    s->cell = br_allocate(r->rows + 1, sizeof *s->cell);
    if (!s->cell)
        return br_no_memory(err, "the table");
    const size_t cells = find_cells(s);
    for (size_t i = 0; i < r->columns; i++)
        studied += br_role_is_studied(&r->column[i]) || is_cost(s, &r->column[i]);
    if (s->no_memory || br_numbers_make_room(n, cells, studied * r->groups, err))
        return s->no_memory ? br_no_memory(err, "the table") : err->status;
    for (size_t i = 0; i < r->rows; i++)
        if (!r->dropped[i])
            n->row[s->cell[i]].line = s->fields.line[i];
    return BR_OK;
}

/* There are no errors: a column may have values. */
static enum br_status refuse_values(const struct source *s, struct br_error *err)
{
    const struct br_role_column *found = NULL;
    char name[200], item[210] = "NAME", shell[240], where[80] = "", text[32], advice[400];
    for (size_t i = s->roles.columns; i-- > 0;) {
        const struct br_role_column *c = &s->roles.column[i];
        if (c->kind == BR_KIND_LOGARITHM && c->role == BR_ROLE_ASIDE) {
            snprintf(advice, sizeof advice, "%s has logarithms: give the numbers themselves",
                     quoted(c->label, name));
            return br_roles_refuse(&s->roles, "found no column of errors", advice, err);
        }
        if (c->role == BR_ROLE_ASIDE && c->why && strstr(c->why, "--value"))
            found = c;
    }
    if (found)
        snprintf(item, sizeof item, strchr(found->label, ',') ? "\"%s\"" : "%s",
                 quoted(found->label, name));
    for (size_t i = 0; found && i < s->roles.rows && !*where; i++)
        if (found->number[i] < 0)
            snprintf(where, sizeof where, ": %s has %g", br_row_place(&s->fields, i, text),
                     found->number[i]);
    snprintf(advice, sizeof advice, "--value %s studies it, if its limit is not known%s",
             br_quoted(shell, sizeof shell, &br_for_shell, item), where);
    return br_roles_refuse(&s->roles, "found no column of errors", advice, err);
}

static enum br_status take_all(struct source *s, struct br_error *err)
{
    if (br_roles_find(&s->fields, s->request, &s->roles, err) || make_room(s, err))
        return err->status;
    for (int axis = 0; axis < BR_AXES; axis++)
        if (take_sizes(s, (enum br_axis)axis, err))
            return err->status;
    if (take_quantities(s, false, err))
        return err->status;
    const size_t studied = s->numbers->quantities;
    const enum br_status status = take_quantities(s, true, err);
    s->numbers->costs = s->numbers->quantities - studied;
    s->numbers->quantities = studied;
    if (status || state(s, err) || check_lists(s, err))
        return err->status;
    return studied ? BR_OK : refuse_values(s, err);
}

enum br_status br_table_read(const struct br_orders_request *q, struct br_numbers *numbers,
                             struct br_error *err)
{
    struct br_orders_request own = *q; /* as br_roles_find has it */
    struct source s = {.request = &own, .numbers = numbers};
    err->status = BR_OK;
    own.path = (char *)br_orders_path(q);
    own.dimension = q->assumed_dimension ? 0 : q->dimension;
    own.errors = q->errors ? strdup(q->errors) : NULL;
    own.values = q->values ? strdup(q->values) : NULL;
    enum br_status status =
        (q->errors && !own.errors) || (q->values && !own.values)
            ? br_no_memory(err, "the table")
            : br_fields_read(q->table, br_orders_path(q), q->observer, &s.fields, err);
    if (!status)
        status = take_all(&s, err);
    free(own.errors);
    free(own.values);
    free(s.cell);
    free(s.text);
    br_roles_clear(&s.roles);
    br_fields_clear(&s.fields);
    return status;
}
