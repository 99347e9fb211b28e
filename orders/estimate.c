/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/estimate.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdio.h>

bool br_order_determined(const struct br_estimate *order)
{
    return order->high - order->low <= 1 && order->low > 0; /* false for NaN */
}

const char *br_order_text(const struct br_estimate *order, char *buffer, size_t size)
{
    if (!isfinite(order->value))
        return "-";
    if (!isfinite(order->low) || !isfinite(order->high)) {
        snprintf(buffer, size, "%.2f [no interval]", order->value);
        return buffer;
    }
    const double half = (order->high - order->low) / 2;
    const int decimals = half < 0.0005 ? 4 : half < 0.005 ? 3 : 2;
    const double unit = pow(10, -decimals);
    double value[] = {order->value, order->low, order->high};
    for (int i = 0; i < 3; i++)
        value[i] = unit * round(value[i] / unit) + 0.0; /* what rounds to zero has no sign */
    if (!(value[1] < value[2]))                         /* no interval has a width of zero */
        value[1] -= unit, value[2] += unit;
    snprintf(buffer, size, "%.*f [%.*f, %.*f]", decimals, value[0], decimals, value[1], decimals,
             value[2]);
    return buffer;
}

/* The power of ten of the first digit; of 0: a very small one. */
static int first_digit(double value)
{
    return value != 0 ? (int)floor(log10(fabs(value))) : -400;
}

/* Rounds to a multiple of 10^last. */
static int print_rounded(double value, int last, char *buffer, size_t size)
{
    const double unit = pow(10, last), rounded = unit * round(value / unit);
    const int first = first_digit(rounded);
    if (rounded == 0)
        return snprintf(buffer, size, "0");
    if (first >= -4 && first < 7)
        return snprintf(buffer, size, "%.*f", last < 0 ? -last : 0, rounded);
    return snprintf(buffer, size, "%.*e", first > last ? first - last : 0, rounded);
}

const char *br_digits_text(double value, int digits, char *buffer, size_t size)
{
    if (isfinite(value) && value != 0)
        print_rounded(value, first_digit(value) - digits + 1, buffer, size);
    else
        snprintf(buffer, size, "%g", value + 0.0); /* no minus zero */
    return buffer;
}

const char *br_uncertain_text(double value, double half, char *buffer, size_t size)
{
    enum { MOST = 10 };
    if (!(half > 0 && isfinite(half) && isfinite(value))) {
        snprintf(buffer, size, "%.6g", value + 0.0);
        return buffer;
    }
    const int last = first_digit(half) - 1, least = first_digit(value) - MOST + 1;
    int used = print_rounded(value, last > least ? last : least, buffer, size);
    used += snprintf(buffer + used, size - (size_t)used, " +- ");
    print_rounded(half, last, buffer + used, size - (size_t)used);
    return buffer;
}

const char *br_interval_text(const struct br_estimate *e, char *buffer, size_t size)
{
    enum { MOST = 12 };
    const double half = (e->high - e->low) / 2, end[] = {e->value, e->low, e->high};
    static const char *const before[] = {"", " [", ", "};
    if (!(half > 0 && isfinite(half) && isfinite(e->value))) {
        snprintf(buffer, size, isfinite(e->value) ? "%.9g" : "-", e->value + 0.0);
        return buffer;
    }
    const int last = first_digit(half) - 1, least = first_digit(e->value) - MOST + 1;
    size_t used = 0;
    for (int i = 0; i < 3; i++) {
        used += (size_t)snprintf(buffer + used, size - used, "%s", before[i]);
        used +=
            (size_t)print_rounded(end[i], last > least ? last : least, buffer + used, size - used);
    }
    snprintf(buffer + used, size - used, "]");
    return buffer;
}

/* ---- linear least squares ---- */

double br_least_squares_solve(double *a, double *b, size_t m, size_t n, double least, double *c,
                              double *covariance)
{
    enum { MOST = 8 };
    double tau[MOST], norm[MOST], inverse[MOST][MOST] = {{0}}, left = 0;
    size_t column[MOST], rank = 0;
    gsl_matrix_view rows = gsl_matrix_view_array(a, m, n);
    gsl_vector_view scale = gsl_vector_view_array(tau, n), room = gsl_vector_view_array(norm, n);
    gsl_permutation order = {n, column};
    int sign;
    gsl_linalg_QRPT_decomp(&rows.matrix, &scale.vector, &order, &sign, &room.vector);
    while (rank < n && fabs(a[rank * n + rank]) > least * fabs(a[0]))
        rank++;
    for (size_t k = 0; k < rank; k++)
        for (size_t i = k + 1; i-- > 0;) { /* R inverse = 1 */
            double sum = i == k;
            for (size_t l = i + 1; l <= k; l++)
                sum -= a[i * n + l] * inverse[l][k];
            inverse[i][k] = sum / a[i * n + i];
        }
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            double *out = &covariance[column[i] * n + column[j]];
            *out = 0;
            for (size_t k = 0; k < rank; k++)
                *out += inverse[i][k] * inverse[j][k];
        }
    if (!b)
        return NAN;
    gsl_vector_view rest = gsl_vector_view_array(b, m);
    gsl_linalg_QR_QTvec(&rows.matrix, &scale.vector, &rest.vector); /* b = Q' b */
    for (size_t i = 0; i < n; i++) {
        c[column[i]] = 0;
        for (size_t k = i; k < rank; k++)
            c[column[i]] += inverse[i][k] * b[k];
    }
    for (size_t i = rank; i < m; i++)
        left += b[i] * b[i];
    return left;
}

const char *br_range_text(double order, double highest, char *buffer, size_t size)
{
    if (isnan(order))
        return "-";
    snprintf(buffer, size, highest > order ? "%g to %g" : "%g", order, highest);
    return buffer;
}
