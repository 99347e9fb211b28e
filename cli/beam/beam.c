/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/beam/beam.h"

#include "study/ranks/ranks.h"

const struct br_beam br_beam = {
    .add_options = br_beam_add_options,
    .standard = br_beam_standard,
    .check_options = br_beam_check_options,
    .start = br_ranks_start,
    .end = br_ranks_end,
    .first = br_ranks_first,
    .size = br_ranks_size,
    .topics = br_beam_topics,
    .print_topic = br_beam_print_topic,
};
