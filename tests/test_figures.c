/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What stands behind the figures, against values from elsewhere: closed forms, and the exact
 * discrete solution. */
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/observer.h"
#include "study/paper/paper.h"
#include "support.h"

static struct br_paper paper;

static atomic_size_t told;

static void hear(void *self, double share)
{
    (void)self;
    if (share >= 0 && share <= 1)
        told++;
}

static int run_paper(void **state)
{
    (void)state;
    struct br_paper_request request = br_paper_request_default();
    if (br_test_quick())
        request.n = request.per_second = 100, request.per_decade = 1;
    if (br_paper_run(&paper, &request, &(struct br_observer){.preparing = hear}, &err) == BR_OK)
        return 0;
    print_error("%s\n", err.message);
    return -1;
}

static int clear_paper(void **state)
{
    (void)state;
    br_paper_clear(&paper);
    return 0;
}

static struct br_finding find(const char *name)
{
    for (size_t i = 0; br_claims[i].name; i++)
        if (strcmp(br_claims[i].name, name) == 0)
            return br_claim_measure(&br_claims[i], &paper);
    fail_msg("no claim %s", name);
    return (struct br_finding){0};
}

static const struct br_history_row *last_row(size_t example)
{
    const struct br_history_record *r = &paper.example[example].record;
    return &r->row[r->rows - 1];
}

/* The display hears of every step of an exact solution, and of those that the tables are measured
 * against. */
TEST(test_progress)
{
    assert_true(told > 100);
}

/* Closed forms at t = 1 s; of Example 2 also the exact discrete solution at k = 1e-3 s, from
 * quadruple precision (at n = 12800; the mesh moves it by 1e-9). */
TEST(test_ends)
{
    const struct br_example *e = paper.example;
    CLOSE(e[0].exact[e[0].exacts - 1].displacement[BR_AXIAL], 0.171692329889782302, 1e-13);
    CLOSE(e[1].exact[e[1].exacts - 1].displacement[BR_AXIAL], 0.0429230824724455755, 1e-13);
    CLOSE(e[1].exact[e[1].exacts - 1].displacement[BR_BENDING], -0.0715950242871993164, 1e-13);
    CLOSE(last_row(2)->displacement[BR_BENDING], -0.24875, 1e-10);
    const struct br_history_record *r = &e[2].record;
    const double *w = br_history_field(r, r->samples - 1, BR_BENDING, false);
    CLOSE(w[r->n], -0.129765625, 1e-8); /* node n/2 */
    if (!br_test_quick())
        CLOSE(last_row(1)->displacement[BR_BENDING], -0.07148198874, 1e-8);
}

/* 3/8 q L reaches the bound. */
TEST(test_release)
{
    const struct br_finding f = find("release");
    const double theory = 3000 / (0.375 * 10000), k = 1.0 / (double)paper.request.per_second;
    CLOSE(f.exact, theory, 1e-9);
    CLOSE(f.value, theory, 1.5 * k);
    assert_int_equal(f.agreement, BR_DIFFERS);
    CLOSE(find("reaches").value, 3000, 1e-9);
    CLOSE(find("decouples").value, 0, 0);
}

/* The exact tip slips first; a march with k = 0.1 microseconds sees the same. */
TEST(test_early_slip)
{
    const struct br_finding f = find("stuck");
    const struct br_history_record *r = &paper.early.record;
    double slip = 0, ends = 0;
    for (size_t i = 1; i < r->rows; i++) {
        slip = fmax(slip, fabs(r->row[i].displacement[BR_BENDING]));
        if (r->row[i].velocity[BR_BENDING] < -1e-6)
            ends = r->row[i].time;
    }
    CLOSE(ends, f.exact, 0.02 * f.exact);
    CLOSE(slip, fabs(paper.early.exact[BR_EXACT_EARLY].displacement[BR_BENDING]), 0.03 * slip);
    assert_true(slip > 1e-7 && slip < 1e-6);
    assert_int_equal(f.agreement, BR_DIFFERS);
}

/* numerics: 7.8e-4 and 7.4e-4 at k = 0.01 s. */
TEST(test_tables)
{
    CLOSE(find("table1").value, 7.8e-4, 0.05e-4);
    CLOSE(find("table2").value, 7.4e-4, 0.05e-4);
    CLOSE(find("table1").printed, 5.042e-3, 0);
    CLOSE(find("table2").printed, 1.522e-2, 0);
    CLOSE(find("converges1").value, 1, 0.02);
    CLOSE(find("converges2").value, 1, 0.02);
}

/* L2 norm by Simpson's rule. */
static double norm_of(double (*f)(double x, double load), double load)
{
    const int n = 400;
    double sum = 0;
    for (int i = 0; i <= n; i++)
        sum += (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * pow(f((double)i / n, load), 2);
    return sqrt(sum / (3 * n));
}

/* Statics with L = 1, a1 = a2 = 1000: the beam free or propped at its tip, the pressed rod. */
static double free_beam(double x, double q)
{
    return q / 24e3 * x * x * (x * x - 4 * x + 6);
}

static double propped_beam(double x, double q)
{
    return q / 48e3 * x * x * (3 - 5 * x + 2 * x * x);
}

static double rod(double x, double f)
{
    const double tip = f / 2 / (1000 + 1000);
    return (f * (x - x * x / 2) - 1000 * tip * x) / 1000;
}

/* The ends of the sweep over c_V are all but static: inertia and viscosity move it by 1e-3. */
static void check_end(const struct br_sweep_point *point, double (*beam)(double, double))
{
    double most = 0;
    for (int i = 1; i <= 300; i++) {
        const double t = i / 100.0;
        most = fmax(most, norm_of(rod, 125 * t) + norm_of(beam, 1e4 * sin(M_PI_2 * t)));
    }
    CLOSE(point->most[1], most, 0.004 * most);
    CLOSE(point->most[0], most, 0.004 * most);
    CLOSE(point->most[2], most, 0.006 * most);
}

TEST(test_sweep)
{
    const struct br_sweep *s = &paper.sweep[BR_SWEEP_FRICTION];
    check_end(&s->point[0], free_beam);
    check_end(&s->point[s->points - 1], propped_beam);
    for (size_t i = 0; i < BR_SWEEPS; i++)
        assert_true(paper.sweep[i].point[paper.sweep[i].points - 1].coefficient >=
                    0.99e6 * paper.sweep[i].point[0].coefficient);
}

TEST(test_verdicts)
{
    static const char *const differ[] = {"table1", "table2", "stuck", "release", "stable-printed"};
    size_t differing = 0;
    for (size_t i = 0; br_claims[i].name; i++) {
        const struct br_finding f = br_claim_measure(&br_claims[i], &paper);
        if (!isfinite(f.value) || f.agreement == BR_UNDECIDED)
            fail_msg("%s: %g +- %g is undecided", br_claims[i].name, f.value, f.error);
        differing += f.agreement == BR_DIFFERS;
    }
    for (size_t i = 0; i < sizeof differ / sizeof *differ; i++)
        assert_int_equal(find(differ[i]).agreement, BR_DIFFERS);
    assert_int_equal(differing, sizeof differ / sizeof *differ);
}

/* What is no number is never agreed to. */
TEST(test_nan)
{
    assert_int_equal(br_below(NAN, 0, 1), BR_UNDECIDED);
    assert_int_equal(br_below(0, NAN, 1), BR_UNDECIDED);
    assert_int_equal(br_above(NAN, 0, 1), BR_UNDECIDED);
    assert_int_equal(br_below(0.5, 0.6, 1), BR_UNDECIDED);
    assert_int_equal(br_below(0.5, 0.4, 1), BR_AGREES);
    assert_int_equal(br_above(0.5, 0.4, 1), BR_DIFFERS);
    const struct br_finding f = {.value = 1, .error = NAN, .exact = NAN, .printed = 1};
    assert_int_equal(br_same(&f, 0.5), BR_UNDECIDED);
    double *u = &paper.example[3].record.row[1].displacement[BR_AXIAL], *w, kept = *u;
    *u = NAN;
    w = &paper.example[0].record.row[1].displacement[BR_BENDING];
    const double kept_w = *w;
    *w = NAN;
    assert_int_equal(find("penetrates").agreement, BR_UNDECIDED);
    assert_int_equal(find("clamped").agreement, BR_UNDECIDED);
    *u = kept, *w = kept_w;
}

/* Any number of threads gives the same bits. */
TEST(test_threads)
{
    struct br_paper runs[2];
    struct br_paper_request request = {.n = 20, .per_second = 100, .per_decade = 1};
    for (int i = 0; i < 2; i++) {
        request.threads = 1 + 2 * i;
        MUST(br_paper_run(&runs[i], &request, NULL, &err));
    }
    for (size_t s = 0; s < BR_SWEEPS; s++)
        for (size_t i = 0; i < runs[0].sweep[s].points; i++)
            assert_memory_equal(&runs[0].sweep[s].point[i], &runs[1].sweep[s].point[i],
                                offsetof(struct br_sweep_point, unstable));
    for (size_t i = 0; br_claims[i].name; i++) {
        const double a = br_claim_measure(&br_claims[i], &runs[0]).value;
        const double b = br_claim_measure(&br_claims[i], &runs[1]).value;
        assert_memory_equal(&a, &b, sizeof a);
    }
    br_paper_clear(&runs[0]);
    br_paper_clear(&runs[1]);
}

AROUND_TESTS(run_paper, clear_paper)
