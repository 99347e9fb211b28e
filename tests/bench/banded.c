/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The yardstick of a whole `beamrate run`: the paper's march of Example 2 as one writes it by hand.
 * Equal linear and Hermite elements; the assembled matrices M/k + C + k K are factorised once as
 * L D L^T in bands; each step is one loop forward and one back, in which both fields overlap.
 * Prints the CPU seconds of both processes. Fails where their tips differ on a coarse mesh.
 * usage: bench-banded BEAMRATE [N STEPS]   12800 elements and 10000 steps if not given */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "solver/scene.h"
#include "tests/support.h"

/* Example 2 (3.2.2); L = T = 1, g = 0; f_H = 100 (e^t - 1), f_V = -1000 (e^t - 1). */
static const double rho = 1e-4, a = 1000, c = 1, c_H = 1e3, c_V = 1e4, load_H = 100, load_V = -1000;

/* Row i of L, from its diagonal to the left; 1/D. The unknowns of node j of the beam are w, h w_x.
 */
enum { BAND = 3 };
struct row {
    double l[BAND], d;
};

/* Row i of L D L^T = A from the bands of A's row, the diagonal first. */
static void factorise(struct row *f, size_t i, const double band[BAND + 1])
{
    double g[BAND + 1] = {0}, d = band[0]; /* g[b] = L(i, i-b) D(i-b) */
    for (size_t b = i < BAND ? i : BAND; b >= 1; b--) {
        g[b] = band[b];
        for (size_t e = b + 1; e <= BAND && e <= i; e++)
            g[b] -= g[e] * f[i - b].l[e - b - 1];
    }
    for (size_t b = 1; b <= BAND && b <= i; b++) {
        f[i].l[b - 1] = g[b] * f[i - b].d;
        d -= g[b] * f[i].l[b - 1];
    }
    f[i].d = 1 / d;
}

/* The state and the factors, by node: node 0 is clamped. */
struct problem {
    double *u, *v, *w, *x, *p, *q; /* displacements, velocities, and L \ b of rod and beam */
    struct row *rod, *beam;
};

static void assemble(const struct problem *o, size_t n, double mass, double bulk, double beam_mass,
                     double bend)
{
    static const double m[4][4] = {
        {156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}};
    static const double k[4][4] = {
        {12, 6, -12, 6}, {6, 4, -6, 2}, {-12, -6, 12, -6}, {6, 2, -6, 4}};
    double e[4][4];
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            e[i][j] = beam_mass * m[i][j] + bend * k[i][j];
    for (size_t j = 0; j < n; j++) {
        const double ahead = j + 1 < n; /* the tip has no element ahead of it */
        factorise(o->rod + 1, j, (double[]){(1 + ahead) * (2 * mass + bulk), mass - bulk, 0, 0});
        factorise(o->beam + 2, 2 * j, (double[]){e[2][2] + ahead * e[0][0], e[2][1], e[2][0], 0});
        factorise(
            o->beam + 2, 2 * j + 1,
            (double[]){e[3][3] + ahead * e[1][1], e[3][2] + ahead * e[1][0], e[3][1], e[3][0]});
    }
}

/* All steps; tip (out): u(L, T) and w(L, T). */
static void march(const struct problem *o, size_t n, size_t steps, double tip[2])
{
    const double h = 1 / (double)n, k = 1 / (double)steps, rate = c / a + k;
    const double mu = rho * h / 6 / k, ku = a / h, mw = rho * h / 420 / k, kw = a / (h * h * h);
    double *const u = o->u, *const v = o->v, *const w = o->w, *const x = o->x;
    assemble(o, n, mu, ku * rate, mw, kw * rate);
    const struct row *last = o->beam + 2 * n; /* the tip's w, h w_x behind it */
    const double z = last[0].d + last[1].l[0] * last[1].l[0] * last[1].d;
    for (size_t step = 1; step <= steps; step++) {
        const double g = expm1((double)step * k), fu = load_H * g * h, fw = load_V * g * h;
        double p = 0, q0 = 0, q1 = 0;
        for (size_t j = 1; j <= n; j++) { /* b = F + M v/k - K u; L \ b */
            const double *W = w + 2 * j, *X = x + 2 * j;
            const struct row *r = o->beam + 2 * j;
            double bu, b0, b1;
            if (j < n) {
                bu = fu + mu * (v[j - 1] + 4 * v[j] + v[j + 1]) +
                     ku * (u[j - 1] - 2 * u[j] + u[j + 1]);
                b0 = fw + mw * (54 * (X[-2] + X[2]) + 312 * X[0] + 13 * (X[-1] - X[3])) +
                     kw * (12 * (W[-2] + W[2]) - 24 * W[0] + 6 * (W[-1] - W[3]));
                b1 = mw * (13 * (X[2] - X[-2]) + 8 * X[1] - 3 * (X[-1] + X[3])) +
                     kw * (6 * (W[2] - W[-2]) - 8 * W[1] - 2 * (W[-1] + W[3]));
            } else {
                bu = fu / 2 + mu * (v[j - 1] + 2 * v[j]) + ku * (u[j - 1] - u[j]) -
                     c_H * fmax(u[j], 0);
                b0 = fw / 2 + mw * (54 * X[-2] + 13 * X[-1] + 156 * X[0] - 22 * X[1]) +
                     kw * (12 * W[-2] + 6 * W[-1] - 12 * W[0] + 6 * W[1]);
                b1 = -fw / 12 + mw * (4 * X[1] - 13 * X[-2] - 3 * X[-1] - 22 * X[0]) +
                     kw * (6 * W[0] - 6 * W[-2] - 2 * W[-1] - 4 * W[1]);
            }
            p = bu - o->rod[j].l[0] * p;
            b1 = b1 - r[1].l[2] * q0 - r[1].l[1] * q1;
            q0 = b0 - r[0].l[1] * q0 - r[0].l[0] * q1;
            q1 = b1 - r[1].l[0] * q0;
            o->p[j] = p;
            o->q[2 * j] = q0;
            o->q[2 * j + 1] = q1;
        }
        /* the laws at the tip: u_n is known, and the tip's velocity without friction */
        const double bound = c_V * fmax(u[n] + k * p * o->rod[n].d, 0);
        const double free = q0 * last[0].d - last[1].l[0] * q1 * last[1].d;
        const double friction = fmin(fmax(free / z, -bound), bound);
        o->q[2 * n] -= friction;
        o->q[2 * n + 1] += friction * last[1].l[0];
        double vp = 0, x0 = 0, x1 = 0; /* (D L') \ ..., of the node ahead; u = u + k v */
        for (size_t j = n; j >= 1; j--) {
            const struct row *r = o->beam + 2 * j;
            const double d1 = o->q[2 * j + 1] * r[1].d - r[3].l[1] * x1 - r[2].l[0] * x0;
            const double d0 = o->q[2 * j] * r[0].d - r[3].l[2] * x1 - r[2].l[1] * x0;
            vp = o->p[j] * o->rod[j].d - o->rod[j + 1].l[0] * vp;
            x1 = d1;
            x0 = d0 - r[1].l[0] * x1;
            v[j] = vp;
            x[2 * j] = x0;
            x[2 * j + 1] = x1;
            u[j] += k * vp;
            w[2 * j] += k * x0;
            w[2 * j + 1] += k * x1;
        }
    }
    tip[0] = u[n];
    tip[1] = w[2 * n];
}

/* CPU seconds of this march. */
static double by_hand(size_t n, size_t steps, double tip[2])
{
    const double begun = br_thread_seconds();
    double *room = calloc(9 * (n + 2), sizeof *room);
    struct row *rows = calloc(3 * (n + 2), sizeof *rows);
    if (!room || !rows)
        abort();
    const size_t m = n + 2;
    march(&(struct problem){room, room + m, room + 2 * m, room + 4 * m, room + 6 * m, room + 7 * m,
                            rows, rows + m},
          n, steps, tip);
    free(room);
    free(rows);
    return br_thread_seconds() - begun;
}

/* CPU seconds of the same march by the solver alone. */
static double by_solver(size_t n, size_t steps)
{
    struct br_scene scene = br_test_bundled("example2");
    const struct br_method method = br_method_default();
    const double begun = br_thread_seconds();
    br_test_run(&scene, n, steps, &method);
    const double seconds = br_thread_seconds() - begun;
    br_scene_clear(&scene);
    return seconds;
}

/* CPU seconds of `beamrate run`, all of it; below 0: it failed. */
static double by_beamrate(const char *program, const char *n, const char *steps)
{
    struct rusage used;
    int status = -1;
    char k[40];
    snprintf(k, sizeof k, "T/%s", steps);
    const pid_t child = fork();
    if (child == 0) {
        if (freopen("/dev/null", "w", stdout) && freopen("/dev/null", "w", stderr))
            execl(program, program, "run", "example2", "-n", n, "-k", k, (char *)NULL);
        _exit(127);
    }
    if (child < 0 || wait4(child, &status, 0, &used) != child || status != 0)
        return -1;
    return (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

int main(int count, char **argument)
{
    enum { COARSE = 50, STEPS = 1000, REPEATS = 3 };
    const char *n = count == 4 ? argument[2] : "12800", *steps = count == 4 ? argument[3] : "10000";
    const size_t elements = strtoul(n, NULL, 10), levels = strtoul(steps, NULL, 10);
    double tip[2], least[3] = {INFINITY, INFINITY, INFINITY};
    if (count != 2 && count != 4) {
        fputs("usage: bench-banded BEAMRATE [N STEPS]\n", stderr);
        return 2;
    }
    struct br_scene scene = br_test_bundled("example2");
    const struct br_method method = br_method_default();
    const struct br_test_end end = br_test_run(&scene, COARSE, STEPS, &method);
    br_scene_clear(&scene);
    by_hand(COARSE, STEPS, tip);
    if (!(fabs(tip[0] - end.u_tip) <= 1e-8 * fabs(end.u_tip)) ||
        !(fabs(tip[1] - end.w_tip) <= 1e-8 * fabs(end.w_tip))) {
        printf("the tips differ: %.12g and %.12g, %.12g and %.12g m\n", tip[0], end.u_tip, tip[1],
               end.w_tip);
        return 1;
    }
    for (int i = 0; i < REPEATS; i++) { /* in turn, so that other work on the machine meets all */
        const double seconds = by_beamrate(argument[1], n, steps);
        if (!(seconds > 0)) {
            printf("%s run example2 -n %s -k T/%s failed\n", argument[1], n, steps);
            return 1;
        }
        least[0] = fmin(least[0], by_hand(elements, levels, tip));
        least[1] = fmin(least[1], by_solver(elements, levels));
        least[2] = fmin(least[2], seconds);
    }
    printf(
        "Example 2, n = %s, %s steps, CPU s, the least of %d: banded L D L^T %.3f, the march %.3f "
        "(%.2f times as fast), beamrate run with its forecast %.3f (%.2f times)\n",
        n, steps, REPEATS, least[0], least[1], least[0] / least[1], least[2], least[0] / least[2]);
    return 0;
}
