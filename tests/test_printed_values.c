/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What machines read is what was computed: every number of the CSV, JSON, JUnit, TAP and HDF5 of
 * run, check, trade and split stands under its own key. The structs hold a different number in
 * every place, so that two that are exchanged are seen. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#ifdef BR_HAVE_HDF5
#include <hdf5.h>
#endif

#include "tables/check_emitter.h"
#include "tables/fields_file.h"
#include "tables/run_page.h"
#include "tables/split_emitter.h"
#include "tables/trade_emitter.h"
#include "tests/support.h"

static const struct br_provenance provenance = {.version = "1",
                                                .commit = "c",
                                                .compiler = "cc",
                                                .flags = "-O",
                                                .command_line = "beamrate",
                                                .machine = "m",
                                                .date = "d",
                                                .threads = 1,
                                                .scene_path = "p",
                                                .scene_text = "t"};

/* A key with the number that belongs to it; NAN: none is printed. */
struct expected {
    const char *key;
    double value;
};

/* As it is printed: with six digits at least. */
static void is(const char *where, const char *key, double found, double expected)
{
    if (isnan(expected) ? !isnan(found) : !(fabs(found - expected) <= 1e-5 * fabs(expected)))
        fail_msg("%s: %s is %.17g, expected %.17g", where, key, found, expected);
}

/* ---- reading ---- */

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

/* The number in a place of a line; NAN: it is empty. */
static double number_at(const char *line, size_t place, char separator)
{
    for (; place > 0 && line; place--) {
        line = strchr(line, separator);
        line = line ? line + 1 : NULL;
    }
    assert_non_null(line);
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

/* The value at a path, "runs.0.parts.2.tip". */
static const json_t *at_path(const json_t *value, const char *path)
{
    char key[64];
    for (int used; value && sscanf(path, "%63[^.]%n", key, &used) == 1;) {
        value = json_is_array(value) ? json_array_get(value, strtoul(key, NULL, 10))
                                     : json_object_get(value, key);
        path += used + (path[used] == '.');
    }
    return value;
}

static void json_has(const json_t *root, const struct expected *e, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const json_t *value = at_path(root, e[i].key);
        if (!value)
            fail_msg("JSON has no %s", e[i].key);
        is("JSON", e[i].key, json_is_number(value) ? json_number_value(value) : NAN, e[i].value);
    }
}

static json_t *read_json(char *text)
{
    json_error_t error;
    json_t *root = json_loads(text, 0, &error);
    if (!root)
        fail_msg("%s in:\n%s", error.text, text);
    free(text);
    return root;
}

/* ---- trade ---- */

/* Two trials whose numbers are all different. */
static struct br_trade *made_trade(const struct br_scene *scene)
{
    struct br_error err = {0};
    struct br_trade *t = calloc(1, sizeof *t);
    assert_non_null(t);
    MUST(br_contenders_read("--methods", "euler,adaptive", &t->contenders, &err));
    t->request = br_trial_request_default(scene);
    t->norm[0] = &br_norm_l2;
    t->count = 2;
    t->trial = calloc(2, sizeof *t->trial);
    t->front = calloc(2, sizeof *t->front);
    assert_true(t->trial && t->front);
    for (size_t i = 0; i < t->count; i++)
        t->trial[i] = (struct br_trial){
            .contender = &t->contenders.list[i],
            .at = {11 + i, 20 + i},
            .tolerance = i ? 0.0625 : 0,
            .cost = {2.5,
                     3.75,
                     4,
                     {.steps = 5, .stages = 6, .rejected = 7, .set_ups = 8, .iterations = 9}},
            .error = {{0.125, 0.25, 0.375}},
            .scale = {1.5},
            .own = {0.0078125},
        };
    t->front[1] = true;
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
    struct br_error err = {0};
    const struct br_scene scene = br_test_bare();
    struct br_trade *trade = made_trade(&scene);
    const struct br_trade_page page = {"made", "Made", trade, &provenance};
    char *csv = NULL, *json = NULL;
    size_t size;
    FILE *out = open_memstream(&csv, &size);
    MUST(br_trade_csv(out, &page, &err));
    fclose(out);
    out = open_memstream(&json, &size);
    MUST(br_trade_json(out, &page, &err));
    fclose(out);

    char *rest = csv, *head = next_line(&rest), *fixed = next_line(&rest);
    row_has("CSV", head, fixed, ',', trial_numbers, TRIAL_NUMBERS);
    const struct expected others[] = {{"steps_or_levels", 20}, {"scale", 1.5}, {"front", 0}};
    row_has("CSV", head, fixed, ',', others, 3);
    const struct expected adaptive[] = {{"k", NAN}, {"tolerance", 0.0625}, {"front", 1}};
    row_has("CSV", head, next_line(&rest), ',', adaptive, 3);

    json_t *root = read_json(json);
    json_has(at_path(root, "trials.0"), trial_numbers, TRIAL_NUMBERS);
    assert_true(json_is_false(at_path(root, "trials.0.front")));
    json_has(at_path(root, "trials.1"), adaptive, 2);
    json_decref(root);
    free(csv);
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
        .method = br_test_method(NULL, "lagged", NULL),
        .at = {12, 16},
        .norm = {&br_norm_l2},
        .norms = 1,
        .judge = &br_judge_exact,
        .whole = {.error = {{16, 32, 48}}, .floor = {{0.5, 0.625, 0.75}}, .tip = {17, 33}},
        .sum = {{64, 128, 192}},
        .tip_sum = {65, 129},
        .tip = {66, 130},
        .solution_tip = {67, 131},
        .scale = {1},
        .predicted_round_off = 0.03125,
    };
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

/* Where CSV has a column, JSON has a path below the part. */
static const struct {
    struct expected csv;
    const char *json;
} part_numbers[] = {
    {{"error", 3}, "norms.0.error.total"},
    {{"axial", 6}, "norms.0.error.axial"},
    {{"bending", 9}, "norms.0.error.bending"},
    {{"floor", 0.375}, "norms.0.floor.total"},
    {{"axial_floor", 0.75}, "norms.0.floor.axial"},
    {{"bending_floor", 1.125}, "norms.0.floor.bending"},
    {{"share", 3.0 / 64}, "norms.0.share"},
    {{"axial_tip", 15}, "tip.axial"},
    {{"bending_tip", -21}, "tip.bending"},
};

static char *emitted_split(const struct br_split *split, const char *format)
{
    struct br_error err = {0};
    const struct br_split_page page = {split, 1, &provenance};
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    for (const struct br_split_emitter *const *e = br_split_emitters; *e; e++)
        if (strcmp((*e)->name, format) == 0)
            MUST((*e)->emit(out, &page, &err));
    fclose(out);
    return text;
}

static void split_is_printed(void **state)
{
    (void)state;
    struct br_scene scene = br_test_bare();
    scene.name = (char[]){"made"};
    const struct br_split split = made_split(&scene);
    char *csv = emitted_split(&split, "csv"), *rest = csv, *head = next_line(&rest);
    char *third = (next_line(&rest), next_line(&rest), next_line(&rest));
    json_t *root = read_json(emitted_split(&split, "json"));
    for (size_t i = 0; i < sizeof part_numbers / sizeof *part_numbers; i++) {
        const struct expected json = {part_numbers[i].json, part_numbers[i].csv.value};
        row_has("CSV", head, third, ',', &part_numbers[i].csv, 1);
        json_has(at_path(root, "runs.0.parts.2"), &json, 1);
    }
    const struct expected run[] = {{"n", 12},
                                   {"k", 1.0 / 16},
                                   {"steps", 16},
                                   {"predicted_round_off", 0.03125},
                                   {"sum.norms.0.error.axial", 128},
                                   {"sum.tip.bending", 129},
                                   {"whole.norms.0.error.bending", 48},
                                   {"whole.norms.0.floor.axial", 0.625},
                                   {"whole.tip.axial", 17},
                                   {"tip.axial", 66},
                                   {"solution_tip.bending", 131}};
    row_has("CSV", head, third, ',', run, 2);
    json_has(at_path(root, "runs.0"), run, sizeof run / sizeof *run);
    json_decref(root);
    free(csv);
}

/* ---- check ---- */

static const struct expected case_numbers[] = {
    {"order", 2.25},   {"low", 2.125},    {"high", 2.5},   {"expected", 2.75}, {"tolerance", 0.375},
    {"margin", 0.625}, {"constant", 3.5}, {"floor", 0.75}, {"ceiling", 7.5}};
enum { CASE_NUMBERS = sizeof case_numbers / sizeof *case_numbers };

static char *emitted_check(const char *format)
{
    struct br_error err = {0};
    struct br_scene scene = br_test_bare();
    struct br_verify verify = {0};
    struct br_point point = {
        .at = {21, 22}, .against = {23, 24}, .error = 1.5, .constant = 1.75, .used = true};
    struct br_case c = {
        .kind = BR_VERIFY_TIME,
        .expected = {&br_norm_l2, BR_PART_AXIAL, 2.75, 0.375, 0.75, 7.5, 26},
        .point = &point,
        .points = 1,
        .used = 1,
        .order = {2.25, 2.125, 2.5},
        .constant = 3.5,
        .margin = 0.625,
    };
    scene.name = (char[]){"made"};
    const struct br_check check = {"made.yaml", &scene, &verify, {0}, &c, 1, 4.25, 5.25};
    const struct br_check_page page = {
        .checks = &check, .count = 1, .wall_seconds = 8.5, .provenance = &provenance};
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    for (const struct br_check_emitter *const *e = br_check_emitters; *e; e++)
        if (strcmp((*e)->name, format) == 0)
            MUST((*e)->emit(out, &page, &err));
    fclose(out);
    return text;
}

/* The number behind a key, as `pattern` puts it. */
static double number_behind(const char *text, const char *pattern, const char *key)
{
    char wanted[64];
    snprintf(wanted, sizeof wanted, pattern, key);
    const char *at = strstr(text, wanted);
    if (!at)
        fail_msg("'%s' is not in:\n%s", wanted, text);
    return strtod(at + strlen(wanted), NULL);
}

static void check_is_printed(void **state)
{
    (void)state;
    char *junit = emitted_check("junit"), *tap = emitted_check("tap");
    for (size_t i = 0; i < CASE_NUMBERS; i++) {
        const struct expected *e = &case_numbers[i];
        is("JUnit", e->key, number_behind(junit, "<property name=\"%s\" value=\"", e->key),
           e->value);
        if (strcmp(e->key, "expected") != 0)
            is("TAP", e->key, number_behind(tap, "\n  %s: ", e->key), e->value);
    }
    assert_non_null(strstr(tap, "expected 2.75 +- 0.375: PASS"));
    is("JUnit", "line", number_behind(junit, " %s=\"", "line"), 26);
    is("JUnit", "tests", number_behind(junit, " %s=\"", "tests"), 1);
    is("JUnit", "failures", number_behind(junit, " %s=\"", "failures"), 0);
    free(junit);
    free(tap);
}

static void check_is_printed_for_people(void **state)
{
    (void)state;
    char *text = emitted_check("markdown");
    char *rest = strstr(text, "| scene |"), *head = next_line(&rest);
    next_line(&rest);
    char *row = next_line(&rest);
    const struct expected numbers[] = {{"expected", 2.75},
                                       {"observed order", 2.25},
                                       {"margin", 0.625},
                                       {"constant", 3.5},
                                       {"its range", 0.75}};
    row_has("Markdown", head, row, '|', numbers, sizeof numbers / sizeof *numbers);
    assert_non_null(strstr(row, "| 2.75 +- 0.375 |"));
    assert_non_null(strstr(row, "[2.12, 2.50]"));
    assert_non_null(strstr(row, "| 0.75 to 7.5 |"));
    free(text);
}

static void check_is_in_json(void **state)
{
    (void)state;
    json_t *root = read_json(emitted_check("json"));
    const json_t *scene = at_path(root, "scenes.0"), *c = at_path(scene, "cases.0");
    const struct expected order[] = {{"value", 2.25}, {"low", 2.125}, {"high", 2.5}};
    const struct expected point[] = {{"n", 21},         {"steps", 22},
                                     {"against_n", 23}, {"against_steps", 24},
                                     {"error", 1.5},    {"constant", 1.75}};
    const struct expected cost[] = {{"seconds", 4.25}, {"element_steps", 5.25}};
    json_has(at_path(c, "order"), order, 3);
    json_has(c, case_numbers + 3, CASE_NUMBERS - 3);
    json_has(at_path(c, "points.0"), point, 6);
    json_has(scene, cost, 2);
    json_decref(root);
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
        const struct br_fields_request fields = {path,  &w->scene, ELEMENTS,   STEPS,
                                                 LOOKS, 1,         &provenance};
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

static json_t *summary(const struct watched *w, const struct br_prediction *prediction)
{
    struct br_error err = {0};
    const struct br_warnings warnings = {0};
    const struct br_run_page page = {&w->report, prediction, &warnings, &provenance, 12.5};
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    MUST(br_run_json(out, &page, &err));
    fclose(out);
    return read_json(text);
}

static void prediction_is_printed(void **state)
{
    const struct br_prediction made = {
        .known = true,
        .bounded = true,
        .field = {{0.125, 0.0625, 0.25, 1}, {0.375, 0.1875, 0.75, 1}},
        .space = {1.125, 1.0625, 1.25, 1},
        .time = {2.125, 2.0625, 2.25, 1},
        .whole = {3.125, 3.0625, 3.25, 1},
        .round_off = 0.03125,
        .seconds = 4.5,
    };
    const struct expected numbers[] = {
        {"prediction.discretisation.error", 3.125},
        {"prediction.discretisation.low", 3.0625},
        {"prediction.discretisation.high", 3.25},
        {"prediction.axial.error", 0.125},
        {"prediction.axial.low", 0.0625},
        {"prediction.axial.high", 0.25},
        {"prediction.bending.error", 0.375},
        {"prediction.bending.high", 0.75},
        {"prediction.bending.most", br_predicted_most(&made, BR_BENDING)},
        {"prediction.axial.most", br_predicted_most(&made, BR_AXIAL)},
        {"prediction.time.error", 2.125},
        {"prediction.time.high", 2.25},
        {"prediction.space.low", 1.0625},
        {"prediction.space.error", 1.125},
        {"prediction.round_off", 0.03125},
        {"prediction.seconds", 4.5},
        {"seconds.wall", 12.5}};
    json_t *root = summary(*state, &made);
    json_has(root, numbers, sizeof numbers / sizeof *numbers);
    json_decref(root);
}

static void summary_is_printed(void **state)
{
    const struct watched *w = *state;
    const struct br_run_report *p = &w->report;
    const struct br_history_row *last = &w->record.row[STEPS];
    const struct br_work *work = &p->work;
    const struct expected numbers[] = {
        {"n", ELEMENTS},
        {"steps", STEPS},
        {"h", w->scene.length / ELEMENTS},
        {"k", 1.0 / STEPS},
        {"tip.t", 1},
        {"tip.step", STEPS},
        {"tip.displacement.axial", last->displacement[BR_AXIAL]},
        {"tip.displacement.bending", last->displacement[BR_BENDING]},
        {"tip.velocity.axial", last->velocity[BR_AXIAL]},
        {"tip.velocity.bending", last->velocity[BR_BENDING]},
        {"tip.contact_force", last->contact_force},
        {"tip.friction_force", last->friction_force},
        {"tip.friction_bound", last->friction_bound},
        {"events.largest_contact_force.value", p->watch.contact_force.value},
        {"events.largest_contact_force.t", p->watch.contact_force.time},
        {"events.largest_friction_force.value", p->watch.friction_force.value},
        {"events.counts.slipped", (double)p->watch.count[BR_TIP_SLIPPED]},
        {"events.steps.slip", (double)p->watch.regime_steps[BR_TIP_SLIP]},
        {"events.steps.closed", (double)p->watch.closed_steps},
        {"energies.end.kinetic.axial", p->energy_now.kinetic[BR_AXIAL]},
        {"energies.end.kinetic.bending", p->energy_now.kinetic[BR_BENDING]},
        {"energies.end.stored.axial", p->energy_now.stored[BR_AXIAL]},
        {"energies.end.stored.bending", p->energy_now.stored[BR_BENDING]},
        {"energies.end.contact", p->energy_now.contact},
        {"energies.end.total", br_energy_total(&p->energy_now)},
        {"energies.lost_to_friction", work->friction},
        {"energies.work_of_loads.axial", work->loads[BR_AXIAL]},
        {"energies.work_of_loads.bending", work->loads[BR_BENDING]},
        {"energies.lost_to_viscosity.axial", work->viscous[BR_AXIAL]},
        {"energies.lost_to_viscosity.bending", work->viscous[BR_BENDING]},
        {"energies.lost_to_scheme.axial", work->scheme[BR_AXIAL]},
        {"energies.lost_to_scheme.bending", work->scheme[BR_BENDING]},
        {"energies.lost_to_scheme_by_contact", work->scheme_contact},
        {"energies.largest_imbalance_of_a_step", p->energy_worst},
        {"certificate.worst.axial", p->worst.axial_residual},
        {"certificate.worst.bending", p->worst.bending_residual},
        {"certificate.worst.update", p->worst.update},
        {"certificate.worst.friction", p->worst.friction},
        {"certificate.worst.contact", p->worst.contact},
        {"certificate.worst.energy", p->energy_worst},
        {"certificate.limits.axial", p->limits.axial_residual},
        {"certificate.limits.energy", p->energy_limit},
        {"seconds.set_up", p->end.set_up_seconds},
        {"seconds.march", p->end.march_seconds},
        {"seconds.per_step", p->end.march_seconds / STEPS}};
    const struct br_prediction none = {0};
    json_t *root = summary(w, &none);
    json_has(root, numbers, sizeof numbers / sizeof *numbers);
    json_decref(root);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trade_is_printed),      cmocka_unit_test(split_is_printed),
        cmocka_unit_test(check_is_printed),      cmocka_unit_test(check_is_printed_for_people),
        cmocka_unit_test(check_is_in_json),      cmocka_unit_test(history_is_printed),
        cmocka_unit_test(tip_is_the_last_node),  cmocka_unit_test(fields_are_printed),
#ifdef BR_HAVE_HDF5
        cmocka_unit_test(fields_are_in_hdf5),
#endif
        cmocka_unit_test(prediction_is_printed), cmocka_unit_test(summary_is_printed),
    };
    return cmocka_run_group_tests_name("printed_values", tests, set_up, tear_down);
}
