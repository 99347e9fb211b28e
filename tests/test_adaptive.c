/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the adaptive scheme goes by: its estimate of a step's error. Where that is wrong the answer
 * may still be right, and the work is not: so steps are counted, too. */
#include <math.h>

#include "reference/textbook.h"
#include "solver/scene.h"
#include "support.h"

/* ---- the estimate, by the tables as they are printed ---- */

enum { ROWS = BR_TEXTBOOK_ROWS };

/* Second ends of third order: Hairer and Wanner's Table IV.6.5, and Kennedy and Carpenter's
 * ARK4(3)6L[2]SA. */
static const long double second_end[2][ROWS] = {
    {59 / 48.0L, -17 / 96.0L, 225 / 32.0L, -85 / 12.0L, 0},
    {4586570599 / 29645900160.0L, 0, 178811875 / 945068544.0L, 814220225 / 1159782912.0L,
     -3700637 / 11593932.0L, 61727 / 225920.0L}};

/* The conditions of order 3 that a second end has to meet, and one of order 4 that it does not. */
TEST(test_second_ends)
{
    for (size_t since = 0; since < 2; since++) {
        const struct br_textbook *book = br_textbook_step("adaptive", since);
        const long double *b = second_end[since];
        long double sum[5] = {0};
        for (int i = 0; i < book->rows; i++) {
            long double inner = 0;
            for (int j = 0; j <= i; j++)
                inner += book->a[i][j] * book->c[j];
            sum[0] += b[i];
            sum[1] += b[i] * book->c[i];
            sum[2] += b[i] * book->c[i] * book->c[i];
            sum[3] += b[i] * inner;
            sum[4] += b[i] * book->c[i] * book->c[i] * book->c[i];
        }
        CLOSE((double)sum[0], 1, 1e-15);
        CLOSE((double)sum[1], 1.0 / 2, 1e-15);
        CLOSE((double)sum[2], 1.0 / 3, 1e-15);
        CLOSE((double)sum[3], 1.0 / 6, 1e-15);
        assert_true(fabsl(sum[4] - 0.25L) > 1e-4L);
    }
}

/* y' = lambda y + cos(t), which has stages of one solve each: the scheme's own weights, from
 * states. history: y and tau y' at the step's start. */
static double estimate_by_scheme(size_t since, double lambda, double y, double k)
{
    struct br_stages s;
    br_time_scheme_step(br_time_scheme_find("adaptive"), since, &s);
    double known[BR_KNOWN] = {[BR_NOW] = y}, sum = 0;
    for (int i = 0; i < s.count; i++) {
        const double tau = s.stage[i].gamma * k;
        double z = 0;
        known[BR_RATE] = tau * (lambda * y + 1);
        for (int j = 0; j < BR_KNOWN; j++)
            z += s.stage[i].weight[j] * known[j];
        known[BR_STAGE + i] = (z + tau * cos(s.stage[i].time * k)) / (1 - tau * lambda);
    }
    for (int j = 0; j < BR_KNOWN; j++)
        sum += s.error[j] * known[j];
    return sum;
}

/* The same by Y'_i = lambda Y_i + cos(c_i k), row by row; the first end is the last row. */
static long double estimate_by_book(size_t since, long double lambda, long double y, long double k)
{
    const struct br_textbook *book = br_textbook_step("adaptive", since);
    long double rate[ROWS], sum = 0;
    for (int i = 0; i < book->rows; i++) {
        long double at = y;
        for (int j = 0; j < i; j++)
            at += k * book->a[i][j] * rate[j];
        rate[i] = (lambda * at + cosl(book->c[i] * k)) / (1 - k * book->a[i][i] * lambda);
    }
    for (int i = 0; i < book->rows; i++)
        sum += k * (book->a[book->rows - 1][i] - second_end[since][i]) * rate[i];
    return sum;
}

TEST(test_estimate)
{
    for (size_t since = 0; since < 2; since++)
        for (double k = 1; k > 0.03; k /= 2) {
            const long double book = estimate_by_book(since, -1.3L, 0.7L, k);
            CLOSE(estimate_by_scheme(since, -1.3, 0.7, k), (double)book, 1e-13);
        }
}

/* ---- steps ---- */

static struct br_counts counts_of(const struct br_scene *scene, const char *solver, size_t n,
                                  double tolerance)
{
    struct br_method method = br_test_method(solver, "implicit", NULL);
    method.scheme = br_time_scheme_find("adaptive");
    method.tolerance = tolerance;
    OWNED(br_march) *march = br_test_march(scene, n, 4, &method);
    br_test_advance(march, 4);
    const struct br_counts counts = br_march_counts(march);
    return counts;
}

/* Solvers differ in round-off: an estimate of the same state is the same, and so are the steps, to
 * a few. Some meshes leave lanes of the vectors without an element. */
TEST(test_same_steps)
{
    static const char *const scenes[] = {"chatter", "release", "smoothed"};
    static const size_t meshes[] = {1, 3, 8, 10, 21};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        for (size_t j = 0; j < sizeof meshes / sizeof *meshes; j++) {
            OWNED(br_scene) scene = br_test_bundled(scenes[i]);
            const struct br_counts riccati = counts_of(&scene, "riccati", meshes[j], 1e-6);
            const struct br_counts plain = counts_of(&scene, "plain", meshes[j], 1e-6);
            const struct br_counts assembled = counts_of(&scene, "umfpack", meshes[j], 1e-6);
            const double most = 1 + 0.01 * (double)plain.steps;
            CLOSE((double)riccati.steps, (double)plain.steps, most);
            CLOSE((double)assembled.steps, (double)plain.steps, most);
        }
}

/* What is listed as a switch is one, of the field that has switched alone; each field goes on from
 * the branch on which it was. */
TEST(test_listed_switches)
{
    static const char *const scenes[] = {"example2", "chatter", "impact", "release"};
    size_t all[2] = {0};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        OWNED(br_scene) scene = br_test_bundled(scenes[i]);
        struct br_method method = br_test_method(NULL, "implicit", NULL);
        method.scheme = br_time_scheme_find("adaptive");
        method.tolerance = 1e-6;
        OWNED(br_march) *march = br_test_march(&scene, 10, 4, &method);
        br_test_advance(march, 4);
        const struct br_switch *s;
        const size_t count = br_march_switches(march, &s);
        enum br_regime last[2] = {BR_REGIME_NONE, BR_REGIME_NONE};
        bool any[2] = {false, false};
        for (size_t j = 0; j < count && j < BR_MOST_SWITCHES; j++) {
            assert_true(s[j].from != s[j].to);
            assert_true(!any[s[j].kind] || s[j].from == last[s[j].kind]);
            assert_true(j == 0 || s[j].time >= s[j - 1].time);
            last[s[j].kind] = s[j].to;
            any[s[j].kind] = true;
            all[s[j].kind]++;
        }
    }
    assert_true(all[BR_AXIAL] > 1 && all[BR_BENDING] > 1);
}

/* Without laws at the tip. */
static struct br_scene smooth_scene(const char *axial, const char *bending)
{
    struct br_scene scene = br_test_bare();
    scene.duration = 20;
    scene.axial.load = br_test_load(axial);
    scene.bending.load = br_test_load(bending);
    return scene;
}

/* A step's error is of order 4, so that steps shorten by 10^(1/4) with a tolerance of a tenth. */
TEST(test_steps_of_tolerance)
{
    OWNED(br_scene) scene = smooth_scene("sin(2*t)^5", "3*sin(2*t)^5");
    const double many = (double)counts_of(&scene, NULL, 6, 1e-9).steps;
    const double few = (double)counts_of(&scene, NULL, 6, 1e-5).steps;
    CLOSE(log10(many / few) / 4, 0.25, 0.04);
}

/* Errors are relative: a load whose squares are no doubles has the same steps. */
TEST(test_small_load)
{
    OWNED(br_scene) scene = smooth_scene("sin(2*t)^5", "3*sin(2*t)^5");
    OWNED(br_scene) small = smooth_scene("1e-150*sin(2*t)^5", "3e-150*sin(2*t)^5");
    const double usual = (double)counts_of(&scene, "riccati", 6, 1e-6).steps;
    CLOSE((double)counts_of(&small, "riccati", 6, 1e-6).steps, usual, 2);
    CLOSE((double)counts_of(&small, "plain", 6, 1e-6).steps, usual, 2);
}

/* A rod without mass and viscosity follows a load that jumps at once: steps shorten to the least
 * one there, which is taken although its error stays. */
TEST(test_jump)
{
    OWNED(br_scene) scene = smooth_scene("step(t - 7.3)", "0");
    scene.density = scene.axial.viscosity = 0;
    scene.bending.modelled = false;
    const struct br_counts counts = counts_of(&scene, NULL, 6, 1e-6);
    assert_true(counts.rejected > 30);
}

/* ---- what a step begins with ---- */

struct record {
    const struct br_march *march;
    struct br_tip accepted;
    size_t trials, steps;
};

static void see_stage(void *self, const struct br_march_stage *told)
{
    struct record *record = self;
    const struct br_tip *tip = br_march_tip(record->march);
    if (told->kind != BR_AXIAL || told->index != 0)
        return;
    record->trials++;
    CLOSE(tip->velocity[BR_BENDING], record->accepted.velocity[BR_BENDING], 0);
    CLOSE(tip->friction_force, record->accepted.friction_force, 0);
    CLOSE(tip->friction_bound, record->accepted.friction_bound, 0);
}

static void see_step(void *self, enum br_field_kind kind, bool switched)
{
    struct record *record = self;
    (void)switched;
    record->accepted = *br_march_tip(record->march);
    record->steps += kind == BR_BENDING;
}

/* When the first stage of the rod has ended, the beam's tip is still what the last accepted step
 * left, whatever was tried and taken back since. */
TEST(test_taken_back)
{
    OWNED(br_scene) scene = br_test_bundled("chatter");
    struct br_method method = br_test_method(NULL, "implicit", NULL);
    method.scheme = br_time_scheme_find("adaptive");
    method.tolerance = 1e-4;
    OWNED(br_march) *march = br_test_march(&scene, 4, 10, &method);
    struct record record = {.march = march, .accepted = *br_march_tip(march)};
    assert_true(br_march_watch(march, &(struct br_march_watcher){&record, see_stage, see_step}));
    br_test_advance(march, 10);
    assert_true(br_march_counts(march).rejected > 0);
    assert_true(record.trials > record.steps && record.steps == br_march_counts(march).steps);
}
