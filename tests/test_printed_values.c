/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fields of a run, in CSV, are what was marched. That XDMF has the same is tested by
 * fields_xdmf.py; what the reports of all commands print is compared to the byte in golden/. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "study/run/run.h"
#include "tables/beam/fields_file.h"
#include "tables/beam/reports.h"
#include "tests/support.h"

/* As it is printed: with six digits at least. */
static void is(const char *where, const char *key, double found, double expected)
{
    if (isnan(expected) ? !isnan(found) : !(fabs(found - expected) <= 1e-5 * fabs(expected)))
        fail_msg("%s: %s is %.17g, expected %.17g", where, key, found, expected);
}

/* ---- run ---- */

enum { ELEMENTS = 4, STEPS = 8, LOOKS = 3 };
static const size_t levels[LOOKS] = {1, 5, 8};

/* A march of example2, what it has told, and the files that were written meanwhile. */
struct watched {
    char folder[32];
    struct br_scene scene;
    struct br_history_record record;
    struct br_fields_file fields;
    struct br_run_report report;
};

static enum br_status write_fields(void *self, const struct br_march *march,
                                   const struct br_history_row *row, struct br_error *why)
{
    struct watched *w = self;
    (void)why;
    br_fields_add(&w->fields, march, row);
    return BR_OK;
}

static void path_of(const struct watched *w, const char *name, char path[64])
{
    snprintf(path, 64, "%s/%s", w->folder, name);
}

/* A file of CSV, which must begin with that heading. */
static FILE *open_csv(const struct watched *w, const char *name, const char *heading)
{
    char path[64], line[256] = "";
    path_of(w, name, path);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(line, sizeof line, file));
    assert_string_equal(line, heading);
    return file;
}

/* The next line has these numbers, and no more. */
static void has_row(FILE *file, const char *name, const double *expected, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        double found = NAN; /* an empty field is no number */
        char column[32];
        snprintf(column, sizeof column, "column %zu", i);
        if (!isnan(expected[i]))
            assert_int_equal(fscanf(file, "%lf", &found), 1);
        assert_int_equal(getc(file), i + 1 < count ? ',' : '\n');
        is(name, column, found, expected[i]);
    }
}

/* What the test program does as the command does it: rows and fields go to files as they come. */
static void march_and_write(struct watched *w)
{
    const struct br_provenance provenance = {
        .version = "1", .commit = "c", .command_line = "beamrate run", .scene_text = "title: a\n"};
    char path[64];
    const struct br_history_observer output[] = {
        br_history_recorder(&w->record, ELEMENTS),
        {.self = w, .sample = write_fields},
    };
    const struct br_run_request request = {.scene = &w->scene,
                                           .wanted = 3,
                                           .method = br_test_method(NULL, NULL, NULL),
                                           .n = ELEMENTS,
                                           .steps = STEPS,
                                           .stride = 1,
                                           .level = levels,
                                           .levels = LOOKS,
                                           .check = true,
                                           .energies = true,
                                           .output = output,
                                           .outputs = 2};
    path_of(w, "fields.csv", path);
    FILE *csv = fopen(path, "w"), *xdmf = tmpfile();
    assert_true(csv && xdmf);
    w->fields = (struct br_fields_file){csv, xdmf, &w->scene, ELEMENTS, .axial_degree = 1};
    MUST(br_fields_begin(&w->fields, &provenance, &err));
    MUST(br_run(&request, &w->report, &err));
    br_fields_end(&w->fields, NULL);
    assert_int_equal(fclose(csv) | fclose(xdmf), 0);
}

static int set_up(void **state)
{
    static struct watched w;
    w = (struct watched){.folder = "/tmp/br_printed_XXXXXX", .scene = br_test_bundled("example2")};
    assert_non_null(mkdtemp(w.folder));
    march_and_write(&w);
    *state = &w;
    return 0;
}

static int tear_down(void **state)
{
    struct watched *w = *state;
    char command[64];
    snprintf(command, sizeof command, "rm -r '%s'", w->folder);
    br_history_record_clear(&w->record);
    br_scene_clear(&w->scene);
    return system(command);
}

/* What a variable of the fields is at a node, of the march's own nodal values. */
static double field_value(const struct watched *w, size_t look, size_t node, const char *name)
{
    const double h = w->scene.length / ELEMENTS;
    const enum br_field_kind kind = name[0] == 'u' ? BR_AXIAL : BR_BENDING;
    const bool slope = strstr(name, "slope") != NULL;
    const double *value = br_history_field(&w->record, look, kind, strstr(name, "_t") != NULL);
    return kind == BR_AXIAL ? value[node] : slope ? value[2 * node + 1] / h : value[2 * node];
}

/* The rows' tip is that of the fields. */
TEST(tip_is_the_last_node)
{
    const struct watched *w = *fixture;
    for (size_t look = 0; look < LOOKS; look++) {
        const struct br_history_row *row = &w->record.row[levels[look]];
        is("row", "u", row->displacement[BR_AXIAL], field_value(w, look, ELEMENTS, "u"));
        is("row", "u_t", row->velocity[BR_AXIAL], field_value(w, look, ELEMENTS, "u_t"));
        is("row", "w", row->displacement[BR_BENDING], field_value(w, look, ELEMENTS, "w"));
        is("row", "w_t", row->velocity[BR_BENDING], field_value(w, look, ELEMENTS, "w_t"));
    }
}

TEST(fields_are_printed)
{
    const struct watched *w = *fixture;
    FILE *file = open_csv(w, "fields.csv", "t,x,u,u_t,w,w_slope,w_t,w_t_slope\n");
    for (size_t look = 0; look < LOOKS; look++)
        for (size_t node = 0; node <= ELEMENTS; node++) {
            double expected[2 + BR_FIELD_VARIABLES] = {(double)levels[look] / STEPS,
                                                       w->scene.length * (double)node / ELEMENTS};
            for (size_t v = 0; v < br_field_variable_count(1); v++)
                expected[2 + v] = field_value(w, look, node, br_field_variables[v].name);
            has_row(file, "fields.csv", expected, 2 + br_field_variable_count(1));
        }
    fclose(file);
}

/* Of quadratic elements the fields have the middles, of others not. */
TEST(middles_are_fields)
{
    enum { N = 3, NODES = N + 1 };
    OWNED(br_scene) scene = br_test_bare();
    struct br_method method = br_method_default();
    scene.axial.displacement = br_test_function("x*(2 - x)");
    scene.axial.velocity = br_test_function("x^2");
    assert_int_equal(br_field_variable_count(1), 6);
    assert_int_equal(br_field_variable_count(2), 8);
    for (int degree = 1; degree <= 2; degree++) {
        double values[BR_FIELD_VARIABLES * NODES], work[4 * NODES];
        method.axial_degree = degree;
        OWNED(br_march) *march = br_test_march(&scene, N, 1, &method);
        br_field_values(march, values, work);
        for (size_t i = 1; i < NODES; i++) {
            const double x = (double)i / N, middle = x - 0.5 / N;
            CLOSE(values[i], x * (2 - x), 1e-15);
            CLOSE(values[NODES + i], x * x, 1e-15);
            if (degree == 2) {
                CLOSE(values[6 * NODES + i], middle * (2 - middle), 1e-15);
                CLOSE(values[7 * NODES + i], middle * middle, 1e-15);
            }
        }
        assert_true(degree == 1 || isnan(values[6 * NODES]));
    }
}

AROUND_TESTS(set_up, tear_down)
