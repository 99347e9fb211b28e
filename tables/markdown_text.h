/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BR_MARKDOWN_TEXT_H
#define BR_MARKDOWN_TEXT_H

#include <stdio.h>

/* Prints text; what Markdown would take for something else gets a backslash. */
void br_print_markdown(FILE *out, const char *text);

#endif
