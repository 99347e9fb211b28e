/* SPDX-License-Identifier: GPL-3.0-or-later */
/* -u'' = f on (0, 1), u(0) = 0, u'(1) = e, by finite differences; u = exp(x) - 1.
 * usage: poisson N; prints the largest error at a node, and u(1). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static double f(double x)
{
    return -exp(x);
}

static double exact(double x)
{
    return exp(x) - 1;
}

/* Thomas' algorithm for diagonals -1, 2, -1, the last one 1: u (in/out) is the right-hand side. */
static void solve(int n, double *diagonal, double *u)
{
    for (int i = 1; i <= n; i++)
        diagonal[i] = i < n ? 2 : 1;
    for (int i = 2; i <= n; i++) {
        diagonal[i] -= 1 / diagonal[i - 1];
        u[i] += u[i - 1] / diagonal[i - 1];
    }
    u[n] /= diagonal[n];
    for (int i = n - 1; i > 0; i--)
        u[i] = (u[i] + u[i + 1]) / diagonal[i];
}

int main(int count, char **word)
{
    const int n = count == 2 ? atoi(word[1]) : 0;
    double *u = calloc((size_t)n + 1, sizeof *u), *diagonal = calloc((size_t)n + 1, sizeof *u);
    if (n < 2 || !u || !diagonal) {
        fprintf(stderr, "usage: poisson N, with N > 1\n");
        return EXIT_FAILURE;
    }
    const double h = 1.0 / n;
    for (int i = 1; i < n; i++)
        u[i] = h * h * f(i * h);
    u[n] = h * exp(1) + h * h / 2 * f(1); /* half a cell at the end */
    solve(n, diagonal, u);
    double error = 0;
    for (int i = 1; i <= n; i++)
        error = fmax(error, fabs(u[i] - exact(i * h)));
    printf("n = %d, end %.15g\nerror %.6e\n", n, u[n], error);
    free(u);
    free(diagonal);
    return EXIT_SUCCESS;
}
