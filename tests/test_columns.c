/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which columns a table is read as, and what is refused. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/load.h"
#include "checks.h"
#include "orders/request.h"

/* Which columns of a table are read. */
struct columns {
    const char *errors, *values;
    double dimension;  /* 2: nobody states it */
    const char *names; /* as --column has them */
};
static const struct columns plain = {NULL, NULL, 2, NULL};

static enum br_status read_table(const char *text, const struct columns *columns,
                                 struct br_numbers *numbers)
{
    const struct br_orders_request q = {.path = (char *)"t.csv",
                                        .table = (char *)text,
                                        .errors = (char *)columns->errors,
                                        .values = (char *)columns->values,
                                        .dimension = columns->dimension,
                                        .columns = (char *)columns->names,
                                        .assumed_dimension =
                                            columns->dimension == 2 || columns->names};
    return br_orders_read(&q, numbers, &err);
}

static struct br_numbers read_with(const char *text, const struct columns *columns)
{
    struct br_numbers numbers;
    MUST(read_table(text, columns, &numbers));
    return numbers;
}

static void refuse_with(const char *text, const struct columns *columns, const char *message)
{
    OWNED(br_numbers) numbers;
    REFUSED(read_table(text, columns, &numbers), BR_BAD_INPUT, message);
}

/* That it has h = 1, 1/2, 1/4 and l2 = 3, 2, 1. */
static void is_the_table(const char *text)
{
    OWNED(br_numbers) n = read_with(text, &plain);
    assert_int_equal(n.rows, 3);
    assert_int_equal(n.quantities, 1);
    assert_string_equal(n.quantity[0].name, "l2");
    assert_false(n.quantity[0].is_value);
    for (size_t i = 0; i < 3; i++) {
        CLOSE(n.row[i].z[BR_AXIS_SPACE], 1 / (double)(1 << i), 0);
        CLOSE(n.row[i].number[0], 3 - (double)i, 0);
    }
}

TEST(test_formats)
{
    is_the_table("h,l2\n1,3\n.5,2\n.25,1\n");
    is_the_table("h,l2\n.25,1\n1,3\n.5,2"); /* in any order, without an end of line */
    is_the_table("\xef\xbb\xbfh,l2\r\n1,3\r\n.5,2\r\n.25,1\r\n");
    is_the_table("h\tl2\n1\t3\n.5\t2\n.25\t1\n");
    is_the_table("# errors\n\n h , l2 \n# more\n 1 , 3 \n.5,2\n  \n.25,1\n");
    is_the_table("\"h\",\"l2\"\n\"1\",\"3\"\n\".5\",2\n.25,\"1\"\n");
    is_the_table("n,l2\n1,3\n2,2\n4,1\n");
    is_the_table("dofs,l2\n1,3\n4,2\n16,1\n");
    is_the_table("name,h,l2\ncoarse,1,3\nfine,.5,2\nfiner,.25,1\n"); /* words are left alone */
}

TEST(test_names_and_units)
{
    OWNED(br_numbers)
    n = read_with("h [mm],dt (s),f(x) [N/m],\"a\n\"\"b\"\", c\"\n1,4,3,4\n.5,2,2,2\n.25,1,,1\n",
                  &(struct columns){NULL, NULL, 2, "1=h,dt=dt"});
    assert_string_equal(n.unit[BR_AXIS_SPACE], "mm");
    assert_string_equal(n.unit[BR_AXIS_TIME], "s");
    assert_string_equal(n.column[BR_AXIS_TIME]->name, "dt");
    assert_int_equal(n.quantities, 2);
    assert_string_equal(n.quantity[0].name, "f(x)");
    assert_string_equal(n.quantity[0].unit, "N/m");
    assert_string_equal(n.quantity[1].name, "a\n\"b\", c");
    assert_null(n.quantity[1].unit);
    assert_true(isnan(n.row[2].number[0])); /* an empty field */
    assert_int_equal(n.row[0].line, 3);     /* the heading has two lines */
}

/* The unit is what stands in the last brackets. */
TEST(test_units_behind_brackets)
{
    OWNED(br_numbers)
    n = read_with(
        "h,u(x) (m),u[y] [m/s],e (max) [mm],v [x] (s)\n1,4,3,4,2\n.5,2,2,2,1\n.25,1,1,1,.5\n",
        &plain);
    static const char *const is[][2] = {
        {"u(x)", "m"}, {"u[y]", "m/s"}, {"e (max)", "mm"}, {"v [x]", "s"}};
    assert_int_equal(n.quantities, 4);
    for (size_t i = 0; i < 4; i++) {
        assert_string_equal(n.quantity[i].name, is[i][0]);
        assert_string_equal(n.quantity[i].unit, is[i][1]);
    }
}

TEST(test_resolutions)
{
    struct columns q = plain;
    q.dimension = 3;
    struct br_numbers n = read_with("dofs,l2\n1000,3\n8000,2\n64000,1\n", &q);
    CLOSE(n.row[2].z[BR_AXIS_SPACE], 0.025, 1e-15);
    br_numbers_clear(&n);
    n = read_with("n,h,l2\n1,.3,3\n2,.15,2\n4,.075,1\n", &plain); /* to a constant factor */
    assert_string_equal(n.column[BR_AXIS_SPACE]->name, "h");
    br_numbers_clear(&n);
    refuse_with(
        "n,h,l2\n1,1,3\n2,.4,2\n4,.25,1\n", &plain,
        "t.csv: the sizes are not clear: h = 1/n gives 0.79; h from column h gives 0.79: --column "
        "n=n, or --column h=h, decides");
    n = read_with("n,l2\n1000,3\n1001,2\n1000000,1\n1000001,1\n", &plain); /* two are two */
    assert_true(n.row[0].z[0] > n.row[1].z[0] && n.row[2].z[0] > n.row[3].z[0]);
    br_numbers_clear(&n);
    /* Round-off in the other axis makes no lines of its own. */
    n = read_with("h,k,l2\n1,.3,3\n.5,.30000000000000004,2\n.25,.3,1\n", &plain);
    CLOSE(n.row[1].z[BR_AXIS_TIME], n.row[0].z[BR_AXIS_TIME], 0);
    br_numbers_clear(&n);
}

TEST(test_lists)
{
    const char *text = "h,l2 rate,l2,drag,cpu\n1,,3,-7,1\n.5,.58,2,-8,1\n.25,1,1,-9,1\n";
    const struct columns q = {"l2", " drag ", 2, NULL};
    struct br_numbers n = read_with(text, &q);
    assert_int_equal(n.quantities, 2);
    assert_string_equal(n.quantity[0].name, "l2");
    assert_true(n.quantity[1].is_value);
    br_numbers_clear(&n);
    /* "l2 rate" is no l2. */
    n = read_with(text, &(struct columns){"l2 rate , cpu", NULL, 2, NULL});
    assert_int_equal(n.quantities, 2);
    assert_string_equal(n.quantity[0].name, "l2 rate");
    br_numbers_clear(&n);
    n = read_with(text, &plain);
    assert_string_equal(n.taken,
                        "h from column h; errors: l2; left aside: l2 rate (a rate); drag "
                        "(both signs: --value, if it is studied); cpu (a cost or an index)");
    assert_int_equal(n.lefts, 3);
    assert_string_equal(n.left[1].what, "drag");
    br_numbers_clear(&n);
    refuse_with(text, &(struct columns){"l3", NULL, 2, NULL},
                "t.csv: --error: there is no column 'l3'");
    refuse_with(text, &(struct columns){NULL, "drag,l3", 2, NULL},
                "t.csv: --value: there is no column 'l3'");
    refuse_with(text, &(struct columns){"l2", "l2", 2, NULL},
                "'l2' is given as an error and as a value");
    refuse_with(text, &(struct columns){"h,l2", NULL, 2, NULL},
                "t.csv: --error: 'h' is a resolution");
    refuse_with(text, &(struct columns){NULL, NULL, 2, "\"\"=h,drag=aside"},
                "--column: found '\"\"=h', expected COLUMN=NAME");
    assert_true(br_lists("a, b ,c d", "c d"));
    assert_false(br_lists("a, b ,c d", "c"));
    assert_false(br_lists(NULL, "c"));
    assert_false(br_lists(",", ""));
    assert_false(br_lists("c", NULL));
    refuse_with("10,4.2e-2\n20,1.1e-2\n40,1.8e-3\n80,1.3e-4\nn,l2\n",
                &(struct columns){NULL, "l2", 2, NULL}, "t.csv");
}

/* Tables as programs write them: the order of one column, and what was taken for what. */
static const struct {
    const char *table, *quantity; /* a file, or a text */
    double order;
    const char *taken, *names;
} foreign[] = {
    {"dealii.txt", "L2", 2,
     "h = cells^(-1/d) from column cells, d = 2; errors: L2, H1; left aside: cycle (a cost or "
     "an index); dofs (another size); column 5, column 6, column 8, column 9 (a rate)",
     NULL},
    {"dealii_org.txt", "L2 error", 2,
     "h = cells^(-1/d) from column cells, d = 2; errors: L2 error; left aside: dofs (another "
     "size); L2 rate (a rate)",
     NULL},
    {"excel_europe.csv", "Fehler", 2, "h from column h; errors: Fehler", NULL},
    {"fenics.txt", "E", 2, "h from column h; errors: E; left aside: r (a rate)", NULL},
    {"fortran.txt", "error", 2, "h = 1/n from column n; errors: error", NULL},
    {"gnuplot.dat", "H1", 1, "h = 1/n from column N; errors: L2, H1", NULL},
    {"latex.tex", "$\\|u-u_h\\|$", 2,
     "h = 1/n from column $N$; errors: $\\|u-u_h\\|$; left aside: rate (a rate)", NULL},
    {"markdown.md", "L2 error", 2,
     "h from column Mesh Size; errors: L2 error; left aside: eoc (a rate)", NULL},
    {"mfem.txt", "H1 error", 1,
     "h = 2^-level from column level; errors: L2 error, H1 error; left aside: time (a cost or "
     "an index)",
     NULL},
    {"moose.csv", "l2_error", 2,
     "h from column h; errors: l2_error; left aside: time (a cost or an index); average (one "
     "number only); number_of_elements (another size)",
     NULL},
    {"pandas.csv", "L2", 2, "h = 1/n from column N; errors: L2; left aside: column 1 (a count)",
     NULL},
    {"pandas.txt", "L2", 2, "h = 1/n from column N; errors: L2; left aside: column 1 (a count)",
     NULL},
    {"steps.csv", "L2", 1, "k from column Dt; errors: L2; left aside: Steps (another size)", NULL},
    {"trixi.txt", "rho_e error", 4,
     "no column of the mesh, and the rates show that h halves from row to row; errors: rho "
     "error, rho_v1 error, rho_e error; left aside: rho EOC, rho_v1 EOC, rho_e EOC (a rate); "
     "line 2 'l2' (title); line 10 'mean      4.00      mean      4.00      mean      4.00' "
     "(summary)",
     NULL},
    /* two columns of rates, and a bar behind the last field */
    {"| cycle | # dofs | L2 | rate | H1 | rate |\n| 0 | 81 | 1.6e-2 | - | 2.56e-1 | - |\n"
     "| 1 | 324 | 4e-3 | 2 | 1.28e-1 | 1 |\n| 2 | 1296 | 1e-3 | 2 | 6.4e-2 | 1 |\n",
     "H1", 1,
     "h = dofs^(-1/d) from column # dofs, d = 2; errors: L2, H1; left aside: cycle (a cost or "
     "an index); rate, rate (a rate)",
     NULL},
    {"| level | e |\n|---|---|\n| 0 | 16 |\n| 1 | 4 |\n| 2 | 1 |\n", "e", 2,
     "h = 2^-level from column level; errors: e", NULL},
    /* titles: another number of fields */
    {"-----\n Errors: 1\n-----\n ref.level     h      || u_h - u ||    rate\n 0  5.0e-01  4e-2  0\n"
     " 1  2.5e-01  1e-2  2.00\n 2  1.25e-01  2.5e-3  2.00\n",
     "|| u_h - u ||", 2,
     "h from column h; errors: || u_h - u ||; left aside: ref.level (another size); rate (a "
     "rate); line 2 'Errors: 1' (title)",
     NULL},
    {"Convergence study, 2026\nh,e\n1,16\n.5,4\n.25,1\n", "e", 2,
     "h from column h; errors: e; left aside: line 1 'Convergence study, 2026' (title)", NULL},
    {"Solving on 3 meshes\nn= 1 e= 16\nn= 2 e= 4\nn= 4 e= 1\n", "e", 2,
     "h = 1/n from column n; errors: e; left aside: line 1 'Solving on 3 meshes' (title)", NULL},
    {"time,dofs,h,e\n0,0,0,0\n1,8,.5,16\n1,16,.25,4\n1,32,.125,1\n", "e", 2,
     "h from column h; errors: e; left aside: time (a cost or an index); dofs (another size); "
     "line 2 (a first row of zeros)",
     NULL},
    {"# 1:h  2:e\n1 16\n.5 4\n.25 1\n", "e", 2, "h from column h; errors: e", NULL},
    {"N | e | rate\n--|---|---\n8 | 16 | -\n16 | 4 | 2\n32 | 1 | 2\n", "e", 2,
     "h = 1/n from column N; errors: e; left aside: rate (a rate)", NULL},
    {"┌───┬────┐\n│ h │ e  │\n├───┼────┤\n│ 1 │ 16 │\n│.5 │ 4  │\n│.25│ 1  │\n└───┴────┘\n", "e", 2,
     "h from column h; errors: e", NULL},
    {"$h$ & $e$ \\\\\n$1$ & $1.6\\times 10^{-1}$ \\\\\n$0.5$ & $4\\cdot 10^{-2}$ \\\\\n"
     "$0.25$ & $10^{-2}$ \\\\\n",
     "$e$", 2, "h from column $h$; errors: $e$", NULL},
    {"h;e\n1/8;0,16\n1/16;4 %\n1/32;1%\n", "e", 2, "h from column h; errors: e", NULL},
    {"dt,e\n2^-3,1.6\n2^-4,.4\n2^-5,.1\n", "e", 2, "k from column dt; errors: e", NULL},
    {"\"n\",\"e\"\n\"8\",\"1,6\"\n\"16\",\"0,4\"\n\"32\",\"0,1\"\n", "e", 2,
     "h = 1/n from column n; errors: e", NULL},
    {"p,resolution,e\n1,8,1.6\n2,16,.4\n3,32,.1\n", "e", 2,
     "h = 1/n from column resolution; errors: e; left aside: p (a degree)", NULL},
    {"1/h,e\n4,1.6\n8,.4\n16,.1\n", "e", 2, "h = 1/n from column 1/h; errors: e", NULL},
    {"Time step size,e\n4,16\n2,4\n1,1\n", "e", 2, "k from column Time step size; errors: e", NULL},
    /* frames of Julia, polars and R, with types; an index of R */
    {"Row \u2502 N      L2\n     \u2502 Int64  Float64\n\u2500\u2500\u253c\u2500\u2500\n"
     "   1 \u2502     8  1.6\n   2 \u2502    16  0.4\n   3 \u2502    32  0.1\n",
     "L2", 2, "h = 1/n from column N; errors: L2; left aside: Row (a cost or an index)", NULL},
    {"shape: (3, 3)\n\u250c\u2500\u252c\u2500\u2510\n\u2502 h \u2506 l2 \u2506 h1 \u2502\n"
     "\u2502 --- \u2506 --- \u2506 --- \u2502\n"
     "\u2502 f64 \u2506 f64 \u2506 f64 \u2502\n"
     "\u2502 1 \u2506 1.6 \u2506 4 \u2502\n\u2502 .5 \u2506 .4 \u2506 2 \u2502\n"
     "\u2502 .25 \u2506 .1 \u2506 1 \u2502\n",
     "h1", 1, "h from column h; errors: l2, h1; left aside: line 1 'shape: (3, 3)' (title)", NULL},
    {"# A tibble: 3 x 2\n     h    l2\n <dbl> <dbl>\n1 1 1.6\n2 .5 .4\n3 .25 .1\n", "l2", 2,
     "h from column h; errors: l2; left aside: column 1 (a count)", NULL},
    /* a title above a heading that is a comment; sizes of three digits beside a level */
    {"Table: Error\n  #Level  h  ||u-u_h||\n\n 0 3.12e-2 1.6\n 1 1.56e-2 .4\n 2 7.81e-3 .1\n",
     "||u-u_h||", 2,
     "h from column h; errors: ||u-u_h||; left aside: Level (another size); line 1 'Table: "
     "Error' (title)",
     NULL},
    /* brackets that are no units */
    {"h [m],L2(u) [m],L2(v),L2(p)\n1,4,1.6,4\n.5,2,.4,2\n.25,1,.1,1\n", "L2(v)", 2,
     "h from column h; errors: L2(u), L2(v), L2(p)", NULL},
    /* named by hand */
    {"Elemente;Gitterweite;Fehler\n8;0,125;1,6\n16;0,0625;0,4\n32;0,03125;0,1\n", "Fehler", 2,
     "h from column Gitterweite; errors: Fehler; left aside: Elemente (a count)", "Gitterweite=h"},
    {"8 1.6\n16 .4\n32 .1\n", "l2", 2, "h = 1/n from column 1; errors: l2", "1=n, 2=l2"},
    {"# name: A\n# rows: 3\n# columns: 2\n 1 16\n .5 4\n .25 1\n", "2", 2,
     "h from column 1; errors: 2", "1=h"},
    {"mesh,e\n8x8,1.6\n16x16,.4\n32\xc3\x97"
     "32,.1\n",
     "e", 2, "h = 1/n from column mesh; errors: e", "mesh=n"},
    {"h,cells,order,e\n1,8,1.6,4\n1,32,.4,2\n1,128,.1,1\n", "order", 1,
     "h = 1/n from column cells; errors: order, e; left aside: h (one number only)",
     "cells=n,order=order"},
    {"h,L2=u-u_h\n1,1.6\n.5,.4\n.25,.1\n", "e", 2, "h from column h; errors: e", "L2=u-u_h=e"},
};

TEST(test_foreign_tables)
{
    for (size_t i = 0; i < sizeof foreign / sizeof *foreign; i++) {
        char path[200];
        FREED char *text = NULL;
        OWNED(br_orders) o;
        const bool is_file = !strchr(foreign[i].table, '\n');
        snprintf(path, sizeof path, "%s/tests/data/tables/%s", getenv("BEAMRATE_DATA"),
                 is_file ? foreign[i].table : "");
        if (is_file)
            MUST(br_text_load(path, BR_LONGEST_TABLE, "table", &text, &err));
        OWNED(br_numbers)
        n = read_with(is_file ? text : foreign[i].table,
                      foreign[i].names ? &(struct columns){NULL, NULL, 2, foreign[i].names}
                                       : &plain);
        assert_string_equal(n.taken, foreign[i].taken);
        assert_true(n.assumed == !!strstr(n.taken, "assumed"));
        MUST(br_orders_find(&n, 2, &o, &err));
        const struct br_estimate *order = NULL;
        for (size_t q = 0; q < o.count; q++)
            if (strcmp(n.quantity[q].name, foreign[i].quantity) == 0)
                order = &o.of[q].line[0].observed.order;
        if (!order || !(fabs(order->value - foreign[i].order) <= 0.02))
            fail_msg("%s: %s: order %g, expected %g", foreign[i].table, foreign[i].quantity,
                     order ? order->value : (double)NAN, foreign[i].order);
    }
}

/* A level halves h; words of time are no errors unless they are asked for; cells stand for n, which
 * is an assumption. */
TEST(test_headings)
{
    struct br_numbers n =
        read_with("Refinement,cells,CPU time,L2\n0,8,1,3\n1,32,2,2\n2,128,4,1\n", &plain);
    assert_int_equal(n.quantities, 1);
    CLOSE(n.row[2].z[BR_AXIS_SPACE], 0.25, 0);
    assert_false(n.assumed);
    br_numbers_clear(&n);
    n = read_with("\"h\",\"a;b\n| c = 2x\"\n1,3\n.5,2\n.25,1\n", &plain); /* a comma separates */
    assert_string_equal(n.quantity[0].name, "a;b\n| c = 2x");
    br_numbers_clear(&n);
    const char *cells = "Elements,CPU time\n8,1\n64,2\n512,4\n";
    n = read_with(cells, &(struct columns){"CPU time", NULL, 3, NULL});
    assert_string_equal(n.quantity[0].name, "CPU time");
    CLOSE(n.row[2].z[BR_AXIS_SPACE], 0.125, 1e-15);
    assert_false(n.assumed);
    br_numbers_clear(&n);
    n = read_with(cells, &(struct columns){"CPU time", NULL, 3, "1=cells"});
    CLOSE(n.row[2].z[BR_AXIS_SPACE], 0.125, 1e-15); /* they grow by 8 */
    assert_true(n.assumed && n.dimension == 3);
    br_numbers_clear(&n);
    refuse_with("N,e\n10,9\n100,3\n1000,1\n", &(struct columns){NULL, NULL, 3, NULL},
                "--dimension: found no numbers of unknowns or cells among N, e;");
}

/* No verdict on a mesh whose dimension nobody stated. */
TEST(test_assumed_dimension)
{
    struct br_order_expectation e = {
        .quantity = "e", .axis = BR_AXIS_SPACE, .band = {.order = 2, .tolerance = 0.1}};
    struct br_orders_request q = {.path = (char *)"t.csv",
                                  .table = (char *)"dofs,e\n8,16\n64,4\n512,1\n",
                                  .expectation = &e,
                                  .expectations = 1,
                                  .dimension = 3,
                                  .assumed_dimension = true};
    struct br_numbers n;
    REFUSED(br_orders_read(&q, &n, &err), BR_BAD_INPUT, "state the dimension of the mesh");
    br_numbers_clear(&n);
    q.assumed_dimension = false;
    MUST(br_orders_read(&q, &n, &err));
    br_numbers_clear(&n);
    strcpy(e.quantity, "l");
    REFUSED(br_orders_read(&q, &n, &err), BR_BAD_INPUT,
            "t.csv: what is expected: there is no column 'l', expected one of: e");
    br_numbers_clear(&n);
    struct br_order_expectation twice[] = {e, e};
    strcpy(twice[0].quantity, "E");
    strcpy(twice[1].quantity, "");
    twice[1].axis = BR_AXES;
    q.expectation = twice;
    q.expectations = 2;
    REFUSED(br_orders_read(&q, &n, &err), BR_BAD_INPUT, "the order of e in h is given twice");
    br_numbers_clear(&n);
}

static void refuse_table(char *row)
{
    const char *message = br_test_part(row);
    refuse_with(br_test_unescape(row), &plain, message);
}

TEST(test_refused_tables)
{
    br_test_rows("tables of numbers", refuse_table);
}

/* The orders of the quantities, "l2 2.00, h1 1.00", and what is read. */
static void describe(const struct br_numbers *n, char text[2000])
{
    OWNED(br_orders) o;
    size_t used = 0;
    MUST(br_orders_find(n, 2, &o, &err));
    for (size_t i = 0; i < o.count; i++)
        used += (size_t)snprintf(text + used, 2000 - used, "%s%s %.2f", i ? ", " : "",
                                 n->quantity[i].name, o.of[i].line->observed.order.value);
    snprintf(text + used, 2000 - used, "; %s", n->taken);
}

/* Three tables of each kind that was read wrongly once: a text, what is said by hand, and what is
 * read, or why it is not. */
static void read_kind(char *row)
{
    static const char refused[] = "refused: ", where[] = "where ", value[] = "value ";
    char *by_hand = br_test_part(row);
    const char *expected = br_test_part(by_hand);
    const bool chooses = strncmp(by_hand, where, strlen(where)) == 0;
    struct br_orders_request q = br_orders_request_default();
    q.path = (char *)"t.csv";
    q.table = br_test_unescape(row);
    if (chooses)
        q.where = by_hand + strlen(where);
    else if (strncmp(by_hand, value, strlen(value)) == 0)
        q.values = by_hand + strlen(value);
    else if (strcmp(by_hand, "-") != 0)
        q.columns = by_hand;
    OWNED(br_numbers) n;
    if (strncmp(expected, refused, strlen(refused)) == 0)
        REFUSED(br_orders_read(&q, &n, &err), BR_BAD_INPUT, expected + strlen(refused));
    else {
        char found[2000];
        MUST(br_orders_read(&q, &n, &err));
        describe(&n, found);
        assert_int_equal(n.assumed, strstr(found, " assumed") && strstr(found, "^(-1/d) from"));
        if (strncmp(found, expected, strlen(expected)) != 0)
            fail_msg("found '%s', expected '%s'", found, expected);
    }
}

/* Errors over a degree have no order; each degree divides them by a factor. */
TEST(test_degrees)
{
    struct br_orders_request q = br_orders_request_default();
    struct br_numbers n;
    struct br_orders o;
    q.path = (char *)"t.csv";
    q.table = (char *)"degree,e\n0,8e-1\n1,1.01e-1\n2,1.25e-2\n3,1.56e-3\n4,1.96e-4\n5,2.44e-5\n";
    MUST(br_orders_read(&q, &n, &err));
    MUST(br_orders_find(&n, 0, &o, &err));
    const struct br_estimate factor = o.of[0].line[0].observed.factor;
    assert_true(factor.low > 7.8 && factor.low < 8 && factor.high > 8 && factor.high < 8.2);
    assert_true(isnan(o.of[0].answer[BR_AXIS_SPACE].order.value));
    br_orders_clear(&o);
    br_numbers_clear(&n);
    static const char *const few[] = {"p,e\n1,.1\n2,.01\n3,.001\n4,.0001\n",
                                      "p,e\n2,.1\n4,.001\n6,.00001\n",
                                      "p,e\n1,.1\n2,.01\n3,.001\n4,1e-4\n5,1e-5\n6,1e-6\n"};
    for (size_t i = 0; i < sizeof few / sizeof *few; i++) {
        FREED char *text = strdup(few[i]);
        struct br_orders_request r = {.path = q.path, .table = text};
        MUST(br_orders_read(&r, &n, &err));
        MUST(br_orders_find(&n, 0, &o, &err));
        const struct br_estimate digits = o.of[0].line[0].observed.factor;
        assert_true(digits.low > 3 && digits.low < 9.5 && digits.high > 10.5 && digits.high < 25);
        br_orders_clear(&o);
        br_numbers_clear(&n);
    }
    static const char *const powers[] = {
        "p,e\n1,5\n2,.1\n3,.01\n4,.001\n5,1e-4\n6,1e-5\n7,1e-6\n",  /* the first is none */
        "p,e\n1,1\n2,.0625\n3,.0123\n4,.0039\n5,.0016\n6,.00077\n", /* p^-4 */
        "p,e\n1,6.25e-2\n2,1.2346e-2\n3,3.9063e-3\n4,1.6e-3\n5,7.716e-4\n6,4.1649e-4\n"
        "7,2.4414e-4\n8,1.5242e-4\n"}; /* (p + 1)^-4 */
    for (size_t i = 0; i < sizeof powers / sizeof *powers; i++) {
        FREED char *text = strdup(powers[i]);
        struct br_orders_request r = {.path = q.path, .table = text};
        MUST(br_orders_read(&r, &n, &err));
        MUST(br_orders_find(&n, 0, &o, &err));
        assert_true(isnan(o.of[0].line[0].observed.factor.value));
        br_orders_clear(&o);
        br_numbers_clear(&n);
    }
    q.table = (char *)"p,drag\n1,1.5\n2,1.25\n3,1.125\n4,1.0625\n5,1.03125\n";
    q.values = (char *)"drag"; /* values over it have a limit, but no order and no index */
    MUST(br_orders_read(&q, &n, &err));
    MUST(br_orders_find(&n, 0, &o, &err));
    assert_true(o.of[0].limit.value.low < 1 && o.of[0].limit.value.high > 1);
    assert_true(isnan(o.of[0].line[0].limits.gci.order) && o.of[0].line[0].limits.triples == 0);
    br_orders_clear(&o);
    br_numbers_clear(&n);
    q.values = NULL;
    q.table = (char *)"degree,e\n0,8e-1\n1,1.01e-1\n2,1.25e-2\n3,1.56e-3\n4,1.96e-4\n";
    MUST(br_expectations_read("e: h exponential 8 +- 0.5", 0, &q.expectation, &q.expectations,
                              &err));
    MUST(br_orders_read(&q, &n, &err));
    br_numbers_clear(&n);
    q.expectation[0].band.exponential = false;
    REFUSED(br_orders_read(&q, &n, &err), BR_BAD_INPUT, "errors over a degree have none");
    br_numbers_clear(&n);
    free(q.expectation);
}

/* Percent of a column in percent is as many, of one without a unit a hundredth. */
TEST(test_percent)
{
    struct br_orders_request q = br_orders_request_default();
    struct br_numbers n;
    q.path = (char *)"t.csv";
    for (int i = 0; i < 2; i++) {
        q.table =
            (char *)(i ? "n,e [%]\n8,4 %\n16,1 %\n32,.25 %\n" : "n,e\n8,4 %\n16,1 %\n32,.25 %\n");
        MUST(br_orders_read(&q, &n, &err));
        CLOSE(n.row[1].number[0], i ? 1 : 0.01, 1e-15);
        br_numbers_clear(&n);
    }
}

TEST(test_kinds_of_tables)
{
    br_test_rows("kinds of tables", read_kind);
}

/* A heading of columns n, a, a0, a1, ... and rows 1, 2, ... that are refused or taken. */
static const char *wide_table(int columns, int rows)
{
    static char text[1 << 20];
    size_t used = 0;
    for (int row = 0; row <= rows; row++)
        for (int i = 0; i < columns; i++) {
            const char *const end = i + 1 < columns ? "," : "\n";
            char field[16];
            snprintf(field, sizeof field, row || i > 1 ? "%s%d" : "%s",
                     row ? ""
                     : i ? "a"
                         : "n",
                     row ? i ? 1 : row : i);
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s", field, end);
        }
    return text;
}

/* Each is refused at its limit, with its line; the rows below are not read. */
TEST(test_large_tables)
{
    refuse_with(wide_table(1001, 0), &plain, "t.csv:1: found more than 1000 columns");
    refuse_with(wide_table(1000, 42), &plain,
                "t.csv:42: found row 41 of 1000 fields, expected at most 40000 fields in all");
    refuse_with(wide_table(2, 10002), &plain, "t.csv:10002: found row 10001, expected");
    const struct columns of_a = {"a", NULL, 2, NULL};
    refuse_with(wide_table(2, 1001), &of_a, "t.csv: found 1001 sizes of h, expected at");
    struct br_numbers n = read_with(wide_table(40, 1000), &of_a);
    assert_int_equal(n.lefts, 38);
    br_numbers_clear(&n);
    n = (struct br_numbers){0}; /* as the library makes them */
    REFUSED(br_numbers_make_room(&n, 10001, 1, &err), BR_BAD_INPUT,
            "found 10001 rows, expected at most 10000");
}
