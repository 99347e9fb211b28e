/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Recognises a product X(x) T(t). Its derivatives are products, too, and far shorter than
 * what libmatheval makes of the whole: it keeps every term that a derivative makes zero. */
#ifndef BR_MMS_PRODUCT_H
#define BR_MMS_PRODUCT_H

#include <stdbool.h>
#include <stddef.h>

/* Room for either factor of a text of that length, the terminating zero included. */
size_t br_product_size(size_t length);

/* Whether the text (of the language of derivative.h) is a product of factors that each use
 * at most one of x and t; then in_x and in_t (out, br_product_size each) are those. */
bool br_product_split(const char *text, char *in_x, char *in_t);

#endif
