/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frame of a command with --vary: a scene for each of the values, the results, and one report
 * of all. */
#ifndef BR_CLI_VARY_H
#define BR_CLI_VARY_H

#include "cli/session.h"
#include "study/scene/vary.h"

struct br_vary {
    struct br_session *session; /* borrowed */
    const void *request;        /* what `read` has read */
    struct br_opened_scene base;
    struct br_varied varied;
    size_t points;                            /* number of values that are prepared */
    const struct br_variation_column *column; /* of the results; set once a value is prepared */
    struct br_variation found;
};

/* What a command does at value i. Each value has a point, which begins as zeros. */
struct br_vary_command {
    const char *format; /* of the report */
    size_t size;        /* of a point */
    size_t columns;
    bool alone; /* as in struct br_foreseen */
    /* Reads what is asked of all values alike, and refuses options that are for one value alone.
     * *request (out): static, or the options. */
    enum br_status (*read)(const struct br_options *options, const void **request,
                           struct br_error *err);
    /* Checks everything that can be refused before the march, and names the columns. */
    enum br_status (*prepare)(struct br_vary *vary, size_t i, void *point, struct br_error *err);
    void (*foresee)(void *point, struct br_foreseen *work);
    /* Marches, and fills row i of vary->found. failure (out): why the row is empty, which is a
     * result; but BR_NO_MEMORY, BR_IO and BR_INTERRUPTED end the command, as a failure that is
     * returned does. */
    enum br_status (*march)(struct br_vary *vary, size_t i, void *point, struct br_error *failure,
                            struct br_error *err);
    void (*clear)(void *point);
};

/* The scene with value i. Fails as br_varied_scene; clear it even then. */
enum br_status br_vary_scene(const struct br_vary *vary, size_t i, struct br_opened_scene *scene,
                             struct br_error *err);

/* Fails as br_session_finish, and, after all is written, with BR_NOT_FINITE if values have failed.
 */
enum br_status br_vary_run(const struct br_options *options, struct br_session *session,
                           const struct br_vary_command *command, struct br_error *err);

#endif
