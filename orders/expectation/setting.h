/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a source has got its numbers: the settings of its method, as a report states them and a later
 * check compares them. */
#ifndef BR_ORDERS_EXPECTATION_SETTING_H
#define BR_ORDERS_EXPECTATION_SETTING_H

#include <stdbool.h>
#include <stddef.h>

enum br_setting_kind { BR_SETTING_WORD, BR_SETTING_NUMBER, BR_SETTING_COUNT };

enum { BR_SETTING_TEXT = 512, BR_SETTING_USUAL = 64, BR_MOST_SETTINGS = 12 };

struct br_setting {
    const char *name;             /* for people */
    const char *group, *key;      /* its place in a report: a member of `group`; NULL: of none */
    enum br_setting_kind kind;    /* of the value */
    bool compared;                /* no: it is the machine's, or follows from others */
    bool needed;                  /* each report has it */
    char usual[BR_SETTING_USUAL]; /* else: the value where a report has it not */
    char text[BR_SETTING_TEXT];   /* the value, to its last bit; "": it is not used */
};

struct br_settings {
    size_t count; /* 0: this study is not made */
    struct br_setting row[BR_MOST_SETTINGS];
};

#endif
