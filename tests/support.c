/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "study/scene/expression.h"
#include "study/scene/file.h"

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
        print_error("%s:%d: %s: %s: %s\n", file, line, what, br_status_text(status), err->message);
        _fail(file, line);
    }
}

void br_test_refused(enum br_status status, enum br_status expected, const struct br_error *err,
                     const char *text, const char *what, const char *file, int line)
{
    const bool right = status == expected && err->status == expected && strstr(err->message, text);
    if (!right) {
        print_error("%s:%d: %s: \"%s\" with \"%s\", expected \"%s\" with \"%s\"\n", file, line,
                    what, br_status_text(status), err->message, br_status_text(expected), text);
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

/* ---- the L2 distance ---- */

/* Value and scaled slope (per fine element: ratio of the coarse one) at xi. */
static void hermite(const double *node, long double xi, long double ratio, long double out[2])
{
    const long double w0 = node[0], s0 = node[1], w1 = node[2], s1 = node[3];
    const long double c2 = 3 * (w1 - w0) - 2 * s0 - s1, c3 = 2 * (w0 - w1) + s0 + s1;
    out[0] = w0 + xi * (s0 + xi * (c2 + xi * c3));
    out[1] = (s0 + xi * (2 * c2 + 3 * xi * c3)) / ratio;
}

static void coarse_at(enum br_field_kind kind, const double *coarse, size_t j, size_t ratio,
                      long double out[2])
{
    size_t e = j / ratio;
    long double xi = (long double)(j % ratio) / (long double)ratio;
    if (j > 0 && j % ratio == 0) { /* the end of an element, not beyond the last */
        e--;
        xi = 1;
    }
    if (kind == BR_BENDING) {
        hermite(coarse + 2 * e, xi, (long double)ratio, out);
        return;
    }
    out[0] = (1 - xi) * coarse[e] + xi * coarse[e + 1];
    out[1] = 0;
}

double br_test_distance(enum br_field_kind kind, double length, size_t coarse_n,
                        const double *coarse, size_t fine_n, const double *fine)
{
    static const int rod[4][4] = {{2, 0, 1, 0}, {0, 0, 0, 0}, {1, 0, 2, 0}, {0, 0, 0, 0}};
    static const int beam[4][4] = {
        {156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}};
    const bool axial = kind == BR_AXIAL;
    const size_t unknowns = axial ? 1 : 2;
    long double difference[4] = {0}, sum = 0;
    for (size_t j = 0; j <= fine_n; j++) {
        long double here[2];
        coarse_at(kind, coarse, j, fine_n / coarse_n, here);
        memmove(difference, difference + 2, 2 * sizeof *difference);
        for (size_t i = 0; i < 2; i++)
            difference[2 + i] = i < unknowns ? fine[j * unknowns + i] - here[i] : 0;
        for (int a = 0; a < 4 && j > 0; a++)
            for (int b = 0; b < 4; b++)
                sum += difference[a] * difference[b] * (axial ? rod[a][b] : beam[a][b]);
    }
    return (double)sqrtl(fmaxl(sum, 0) * length / (long double)fine_n / (axial ? 6 : 420));
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

void br_test_keep_wrong(const char *scene, const char *message)
{
    static int count;
    const char *folder = getenv("BR_WRONG_SCENES");
    if (!folder)
        return;
    char path[1024];
    snprintf(path, sizeof path, "%s/%d-%03d.yaml", folder, (int)getpid(), count++);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "# %s\n%s", message, scene);
    assert_int_equal(fclose(file), 0);
}
