/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/estimate.h"

#include <math.h>
#include <stdio.h>

bool br_order_determined(const struct br_estimate *order)
{
    return order->high - order->low <= 1 && order->low > 0; /* false for NaN */
}

/* Whether an end of an interval is its value, rounded to a multiple of that. */
static bool hides_an_end(const struct br_estimate *e, double unit)
{
    const double value = round(e->value / unit);
    return (e->low < e->value && round(e->low / unit) >= value) ||
           (e->high > e->value && round(e->high / unit) <= value);
}

/* The value and the ends, rounded; rounding makes no side of an interval empty. */
static void round_ends(const struct br_estimate *e, double unit, double end[3])
{
    const double value = round(e->value / unit), empty = !(e->low < e->high);
    end[0] = unit * value + 0.0; /* what rounds to zero has no sign */
    end[1] = unit * fmin(round(e->low / unit), value - fmax(empty, e->low < e->value)) + 0.0;
    end[2] = unit * fmax(round(e->high / unit), value + fmax(empty, e->high > e->value)) + 0.0;
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
    int decimals = half < 0.0005 ? 4 : half < 0.005 ? 3 : 2;
    while (decimals < 4 && hides_an_end(order, pow(10, -decimals)))
        decimals++;
    double end[3];
    round_ends(order, pow(10, -decimals), end);
    snprintf(buffer, size, "%.*f [%.*f, %.*f]", decimals, end[0], decimals, end[1], decimals,
             end[2]);
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
    const double half = (e->high - e->low) / 2;
    static const char *const before[] = {"", " [", ", "};
    if (!(half > 0 && isfinite(half) && isfinite(e->value))) {
        snprintf(buffer, size, isfinite(e->value) ? "%.9g" : "-", e->value + 0.0);
        return buffer;
    }
    const int least = first_digit(e->value) - MOST + 1;
    int last = first_digit(half) - 1;
    while (last > least && hides_an_end(e, pow(10, last)))
        last--;
    last = last > least ? last : least;
    double end[3];
    round_ends(e, pow(10, last), end);
    size_t used = 0;
    for (int i = 0; i < 3; i++) {
        used += (size_t)snprintf(buffer + used, size - used, "%s", before[i]);
        used += (size_t)print_rounded(end[i], last, buffer + used, size - used);
    }
    snprintf(buffer + used, size - used, "]");
    return buffer;
}

const char *br_range_text(double order, double highest, char *buffer, size_t size)
{
    if (isnan(order))
        return "-";
    snprintf(buffer, size, highest > order ? "%g to %g" : "%g", order, highest);
    return buffer;
}

/* Abramowitz and Stegun 1964, 26.7.3 and 26.7.4. */
double br_student_below(double t, double freedom)
{
    const double square = freedom / (freedom + t * t), sine = t / sqrt(freedom + t * t);
    const bool odd = (int)freedom % 2 == 1;
    double term = odd ? sqrt(square) : 1, sum = 0;
    for (double k = odd ? 3 : 2; k <= freedom; k += 2) {
        sum += term;
        term *= square * (k - 1) / k;
    }
    return 0.5 + (odd ? (atan(t / sqrt(freedom)) + sine * sum) / M_PI : sine * sum / 2);
}
