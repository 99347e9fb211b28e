/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sections of the manual page that no row of an option has. */
#ifndef BR_CLI_MANUAL_H
#define BR_CLI_MANUAL_H

struct br_manual_section {
    const char *title, *text;
};

/* Ends with a title of NULL. */
extern const struct br_manual_section br_manual_sections[];

#endif
