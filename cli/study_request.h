/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options shared by the commands that compare marches with a solution. */
#ifndef BR_CLI_STUDY_REQUEST_H
#define BR_CLI_STUDY_REQUEST_H

#include "cli/option.h"
#include "study/grid/study.h"
#include "study/scene/named_method.h"

struct br_study_request {
    const struct br_judge *judge; /* NULL: not given */
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
