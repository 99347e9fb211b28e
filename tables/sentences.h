/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BR_TABLES_SENTENCES_H
#define BR_TABLES_SENTENCES_H

/* How many columns a text takes on a terminal: characters, not bytes. */
int br_width_of(const char *text);

#endif
