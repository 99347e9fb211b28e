/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of an error that are made up: what people see of them, what is missing, and the figure. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "document_reader.h"
#include "figure_check.h"
#include "plots/pictures.h"
#include "study/trade/split.h"
#include "tables/reports.h"

enum { RUNS = 4 };

struct sample {
    struct br_scene scene;
    struct br_split split[RUNS];
    struct br_document document;
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
}

static void has(const char *text, const char *part)
{
    if (!strstr(text, part))
        fail_msg("'%s' is not in:\n%s", part, text);
}

/* What people see, and why something is not there. */
static void test_texts(void **state)
{
    (void)state;
    struct sample s;
    sample_init(&s);
    s.scene.axial.modelled = false;
    s.split[1].share[3].error[0][BR_PART_TOTAL] = NAN;
    br_report_split(s.split, RUNS, &br_made_provenance, &s.document);
    char *text = printed(&s.document, &br_document_markdown);
    has(text, "The whole is 0.5 of the sum of its parts, which point against each other (l2)");
    has(text, "No part iteration: nothing iterates.");
    has(text, "| lag | 4.000e-06 | 1.333e-06 | 21.1 % | 1.60e-05 | -1.429e-04 |");
    has(text, "| round-off | \\< 2.5e-01 | \\< 2.5e-01 | - | - |");
    assert_null(strstr(text, "| iteration |"));
    free(text);
    static const struct expected lag[] = {
        {"applies", 1}, {"error", NAN},   {"axial", NAN},    {"axial_tip", NAN},
        {"share", NAN}, {"floor", 1e-12}, {"relative", NAN}, {"bending_tip", -0.001 / 7}};
    static const struct expected none[] = {
        {"applies", 0}, {"error", NAN}, {"floor", NAN}, {"share", NAN}, {"bending_tip", NAN}};
    json_t *root = read_back(&s.document);
    NUMBERS(root, "tables.parts.11", lag); /* of the second run */
    NUMBERS(root, "tables.parts.9", none);
    TEXTS(root, "tables.parts.9", "part", "iteration", "none", "nothing iterates");
    json_decref(root);
}

static void test_figure(void **state)
{
    (void)state;
    struct br_error err = {0};
    struct sample s;
    struct br_figure f;
    sample_init(&s);
    f = br_split_draw(s.split, RUNS);
    MUST(br_figure_check(&f, &err));
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
            const struct br_series *other = figure_series(&f.panel[0], br_sources[part]->name);
            assert_int_equal(curve->look, other->look); /* the same in both panels */
        }
        figure_point(figure_series(p, "whole"), 1, 0.1, coarse->whole.error[0][BR_PART_TOTAL]);
    }
    figure_check(&f);
    br_figure_clear(&f);
    for (size_t i = 0; i < RUNS; i++) { /* over h, where they differ by nothing else */
        s.split[i].at = (struct br_resolution){i % 2 ? 40 : 10, 10};
    }
    f = br_split_draw(s.split, RUNS);
    MUST(br_figure_check(&f, &err));
    figure_axes(&f.panel[1], "mesh size h (m)", "error (31) (m^{3/2})");
    figure_point(figure_series(&f.panel[1], "lag"), 0, s.scene.length / 40,
                 s.split[3].share[3].error[0][BR_PART_TOTAL]);
    br_figure_clear(&f);
    f = br_split_draw(s.split, 1);
    MUST(br_figure_check(&f, &err)); /* nothing to draw over */
    assert_int_equal(f.panels, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_texts),
        cmocka_unit_test(test_figure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
