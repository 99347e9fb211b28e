/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of an error that are made up, in every format of the registry, read back; and the figure.
 */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "figure_check.h"
#include "plots/pictures.h"
#include "study/trade/split.h"
#include "tables/split_emitter.h"

enum { RUNS = 4 };

struct sample {
    struct br_scene scene;
    struct br_split split[RUNS];
    struct br_provenance provenance;
    struct br_split_page page;
};

/* Parts of 1, 2, 3, ... thousandths of the run's k, every second one signed. */
static void fill(struct br_split *s, double k)
{
    s->judge = &br_judge_exact;
    s->scale[0] = 0.25;
    strcpy(s->refined.name, "adaptive, tolerance 1e-11");
    for (s->shares = 0; br_sources[s->shares]; s->shares++) {
        struct br_share *share = &s->share[s->shares];
        share->source = br_sources[s->shares];
        share->none = s->shares == 1 ? "nothing iterates" : NULL;
        for (int part = 0; part < BR_PARTS && !share->none; part++) {
            share->error[0][part] = 1e-3 * k * (double)(s->shares + 1) / (1 + part);
            share->floor[0][part] = s->shares == 0 ? 0.25 : 1e-12;
            s->sum[0][part] += share->error[0][part];
            s->whole.error[0][part] += 0.5 * share->error[0][part];
        }
        for (int kind = BR_AXIAL; kind <= BR_BENDING && !share->none; kind++) {
            share->tip[kind] =
                (s->shares % 2 ? -1 : 1) * k / (double)(3 + s->shares + (size_t)kind);
            s->whole.tip[kind] += share->tip[kind];
            s->tip_sum[kind] += share->tip[kind];
        }
    }
}

static void sample_init(struct sample *s)
{
    static char name[] = "made_up", title[] = "Made up, 5 % & more";
    *s = (struct sample){.scene = br_test_bare()};
    s->scene.name = name;
    s->scene.title = title;
    s->scene.contact = (struct br_contact){true, 0, 1};
    s->provenance =
        (struct br_provenance){"1", "c", "cc", "-O2", "beamrate", "m", "d", 1, "p", "t"};
    for (size_t i = 0; i < RUNS; i++) { /* two methods, two steps */
        s->split[i] = (struct br_split){
            .scene = &s->scene,
            .method = br_test_method(NULL, i < 2 ? "lagged" : "implicit", NULL),
            .at = {10, i % 2 ? 1000 : 10},
            .norm = {&br_norm_l2},
            .norms = 1,
        };
        fill(&s->split[i], i % 2 ? 0.001 : 0.1);
    }
    s->page = (struct br_split_page){s->split, RUNS, &s->provenance};
}

static char *emitted(const struct sample *s, const char *name)
{
    struct br_error err = {0};
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    for (const struct br_split_emitter *const *e = br_split_emitters; *e; e++)
        if (strcmp((*e)->name, name) == 0)
            MUST((*e)->emit(out, &s->page, &err));
    fclose(out);
    return text;
}

static void has(const char *text, const char *part)
{
    if (!strstr(text, part))
        fail_msg("'%s' is not in:\n%s", part, text);
}

static void test_texts(void **state)
{
    (void)state;
    struct sample s;
    sample_init(&s);
    char *text = emitted(&s, "text");
    has(text, "n = 10, k = 0.1 s: euler, contact lagged, solver riccati");
    has(text, "iteration  none: nothing iterates");
    has(text, "round-off    < 2.5e-01");
    has(text, "lag          4.000e-06   2.000e-06   1.333e-06      21.1 %  -1.667e-04  -1.429e-04  "
              "####\n");
    has(text, "sum          1.900e-05");
    has(text, "The whole is 0.5 of the sum of its parts, which point against each other (l2)");
    has(text, "adaptive, tolerance 1e-11");
    free(text);
    text = emitted(&s, "markdown");
    has(text, "| lag | 4.000e-06 | 2.000e-06 | 1.333e-06 | 21.1 % | -1.667e-04 | -1.429e-04 |  |");
    has(text, "| iteration |  |  |  |  |  |  | nothing iterates |");
    free(text);
    text = emitted(&s, "latex");
    has(text, "lag & 4.000e-06 &");
    has(text, "Made up, 5 \\% \\& more");
    has(text, "\\multicolumn{6}{l}{none: nothing iterates}");
    free(text);
}

/* What is not modelled or not a number is told as such. */
static void test_missing(void **state)
{
    (void)state;
    struct sample s;
    sample_init(&s);
    s.scene.axial.modelled = false;
    s.split[1].share[3].error[0][BR_PART_TOTAL] = NAN;
    const struct br_split_line line = br_split_line(&s.split[1], 0, 3);
    char text[32];
    assert_string_equal(br_split_error_text(&line, BR_PART_TOTAL, text), "-");
    assert_string_equal(br_split_error_text(&line, BR_PART_AXIAL, text), "-");
    assert_string_equal(br_split_error_text(&line, BR_PART_BENDING, text), "1.333e-06");
    assert_string_equal(br_split_share_text(&line, text), "-");
    assert_string_equal(br_split_tip_text(&line, BR_AXIAL, text), "-");
    assert_string_equal(br_split_tip_text(&line, BR_BENDING, text), "-1.429e-04");
    char *csv = emitted(&s, "csv");
    has(csv, "10,0.001,euler,lagged,exact,riccati,l2,lag,1,,,1.3");
    assert_null(strstr(csv, "nan"));
    free(csv);
}

/* Every number of the JSON document is that of the struct, and of the CSV. */
static void test_json(void **state)
{
    (void)state;
    struct sample s;
    sample_init(&s);
    char *text = emitted(&s, "json"), *csv = emitted(&s, "csv");
    json_t *o = json_loads(text, 0, NULL), *runs = json_object_get(o, "runs");
    assert_int_equal(json_array_size(runs), RUNS);
    for (size_t r = 0; r < RUNS; r++) {
        const struct br_split *split = &s.split[r];
        json_t *run = json_array_get(runs, r), *parts = json_object_get(run, "parts");
        assert_int_equal(json_array_size(parts), split->shares);
        for (size_t i = 0; i < split->shares; i++) {
            const char *part, *field;
            int applies;
            double total, bending, tip;
            assert_int_equal(json_unpack(json_array_get(parts, i),
                                         "{s:s, s:b, s:{s:F}, s:[{s:{s:F, s:F}}]}", "part", &part,
                                         "applies", &applies, "tip", "axial", &tip, "norms",
                                         "error", "total", &total, "bending", &bending),
                             0);
            assert_string_equal(part, br_sources[i]->name);
            assert_true(applies == (split->share[i].none == NULL));
            assert_true(total == split->share[i].error[0][BR_PART_TOTAL]);
            assert_true(bending == split->share[i].error[0][BR_PART_BENDING]);
            assert_true(tip == split->share[i].tip[BR_AXIAL]);
            char row[128];
            snprintf(row, sizeof row, ",%s,exact,riccati,l2,%s,%d,%.17g,",
                     split->method.contact->name, part, applies, total);
            field = strstr(csv, row);
            assert_non_null(field);
        }
        double whole = json_real_value(
            json_object_get(json_object_get(json_object_get(run, "whole"), "tip"), "bending"));
        assert_true(whole == split->whole.tip[BR_BENDING]);
    }
    json_decref(o);
    free(text);
    free(csv);
}

static void test_figure(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct sample s;
    struct br_figure f;
    sample_init(&s);
    MUST(br_split_draw(s.split, RUNS, &f, &err));
    assert_int_equal(f.panels, 2);
    for (size_t i = 0; i < 2; i++) {
        const struct br_panel *p = &f.panel[i];
        const struct br_split *coarse = &s.split[2 * i], *fine = coarse + 1;
        figure_axes(p, "time step k (s)", "error (31) (m^{3/2})");
        assert_non_null(strstr(p->title, i ? "implicit" : "lagged"));
        assert_int_equal(p->count,
                         5); /* of six parts one is none, one below its floor; the whole */
        for (size_t part = 2; part < coarse->shares; part++) {
            const struct br_series *curve = figure_series(p, br_sources[part]->name);
            figure_point(curve, 0, 0.001, fine->share[part].error[0][BR_PART_TOTAL]);
            figure_point(curve, 1, 0.1, coarse->share[part].error[0][BR_PART_TOTAL]);
            assert_int_equal(curve->hue, part + 1); /* the same in both panels */
        }
        figure_point(figure_series(p, "whole"), 1, 0.1, coarse->whole.error[0][BR_PART_TOTAL]);
    }
    figure_check(&f);
    br_figure_clear(&f);
    for (size_t i = 0; i < RUNS; i++) { /* over h, where they differ by nothing else */
        s.split[i].at = (struct br_resolution){i % 2 ? 40 : 10, 10};
    }
    MUST(br_split_draw(s.split, RUNS, &f, &err));
    figure_axes(&f.panel[1], "mesh size h (m)", "error (31) (m^{3/2})");
    figure_point(figure_series(&f.panel[1], "lag"), 0, s.scene.length / 40,
                 s.split[3].share[3].error[0][BR_PART_TOTAL]);
    br_figure_clear(&f);
    MUST(br_split_draw(s.split, 1, &f, &err)); /* nothing to draw over */
    assert_int_equal(f.panels, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_texts),
        cmocka_unit_test(test_missing),
        cmocka_unit_test(test_json),
        cmocka_unit_test(test_figure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
