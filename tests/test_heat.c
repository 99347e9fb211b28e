/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Heat maps: the data are those of the cells, and gnuplot draws the script. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "plots/heat.h"
#include "plots/plots.h"
#include "support.h"

static struct br_heat heat;

/* 3 cells by 2, of unequal size; a line with a gap. */
static void fill_panel(struct br_heat_panel *p)
{
    struct br_error err = {0};
    static const double x[] = {1, 10, 1000, 1e4}, y[] = {1e-4, 1e-2, 1};
    static const double value[] = {1e-3, 2, INFINITY, 0, NAN, 1e5};
    assert_int_equal(br_heat_panel_init(p, 3, 2, &err), BR_OK);
    for (size_t i = 0; i < 6; i++)
        assert_true(isnan(p->value[i]));
    memcpy(p->x, x, sizeof x);
    memcpy(p->y, y, sizeof y);
    memcpy(p->value, value, sizeof value);
    p->log_x = p->log_y = true;
    snprintf(p->title, sizeof p->title, "it's {/:Italic n}");
    double(*point)[2] = br_heat_line(p, 3, "limit of %s", "it");
    assert_non_null(point);
    point[0][0] = 1, point[0][1] = 1e-4;
    point[1][0] = NAN;
    point[2][0] = 1e4, point[2][1] = 1;
}

static void fill(size_t panels)
{
    heat = (struct br_heat){.stem = "map", .title = "A map of 'it'", .log_value = true};
    heat.panels = panels;
    for (size_t i = 0; i < panels; i++)
        fill_panel(&heat.panel[i]);
}

static const char *printed(void (*write)(FILE *, const struct br_heat *))
{
    static char text[1 << 16];
    FILE *file = fmemopen(text, sizeof text, "w");
    assert_non_null(file);
    write(file, &heat);
    assert_int_equal(fclose(file), 0);
    return text;
}

static void expect(const char *text, const char *part)
{
    if (!strstr(text, part))
        fail_msg("expected:\n%s\nin:\n%s", part, text);
}

/* By their own range, without zero and infinity, which have the nearer end's colour. */
static void test_values(void **state)
{
    (void)state;
    double low, high;
    fill(2);
    heat.panel[1].value[1] = 1e-7;
    br_heat_range(&heat, &low, &high);
    assert_true(low == 1e-7 && high == 1e5);
    const char *text = printed(br_heat_write_data);
    expect(text, "# index 0: it's {/:Italic n}; cells: x y, x from to, y from to, value, colour");
    expect(text, "\n3.16227766017 0.001 1 10 0.0001 0.01 0.001 0.001 1\n"
                 "100 0.001 10 1000 0.0001 0.01 2 2 1\n"
                 "3162.27766017 0.001 1000 10000 0.0001 0.01 Inf 100000 1\n"
                 "3.16227766017 0.1 1 10 0.01 1 0 1e-07 1\n"
                 "100 0.1 10 1000 0.01 1 NaN NaN 0\n"
                 "3162.27766017 0.1 1000 10000 0.01 1 100000 100000 1\n\n\n"
                 "# index 1: it's {/:Italic n}; limit of it\n1 0.0001\nNaN NaN\n10000 1\n\n\n"
                 "# index 2: it's");
    heat.low = 1e-2, heat.high = 10;
    br_heat_range(&heat, &low, &high);
    assert_true(low == 1e-2 && high == 10);
    expect(printed(br_heat_write_data), "0.01 1 100000 10 1\n");
    expect(printed(br_heat_write_script), "set cbrange [0.01:10]");
    br_heat_clear(&heat);
}

static void test_no_range(void **state)
{
    (void)state;
    double low, high;
    heat = (struct br_heat){.log_value = true};
    br_heat_range(&heat, &low, &high);
    assert_true(low > 0 && low < high && isfinite(high));
    heat.log_value = false;
    br_heat_range(&heat, &low, &high);
    assert_true(low < high);
}

/* What is no kind is not told. */
static void test_kinds(void **state)
{
    (void)state;
    fill(1);
    heat.kinds = 2;
    snprintf(heat.kind[0], sizeof heat.kind[0], "right");
    snprintf(heat.kind[1], sizeof heat.kind[1], "isn't");
    heat.panel[0].value[1] = 1;
    heat.panel[0].value[3] = -1;
    assert_true(br_heat_told(&heat, 0) && br_heat_told(&heat, 1));
    assert_false(br_heat_told(&heat, 2) || br_heat_told(&heat, -1) || br_heat_told(&heat, NAN));
    const char *text = printed(br_heat_write_data);
    expect(text, "# value 1: isn't\n");
    expect(text, " 1 1 1\n");
    expect(text, " Inf Inf 0\n");
    expect(text, " -1 -1 0\n");
    text = printed(br_heat_write_script);
    expect(text, "title 'right'");
    expect(text, "title \"isn\\047t\"");
    expect(text, "title 'not told'");
    assert_null(strstr(text, "colorbox user"));
    br_heat_clear(&heat);
}

static void write_file(const char *folder, const char *name,
                       void (*write)(FILE *, const struct br_heat *))
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    write(file, &heat);
    assert_int_equal(fclose(file), 0);
}

/* gnuplot takes it, and both pictures are whole. */
static void draw(void)
{
    static const char *const names[] = {"map.dat", "map.gp", "map.svg", "map.png"};
    char folder[] = "/tmp/beamrate-heat-XXXXXX", path[128];
    bool missing;
    struct br_error err = {0};
    assert_non_null(mkdtemp(folder));
    write_file(folder, "map.dat", br_heat_write_data);
    write_file(folder, "map.gp", br_heat_write_script);
    const enum br_status status = br_plot_render(folder, "map.gp", &missing, &err);
    if (status && !missing)
        fail_msg("%s", err.message);
    for (size_t i = 0; i < 4; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        assert_true(unlink(path) == 0 || missing);
    }
    rmdir(folder);
}

static void test_drawn(void **state)
{
    (void)state;
    for (size_t panels = 1; panels <= BR_HEAT_PANELS; panels++)
        for (heat.kinds = 0; heat.kinds <= 2; heat.kinds += 2) {
            const size_t kinds = heat.kinds;
            fill(panels);
            heat.kinds = kinds;
            heat.log_value = kinds == 0;
            draw();
            br_heat_clear(&heat);
            heat.kinds = kinds;
        }
    heat.kinds = 0;
}

static void test_no_memory(void **state)
{
    (void)state;
    struct br_error err = {0};
    for (long i = 0; i < 3; i++) {
        heat = (struct br_heat){.panels = 1};
        br_allocation_fails_at(i);
        assert_int_equal(br_heat_panel_init(&heat.panel[0], 2, 2, &err), BR_NO_MEMORY);
        br_allocation_fails_at(-1);
        br_heat_clear(&heat);
    }
    fill(1);
    br_allocation_fails_at(0);
    assert_null(br_heat_line(&heat.panel[0], 2, "one more"));
    br_allocation_fails_at(-1);
    for (size_t i = 1; i < BR_HEAT_LINES; i++)
        assert_non_null(br_heat_line(&heat.panel[0], 2, "one more"));
    assert_null(br_heat_line(&heat.panel[0], 2, "one too many"));
    br_heat_clear(&heat);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),    cmocka_unit_test(test_no_range),
        cmocka_unit_test(test_kinds),     cmocka_unit_test(test_drawn),
        cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
