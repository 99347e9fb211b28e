/* SPDX-License-Identifier: GPL-3.0-or-later */
/* -div grad u = f on the unit square, u = exp(x + 2 y) sin(pi x) sin(pi y), by the five-point
 * formula and conjugate gradients.
 * usage: fd N; prints the error in l2, the root mean square over the nodes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

static double a(double x, double c) /* exp(c x) sin(pi x), and its second derivative */
{
    return exp(c * x) * sin(pi * x);
}

static double a2(double x, double c)
{
    return exp(c * x) * ((c * c - pi * pi) * sin(pi * x) + 2 * c * pi * cos(pi * x));
}

/* y = A x for the nodes (1 .. n - 1)^2 of arrays with a frame of zeros. */
static void multiply(int n, const double *x, double *y)
{
    for (int j = 1; j < n; j++)
        for (int i = 1; i < n; i++) {
            const double *at = x + j * (n + 1) + i;
            y[j * (n + 1) + i] = 4 * at[0] - at[1] - at[-1] - at[n + 1] - at[-n - 1];
        }
}

static double dot(int n, const double *x, const double *y)
{
    double sum = 0;
    for (int i = 0; i < (n + 1) * (n + 1); i++)
        sum += x[i] * y[i];
    return sum;
}

int main(int count, char **word)
{
    const int n = count == 2 ? atoi(word[1]) : 0;
    const int all = n > 1 ? (n + 1) * (n + 1) : 0;
    double *u = calloc((size_t)all + 1, sizeof *u), *r = calloc((size_t)all + 1, sizeof *r),
           *p = calloc((size_t)all + 1, sizeof *p), *q = calloc((size_t)all + 1, sizeof *q);
    if (n < 2 || n > 20000 || !u || !r || !p || !q) {
        fprintf(stderr, "usage: fd N, with N > 1\n");
        return EXIT_FAILURE;
    }
    const double h = 1.0 / n;
    for (int j = 1; j < n; j++)
        for (int i = 1; i < n; i++)
            p[j * (n + 1) + i] = r[j * (n + 1) + i] =
                -h * h * (a2(i * h, 1) * a(j * h, 2) + a(i * h, 1) * a2(j * h, 2));
    double old = dot(n, r, r);
    const double small = 1e-20 * old; /* the residual falls by 1e-10 */
    while (old > small) {
        multiply(n, p, q);
        const double step = old / dot(n, p, q);
        for (int i = 0; i < all; i++) {
            u[i] += step * p[i];
            r[i] -= step * q[i];
        }
        const double now = dot(n, r, r);
        for (int i = 0; i < all; i++)
            p[i] = r[i] + now / old * p[i];
        old = now;
    }
    double sum = 0;
    for (int j = 1; j < n; j++)
        for (int i = 1; i < n; i++)
            sum += pow(u[j * (n + 1) + i] - a(i * h, 1) * a(j * h, 2), 2);
    printf("l2 %.6e\n", h * sqrt(sum));
    free(u);
    free(r);
    free(p);
    free(q);
    return EXIT_SUCCESS;
}
