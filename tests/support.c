/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support.h"

#include <ctype.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "solver/linear/linear_solver.h"
#include "study/known/expression.h"
#include "study/scene/file.h"
#include "study/verify/verify.h"

/* As the program and the library do. */
__attribute__((constructor)) static void let_gsl_return(void)
{
    gsl_set_error_handler_off();
}

void br_test_close(const char *what, double actual, double expected, double tolerance,
                   const char *file, int line)
{
    const double error = fabs(actual - expected);
    if (!(error <= tolerance)) {
        print_error("%s:%d: %s is %.17g, expected %.17g +- %.3g (off by %.3g)\n", file, line, what,
                    actual, expected, tolerance, error);
        _fail(file, line);
    }
}

void br_test_at_most(const char *what, double actual, double limit, const char *file, int line)
{
    if (!(actual <= limit)) {
        print_error("%s:%d: %s is %.6g, expected at most %.6g\n", file, line, what, actual, limit);
        _fail(file, line);
    }
}

void br_test_must(enum br_status status, const struct br_error *err, const char *what,
                  const char *file, int line)
{
    if (status != BR_OK) {
        print_error("%s:%d: %s: status %d: %s\n", file, line, what, status, err->message);
        _fail(file, line);
    }
}

void br_test_refused(enum br_status status, enum br_status expected, const struct br_error *err,
                     const char *text, const char *what, const char *file, int line)
{
    const bool right = status == expected && err->status == expected && strstr(err->message, text);
    if (!right) {
        print_error("%s:%d: %s: status %d with \"%s\", expected %d with \"%s\"\n", file, line, what,
                    status, err->message, expected, text);
        _fail(file, line);
    }
}

static uint64_t next(struct br_test_random *random)
{
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double br_test_uniform(struct br_test_random *random, double low, double high)
{
    return low + (high - low) * (double)(next(random) >> 11) * 0x1p-53;
}

double br_test_log_uniform(struct br_test_random *random, double low, double high)
{
    return exp(br_test_uniform(random, log(low), log(high)));
}

size_t br_test_index(struct br_test_random *random, size_t count)
{
    return (size_t)(next(random) % count);
}

struct br_scene br_test_bundled(const char *name)
{
    struct br_error err = {0};
    struct br_scene scene;
    char path[1024];
    MUST(br_scene_find(name, path, sizeof path, &err));
    MUST(br_scene_read(path, &scene, &err));
    return scene;
}

struct br_scene br_test_bare(void)
{
    return (struct br_scene){
        .length = 1,
        .duration = 1,
        .density = 1,
        .axial = {.modelled = true, .stiffness = 1, .viscosity = 1},
        .bending = {.modelled = true, .stiffness = 1, .viscosity = 1},
    };
}

struct br_function br_test_function(const char *expression)
{
    struct br_error err = {0};
    struct br_function function;
    MUST(br_expression(expression, &function, &err));
    return function;
}

struct br_load br_test_load(const char *expression)
{
    return (struct br_load){.term[0].space = br_test_function(expression),
                            .term[0].time = {.constant = 1}};
}

struct br_method br_test_method(const char *solver, const char *contact, const char *friction)
{
    struct br_method method = br_method_default();
    if (solver)
        method.solver = br_linear_solver_find(solver);
    if (contact)
        method.contact = br_contact_rule_find(contact);
    if (friction)
        method.friction = br_friction_rule_find(friction);
    assert_non_null(method.solver);
    assert_non_null(method.contact);
    assert_non_null(method.friction);
    return method;
}

struct br_march *br_test_march(const struct br_scene *scene, size_t n, size_t steps,
                               const struct br_method *method)
{
    struct br_error err = {0};
    struct br_march *march;
    MUST(br_march_create(&march, scene, n, steps, method, &err));
    return march;
}

void br_test_advance(struct br_march *march, size_t until)
{
    struct br_error err = {0};
    while (br_march_steps_done(march) < until)
        MUST(br_march_step(march, &err));
}

struct br_test_end br_test_run(const struct br_scene *scene, size_t n, size_t steps,
                               const struct br_method *method)
{
    struct br_march *march = br_test_march(scene, n, steps, method);
    br_test_advance(march, steps);
    struct br_test_end end = {br_march_tip_displacement(march, BR_AXIAL),
                              br_march_tip_displacement(march, BR_BENDING), 0};
    double *w = calloc(2 * (n + 1), sizeof *w);
    assert_non_null(w);
    br_march_get(march, BR_BENDING, w, NULL);
    end.w_middle = w[2 * (n / 2)];
    free(w);
    br_march_free(march);
    return end;
}

struct br_study br_test_study(const struct br_scene *scene, const struct br_judge *judge,
                              size_t n_count, const size_t *n, size_t k_count, const size_t *steps)
{
    return (struct br_study){
        .scene = scene,
        .norm = br_norms[0],
        .method = br_method_default(),
        .judge = judge,
        .reference_method = br_method_default(),
        .n_count = n_count,
        .k_count = k_count,
        .n = n,
        .steps = steps,
    };
}

void br_test_all_norms(struct br_study s[BR_TEST_NORMS])
{
    for (size_t m = 0; m < BR_TEST_NORMS; m++) {
        s[m] = s[0];
        s[m].norm = br_norms[m];
        s[m].next_norm = m + 1 < BR_TEST_NORMS ? &s[m + 1] : NULL;
    }
}

size_t br_test_golden(struct br_test_golden rows[BR_TEST_MOST_GOLDEN])
{
    char path[1024], line[256];
    br_data_path("tests/data/discrete.csv", path, sizeof path);
    FILE *file = fopen(path, "r");
    size_t count = 0;
    while (file && count < BR_TEST_MOST_GOLDEN && fgets(line, sizeof line, file)) {
        struct br_test_golden *row = &rows[count];
        double k;
        if (sscanf(line, "%31[^,],%zu,%lf,%lf,%lf,%lf", row->scene, &row->n, &k, &row->end.u_tip,
                   &row->end.w_tip, &row->end.w_middle) != 6)
            continue; /* a heading */
        row->steps = (size_t)lround(1 / k);
        count++;
    }
    if (file)
        fclose(file);
    if (count == 0)
        fail_msg("%s: unreadable", path);
    return count;
}

double br_test_deviation(const struct br_test_end *end, const struct br_test_end *golden)
{
    const double scale = fmax(fabs(golden->w_tip), fabs(golden->w_middle));
    const double errors[] = {fabs(end->u_tip / golden->u_tip - 1),
                             fabs(end->w_tip - golden->w_tip) / scale,
                             fabs(end->w_middle - golden->w_middle) / scale};
    double most = 0;
    for (size_t i = 0; i < sizeof errors / sizeof *errors; i++)
        if (!(errors[i] <= most))
            most = errors[i];
    return most;
}

bool br_test_quick(void)
{
    return getenv("BR_TEST_QUICK") != NULL;
}

bool br_test_long(void)
{
    return getenv("BR_TEST_LONG") != NULL;
}

double br_test_slack(void)
{
    volatile long double one = 1, tiny = 1e-18L;
    return one + tiny == one ? 1e4 : 1;
}

/* ---- scenes as files ---- */

static char scene_file[] = "/tmp/br_test_scene_XXXXXX.yaml";

static void remove_scene_file(void)
{
    remove(scene_file);
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

const char *br_test_scene_file(const char *text)
{
    static bool made;
    if (!made) {
        const int descriptor = mkstemps(scene_file, 5);
        assert_true(descriptor >= 0 && close(descriptor) == 0);
        assert_int_equal(atexit(remove_scene_file), 0);
        made = true;
    }
    write_file(scene_file, text);
    return scene_file;
}

void br_test_scene_refused(const char *text, bool verify, const char *message)
{
    struct br_error err = {0};
    struct br_scene scene;
    struct br_verify v = {0};
    const char *path = br_test_scene_file(text);
    const enum br_status status = verify ? br_verify_read(path, text, NULL, &scene, &v, &err)
                                         : br_scene_read_text(path, text, &scene, &err);
    br_verify_clear(&v);
    br_scene_clear(&scene);
    if (status != BR_BAD_INPUT || err.status != BR_BAD_INPUT || !strstr(err.message, message) ||
        strncmp(err.message, path, strlen(path)) != 0)
        fail_msg("%s\nsaid '%s', expected '%s'", text, err.message, message);
}

/* ---- rows ---- */

char *br_test_part(char *row)
{
    char *bar = strstr(row, " | ");
    if (!bar)
        return row + strlen(row);
    *bar = '\0';
    return bar + 3;
}

char *br_test_unescape(char *text)
{
    char *to = text;
    for (const char *from = text; *from; from++)
        if (strncmp(from, "\\n", 2) == 0) {
            *to++ = '\n';
            from++;
        } else
            *to++ = *from;
    *to = '\0';
    return text;
}

void br_test_rows(const char *section, void (*check)(char *row))
{
    char path[1024], *row = NULL;
    size_t room = 0, rows = 0;
    bool inside = false;
    br_data_path("tests/data/text_refusals.txt", path, sizeof path);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (getline(&row, &room, file) > 0) {
        row[strcspn(row, "\n")] = '\0';
        if (strncmp(row, "= ", 2) == 0) {
            inside = strcmp(row + 2, section) == 0;
        } else if (inside && *row && strncmp(row, "##", 2) != 0) {
            check(row);
            rows++;
        }
    }
    assert_true(rows > 20);
    free(row);
    fclose(file);
}

/* ---- stored texts ---- */

/* The number of bytes up to the first difference; numbers may differ within the tolerance. */
static size_t same_bytes(const char *text, const char *stored, double tolerance)
{
    const char *at = text;
    while (*at && *stored) {
        char *end, *stored_end;
        const double number = strtod(at, &end), other = strtod(stored, &stored_end);
        if (tolerance > 0 && isdigit((unsigned char)*at) && isdigit((unsigned char)*stored) &&
            fabs(number - other) <= tolerance * other) {
            at = end;
            stored = stored_end;
        } else if (*at != *stored) {
            return (size_t)(at - text);
        } else {
            at++;
            stored++;
        }
    }
    return (size_t)(at - text) + (*stored != '\0');
}

void br_test_stored(const char *name, void (*print)(FILE *out), double tolerance)
{
    static char stored[1 << 18];
    char path[1024], *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    print(out);
    assert_int_equal(fclose(out), 0);
    snprintf(path, sizeof path, "%s/tests/golden/made/%s.txt", getenv("BEAMRATE_DATA"), name);
    if (getenv("BR_TEST_UPDATE"))
        write_file(path, text);
    FILE *file = fopen(path, "r");
    if (!file)
        fail_msg("%s is not there", path);
    stored[fread(stored, 1, sizeof stored - 1, file)] = '\0';
    fclose(file);
    const size_t same = same_bytes(text, stored, tolerance);
    if (same != size)
        fail_msg("%s is otherwise from here on (./bootstrap update writes it anew): %.200s", path,
                 text + (same < size ? same : size));
    free(text);
}

/* ---- memory ---- */

void br_test_without_memory(enum br_status (*attempt)(const void *data, struct br_error *err),
                            const void *data, long least)
{
    long failed = 0, left = -1;
    for (long i = 0; left < 0; i++) {
        struct br_error err = {0};
        br_allocation_fails_at(i);
        const enum br_status status = attempt(data, &err);
        left = br_allocation_fails_at(-1);
        if (status)
            REFUSED(status, BR_NO_MEMORY, "out of memory");
        failed += status != BR_OK;
        assert_true(i < 10000 && !(status && left >= 0));
    }
    if (failed < least)
        fail_msg("%ld allocations failed, expected at least %ld", failed, least);
}

const struct br_warning *br_test_warning(const struct br_warnings *w, enum br_warning_kind kind)
{
    for (size_t i = 0; i < w->count; i++)
        if (w->list[i].kind == kind)
            return &w->list[i];
    return NULL;
}
