/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the columns of a table are. Headings (names.c) and numbers (evidence.c) speak for and
 * against each; the roles follow from all of it (roles.c, decide.c), or a question that an option
 * answers. */
#ifndef BR_ORDERS_READING_ROLES_H
#define BR_ORDERS_READING_ROLES_H

#include <stdint.h>

#include "orders/request.h"

enum br_role {
    BR_ROLE_ASIDE,
    BR_ROLE_SIZE, /* states the resolution of an axis */
    BR_ROLE_ERROR,
    BR_ROLE_VALUE,     /* its limit is not known */
    BR_ROLE_DEVIATION, /* standard deviations of the numbers in column `of` */
    BR_ROLE_DEGREE,    /* of polynomials: errors over it have no order in h */
    BR_ROLE_CASE,      /* tells studies apart */
};

/* What a heading may be, apart from a size. */
enum br_kind {
    BR_KIND_UNKNOWN,
    BR_KIND_ERROR,
    BR_KIND_RATE,   /* orders from row to row */
    BR_KIND_FACTOR, /* by which an error falls */
    BR_KIND_COST,   /* time, iterations, the number of a row */
    BR_KIND_DEVIATION,
    BR_KIND_DEGREE,
    BR_KIND_REPEAT, /* the number of a repeated run, a seed */
    BR_KIND_LOGARITHM,
};
enum br_kind br_kind_of(const char *name);

/* Whether a name or a unit is that of logarithms: "log10 cpu", "error_log", "dB". */
bool br_is_logarithm(const char *name);

/* The cost that a name and a unit (NULL: none) say; BR_COSTS: none. *factor (out): to s or MB. */
enum br_cost br_cost_of(const char *name, const char *unit, double *factor);

/* The power that a name gives of another one, its base (out): 2 of "h^2" and "dx2"; 0: none. */
int br_power_in(const char *name, char base[20]);

/* Whether a name says an error, not only a norm: "L2 error", "rmse", "u - u_h"; not "L2(u)". */
bool br_says_error(const char *name);

bool br_is_prediction(const char *name); /* what another column should be: "L2 expected" */
bool br_is_residual(const char *name);   /* and not also an error's */

/* Whether a name is that of a coefficient, which has a limit: "C_D", "cl", "drag". */
bool br_is_coefficient(const char *name);

/* Log odds that a column of this name and unit (NULL: none) states a resolution in this way. */
double br_name_odds(const char *name, const char *unit, const struct br_resolution_column *column);

/* The most of these odds, of any way: BR_USUAL_NAME or more for "h" and "N". */
double br_size_name_odds(const char *name);

/* The unit in "dx/m", which ISO and DIN write so, and cuts it off: of a length or a time that is
 * called a size, and of nothing else. NULL: there is none, and the name may have changed. */
char *br_unit_behind_slash(char *name);

/* Whether a text is a usual unit. */
bool br_is_unit(const char *text);

/* Whether a name is that of a number of samples, which is no number of elements. */
bool br_is_samples(const char *name);

/* Whether a name is one of cells, intervals, samples, or an inverse size: points are none. */
bool br_is_no_number_of_points(const char *name);

/* Whether a field says that its row has no run: "Richardson extrapolated". */
bool br_is_summary(const char *text);

/* Whether a field says that there is no number: "diverged". */
bool br_is_gap(const char *text);

struct br_role_column {
    const char *shown;       /* the heading in the source; NULL: there is none */
    const char *name, *unit; /* without its unit, or as --column names it; NULL: none */
    const char *label;       /* its name, or its position from 1 on */
    char position[24];
    enum br_kind kind;
    double odds[BR_RESOLUTIONS]; /* of its name, for each way to state a resolution */
    double named;                /* the greatest of them */
    double *number, *deviation;  /* rows; NaN: none */
    double *rounding;            /* half a unit of the last digit, relative */
    bool rates_in_brackets;      /* its heading says so: "L2 error (rate)" */
    const char *unit_of_fields;  /* that each of its fields has; NULL */
    size_t numbers, words, gaps; /* how many fields are one or the other; gaps: "diverged" */
    const char *gap;             /* the last */
    bool is_whole, is_value;     /* is_value: --value says that its limit is not known */
    double least, most;
    bool of_sides;     /* "8x8": the cells along each side */
    bool without_sign; /* its errors were negative */
    bool fills;        /* a word counts for the empty fields below it, too */

    bool by_hand;                              /* --column says what it is */
    const struct br_resolution_column *stated; /* by hand */
    enum br_role role;
    const char *why; /* why it is aside; static */
    size_t of;       /* of deviations: their column */
};

/* A column that states the resolution of an axis. */
struct br_size {
    const struct br_resolution_column *states; /* NULL: there is none */
    size_t column;
    double dimension;
};

/* From here on a name is a usual one: of one meaning, or of any. */
#define BR_USUAL_NAME 4
#define BR_ANY_NAME 0.5 /* more than that */

static inline double br_odds(const struct br_role_column *c, const struct br_resolution_column *s)
{
    return s->is_degree ? 0 : c->odds[s - br_resolution_columns]; /* a degree has no row */
}

#define BR_NO_ROW SIZE_MAX /* no row, or no column */

struct br_place {
    size_t line, row;
    double log_z;
};

struct br_roles {
    const struct br_fields *fields;
    const struct br_orders_request *wishes; /* how it is read by hand */
    struct br_store store;                  /* all that is below */
    struct br_role_column *column;
    size_t columns, rows;
    const char **dropped;    /* rows: why the row is left aside; NULL: it is not; static */
    size_t *group;           /* rows: the case */
    size_t *line;            /* rows: the line along which one size changes */
    struct br_place *place;  /* rows: room of br_decide_sort */
    const char **group_name; /* groups: "method = P1"; a single one: "" */
    size_t groups;
    struct br_size size[BR_AXES];
    double *log_z[BR_AXES]; /* rows; NaN: none */
    bool halves;            /* no column: h halves from row to row, as rates say */
    bool means;             /* of rows of one size their mean counts */
    char assumed[400];      /* what is assumed, and what settles it; "": nothing */
    bool assumed_dimension;
    const char *of_rates; /* that the table's rates are not those of the sizes; static; NULL */
};

/* Finds the roles (out; clear them even after a failure). wishes: its path is that of the table,
 * its dimension 0 where nobody stated it; names of one column in its lists get the case of the
 * heading. Fails with BR_BAD_INPUT where a column has no clear role, with the option that settles
 * it; or with BR_NO_MEMORY. */
enum br_status br_roles_find(const struct br_fields *fields, const struct br_orders_request *wishes,
                             struct br_roles *roles, struct br_error *err);
void br_roles_clear(struct br_roles *roles); /* accepts zeros */

/* Refuses the table: why, its headings, and what helps (NULL: how to name columns). */
enum br_status br_roles_refuse(const struct br_roles *roles, const char *why, const char *advice,
                               struct br_error *err);

/* "line 3"; "row 2" of a source without lines. Returns text. */
char *br_row_place(const struct br_fields *fields, size_t row, char text[32]);

/* Refuses a field of words in a column of numbers. */
enum br_status br_roles_check_words(const struct br_roles *roles, size_t column,
                                    struct br_error *err);

/* ---- within the reading ---- */

static inline const char *br_role_field(const struct br_roles *r, size_t row, size_t column)
{
    while (r->column[column].fills && row && !r->fields->field[row * r->columns + column])
        row--;
    return r->fields->field[row * r->columns + column];
}

static inline const char *br_role_text(const struct br_roles *r, size_t row, size_t column)
{
    const char *text = br_role_field(r, row, column);
    return text ? text : "";
}

static inline bool br_role_is_studied(const struct br_role_column *c)
{
    return c->role == BR_ROLE_ERROR || c->role == BR_ROLE_VALUE;
}

/* Names the columns by their headings, and by --column (headings.c). */
enum br_status br_roles_take_headings(struct br_roles *roles, struct br_error *err);

/* The column of a heading or a position; BR_NO_ROW: there is none. */
size_t br_roles_find_column(const struct br_roles *roles, const char *text, size_t length);

/* Refuses a column that is not there, with the option that asks for it. */
enum br_status br_roles_refuse_column(const struct br_roles *roles, const char *option,
                                      const char *text, size_t length, struct br_error *err);

/* Reads the numbers of all columns, or of one again: of rows that are not left aside. */
enum br_status br_roles_take_numbers(struct br_roles *roles, struct br_error *err);
void br_roles_read_column(struct br_roles *roles, size_t column);

/* Keeps the rows of the case that --where names. */
enum br_status br_roles_take_where(struct br_roles *roles, struct br_error *err);

/* Finds the columns that tell cases apart, and the case of each row (cases.c). */
enum br_status br_roles_find_cases(struct br_roles *roles, struct br_error *err);

/* Of repeated runs the mean counts, of adaptive meshes the last (repeats.c). */
enum br_status br_roles_take_repeats(struct br_roles *roles, struct br_error *err);

/* A column that may state a resolution. */
struct br_candidate {
    struct br_size size;
    double *log_z; /* rows; NaN: none */
    double odds;
    bool agrees_with_rates, misses_rates, contradicts_rates, wrong_way;
    bool halves; /* intervals between points do, whose numbers do not double */
};

/* Adds up the evidence for a candidate. sorted: rows from coarse to fine, line after line, and
 * BR_NO_ROW. */
void br_evidence_weigh(const struct br_roles *roles, struct br_candidate *candidate,
                       const size_t *sorted);

/* Log odds that a column has errors, over these sizes. */
double br_evidence_of_errors(const struct br_roles *roles, const struct br_candidate *candidate,
                             const size_t *sorted, size_t column);

/* Whether a column falls from each size to the next finer one. */
bool br_evidence_falls(const struct br_roles *roles, const struct br_candidate *candidate,
                       const size_t *sorted, size_t column);

/* The slope of the numbers of a column over the sizes, in logs. */
double br_evidence_order(const struct br_roles *roles, const struct br_candidate *candidate,
                         const size_t *sorted, size_t column);

/* Whether the sizes halve. */
bool br_evidence_halves(const struct br_roles *roles, const struct br_candidate *candidate,
                        const size_t *sorted);

/* Whether two columns state the same sizes, to a factor. */
bool br_evidence_same(const struct br_roles *roles, const double *log_a, const double *log_b,
                      double tolerance);

/* The rows that a candidate has, from coarse to fine, line after line (out: rows + 1). */
void br_decide_sort(const struct br_roles *roles, const struct br_candidate *candidate,
                    size_t *sorted);

/* Chooses the sizes of both axes (decide.c): sets roles->size, ->chosen and what is assumed. */
enum br_status br_decide_sizes(struct br_roles *roles, struct br_error *err);

#endif
