/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BR_LATEX_TEXT_H
#define BR_LATEX_TEXT_H

#include <stdio.h>

/* Prints plain ASCII so that TeX's text mode shows it as it is. */
void br_print_latex(FILE *out, const char *text);

#endif
