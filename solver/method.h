/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What of a method goes together. */
#ifndef BR_METHOD_H
#define BR_METHOD_H

#include "solver/march.h"

/* The contact rule of a time scheme where none is chosen: the paper's where the scheme may lag,
 * else the first that takes its force at the new time level. */
const struct br_contact_rule *br_contact_rule_of(const struct br_time_scheme *scheme);

/* Refuses (BR_BAD_INPUT) what does not go together or is out of its range. */
enum br_status br_method_check(const struct br_method *method, struct br_error *err);

#endif
