/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options shared by the commands that compare marches with a solution. */
#ifndef BR_CLI_BEAM_STUDY_REQUEST_H
#define BR_CLI_BEAM_STUDY_REQUEST_H

#include "cli/option.h"
#include "study/grid/study.h"
#include "study/scene/named_method.h"

/* The numbers of steps of --k, or its default, in a scene (k NULL: neither): *steps (out, *count
 * values) is owned by the caller; NULL: there are none. Fails with BR_BAD_INPUT or BR_NO_MEMORY. */
enum br_status br_steps_read(const char *k, const struct br_scene *scene, size_t **steps,
                             size_t *count, struct br_error *err);

/* The number of steps for the time step in text. Fails with BR_BAD_INPUT, naming the option. */
enum br_status br_read_step(const char *option, const char *text, const struct br_scene *scene,
                            size_t *steps, struct br_error *err);

struct br_study_request {
    size_t *n, n_count; /* of -n; borrowed from the options */
    const char *k;      /* of --k, or its default; NULL: neither; borrowed from the options */
    const struct br_reference *reference_kind; /* NULL: not given */
    size_t reference_n;
    const char *reference_k; /* as br_read_step takes it; borrowed from the options */
    const struct br_norm *norm[BR_MOST_NORMS];
    size_t norms;
    struct br_method method;
    struct br_named_methods methods; /* of --methods; count 0: not given */
};

/* Fails with BR_BAD_INPUT, naming the option, what was found and what was expected. */
enum br_status br_study_request_read(const struct br_options *options,
                                     struct br_study_request *request, struct br_error *err);

/* The fine reference's resolution in a scene (out). Fails with BR_BAD_INPUT. */
enum br_status br_study_request_fine(const struct br_study_request *request,
                                     const struct br_scene *scene, struct br_resolution *fine,
                                     struct br_error *err);

#endif
