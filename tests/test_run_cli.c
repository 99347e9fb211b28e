/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `beamrate run` as a user meets it; what it prints of sound runs is in golden/. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tables/fields_file.h"
#include "tests/cli_driver.h"
#include "tests/support.h"

#define SCENE                                                     \
    "title: a rod\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\n" \
    "axial:\n  stiffness: 100 N\n  viscosity: 1 N s\n  load: 10*t [N/m]\n"

/* One JSON value by its path, "a.b.c". */
static const json_t *look_up(const json_t *value, const char *path)
{
    char text[128];
    snprintf(text, sizeof text, "%s", path);
    for (char *key = strtok(text, "."); key; key = strtok(NULL, ".")) {
        value = json_object_get(value, key);
        if (!value)
            fail_msg("no '%s' in the JSON", path);
    }
    return value;
}

static size_t count_lines(const char *name)
{
    char path[512];
    cli_path(name, path);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    size_t lines = 0;
    for (int c; (c = fgetc(file)) != EOF;)
        lines += c == '\n';
    fclose(file);
    return lines;
}

/* History, summaries, a page and the fields, which HDF5 has in two files. */
static int files_of_run(void)
{
    return strcmp(br_fields_formats[0]->name, "hdf5") == 0 ? 6 : 5;
}

static void test_files(void **state)
{
    (void)state;
    const char *fields = br_fields_formats[0]->file_name;
    char name[64];
    cli_expect("run example2 --n 10 --k 0.01 --at 0.5,0,1 --out f --quiet", NULL, 0, "");
    assert_int_equal(cli_count_files("f"), files_of_run());
    assert_int_equal(count_lines("f/history.csv"), 102);
    assert_true(cli_file_contains(
        "f/history.csv", "step,t,u,w,u_t,w_t,contact_force,friction_force,friction_bound\n0,0,"));
    snprintf(name, sizeof name, "f/%s", fields);
    assert_true(cli_is_there(name));
    assert_true(cli_file_contains("f/summary.txt", "Example 2"));
    assert_true(cli_file_contains("f/summary.json", "\"beamrate run\""));
    cli_expect("run example2 --n 10 --k 0.01 --rows 11 --every 0.1 --out f --quiet", NULL, 0, "");
    assert_int_equal(cli_count_files("f"), files_of_run());
    assert_int_equal(count_lines("f/history.csv"), 12);
    if (strcmp(br_fields_formats[0]->name, "csv") == 0)
        assert_int_equal(count_lines("f/fields.csv"), 1 + 11 * 11);
    /* what is not modelled is empty, not zero */
    cli_expect("run example3 --n 10 --k 0.01 --out h --quiet", NULL, 0, "");
    assert_true(cli_file_contains("h/history.csv", "\n0,0,,0,,0,,,3000\n1,0.01"));
    /* a disk that is full leaves nothing behind */
    const struct cli_circumstances full = {.file_size = 2000};
    cli_expect("run example2 --n 1000 --k 0.01 --out g --quiet", &full, 3, "beamrate: ");
    assert_false(cli_is_there("g"));
}

/* Of quadratic elements the fields have the middles, of others not. */
static void test_middles(void **state)
{
    (void)state;
    enum { N = 3, NODES = N + 1 };
    struct br_scene scene = br_test_bare();
    struct br_method method = br_method_default();
    scene.axial.displacement = br_test_function("x*(2 - x)");
    scene.axial.velocity = br_test_function("x^2");
    assert_int_equal(br_field_variable_count(1), 6);
    assert_int_equal(br_field_variable_count(2), 8);
    for (int degree = 1; degree <= 2; degree++) {
        double values[BR_FIELD_VARIABLES * NODES], work[4 * NODES];
        method.axial_degree = degree;
        struct br_march *march = br_test_march(&scene, N, 1, &method);
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
        br_march_free(march);
    }
    br_scene_clear(&scene);
    cli_expect("run initial_data --n 4 --k 0.1 --axial-degree 2 --out q --check --quiet", NULL, 0,
               "");
    assert_true(cli_file_contains("q/summary.txt", "8 unknowns, P2 elements"));
    cli_expect("run initial_data --axial-degree 2 --solver banded", NULL, 2,
               "solver 'banded' has no quadratic axial elements, expected one of riccati, plain");
}

/* The rows that were made are kept, and the last line says why there are no more. */
static void test_blow_up(void **state)
{
    (void)state;
    cli_write_file("pole.yaml", SCENE "  tip_force: 1/(0.50005 - t)/(t < 0.50005) [N]\n");
    cli_write_file("big.yaml", "title: b\nlength: 1 m\nduration: 1 s\ndensity: 1e-9 kg/m\n"
                               "axial:\n  stiffness: 1e-5 N\n  viscosity: 0 N s\n"
                               "  load: 1e148*t [N/m]\n");
    cli_expect("run big.yaml --n 10 --out b", NULL, 3, "the march blew up at t = ");
    assert_true(cli_file_contains("b/history.csv", "\n# stopped: the march blew up at t = "));
    assert_true(cli_file_contains("b/summary.json", "\"stopped\": \"the march blew up"));
    assert_true(cli_file_contains("b/summary.txt", "STOPPED: the march blew up"));
    assert_int_equal(cli_count_files("b"), files_of_run());
    cli_write_file("tiny.yaml", "title: t\nlength: 1 m\nduration: 1 s\ndensity: 1e-9 kg/m\n"
                                "axial:\n  stiffness: 1e300 N\n  viscosity: 0 N s\n"
                                "  load: 1e-20*t [N/m]\n");
    cli_expect("run tiny.yaml --n 10 --out u", NULL, 3, "the axial motion is lost to underflow");
    assert_true(cli_file_contains("u/summary.json", "\"stopped\": \"the axial motion is lost to"));
    cli_expect("run pole.yaml", NULL, 2, "pole.yaml:9: tip_force: found -inf at t = 1 s");
    /* for a short time only */
    cli_write_file("thin.yaml", SCENE "  tip_force: 1 + sqrt(abs(t - 0.70065) - 3e-9) [N]\n");
    cli_expect("run thin.yaml --n 10 --k 1e-4 --out t", NULL, 2,
               "thin.yaml:9: tip_force: found nan at t = 0.70064999");
}

/* Before it marches, on standard error; then in the summaries. */
static void test_warnings(void **state)
{
    (void)state;
    static struct cli_outcome out;
    const struct cli_circumstances apart = {.errors = "errors.txt"};
    cli_run_line("run example4 --n 100 --k 1 --out warned --json warned.json", &apart, &out);
    assert_int_equal(out.exit_code, 0);
    assert_true(cli_file_contains("errors.txt", "beamrate: warning: the predicted discretisation "
                                                "error at n = 100, k = 1 s, relative to the "
                                                "solution, is 0."));
    assert_true(cli_file_contains("errors.txt", "; remedy:\n    --k T/"));
    assert_null(strstr(out.output, "Warning: ")); /* it stands once */
    assert_true(cli_file_contains("warned/summary.txt", "Warning: the predicted discretisation"));
    assert_true(cli_file_contains("warned/summary.txt", "\nRemedy:\n  --k T/"));
    json_t *root = json_loads(cli_read("warned.json"), 0, NULL);
    const json_t *list = look_up(root, "tables.warnings");
    const char *last = "";
    for (size_t i = 0; i < json_array_size(list); i++)
        last = json_string_value(json_object_get(json_array_get(list, i), "warning"));
    assert_string_equal(last, "inaccurate");
    const json_t *p = json_object_get(root, "prediction");
    assert_true(json_is_true(json_object_get(p, "known")));
    const json_t *whole = json_object_get(p, "discretisation");
    AT_MOST(0.05, json_real_value(json_object_get(whole, "error")));
    const json_t *axial = json_object_get(p, "axial");
    AT_MOST(json_real_value(json_object_get(axial, "error")),
            json_real_value(json_object_get(axial, "most")));
    /* It may be as large as the solution. */
    assert_true(json_is_null(json_object_get(json_object_get(p, "bending"), "most")));
    json_decref(root);

    cli_run_line("run example2 --n 3200 --k 0.001 --solver banded", &apart, &out);
    assert_int_equal(out.exit_code, 0);
    assert_true(cli_file_contains("errors.txt", "round-off of --solver banded at n = 3200"));
    assert_true(cli_file_contains("errors.txt", "\n    --solver auto  # "));
    cli_run_line("run example2", &apart, &out);
    assert_int_equal(out.exit_code, 0);
    assert_false(cli_file_contains("errors.txt", "warning"));
    assert_non_null(strstr(out.output, "\ndiscretisation error: 0.0014, between "));
    assert_non_null(strstr(out.output, "\nround-off: 2.0e-12\n"));
}

static void test_interrupt(void **state)
{
    (void)state;
    const struct cli_circumstances soon = {.interrupt_after = 300};
    static struct cli_outcome out;
    cli_run_line("run example2 --n 1000 --k 1e-6 --out i --quiet", &soon, &out);
    assert_int_equal(out.exit_code, -2);
    assert_false(cli_is_there("i"));
}

/* A lagged contact that will be unstable is warned of before the march, with what is within its
 * limit; marched like that, nothing is said. */
static void test_contact_limit(void **state)
{
    (void)state;
    static const char stiff[] = SCENE "contact:\n  gap: 0 m\n"
                                      "  stiffness: 5e4 N/m\n";
    static const char *const lines[] = {
        "run stiff.yaml --n 4 --k 0.1 --quiet",
        "study stiff.yaml --n 2,4 --k 0.1,0.05 --reference none --no-plots --quiet",
        "trade stiff.yaml --methods euler+lagged --n 4 --k 0.1 --no-plots --quiet --out tr",
    };
    static struct cli_outcome out;
    cli_write_file("stiff.yaml", stiff);
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        cli_expect(lines[i], NULL, 0, "the lagged contact is beyond its stability limit");
        cli_expect(lines[i], NULL, 0,
                   "; remedy:\n    --contact implicit  # has no limit\n    --k T/");
    }
    cli_expect("run stiff.yaml --n 4 --k 0.1 --quiet --json unknown.json", NULL, 0,
               "the discretisation error at n = 4, k = 0.1 s is not known: the lagged contact is "
               "beyond its stability limit");
    json_t *root = json_loads(cli_read("unknown.json"), 0, NULL);
    const json_t *p = json_object_get(root, "prediction");
    assert_false(json_is_true(json_object_get(p, "known")));
    assert_non_null(strstr(json_string_value(json_object_get(p, "why_not")), "stability limit"));
    json_decref(root);
    cli_run_line(lines[0], NULL, &out);
    const char *k = strstr(out.output, "--k ");
    assert_non_null(k);
    char line[128];
    snprintf(line, sizeof line, "run stiff.yaml --n 4 --quiet %.*s", (int)strcspn(k, "#\n"), k);
    cli_run_line(line, NULL, &out);
    assert_int_equal(out.exit_code, 0);
    assert_null(strstr(out.output, "stability limit"));
    cli_run_line("run stiff.yaml --n 4 --k 0.1 --contact implicit --quiet", NULL, &out);
    assert_null(strstr(out.output, "stability limit"));
}

/* What is left of a sticking tip's velocity is round-off: people see 0, programs what it is. */
static void test_tip_at_rest(void **state)
{
    (void)state;
    cli_expect("run example4 --n 10 --k 0.1 --out s --quiet", NULL, 0, "");
    assert_true(cli_file_contains("s/summary.txt", "velocity, bending: 0 m/s\n"));
    assert_false(cli_file_contains("s/summary.txt", "velocity, axial: 0 m/s"));
    assert_true(cli_file_contains("s/summary.json", "e-15"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_files),       cmocka_unit_test(test_middles),
        cmocka_unit_test(test_blow_up),     cmocka_unit_test(test_interrupt),
        cmocka_unit_test(test_warnings),    cmocka_unit_test(test_contact_limit),
        cmocka_unit_test(test_tip_at_rest),
    };
    return cmocka_run_group_tests(tests, cli_make_folder, cli_remove_folder);
}
