/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers with their 95 % intervals, and as texts. */
#ifndef BR_ORDERS_ESTIMATE_H
#define BR_ORDERS_ESTIMATE_H

#include <stdbool.h>
#include <stddef.h>

/* A number with its 95 % interval; NaN: not known. */
struct br_estimate {
    double value, low, high;
};

/* Whether an order's interval is at most 1 wide and above zero. Any other interval says nothing. */
bool br_order_determined(const struct br_estimate *order);

/* "1.02 [1.00, 1.04]" with 2 to 4 decimals, by the width of the interval, which is never zero; "-":
 * there is no order.
 * buffer: at least 64 characters. */
const char *br_order_text(const struct br_estimate *order, char *buffer, size_t size);

/* "-0.2216 +- 0.0014": a value with the digits that half the width of its interval allows, at most
 * ten, "0" where it allows none; six digits where the width is not known. br_digits_text: a value
 * with this number of digits. buffer: at least 64 characters. */
const char *br_uncertain_text(double value, double half, char *buffer, size_t size);
const char *br_digits_text(double value, int digits, char *buffer, size_t size);
/* "24.936 [24.922, 24.940]": two digits of half the width; nine of a value without a width. */
const char *br_interval_text(const struct br_estimate *e, char *buffer, size_t size);

/* value -+ half width of the 95 % interval: t quantile times the deviation. */
struct br_estimate br_estimate_of(double value, double deviation, size_t freedom);

/* Student's distribution of whole freedom: the probability of less than t. */
double br_student_below(double t, double freedom);

/* What a known deviation adds to the scale of that distribution, so that it widens the 95 %
 * interval as the normal distribution would: the ratio of their quantiles, to 3 %. */
double br_scale_of_known(double freedom);

/* Akaike's criterion, with Hurvich and Tsai's correction for few points, of `count` residuals; sum:
 * of their squares. Infinite where there are too few. */
double br_akaike(double sum, size_t count, size_t unknowns);

/* "2", "2 to 4", or "-" for none. buffer: at least 32 characters. */
const char *br_range_text(double order, double highest, char *buffer, size_t size);

#endif
