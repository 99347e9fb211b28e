/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scripts in a folder of their own, which is there before all tests and is removed after them, and
 * runs of them. */
#ifndef BR_TESTS_MADE_PROGRAMS_H
#define BR_TESTS_MADE_PROGRAMS_H

#include "checks.h"
#include "orders/request.h"

extern const struct br_resolution_column cells, step; /* n and k */
extern const struct br_reading err_reading;           /* "err=NUMBER" */
extern const char good[];                             /* a script of n and k */

/* Longer than any run takes that ends by itself, s. */
enum { PATIENCE = 600 };

/* n in {4, 8, 16}, one run at once. */
struct br_orders_request program(const char *command);

/* The good script on a grid of three n and two k. */
struct br_orders_request on_grid(int jobs);

extern char folder[];

/* A file of the folder, whose name is there until the fourth next call. */
const char *path_of(const char *name);
void write_script(const char *name, const char *text);

/* The command of a script in the folder, with these words behind it. */
const char *command_of(const char *name, const char *words);

/* A shell command, in the folder, that must succeed. */
__attribute__((format(printf, 1, 2))) void shell(const char *format, ...);
void has_entries(const char *name, size_t count);

/* The process whose number is in the file does nothing, a moment after it was killed, which it may
 * need to die. A dead one may wait to be buried by others. */
void expect_dead(const char *name);

extern struct br_numbers numbers; /* of the last run */
void run(const struct br_orders_request *p);
void refuse(const struct br_orders_request *p, enum br_status status, const char *message);

/* The last run ends once the others have made their marks: if it does not within the time limit,
 * the machine is loaded, and all run again with a longer one. */
void run_limited(struct br_orders_request *p, double seconds, const char *marks);

#endif
