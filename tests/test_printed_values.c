/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What machines read is what was computed: every number of the CSV, JSON and HDF5 of run,
 * trade, split and plan stands under its own key. The structs hold a different number
 * in every place, so that two that are exchanged are seen. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#ifdef BR_HAVE_HDF5
#include <hdf5.h>
#endif

#include "study/run/run.h"
#include "study/trade/plan.h"
#include "study/trade/split.h"
#include "study/trade/trade.h"
#include "tables/fields_file.h"
#include "tables/reports.h"
#include "tests/document_reader.h"

/* As it is printed: with six digits at least. */
static void is(const char *where, const char *key, double found, double expected)
{
    if (isnan(expected) ? !isnan(found) : !(fabs(found - expected) <= 1e-5 * fabs(expected)))
        fail_msg("%s: %s is %.17g, expected %.17g", where, key, found, expected);
}

/* ---- trade ---- */

/* Two trials whose numbers are all different. */
static struct br_trade *made_trade(const struct br_scene *scene)
{
    struct br_error err = {0};
    struct br_trade *t = calloc(1, sizeof *t);
    assert_non_null(t);
    MUST(br_named_methods_read("--methods", "euler,adaptive", &t->methods, &err));
    t->request = br_trial_request_default(scene);
    t->norm[0] = &br_norm_l2;
    t->count = 2;
    t->trial = calloc(2, sizeof *t->trial);
    t->front = calloc(2, sizeof *t->front);
    assert_true(t->trial && t->front);
    for (size_t i = 0; i < t->count; i++)
        t->trial[i] = (struct br_trial){
            .named = &t->methods.list[i],
            .at = {11 + i, 20 + i},
            .tolerance = i ? 0.0625 : 0,
            .printed = i == 0,
            .cost = {i ? 0.5 : 2.5,
                     i ? 0.75 : 3.75,
                     4,
                     {.steps = 5, .stages = 6, .rejected = 7, .set_ups = 8, .iterations = 9}},
            .error = {{0.125, 0.25, 0.375}},
            .scale = {1.5},
            .own = {0.0078125},
        };
    t->front[1] = true;
    t->wall_seconds = 10.5;
    for (size_t d = 0; d < BR_TRADE_DIGITS; d++) {
        t->best[d] = d == 1 || d == 3 ? 1 : 2;
        t->best_of[0][d] = t->best_of[1][d] = d == 3 ? 0 : 2;
    }
    return t;
}

static const struct expected trial_numbers[] = {
    {"n", 11},         {"k", 0.05},     {"tolerance", NAN}, {"relative_error", 0.125 / 1.5},
    {"error", 0.125},  {"axial", 0.25}, {"bending", 0.375}, {"own_error", 0.0078125},
    {"seconds", 6.25}, {"set_up", 2.5}, {"march", 3.75},    {"repeats", 4},
    {"steps", 5},      {"solves", 6},   {"rejected", 7},    {"set_ups", 8},
    {"iterations", 9}};
enum { TRIAL_NUMBERS = sizeof trial_numbers / sizeof *trial_numbers };

static void trade_is_printed(void **state)
{
    (void)state;
    struct br_scene scene = br_test_bare();
    scene.name = (char[]){"made"};
    struct br_trade *trade = made_trade(&scene);
    struct br_document d = {.name = NULL};
    br_report_trade(trade, &br_made_provenance, &d);
    json_t *root = read_back(&d);
    NUMBERS(root, "tables.trials.0", trial_numbers);
    const struct expected others[] = {
        {"steps_or_levels", 20}, {"scale", 1.5}, {"digits_per_second", -log10(0.125 / 1.5) / 6.25}};
    NUMBERS(root, "tables.trials.0", others);
    const struct expected adaptive[] = {{"k", NAN}, {"tolerance", 0.0625}, {"n", 12}};
    NUMBERS(root, "tables.trials.1", adaptive);
    const struct expected cheapest[] = {
        {"target", 1e-3}, {"trial", 1}, {"n", 12}, {"tolerance", 0.0625}, {"error", 0.125}};
    NUMBERS(root, "tables.cheapest.1", cheapest);
    const struct expected none[] = {{"target", 1e-2}, {"trial", NAN}, {"n", NAN}, {"k", NAN}};
    NUMBERS(root, "tables.cheapest.0", none);
    const struct expected seconds[] = {
        {"axial_degree", 1}, {"seconds_to_1e-05", 6.25}, {"seconds_to_1e-04", NAN}};
    NUMBERS(root, "tables.methods.0", seconds);
    const struct expected facts[] = {
        {"wall_seconds", 10.5}, {"repeats", 3}, {"repeat_seconds", 0.1}, {"time_limit", 10}};
    NUMBERS(root, "", facts);
    answers(root, "To an error of 1e-03: adaptive, n = 12, tolerance 0.0625; 1.25 CPU s, relative "
                  "error 8.33e-02.");
    answers(root, "No trial has an error of 1e-06 or less.");
    answers(root, "Fastest and most accurate: adaptive, n = 12, tolerance 0.0625; 1.25 CPU s, "
                  "relative error 8.33e-02.");
    answers(root, "The paper's way, euler, reaches 1e-05 in 6.25 CPU s, 5 times as much as the "
                  "cheapest.");
    answers(root, "Trials: 2 done.");
    const struct expected truths[][2] = {{{"front", 0}, {"printed", 1}},
                                         {{"front", 1}, {"printed", 0}}};
    for (size_t i = 0; i < 2; i++)
        NUMBERS(root, i ? "tables.trials.1" : "tables.trials.0", truths[i]);
    TEXTS(root, "tables.trials.0", "method", "euler", "end", "done");
    json_decref(root);
    free(trade->trial);
    free(trade->front);
    free(trade);
}

/* ---- split ---- */

/* A split whose part i has errors, floors and tips that are i + 1 times what the first has. */
static struct br_split made_split(struct br_scene *scene)
{
    struct br_split s = {
        .scene = scene,
        .method = br_test_method("umfpack", "implicit", "uzawa"),
        .unstable = true,
        .refined = {.name = "made finer"},
        .at = {12, 16},
        .norm = {&br_norm_l2},
        .norms = 1,
        .judge = &br_judge_exact,
        .whole = {.error = {{16, 32, 48}}, .floor = {{0.5, 0.625, 0.75}}, .tip = {17, 33}},
        .sum = {{64, 128, 192}},
        .tip_sum = {65, 129},
        .tip = {66, 130},
        .solution_tip = {67, 131},
        .scale = {4},
        .predicted_round_off = 0.03125,
    };
    s.method.scheme = br_time_scheme_find("adaptive");
    s.method.tolerance = 0.0009765625;
    s.method.linear.refinement = 3;
    s.method.iteration = (struct br_iteration){0.25, 0.0001220703125, 77};
    for (; br_sources[s.shares]; s.shares++) {
        const double times = (double)(s.shares + 1);
        s.share[s.shares] = (struct br_share){
            .source = br_sources[s.shares],
            .error = {{times, 2 * times, 3 * times}},
            .floor = {{0.125 * times, 0.25 * times, 0.375 * times}},
            .tip = {5 * times, -7 * times},
        };
    }
    return s;
}

static void split_is_printed(void **state)
{
    (void)state;
    static const struct expected third[] = {{"run", 0},
                                            {"n", 12},
                                            {"steps", 16},
                                            {"k", 1.0 / 16},
                                            {"error", 3},
                                            {"axial", 6},
                                            {"bending", 9},
                                            {"floor", 0.375},
                                            {"axial_floor", 0.75},
                                            {"bending_floor", 1.125},
                                            {"share", 3.0 / 64},
                                            {"relative", 0.75},
                                            {"axial_tip", 15},
                                            {"bending_tip", -21},
                                            {"applies", 1},
                                            {"tolerance", 0.0009765625},
                                            {"axial_degree", 1},
                                            {"refinement", 3},
                                            {"friction_parameter", 0.25},
                                            {"friction_tolerance", 0.0001220703125},
                                            {"friction_iterations", 77}};
    static const struct expected sum[] = {{"error", 64},     {"axial", 128},      {"bending", 192},
                                          {"floor", NAN},    {"share", 1},        {"relative", 16},
                                          {"axial_tip", 65}, {"bending_tip", 129}};
    static const struct expected whole[] = {
        {"error", 16},          {"axial", 32},           {"bending", 48}, {"floor", 0.5},
        {"axial_floor", 0.625}, {"bending_floor", 0.75}, {"share", NAN},  {"relative", 4},
        {"axial_tip", 17},      {"bending_tip", 33}};
    static const struct expected run[] = {{"n", 12},
                                          {"steps", 16},
                                          {"predicted_round_off", 0.03125},
                                          {"axial_tip", 66},
                                          {"bending_tip", 130},
                                          {"solution_axial_tip", 67},
                                          {"solution_bending_tip", 131},
                                          {"unstable", 1}};
    struct br_scene scene = br_test_bare();
    scene.name = (char[]){"made"};
    const struct br_split split = made_split(&scene);
    struct br_document d = {.name = NULL};
    br_report_split(&split, 1, &br_made_provenance, &d);
    json_t *root = read_back(&d);
    TEXTS(root, "tables.parts.2", "scheme", "adaptive", "contact", "implicit", "friction", "uzawa",
          "solver", "umfpack", "scaling", "none", "norm", "l2", "unit", "m^(3/2)", "part", "mu");
    TEXTS(root, "tables.runs.0", "reference", "exact", "refined", "made finer");
    answers(root,
            "n = 12, k = 0.0625 s: scheme adaptive to 0.0009765625, solver umfpack, refinement "
            "steps 3, contact none, friction none. Error 1.600e+01 m^(3/2), by parts: "
            "round-off 1.6 %, iteration 3.1 %, mu 4.7 %, lag 6.2 %, time 7.8 %, space 9.4 %. The "
            "lagged contact is beyond its stability limit: its part is bounded chatter.");
    NUMBERS(root, "tables.parts.2", third);
    assert_int_equal(split.shares, 6);
    NUMBERS(root, "tables.parts.6", sum);
    NUMBERS(root, "tables.parts.7", whole);
    NUMBERS(root, "tables.runs.0", run);
    json_decref(root);
}

/* ---- plan ---- */

static double seconds_of_plan(const struct br_trial *trial)
{
    return 2 * br_trial_seconds(trial);
}

/* Two trials and models of two methods; the second is not known. */
static struct br_plan *made_plan(const struct br_scene *scene)
{
    struct br_error err = {0};
    struct br_plan *p = calloc(1, sizeof *p);
    assert_non_null(p);
    br_plan_default(p, scene);
    MUST(br_named_methods_read("--methods", "euler,bdf2", &p->methods, &err));
    p->goal = (struct br_plan_goal){0.5, NAN};
    p->norm[0] = &br_norm_l2;
    p->seconds = seconds_of_plan;
    p->count = 2;
    p->trial = calloc(2, sizeof *p->trial);
    p->forecast = calloc(2, sizeof *p->forecast);
    assert_true(p->trial && p->forecast);
    for (size_t i = 0; i < p->count; i++) {
        p->trial[i] = (struct br_trial){
            .named = &p->methods.list[0],
            .at = {11 + i, 20 + i},
            .cost = {2.5, 3.75, 4, {.steps = 5, .stages = 6, .set_ups = 8}},
            .error = {{0.125, 0.25, 0.375}},
            .scale = {1.5},
            .own = {0.25},
        };
        p->forecast[i] = (struct br_plan_forecast){i, 0.0625, 7.5};
    }
    p->first = 0;
    p->chosen = 1;
    p->rounds = 9;
    p->own = 0.0078125;
    p->wall_seconds = 10.5;
    struct br_plan_models *m = &p->model[0];
    m->known = true;
    m->error = (struct br_plan_model){.r = 0.75, .scatter = 0.875, .points = 13};
    m->error.space = m->error.time = (struct br_plan_curve){1, {1.25}, {-2.25}};
    m->error.time.value[0] = -3.25;
    m->cost =
        (struct br_plan_cost){.c = {1, 2, 3, 4}, .scatter = 0.9375, .solves = {1, {4.25}, {5.25}}};
    return p;
}

static void plan_is_printed(void **state)
{
    (void)state;
    struct br_scene scene = br_test_bare();
    scene.name = (char[]){"made"};
    struct br_plan *plan = made_plan(&scene);
    struct br_document d = {.name = NULL};
    br_report_plan(plan, "made", &br_made_provenance, &d);
    json_t *root = read_back(&d);
    answers(root, "Proposal: euler, n = 12, k = 0.047619 s. Error 2.500e-01 (predicted 6.250e-02), "
                  "CPU 12.5 s (predicted 7.5 s), 5 steps.");
    answers(root, "First proposal, by the cheap trials alone: euler, n = 11, k = 0.05 s. Error "
                  "2.500e-01 (predicted 6.250e-02), CPU 12.5 s (predicted 7.5 s), 5 steps.");
    answers(root, "Met: the achieved error is 0.50 of the goal, a relative error of 0.5.");
    TEXTS(root, "", "run", "beamrate run made --n 12 --k T/21", "trade",
          "beamrate trade made --methods euler --n 12 --k T/21");
    const struct expected trial[] = {
        {"round", 1},
        {"n", 12},
        {"steps_or_levels", 21},
        {"k", 1.0 / 21},
        {"tolerance", NAN},
        {"predicted_error", 0.0625},
        {"relative_error", 0.375 / 1.5},
        {"predicted_seconds", 7.5},
        {"seconds", 12.5},
        {"steps", 5},
        {"solves", 6},
        {"set_ups", 8},
        {"chosen", 1},
    };
    TEXTS(root, "tables.trials.1", "method", "euler", "end", "done");
    TEXTS(root, "tables.curves.2", "method", "euler", "curve", "log_solves");
    NUMBERS(root, "tables.trials.1", trial);
    const struct expected model[] = {{"trials", 13},           {"r", 0.75},
                                     {"error_scatter", 0.875}, {"cost_scatter", 0.9375},
                                     {"seconds_set_up", 1},    {"seconds_element", 2},
                                     {"seconds_solve", 3},     {"seconds_element_solve", 4}};
    NUMBERS(root, "tables.models.0", model);
    numbers_are(root, "tables.models.1", &(struct expected){"r", NAN}, 1);
    const struct expected curve[][2] = {{{"at", 1.25}, {"value", -2.25}},
                                        {{"at", 1.25}, {"value", -3.25}},
                                        {{"at", 4.25}, {"value", 5.25}}};
    for (size_t i = 0; i < 3; i++)
        numbers_are(at_path(root, "tables.curves"), (const char[]){(char)('0' + (int)i), '\0'},
                    curve[i], 2);
    const struct br_plan_parts parts = br_plan_chosen_parts(plan);
    const struct expected facts[] = {{"goal_error", 0.5},
                                     {"goal_seconds", NAN},
                                     {"own_error", 0.0078125},
                                     {"rounds", 9},
                                     {"first", 0},
                                     {"chosen", 1},
                                     {"marched_seconds", br_plan_spent(plan)},
                                     {"wall_seconds", 10.5},
                                     {"space_error", parts.space},
                                     {"time_error", parts.time},
                                     {"space_order", parts.p},
                                     {"time_order", parts.q}};
    NUMBERS(root, "", facts);
    json_decref(root);
    free(plan->trial);
    free(plan->forecast);
    free(plan);
}

/* ---- CSV ---- */

/* The next line of a text, without its end; NULL: none. Advances *text. */
static char *next_line(char **text)
{
    return *text && **text ? strsep(text, "\n") : NULL;
}

/* The place of a name among a line's fields. */
static size_t place_of(const char *line, const char *name, char separator)
{
    const size_t size = strlen(name);
    for (size_t i = 0; line; i++) {
        line += strspn(line, " ");
        if (strncmp(line, name, size) == 0 && strchr(" ,|", line[size]))
            return i;
        line = strchr(line, separator);
        line = line ? line + 1 : NULL;
    }
    fail_msg("there is no column %s", name);
    return 0;
}

/* The number in a place of a line, 1 or 0 for a truth; NAN: it is empty. */
static double number_at(const char *line, size_t place, char separator)
{
    for (; place > 0 && line; place--) {
        line = strchr(line, separator);
        line = line ? line + 1 : NULL;
    }
    assert_non_null(line);
    if (strncmp(line, "true", 4) == 0 || strncmp(line, "false", 5) == 0)
        return *line == 't';
    char *end;
    const double value = strtod(line, &end);
    return end == line ? NAN : value;
}

static void row_has(const char *what, const char *head, const char *row, char separator,
                    const struct expected *e, size_t count)
{
    for (size_t i = 0; i < count; i++)
        is(what, e[i].key, number_at(row, place_of(head, e[i].key, separator), separator),
           e[i].value);
}

/* ---- run ---- */

enum { ELEMENTS = 4, STEPS = 8, LOOKS = 3, MOST_FORMATS = 4 };
static const size_t levels[LOOKS] = {1, 5, 8};

/* A march of example2, what it has told, and the files that were written meanwhile. */
struct watched {
    char folder[32];
    struct br_scene scene;
    struct br_history_record record;
    FILE *history;
    struct br_fields_file *file[MOST_FORMATS];
    struct br_run_report report;
};

static enum br_status write_row(void *self, const struct br_history_row *row, struct br_error *err)
{
    const struct watched *w = self;
    (void)err;
    br_history_csv_row(w->history, row);
    return BR_OK;
}

static enum br_status write_fields(void *self, const struct br_march *march,
                                   const struct br_history_row *row, struct br_error *err)
{
    struct watched *w = self;
    enum br_status status = BR_OK;
    for (size_t f = 0; br_fields_formats[f] && !status; f++)
        status = br_fields_formats[f]->look(w->file[f], march, row, err);
    return status;
}

static void path_of(const struct watched *w, const char *name, char path[64])
{
    snprintf(path, 64, "%s/%s", w->folder, name);
}

static char *read_file(const struct watched *w, const char *name)
{
    char path[64];
    path_of(w, name, path);
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    char *text = calloc(1, 1 << 16);
    assert_non_null(text);
    assert_true(fread(text, 1, (1 << 16) - 1, in) > 0);
    fclose(in);
    return text;
}

/* What the test program does as the command does it: rows and fields go to files as they come. */
static void march_and_write(struct watched *w)
{
    struct br_error err = {0};
    char path[64];
    const struct br_history_observer output[] = {
        br_history_recorder(&w->record, ELEMENTS),
        {.self = w, .row = write_row, .look = write_fields},
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
    path_of(w, "history.csv", path);
    w->history = fopen(path, "w");
    assert_non_null(w->history);
    br_history_csv_head(w->history);
    for (size_t f = 0; br_fields_formats[f]; f++) {
        path_of(w, br_fields_formats[f]->file_name, path);
        const struct br_fields_request fields = {path,  &w->scene, ELEMENTS,           STEPS,
                                                 LOOKS, 1,         &br_made_provenance};
        MUST(br_fields_formats[f]->open(&w->file[f], &fields, &err));
    }
    MUST(br_run(&request, &w->report, &err));
    fclose(w->history);
    for (size_t f = 0; br_fields_formats[f]; f++)
        MUST(br_fields_formats[f]->close(w->file[f], NULL, &err));
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

static void history_is_printed(void **state)
{
    const struct watched *w = *state;
    char *text = read_file(w, "history.csv"), *rest = text, *head = next_line(&rest);
    assert_int_equal(w->record.rows, STEPS + 1);
    for (size_t i = 0; i < w->record.rows; i++) {
        const struct br_history_row *row = &w->record.row[i];
        const struct expected numbers[] = {{"step", (double)i},
                                           {"t", (double)i / STEPS},
                                           {"u", row->displacement[BR_AXIAL]},
                                           {"w", row->displacement[BR_BENDING]},
                                           {"u_t", row->velocity[BR_AXIAL]},
                                           {"w_t", row->velocity[BR_BENDING]},
                                           {"contact_force", row->contact_force},
                                           {"friction_force", row->friction_force},
                                           {"friction_bound", row->friction_bound}};
        row_has("history.csv", head, next_line(&rest), ',', numbers, 9);
    }
    free(text);
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
static void tip_is_the_last_node(void **state)
{
    const struct watched *w = *state;
    for (size_t look = 0; look < LOOKS; look++) {
        const struct br_history_row *row = &w->record.row[levels[look]];
        is("row", "u", row->displacement[BR_AXIAL], field_value(w, look, ELEMENTS, "u"));
        is("row", "u_t", row->velocity[BR_AXIAL], field_value(w, look, ELEMENTS, "u_t"));
        is("row", "w", row->displacement[BR_BENDING], field_value(w, look, ELEMENTS, "w"));
        is("row", "w_t", row->velocity[BR_BENDING], field_value(w, look, ELEMENTS, "w_t"));
    }
}

static void fields_are_printed(void **state)
{
    const struct watched *w = *state;
    char *text = read_file(w, "fields.csv"), *rest = text, *head = next_line(&rest);
    for (size_t look = 0; look < LOOKS; look++)
        for (size_t node = 0; node <= ELEMENTS; node++) {
            const char *row = next_line(&rest);
            const struct expected place[] = {{"t", (double)levels[look] / STEPS},
                                             {"x", w->scene.length * (double)node / ELEMENTS}};
            row_has("fields.csv", head, row, ',', place, 2);
            for (size_t v = 0; v < br_field_variable_count(1); v++) {
                const char *name = br_field_variables[v].name;
                const struct expected e = {name, field_value(w, look, node, name)};
                row_has("fields.csv", head, row, ',', &e, 1);
            }
        }
    free(text);
}

#ifdef BR_HAVE_HDF5
static void read_set(hid_t file, const char *name, hssize_t size, double *values)
{
    const hid_t set = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(set);
    assert_int_equal(H5Sget_simple_extent_npoints(space), size);
    assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
    H5Sclose(space);
    H5Dclose(set);
}

static void fields_are_in_hdf5(void **state)
{
    const struct watched *w = *state;
    double x[ELEMENTS + 1], t[LOOKS], values[LOOKS][ELEMENTS + 1];
    char path[64];
    path_of(w, "fields.h5", path);
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_true(file >= 0);
    read_set(file, "x", ELEMENTS + 1, x);
    read_set(file, "t", LOOKS, t);
    for (size_t node = 0; node <= ELEMENTS; node++)
        is("fields.h5", "x", x[node], w->scene.length * (double)node / ELEMENTS);
    for (size_t look = 0; look < LOOKS; look++)
        is("fields.h5", "t", t[look], (double)levels[look] / STEPS);
    for (size_t v = 0; v < br_field_variable_count(1); v++) {
        const char *name = br_field_variables[v].name;
        read_set(file, name, LOOKS * (ELEMENTS + 1), &values[0][0]);
        for (size_t look = 0; look < LOOKS; look++)
            for (size_t node = 0; node <= ELEMENTS; node++)
                is("fields.h5", name, values[look][node], field_value(w, look, node, name));
    }
    H5Fclose(file);
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trade_is_printed),     cmocka_unit_test(split_is_printed),
        cmocka_unit_test(plan_is_printed),      cmocka_unit_test(history_is_printed),
        cmocka_unit_test(tip_is_the_last_node), cmocka_unit_test(fields_are_printed),
#ifdef BR_HAVE_HDF5
        cmocka_unit_test(fields_are_in_hdf5),
#endif
    };
    return cmocka_run_group_tests_name("printed_values", tests, set_up, tear_down);
}
