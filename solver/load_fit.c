/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A load f(x, t) that is no product, as a sum of few: in each of some cells of the beam
 *     f(x, t) = sum over j of f(x_j, t) L_j(x)
 * with the Lagrange polynomials L_j of m Chebyshev points x_j. Their load vectors are assembled
 * once; a step evaluates f at the x_j alone, where the direct way has five Gauss points an element.
 *
 * On a cell of width w the error is at most |d^m f / dx^m| / m! 2 (w/4)^m. The derivative is
 * enclosed over all times of the march by interval arithmetic (function.h), not sampled. Where f is
 * not smooth, or too many cells would be needed, there is no fit, and the load is assembled
 * directly. */
#include "solver/load.h"

#include <math.h>
#include <string.h>

#include "solver/linear/states.h"

enum { MOST_POINTS = BR_MOST_STATES, MOST_CELLS = 256, MOST_HALVINGS = 4 };

/* A cell has at most so many elements, or this share of all: equal cells share their vectors, which
 * then stay in the caches and take little memory. */
enum { MOST_ELEMENTS = 512, LEAST_CELLS = 128 };

/* Numbers of points of a cell to try, and how many evaluations an element each may cost. */
static const struct {
    size_t points;
    double evaluations;
} kinds[] = {{8, 0.125}, {12, 0.25}, {MOST_POINTS, 1}};

/* The error that is proved, relative to the largest sampled value; and the error that a step
 * accepts, relative to its own largest value, which may be smaller. */
static const double proved = 0x1p-66, wanted = 0x1p-54;

/* Proofs for each element and step: they may cost a quarter of the time that a fit saves. */
static const double proofs_a_step = 4e-4;

struct br_load_fit {
    struct br_field field;
    double duration, error; /* s; N/m, at most */
    size_t points, cells;   /* of a cell */
    size_t proofs;          /* that may still be tried */
    size_t first[MOST_CELLS + 1];
    double *column[MOST_CELLS]; /* the load vectors of each cell's polynomials; those of equal cells
                                   are the same */
    double *x, *value;          /* points of all cells */
    double *columns;            /* all of them */
};

void br_load_fit_free(struct br_load_fit *fit)
{
    if (!fit)
        return;
    free(fit->x);
    free(fit->columns);
    free(fit);
}

/* Chebyshev point j in [0, 1]. */
static double chebyshev_point(size_t points, size_t j)
{
    const double angle = (2 * (double)j + 1) / (double)(2 * points) * 3.14159265358979323846;
    return (1 - cos(angle)) / 2;
}

/* ---- cells ---- */

/* Whether the error is proved to be small on an interval of x; where a proof fails, the interval of
 * times is halved. */
static bool is_good(struct br_load_fit *fit, const struct br_function *f, struct br_interval x,
                    struct br_interval t, int halvings)
{
    struct br_interval c[MOST_POINTS + 1];
    const size_t m = fit->points;
    if (fit->proofs == 0)
        return false;
    fit->proofs--;
    if (br_function_taylor(f, BR_X, (struct br_box){x, t}, m, c) &&
        fmax(-c[m].low, c[m].high) * 2 * pow((x.high - x.low) / 4, (double)m) <= fit->error)
        return true;
    const double middle = t.low + (t.high - t.low) / 2;
    return halvings > 0 && is_good(fit, f, x, (struct br_interval){t.low, middle}, halvings - 1) &&
           is_good(fit, f, x, (struct br_interval){middle, t.high}, halvings - 1);
}

/* Adds the cells of elements [begin, end); false: there would be too many. */
static bool add_cells(struct br_load_fit *fit, const struct br_function *f, size_t begin,
                      size_t end, size_t most)
{
    const double h = fit->field.h;
    const struct br_interval x = {h * (double)begin, h * (double)end};
    if (fit->cells >= most)
        return false;
    const bool short_enough =
        end - begin <= MOST_ELEMENTS || end - begin <= fit->field.n / LEAST_CELLS;
    if (short_enough && is_good(fit, f, x, (struct br_interval){0, fit->duration}, MOST_HALVINGS)) {
        fit->first[fit->cells++] = begin;
        fit->first[fit->cells] = end;
        return true;
    }
    const size_t middle = begin + (end - begin) / 2;
    return middle > begin && fit->proofs > 0 && add_cells(fit, f, begin, middle, most) &&
           add_cells(fit, f, middle, end, most);
}

/* The peak at some times. A larger peak at another time would only allow a larger error. */
static double peak_of(const struct br_field *field, const struct br_function *f, double duration)
{
    enum { TIMES = 8 };
    double most = 0;
    for (int j = 1; j <= TIMES; j++)
        most = fmax(most, br_load_peak(field, f, duration * j / TIMES));
    return most;
}

static bool find_cells(struct br_load_fit *fit, const struct br_function *f)
{
    const double n = (double)fit->field.n;
    fit->error = proved * peak_of(&fit->field, f, fit->duration);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds && isnormal(fit->error); i++) {
        const double most = floor(n * kinds[i].evaluations / (double)kinds[i].points);
        fit->points = kinds[i].points;
        fit->cells = 0;
        if (add_cells(fit, f, 0, fit->field.n, most < MOST_CELLS ? (size_t)most : MOST_CELLS))
            return true;
    }
    return false;
}

/* ---- load vectors ---- */

/* A Lagrange polynomial on a cell, from its left end on. */
struct polynomial {
    double width; /* m */
    size_t points, which;
};

/* By products: at most 16 factors. */
static void evaluate_polynomial(void *self, size_t count, const double *x, double t, double *value)
{
    (void)t;
    const struct polynomial *p = self;
    const double own = chebyshev_point(p->points, p->which);
    for (size_t i = 0; i < count; i++)
        value[i] = 1;
    for (size_t j = 0; j < p->points; j++) {
        const double point = chebyshev_point(p->points, j);
        for (size_t i = 0; i < count && j != p->which; i++)
            value[i] *= (x[i] / p->width - point) / (own - point);
    }
}

static const struct br_function_ops polynomial_ops = {.evaluate = evaluate_polynomial};

static struct br_field cell_field(const struct br_load_fit *fit, size_t cell)
{
    struct br_field field = fit->field;
    field.n = fit->first[cell + 1] - fit->first[cell];
    return field;
}

/* The first cell with the same number of elements. */
static size_t equal_cell(const struct br_load_fit *fit, size_t cell)
{
    size_t i = 0;
    while (cell_field(fit, i).n != cell_field(fit, cell).n)
        i++;
    return i;
}

static enum br_status fill(struct br_load_fit *fit, struct br_error *err)
{
    const size_t m = fit->points, points = m * fit->cells;
    size_t rows = 0;
    for (size_t cell = 0; cell < fit->cells; cell++) {
        const struct br_field field = cell_field(fit, cell);
        rows += equal_cell(fit, cell) == cell ? br_field_size(&field) : 0;
    }
    fit->x = br_allocate(2 * points, sizeof *fit->x);
    fit->columns = br_allocate_aligned(m * rows, sizeof *fit->columns);
    if (!fit->x || !fit->columns)
        return br_no_memory(err, "a load's fit");
    fit->value = fit->x + points;
    enum br_status status = BR_OK;
    double *next = fit->columns;
    for (size_t cell = 0; cell < fit->cells && !status; cell++) {
        const struct br_field field = cell_field(fit, cell);
        const size_t equal = equal_cell(fit, cell);
        const double left = field.h * (double)fit->first[cell], width = field.h * (double)field.n;
        for (size_t j = 0; j < m; j++)
            fit->x[cell * m + j] = left + width * chebyshev_point(m, j);
        fit->column[cell] = equal < cell ? fit->column[equal] : next;
        for (size_t j = 0; j < m && equal == cell && !status; j++) {
            struct polynomial p = {width, m, j};
            const struct br_function f = {.ops = &polynomial_ops, .self = &p, .uses_x = true};
            status = br_assemble_load(&field, &f, 0, next, err);
            next += br_field_size(&field);
        }
    }
    return status;
}

enum br_status br_load_fit_create(const struct br_field *field, const struct br_function *f,
                                  double duration, struct br_load_fit **out, struct br_error *err)
{
    *out = NULL;
    struct br_load_fit *fit = br_allocate(1, sizeof *fit);
    if (!fit)
        return br_no_memory(err, "a load's fit");
    fit->field = *field;
    fit->duration = duration;
    fit->proofs = (size_t)fmin(1e5, proofs_a_step * (double)field->n * duration / field->k);
    const bool found = find_cells(fit, f);
    const enum br_status status = found ? fill(fit, err) : BR_OK;
    if (!found || status)
        br_load_fit_free(fit);
    else
        *out = fit;
    return status;
}

/* ---- a step ---- */

/* Whether the proved error is round-off of the largest value. */
static bool is_round_off(const struct br_load_fit *fit)
{
    double most = 0;
    for (size_t i = 0; i < fit->points * fit->cells; i++) {
        if (!isfinite(fit->value[i]))
            return false;
        most = fabs(fit->value[i]) > most ? fabs(fit->value[i]) : most;
    }
    return fit->error <= wanted * most;
}

bool br_load_fit_assemble(struct br_load_fit *fit, const struct br_function *f, double t,
                          double *vector)
{
    if (!(t >= 0 && t <= fit->duration))
        return false;
    br_function_evaluate(f, fit->points * fit->cells, fit->x, t, fit->value);
    if (!is_round_off(fit))
        return false;
    const size_t unknowns = br_field_unknowns(&fit->field);
    double common[2] = {0}; /* the load of the cell before at their common node */
    for (size_t cell = 0; cell < fit->cells; cell++) {
        const struct br_field field = cell_field(fit, cell);
        const size_t rows = br_field_size(&field);
        double *from[MOST_POINTS], *to = vector + fit->first[cell] * unknowns;
        for (size_t j = 0; j < fit->points; j++)
            from[j] = fit->column[cell] + j * rows;
        br_add_states(to, rows, fit->points, from, fit->value + cell * fit->points);
        for (size_t a = 0; a < unknowns; a++) {
            to[a] += common[a];
            common[a] = to[rows - unknowns + a];
        }
    }
    return true;
}
