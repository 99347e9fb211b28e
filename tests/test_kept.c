/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies that were stopped go on with what is kept, and have the bits of one go. All that a
 * request states is in the text that an entry belongs to. Nothing else, and nothing damaged, is
 * taken. */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "orders/program/process.h"
#include "orders/request.h"
#include "solver/linear/linear_solver.h"
#include "study/grid/sweep.h"
#include "study/kept/kept_study.h"
#include "study/scene/file.h"
#include "study/scene/method_fields.h"
#include "study/trade/trial.h"
#include "support.h"

static const size_t grid_n[] = {10, 20, 30, 40, 60}, grid_steps[] = {20, 50, 100, 200};
enum { N = 4, STEPS = 4 };

static char folder[64];

static int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/beamrate-kept-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    br_remove_folder(folder);
    return 0;
}

/* All norms of one study, and where they are kept. */
static void prepare(struct br_study s[BR_TEST_NORMS], const struct br_scene *scene, size_t n,
                    struct br_kept *kept)
{
    s[0] = br_test_study(scene, br_judge_best(scene), n, grid_n, STEPS, grid_steps);
    s[0].engine = br_kept_engine(kept);
    br_test_all_norms(s);
}

static void clear(struct br_study s[BR_TEST_NORMS])
{
    for (size_t m = 0; m < BR_TEST_NORMS; m++)
        br_study_clear(&s[m]);
}

static struct br_kept open_kept(bool take, const char *machine)
{
    struct br_kept kept = {0};
    struct br_error err;
    assert_int_equal(br_kept_open(&kept, folder, take, machine, &err), BR_OK);
    kept.slice = 0; /* a slice for each cell, whatever the reference costs */
    kept.most_reference = 1e30;
    return kept;
}

static size_t count_entries(void)
{
    char path[100];
    size_t count = 0;
    snprintf(path, sizeof path, "%s/.kept", folder);
    DIR *all = opendir(path);
    for (struct dirent *e; all && (e = readdir(all));)
        count += e->d_name[0] != '.';
    if (all)
        closedir(all);
    return count;
}

static void expect_same(const struct br_study a[BR_TEST_NORMS],
                        const struct br_study b[BR_TEST_NORMS], size_t cells)
{
    for (const struct br_study *x = a, *y = b; x < a + BR_TEST_NORMS; x++, y++) {
        assert_memory_equal(&x->reference_scale, &y->reference_scale, sizeof x->reference_scale);
        assert_memory_equal(x->reference_size, y->reference_size, sizeof x->reference_size);
        assert_memory_equal(x->reference_tip, y->reference_tip, sizeof x->reference_tip);
        assert_string_equal(x->events, y->events);
        for (size_t c = 0; c < cells; c++) {
            const struct br_cell *p = &x->cell[c], *q = &y->cell[c];
            assert_memory_equal(&p->at, &q->at, sizeof p->at);
            assert_memory_equal(p->error, q->error, sizeof p->error);
            assert_memory_equal(p->worst_time, q->worst_time, sizeof p->worst_time);
            assert_memory_equal(p->tip, q->tip, sizeof p->tip);
            assert_int_equal(p->unstable, q->unstable);
            assert_int_equal(p->failure.status, BR_OK);
        }
    }
}

/* Stops when so many entries are there. */
static size_t stop_at;

static bool stop_when_kept(void *self)
{
    (void)self;
    return count_entries() >= stop_at;
}

/* Runs n meshes with what is kept; returns how many cells were taken. */
static size_t run(struct br_study s[BR_TEST_NORMS], const struct br_scene *scene, size_t n,
                  struct br_kept *kept)
{
    struct br_error err = {0};
    prepare(s, scene, n, kept);
    MUST(br_study_run(s, 1, 2, NULL, &err));
    return kept ? atomic_load(&kept->taken) : 0;
}

/* A study in one go, and one that is stopped in the middle and resumed; then all of it is there,
 * and a larger one goes on from it. */
TEST(test_stopped_and_resumed)
{
    struct br_error err;
    struct br_study whole[BR_TEST_NORMS], s[BR_TEST_NORMS];
    const struct br_observer observer = {.stop = stop_when_kept};
    struct br_scene scene = br_test_bundled("example2");
    struct br_kept first = open_kept(false, "here"), second = open_kept(true, "here"),
                   third = open_kept(true, "here"), more = open_kept(true, "here");
    run(whole, &scene, N, NULL);
    stop_at = 6;
    prepare(s, &scene, N, &first);
    assert_int_equal(br_study_run(s, 1, 2, &observer, &err), BR_INTERRUPTED);
    const size_t kept = count_entries();
    if (!(kept >= stop_at && kept < BR_TEST_NORMS * N * STEPS))
        fail_msg("%zu entries were kept", kept);
    assert_int_equal(run(s, &scene, N, &second), kept / BR_TEST_NORMS);
    assert_int_equal(atomic_load(&second.bad), 0);
    expect_same(whole, s, N * STEPS);
    assert_int_equal(count_entries(), BR_TEST_NORMS * (N * STEPS + 1));
    clear(s);
    assert_int_equal(run(s, &scene, N, &third), N * STEPS);
    expect_same(whole, s, N * STEPS);
    clear(s);
    assert_int_equal(run(s, &scene, N + 1, &more), N * STEPS);
    for (size_t c = 0; c < N * STEPS; c++)
        CLOSE(s[0].cell[c].error[BR_PART_TOTAL], whole[0].cell[c].error[BR_PART_TOTAL], 1e-12);
    clear(s);
    clear(whole);
    br_scene_clear(&scene);
}

/* A tip that chatters does so, too, where its cell is taken from what is kept. */
TEST(test_unstable_is_kept)
{
    static const size_t n = 4, steps = 10;
    struct br_scene scene = br_test_bundled("example2");
    scene.contact.stiffness = 1e9; /* N/m */
    for (int take = 0; take < 2; take++) {
        struct br_error err = {0};
        struct br_kept kept = open_kept(take, "here");
        struct br_study s = br_test_study(&scene, &br_judge_fine, 1, &n, 1, &steps);
        s.reference_method.contact = br_contact_rule_find("implicit");
        s.reference = (struct br_resolution){8, 20};
        s.engine = br_kept_engine(&kept);
        MUST(br_study_run(&s, 1, 1, NULL, &err));
        assert_int_equal(atomic_load(&kept.taken), take);
        assert_true(s.cell[0].unstable);
        br_study_clear(&s);
    }
    br_scene_clear(&scene);
}

/* ---- all that is asked is in the text ---- */

/* All members of each struct, in their order: whether they are in the text of a cell (CELL), of the
 * whole study alone (GRID), or in none (NONE: what is found, or how); a value; another one. The
 * compiler refuses a member that has no row. */
#pragma GCC diagnostic error "-Wmissing-field-initializers"
#define FIRST(in, member, a, b) a,
#define ITERATION(X) \
    X(CELL, parameter, 0.5, 0.25) X(CELL, tolerance, 1e-8, 2e-8) X(CELL, most, 10, 11)
#define METHOD(X)                                                               \
    X(CELL, scheme, br_time_schemes[0], br_time_schemes[1])                     \
    X(CELL, tolerance, 1e-6, 2e-6)                                              \
    X(CELL, solver, br_linear_solvers[0], br_linear_solvers[1])                 \
        X(CELL, kernel, br_kernels[0], br_kernels[1])                           \
            X(CELL, contact, br_contact_rules[0], br_contact_rules[1])          \
                X(CELL, friction, br_friction_rules[0], br_friction_rules[1])   \
                    X(NONE, iteration, iteration, iteration) /* ITERATION */ X( \
                        CELL, axial_degree, 1, 2) X(CELL, most_steps, 7, 8)
#define FIELD(X)                                                                           \
    X(CELL, modelled, true, false)                                                         \
    X(CELL, stiffness, 1, 2)                                                               \
    X(CELL, viscosity, 1, 2)                                                               \
    X(CELL, load, none, load) X(CELL, tip_force, zero, one) X(CELL, tip_moment, zero, one) \
        X(CELL, displacement, zero, one) X(CELL, velocity, zero, one)                      \
            X(CELL, displacement_slope, zero, one) X(CELL, velocity_slope, zero, one)      \
                X(CELL, solution, NULL, "x [m]") X(CELL, given, zero, one)                 \
                    X(CELL, stick_force, zero, one)
#define FIELDS             \
    {                      \
        {                  \
            axial, bending \
        }                  \
    }
#define CONTACT(X) \
    X(CELL, modelled, true, false) X(CELL, gap, 0, 0x1p-1074) X(CELL, stiffness, 1, 2)
#define FRICTION(X)                     \
    X(CELL, law, BR_TRESCA, BR_COULOMB) \
    X(CELL, coefficient, 1, 1 + 0x1p-52) X(CELL, regularisation, 0, 1)
#define SCENE(X)                                                                                   \
    X(NONE, name, "a", "b")                                                                        \
    X(CELL, title, "a", "b")                                                                       \
    X(CELL, remark, "a", "b")                                                                      \
    X(CELL, length, 1, 2) X(CELL, duration, 1, 2) X(CELL, density, 1, 2)                           \
        X(NONE, field, FIELDS, )                                                 /* FIELD */       \
        X(NONE, contact, contact, contact) X(NONE, friction, friction, friction) /* those lists */ \
        X(NONE, derived, {{0}}, )
#define STUDY(X)                                                                                   \
    X(NONE, scene, &scene, &scene)                                                                 \
    /* SCENE */ X(CELL, norm, &br_norm_l2, &br_norm_energy) X(                                     \
        NONE, method, method, method) /* METHOD */ X(CELL, cell_method, NULL, apart)               \
        X(CELL, judge, &br_judge_fine, &br_judge_mms) X(CELL, reference_method, method, apart[0])  \
            X(CELL, reference, finer, finest) X(GRID, auditor, NULL, &br_judge_exact)              \
                X(GRID, n_count, 2, 1) X(GRID, k_count, 2, 1) X(GRID, path, false, true)           \
                    X(CELL, n, grid_n, grid_n + 1) X(CELL, steps, grid_steps, grid_steps + 1)      \
                        X(NONE, next_norm, NULL, NULL) X(NONE, engine, {0}, )                      \
                            X(NONE, cell, NULL, NULL) X(NONE, judged_by, unjudged, )               \
                                X(NONE, events, NULL, NULL) X(NONE, reference_scale, 0, 0)         \
                                    X(NONE, reference_size, {0}, ) X(NONE, reference_error, {0}, ) \
                                        X(NONE, reference_tip, {0}, ) X(NONE, failure, {0}, )

static char *text_of(const struct br_study *s, size_t cell)
{
    struct br_statement text;
    br_statement_begin(&text);
    br_state_study(&text, s, cell);
    return br_statement_end(&text);
}

/* Two requests' texts differ, of a cell and of the whole, or of the whole alone. */
static void expect_other(const char *what, const struct br_study *a, const struct br_study *b,
                         bool cell)
{
    for (int whole = 0; whole < 2; whole++) {
        char *x = text_of(a, whole ? SIZE_MAX : 0), *y = text_of(b, whole ? SIZE_MAX : 0);
        assert_non_null(x);
        assert_non_null(y);
        if ((strcmp(x, y) != 0) != (whole || cell))
            fail_msg("%s: %s in the text of %s", what, whole || cell ? "is not" : "is",
                     whole ? "a study" : "a cell");
        free(x);
        free(y);
    }
}

static void reset(const struct br_study *asked, struct br_study *other,
                  const struct br_scene *scene, struct br_scene *of)
{
    *other = *asked;
    *of = *scene;
    other->scene = of;
}

TEST(test_all_members_are_stated)
{
    struct br_function zero = {0}, one = {.constant = 1};
    struct br_load none = {0}, load = {{{one, one}}};
    struct br_scene_field axial = {FIELD(FIRST)}, bending = axial;
    struct br_contact contact = {CONTACT(FIRST)};
    struct br_friction friction = {FRICTION(FIRST)};
    struct br_scene scene = {SCENE(FIRST)};
    struct br_iteration iteration = {ITERATION(FIRST)};
    struct br_method method = {METHOD(FIRST)}, apart[4] = {method, method, method, method};
    struct br_judge_report unjudged = {.unstable = false};
    struct br_resolution finer = {80, 200}, finest = {80, 400};
    for (int i = 0; i < 4; i++)
        apart[i].tolerance = 1e-3;
    const struct br_study asked = {STUDY(FIRST)};
    struct br_study other = asked;
    struct br_scene of = scene;
#define CELL(member, b, at)                              \
    (at).member = b;                                     \
    expect_other(#at "." #member, &asked, &other, true); \
    reset(&asked, &other, &scene, &of);
#define GRID(member, b, at)                               \
    (at).member = b;                                      \
    expect_other(#at "." #member, &asked, &other, false); \
    reset(&asked, &other, &scene, &of);
#define NONE(member, b, at)
#define IN_STUDY(in, member, a, b) in(member, b, other)
#define IN_METHOD(in, member, a, b) in(member, b, other.method)
#define IN_ITERATION(in, member, a, b) in(member, b, other.method.iteration)
#define IN_SCENE(in, member, a, b) in(member, b, of)
#define IN_AXIAL(in, member, a, b) in(member, b, of.axial)
#define IN_BENDING(in, member, a, b) in(member, b, of.bending)
#define IN_CONTACT(in, member, a, b) in(member, b, of.contact)
#define IN_FRICTION(in, member, a, b) in(member, b, of.friction)
    reset(&asked, &other, &scene, &of);
    STUDY(IN_STUDY)
    METHOD(IN_METHOD)
    ITERATION(IN_ITERATION)
    SCENE(IN_SCENE) FIELD(IN_AXIAL) FIELD(IN_BENDING) CONTACT(IN_CONTACT) FRICTION(IN_FRICTION)
        other.reference_method.most_steps = 9;
    expect_other("the reference's method", &asked, &other, true);
    /* The registries: a field of a method that is got, and a number of a scene, is stated. */
    for (const struct br_method_field *f = br_method_fields;
         f < br_method_fields + BR_METHOD_FIELDS; f++) {
        reset(&asked, &other, &scene, &of);
        f->set(&other.method, f->words ? f->get(&method) == 0 : 0.125);
        expect_other(f->name, &asked, &other, true);
    }
    for (const struct br_scene_key *key = br_scene_keys; key->name; key++) {
        reset(&asked, &other, &scene, &of);
        if (key->need == BR_MAKES || key->offset == 0 || key->kind == BR_KEY_TEXT)
            continue;
        ((char *)&of)[key->offset] ^= key->kind == BR_KEY_SOLUTION ? 0 : 1;
        if (key->kind == BR_KEY_POSITIVE || key->kind == BR_KEY_NOT_NEGATIVE)
            expect_other(key->name, &asked, &other, true);
    }
}

/* Expressions of the same nodes in another order, or of an operation with the same word. */
TEST(test_functions_are_stated)
{
    static const char *const same[][2] = {{"x*t", "t*t"},
                                          {"sin(x)", "cos(x)"},
                                          {"x-t", "t-x"},
                                          {"-x", "x-x"},
                                          {"x+1", "x+1.0000000000000002"},
                                          {"x>t ? x : t", "x>t ? t : x"},
                                          {"x*t+x", "x*t+t"}};
    struct br_scene scene = br_test_bare(), of = scene;
    const struct br_method method = br_method_default();
    const struct br_study a = {.scene = &scene,
                               .norm = br_norms[0],
                               .method = method,
                               .judge = &br_judge_mms,
                               .n_count = 1,
                               .k_count = 1,
                               .n = grid_n,
                               .steps = grid_steps};
    struct br_study b = a;
    b.judge = &br_judge_exact;
    expect_other("a judge without a resolution", &a, &b, true);
    b = a;
    b.scene = &of;
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        scene.axial.displacement = br_test_function(same[i][0]);
        of.axial.displacement = br_test_function(same[i][1]);
        expect_other(same[i][0], &a, &b, true);
        br_function_free(&scene.axial.displacement);
        br_function_free(&of.axial.displacement);
    }
    static const struct br_function_ops unknown = {0};
    of.axial.displacement = (struct br_function){.ops = &unknown};
    assert_null(text_of(&b, 0)); /* nothing of it is kept */
}

/* ---- what is not taken ---- */

/* The work of each command: n cells, trials or runs that are marched in a moment. Returns how many
 * of its entries were taken. */
enum work { STUDY_WORK, TRIAL_WORK, RUN_WORK, WORKS };

static struct br_scene small;
static struct br_trial_request asked_of_trials;

static size_t taken_of(enum work work, struct br_kept *kept, const struct br_trial_request *asked)
{
    struct br_error err = {0};
    static const size_t n = 4, steps = 10;
    size_t taken = 0;
    if (work == STUDY_WORK) {
        struct br_study s = br_test_study(&small, br_judge_best(&small), 1, &n, 1, &steps);
        s.engine = br_kept_engine(kept);
        MUST(br_study_run(&s, 1, 1, NULL, &err));
        br_study_clear(&s);
    } else if (work == TRIAL_WORK) {
        struct br_trial_request request = *asked;
        const struct br_named_method named = {.method = br_method_default()};
        struct br_trial trial = br_trial_at(&named, n, steps, 0);
        request.kept = kept;
        MUST(br_trials_run(&trial, 1, &request, &err));
        assert_true(trial.end == BR_TRIAL_DONE || trial.end == BR_TRIAL_OVER ||
                    trial.end == BR_TRIAL_DOUBTFUL);
    } else {
        static const struct br_resolution_column cells = {.name = "n", .axis = BR_AXIS_SPACE};
        static const struct br_reading reading = {
            .name = "err", .what = "(.*)", .kind = BR_READING_REGEX};
        static const double one = 4;
        struct br_numbers numbers = {.rows = 0};
        const struct br_orders_request request = {.command = "/bin/echo {n}",
                                                  .axis[BR_AXIS_SPACE] = {&cells, &one, 1},
                                                  .dimension = 1,
                                                  .reading = &reading,
                                                  .readings = 1,
                                                  .jobs = 1,
                                                  .seconds = 10,
                                                  .kept = kept->folder,
                                                  .anew = !kept->take};
        MUST(br_program_run(&request, &numbers, &err));
        assert_true(isfinite(numbers.row[0].number[0]) && numbers.row[0].seconds >= 0);
        taken = numbers.row[0].kept;
        br_numbers_clear(&numbers);
    }
    return taken + (work == RUN_WORK ? 0 : atomic_exchange(&kept->taken, 0));
}

/* Empties the folder and fills it with the entries of a work. */
static void fill(enum work work, struct br_kept *kept)
{
    br_remove_folder(kept->folder);
    assert_int_equal(mkdir(kept->folder, 0700), 0);
    kept->take = false;
    taken_of(work, kept, &asked_of_trials);
    kept->take = true;
    assert_int_equal(taken_of(work, kept, &asked_of_trials), work == TRIAL_WORK ? 2 : 1);
}

static void start_works(void)
{
    small = br_test_bundled("example2");
    asked_of_trials = br_trial_request_default(&small);
    asked_of_trials.repeats = 1;
    asked_of_trials.repeat_seconds = 1e-9;
}

/* A trial's timing and the cell of its error, each by what it depends on. */
TEST(test_requests_of_trials)
{
    start_works();
    struct br_kept kept = open_kept(true, "here"), there = open_kept(true, "there");
    struct br_kept version = open_kept(true, "here");
    struct br_trial_request r = asked_of_trials;
    version.program[0] ^= 1;
    fill(TRIAL_WORK, &kept);
    assert_int_equal(taken_of(TRIAL_WORK, &there, &r), 0);
    fill(TRIAL_WORK, &kept);
    assert_int_equal(taken_of(TRIAL_WORK, &version, &r), 0);
    struct br_scene other = br_test_bundled("example2");
    other.friction.coefficient *= 1 + 0x1p-52;
    r.scene = &other;
    assert_int_equal(taken_of(TRIAL_WORK, &kept, &r), 0);
    r = asked_of_trials;
    r.repeats = 2; /* each changes the timing alone, ... */
    assert_int_equal(taken_of(TRIAL_WORK, &kept, &r), 1);
    r = asked_of_trials;
    r.repeat_seconds *= 2;
    assert_int_equal(taken_of(TRIAL_WORK, &kept, &r), 1);
    r = asked_of_trials;
    r.time_limit *= 2;
    assert_int_equal(taken_of(TRIAL_WORK, &kept, &r), 1);
    r = asked_of_trials;
    r.norm = br_norms[1]; /* ... or the error alone */
    assert_int_equal(taken_of(TRIAL_WORK, &kept, &r), 1);
    br_scene_clear(&other);
    br_scene_clear(&small);
}

/* Nothing is kept of a trial that fails, so that nothing is found damaged. The third-order scheme
 * refuses a vibration without damping. */
TEST(test_failed_trials)
{
    struct br_error err = {0};
    struct br_named_method named;
    struct br_scene scene = br_test_bundled("impact");
    struct br_trial_request request = br_trial_request_default(&scene);
    MUST(br_named_method_read("bdf3", &named, &err));
    for (int take = 0; take < 2; take++) {
        struct br_kept kept = open_kept(take, "here");
        struct br_trial trial = br_trial_at(&named, 10, 120, 0);
        request.kept = &kept;
        MUST(br_trials_run(&trial, 1, &request, &err));
        assert_int_equal(trial.end, BR_TRIAL_FAILED);
        assert_non_null(strstr(trial.failure.message, "of so little damping"));
        assert_int_equal(atomic_load(&kept.bad), 0);
    }
    br_scene_clear(&scene);
}

/* A file's bytes, with its right sum again. */
static void write_entry(const char *path, char *bytes, size_t size)
{
    char sum[BR_SHA256_TEXT];
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    if (size >= BR_SHA256_TEXT) {
        br_sha256_of(bytes + BR_SHA256_TEXT, size - BR_SHA256_TEXT, sum);
        memcpy(bytes, sum, BR_SHA256_TEXT - 1);
    }
    fwrite(bytes, 1, size, file);
    fclose(file);
}

/* The entries of a folder, at most `most`. */
static size_t list(const struct br_kept *kept, char path[][1300], size_t most)
{
    size_t count = 0;
    DIR *all = opendir(kept->folder);
    for (struct dirent *e; (e = readdir(all));)
        if (e->d_name[0] != '.' && count < most)
            snprintf(path[count++], 1300, "%.1100s/%.100s", kept->folder, e->d_name);
    closedir(all);
    return count;
}

/* Spoils an entry: 0: random numbers; 1: some byte of its text; 2: cut off or longer; 3: one number
 * that may be right, or not. */
static size_t spoil(char *bytes, size_t size, int how, struct br_test_random *random)
{
    static const double special[] = {-1, 1e300, 0.5, -0.0};
    const size_t head = BR_SHA256_TEXT + strlen(bytes + BR_SHA256_TEXT) + 1;
    const size_t at = head + sizeof(double) * br_test_index(random, (size - head) / sizeof(double));
    for (size_t i = head; i < size && how == 0; i++)
        bytes[i] = (char)br_test_index(random, 256);
    if (how == 1)
        bytes[BR_SHA256_TEXT + br_test_index(random, head - BR_SHA256_TEXT)] ^= 1;
    if (how == 3)
        memcpy(bytes + at, &special[br_test_index(random, 4)], sizeof(double));
    return how != 2 ? size : br_test_index(random, 2) ? size + 8 : br_test_index(random, size);
}

/* Whatever the bytes behind a right sum are: no crash, and of random ones nothing is taken, with a
 * warning. More files with FUZZ=2000. */
TEST(test_damaged_with_a_right_sum)
{
    enum { MOST = 8, LONGEST = 20000 };
    static char path[MOST][1300], whole[LONGEST + 8], bytes[LONGEST + 8];
    struct br_test_random random = {31};
    const size_t files = getenv("FUZZ") ? (size_t)atol(getenv("FUZZ")) : 24;
    start_works();
    for (size_t i = 0; i < files; i++) {
        const enum work work = (enum work)(i % WORKS);
        const int how = (int)(i / WORKS % 4);
        struct br_kept kept = open_kept(true, "here");
        fill(work, &kept);
        const size_t entries = list(&kept, path, MOST), which = br_test_index(&random, entries);
        FILE *file = fopen(path[which], "r");
        const size_t size = fread(whole, 1, LONGEST, file);
        fclose(file);
        memset(bytes, 0, sizeof bytes);
        memcpy(bytes, whole, size);
        write_entry(path[which], bytes, spoil(bytes, size, how, &random));
        const size_t taken = taken_of(work, &kept, &asked_of_trials);
        if (how < 3 && work == RUN_WORK)
            assert_int_equal(taken, 0);
        else if (how < 3)
            assert_int_equal(atomic_load(&kept.bad), 1);
    }
    br_scene_clear(&small);
}

static void pass_seven(struct br_record *r, void *self)
{
    br_record_number(r, self, 0, 7);
}

static void pass_count(struct br_record *r, void *self)
{
    br_record_count(r, self, 2, 7);
}

/* One bit of an entry is enough; so are another's name, and a number out of its range. */
TEST(test_damaged)
{
    struct br_kept k = open_kept(true, "here");
    double seven = 7, found = 0;
    char path[2][1300];
    br_remove_folder(k.folder);
    assert_true(br_kept_put(&k, "a", pass_seven, &seven));
    assert_true(br_kept_take(&k, "a", pass_seven, &found));
    assert_true(found == 7);
    assert_int_equal(list(&k, path, 1), 1);
    snprintf(path[1], sizeof path[1], "%.1000s/%s", k.folder,
             "3e23e8160039594a33894f6564e1b1348bbd7a0088d42c4acb73eeaed59c009d"); /* of b */
    assert_int_equal(link(path[0], path[1]), 0);
    assert_false(br_kept_take(&k, "b", pass_seven, &found));
    assert_int_equal(atomic_load(&k.bad), 1);
    for (long at = 0, size = BR_SHA256_TEXT + 2 + sizeof seven; at < size; at++) {
        FILE *file = fopen(path[0], "r+");
        assert_non_null(file);
        fseek(file, at, SEEK_SET);
        const int was = fgetc(file);
        fseek(file, at, SEEK_SET);
        fputc(was ^ 1, file);
        fflush(file);
        assert_false(br_kept_take(&k, "a", pass_seven, &found));
        fseek(file, at, SEEK_SET);
        fputc(was, file);
        fclose(file);
    }
    assert_true(br_kept_take(&k, "a", pass_seven, &found));
    for (size_t i = 0; i < 4; i++) {
        seven = (double[]){7.5, -1, (double)NAN, (double)INFINITY}[i];
        assert_true(br_kept_put(&k, "c", pass_seven, &seven)); /* it is no failure, but ... */
        assert_false(br_kept_take(&k, "c", pass_seven, &found));
    }
    for (size_t count = 1, read = 0; count <= 8; count++) {
        const bool right = count >= 2 && count <= 7;
        assert_true(br_kept_put(&k, "d", pass_count, &count));
        assert_int_equal(br_kept_take(&k, "d", pass_count, &read), right || count == 8);
        assert_int_equal(read, right ? count : count == 8 ? 7 : 0);
    }
    assert_int_equal(truncate(path[0], 20), 0);
    assert_false(br_kept_take(&k, "a", pass_seven, &found));
    assert_false(br_kept_take(&k, NULL, pass_seven, &found));
    strcpy(k.folder, "/dev/null/.kept");
    seven = 7;
    assert_false(br_kept_put(&k, "a", pass_seven, &seven));
    assert_int_equal(atomic_load(&k.lost), 1);
}

AROUND_TESTS(make_folder, remove_folder)
