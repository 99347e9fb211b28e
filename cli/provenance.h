/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a result comes from: program, compiler, command line, machine, date. */
#ifndef BR_CLI_PROVENANCE_H
#define BR_CLI_PROVENANCE_H

#include "tables/document.h"

const char *br_version(void);

/* With the commit, and the libraries that it was built with: "GSL 2.7.1, ...". */
void br_print_version(const char *program);

/* Fails with BR_NO_MEMORY. */
enum br_status br_remember_command_line(int argc, const char **argv, struct br_error *err);

/* The whole command line, quoted for a shell. */
const char *br_command_line(void);

/* Fills all members but the scene. The strings are static, so call it once a run. */
void br_provenance_fill(struct br_provenance *provenance, int threads);

#endif
