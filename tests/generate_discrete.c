/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Regenerates tests/data/discrete.csv: what the scheme itself gives, free of round-off.
 *
 * An independent program: quadruple precision (113 bits), the textbook stiffness form in
 * (w, w_x), a banded L D L' factorisation, and no line of the solver. The stiffness form
 * loses some 1e17 times the unit round-off at n = 12800; here that still leaves 17 digits
 * more than the tests compare.
 *
 *     meson compile -C build/release regenerate-discrete
 *
 * writes the file anew, in a minute or two on four cores. */
#include <stdio.h>
#include <stdlib.h>

typedef __float128 quad;

enum { BAND = 3 }; /* below the diagonal: two unknowns a node */

/* The scenes of the tables differ in the loads and the friction coefficient only. */
struct scene {
    const char *name;
    quad axial_load, bending_load; /* times (e^t - 1), N/m */
    quad friction;                 /* c_V, N/m */
};

static const struct scene scenes[] = {{"example1", 400, -10000, 5e6},
                                      {"example2", 100, -1000, 1e4}};
static const int meshes[] = {400, 3200, 12800};
enum { SCENES = 2, MESHES = 3, STEPS = 1000 };

/* L = T = 1, g = 0, and, with 1e-4 not a binary number: */
static const quad density = (quad)1 / 10000, stiffness = 1000, viscosity = 1, compliance = 1000;

struct result {
    quad u_tip, w_tip, w_middle;
};

/* One field: element matrices, the factors of the step matrix, and its state. */
struct field {
    int n, unknowns, order;
    quad k, mass[4][4], elastic[4][4]; /* elastic: for unit material */
    quad (*lower)[BAND + 1];           /* lower[i][j]: column i - j; j = 0: D */
    quad *load;                        /* for a unit load */
    quad *displacement, *velocity, *solution, *response;
};

/* e^t by its series. */
static quad exponential(quad t)
{
    quad term = 1, sum = 1;
    for (int i = 1; i < 60; i++)
        sum += term *= t / i;
    return sum;
}

static void set_rod(struct field *f, quad h, quad mean[4])
{
    static const int mass[2][2] = {{2, 1}, {1, 2}}, elastic[2][2] = {{1, -1}, {-1, 1}};
    for (int a = 0; a < 2; a++) {
        mean[a] = h / 2;
        for (int b = 0; b < 2; b++) {
            f->mass[a][b] = density * h / 6 * mass[a][b];
            f->elastic[a][b] = elastic[a][b] / h;
        }
    }
}

static void set_beam(struct field *f, quad h, quad mean[4])
{
    static const int mass[4][4] = {
        {156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}};
    static const int elastic[4][4] = {
        {12, 6, -12, 6}, {6, 4, -6, 2}, {-12, -6, 12, -6}, {6, 2, -6, 4}};
    const quad length[4] = {1, h, 1, h}; /* of the unknowns (w, w_x) */
    const quad load[4] = {h / 2, h / 12, h / 2, -h / 12};
    for (int a = 0; a < 4; a++) {
        mean[a] = load[a] * length[a];
        for (int b = 0; b < 4; b++) {
            const quad scale = length[a] * length[b];
            f->mass[a][b] = density * h / 420 * mass[a][b] * scale;
            f->elastic[a][b] = elastic[a][b] * scale / (h * h * h);
        }
    }
}

/* L D L' of M/k + C + kK, in place. */
static void factorise(struct field *f)
{
    for (int i = 0; i < f->order; i++)
        for (int j = i < BAND ? i : BAND; j >= 0; j--) {
            quad sum = f->lower[i][j];
            for (int m = j + 1; m <= BAND && m <= i; m++) /* column i - m */
                sum -= f->lower[i][m] * f->lower[i - m][0] * f->lower[i - j][m - j];
            f->lower[i][j] = j ? sum / f->lower[i - j][0] : sum;
        }
}

static void solve(const struct field *f, quad *x)
{
    for (int i = 0; i < f->order; i++)
        for (int j = 1; j <= BAND && j <= i; j++)
            x[i] -= f->lower[i][j] * x[i - j];
    for (int i = 0; i < f->order; i++)
        x[i] /= f->lower[i][0];
    for (int i = f->order - 1; i >= 0; i--)
        for (int j = 1; j <= BAND && i + j < f->order; j++)
            x[i] -= f->lower[i + j][j] * x[i + j];
}

static quad *zeros(int count)
{
    quad *x = calloc((size_t)count, sizeof *x);
    if (!x)
        exit(EXIT_FAILURE);
    return x;
}

static struct field create(int n, int unknowns, quad k)
{
    struct field f = {.n = n, .unknowns = unknowns, .order = n * unknowns, .k = k};
    quad mean[4];
    (unknowns == 1 ? set_rod : set_beam)(&f, (quad)1 / n, mean);
    f.lower = calloc((size_t)f.order, sizeof *f.lower);
    if (!f.lower)
        exit(EXIT_FAILURE);
    f.load = zeros(f.order);
    f.displacement = zeros(f.order);
    f.velocity = zeros(f.order);
    f.solution = zeros(f.order);
    f.response = zeros(f.order);
    for (int e = 0; e < n; e++)
        for (int a = 0; a < 2 * unknowns; a++) {
            const int p = (e - 1) * unknowns + a; /* the clamped node is left out */
            if (p < 0)
                continue;
            f.load[p] += mean[a];
            for (int b = 0; b <= a; b++) {
                const int q = (e - 1) * unknowns + b;
                if (q >= 0)
                    f.lower[p][p - q] +=
                        f.mass[a][b] / k + (viscosity + k * stiffness) * f.elastic[a][b];
            }
        }
    factorise(&f);
    f.response[f.order - unknowns] = 1;
    solve(&f, f.response);
    return f;
}

static void destroy(struct field *f)
{
    free(f->lower);
    free(f->load);
    free(f->displacement);
    free(f->velocity);
    free(f->solution);
    free(f->response);
}

/* solution = A^-1 (factor F + M v/k - K w) */
static void predict(struct field *f, quad factor)
{
    for (int i = 0; i < f->order; i++)
        f->solution[i] = factor * f->load[i];
    for (int e = 0; e < f->n; e++)
        for (int a = 0; a < 2 * f->unknowns; a++)
            for (int b = 0; b < 2 * f->unknowns; b++) {
                const int p = (e - 1) * f->unknowns + a, q = (e - 1) * f->unknowns + b;
                if (p >= 0 && q >= 0)
                    f->solution[p] += f->mass[a][b] / f->k * f->velocity[q] -
                                      stiffness * f->elastic[a][b] * f->displacement[q];
            }
    solve(f, f->solution);
}

static void finish(struct field *f, quad force)
{
    for (int i = 0; i < f->order; i++) {
        f->velocity[i] = f->solution[i] - force * f->response[i];
        f->displacement[i] += f->k * f->velocity[i];
    }
}

static struct result march(const struct scene *s, int n)
{
    const quad k = (quad)1 / STEPS;
    struct field rod = create(n, 1, k), beam = create(n, 2, k);
    const int u_tip = rod.order - 1, w_tip = beam.order - 2;
    for (int step = 1; step <= STEPS; step++) {
        const quad growth = exponential((quad)step / STEPS) - 1, u = rod.displacement[u_tip];
        predict(&rod, s->axial_load * growth);
        finish(&rod, u > 0 ? compliance * u : 0); /* contact at u_{n-1} */

        predict(&beam, s->bending_load * growth);
        const quad bound = rod.displacement[u_tip] > 0 ? s->friction * rod.displacement[u_tip] : 0;
        quad lambda = beam.solution[w_tip] / beam.response[w_tip]; /* what would stick */
        lambda = lambda > bound ? bound : lambda < -bound ? -bound : lambda;
        finish(&beam, lambda);
    }
    const struct result r = {rod.displacement[u_tip], beam.displacement[w_tip],
                             beam.displacement[2 * (n / 2 - 1)]};
    destroy(&rod);
    destroy(&beam);
    return r;
}

/* ",-d.ddd...e-XX" with 21 digits, the last one cut. */
static void print(quad x)
{
    int exponent = 0;
    printf(",%s", x < 0 ? "-" : "");
    x = x < 0 ? -x : x;
    for (; x > 0 && x < 1; exponent--)
        x *= 10;
    for (int i = 0; i < 21; i++) {
        const int digit = (int)x;
        printf(i == 1 ? ".%d" : "%d", digit);
        x = (x - digit) * 10;
    }
    printf("e%+03d", exponent);
}

int main(void)
{
    struct result results[SCENES * MESHES];
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = SCENES * MESHES - 1; i >= 0; i--)
        results[i] = march(&scenes[i / MESHES], meshes[i % MESHES]);
    printf("# Values at t = 1 of the scheme as printed (contact at u_{n-1}, exact friction law),\n"
           "# by tests/generate_discrete.c in quadruple precision.\n"
           "scene,n,k,u_tip,w_tip,w_middle\n");
    for (int i = 0; i < SCENES * MESHES; i++) {
        printf("%s,%d,1e-3", scenes[i / MESHES].name, meshes[i % MESHES]);
        print(results[i].u_tip);
        print(results[i].w_tip);
        print(results[i].w_middle);
        putchar('\n');
    }
    return fflush(stdout) || ferror(stdout) ? EXIT_FAILURE : EXIT_SUCCESS;
}
