/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/rounding_option.h"

#include <fenv.h>
#include <stdio.h>
#include <string.h>

/* Nearest is the usual one. */
static const struct {
    const char *name;
    int mode;
} roundings[] = {
    {"nearest", FE_TONEAREST}, {"up", FE_UPWARD}, {"down", FE_DOWNWARD}, {"zero", FE_TOWARDZERO}};
enum { ROUNDINGS = sizeof roundings / sizeof *roundings };

const char *br_rounding_words(void)
{
    return "nearest up down zero";
}

enum br_status br_read_rounding(const char *text, int *mode, struct br_error *err)
{
    *mode = FE_TONEAREST;
    for (size_t i = 0; i < ROUNDINGS && text; i++)
        if (strcmp(roundings[i].name, text) == 0) {
            *mode = roundings[i].mode;
            return BR_OK;
        }
    return text ? br_fail(err, BR_BAD_INPUT,
                          "--rounding: found '%s', expected one of: nearest, up, down, zero", text)
                : BR_OK;
}
