/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bugs that the certificate of one march sees; most of them would pass as a scheme of some order.
 */
#ifndef PLANTED_MARCHES_H
#define PLANTED_MARCHES_H

#include "tests/planted_bugs.h"

struct planted_march {
    struct planted_bug bug;
    const char *run; /* what is marched, with --check */
};

static const struct planted_march planted_marches[] = {
    {{"esdirk3_start", "solver/scheme.c", "{(1 - GAMMA3) / 2, GAMMA3},",
      "{(1 - GAMMA3) / 3, GAMMA3},"},
     "chatter --scheme esdirk3 --n 10 --k 0.02"},
    {{"esdirk3_of_other_stages", "solver/scheme.c", "#define C2 (3.0 / 5)", "#define C2 (3.1 / 5)"},
     "chatter --scheme esdirk3 --n 10 --k 0.02"},
    {{"esdirk4_start", "solver/scheme.c", "{1.0 / 2, 1.0 / 4},", "{1.0 / 3, 1.0 / 4},"},
     "chatter --scheme esdirk4 --n 10 --k 0.02"},
    {{"start_forgotten_after_a_switch", "solver/part.c",
      "part->since = switched ? 0 : part->since + 1;", "part->since++;"},
     "chatter --scheme bdf2 --n 10 --k 0.02"},
    {{"start_of_bdf3_too_short", "solver/scheme.c",
      "if (since < 2)\n        bdf2_stages(since, s);",
      "if (since < 1)\n        bdf2_stages(since, s);"},
     "chatter --scheme bdf3 --n 10 --k 0.02"},
    {{"rate_of_another_step", "solver/part.c",
      "(i == BR_RATE ? part->field.k / part->rate_tau : 1)",
      "(i == BR_RATE ? 0.999 * part->field.k / part->rate_tau : 1)"},
     "release --scheme adaptive --n 10 --k 0.1"},
    {{"weight_lost", "solver/part.c", "if (weight[i] != 0)\n            by_slot",
      "if (weight[i] != 0 && i != BR_BEFORE_THAT)\n            by_slot"},
     "chatter --scheme bdf3 --n 10 --k 0.02"},
    {{"history_out_of_order", "solver/part.c", "for (int i = 2; i > 0; i--) {",
      "for (int i = 1; i <= 2; i++) {"},
     "chatter --scheme bdf3 --n 10 --k 0.02"},
    {{"pieces_load_stale_after_a_change_of_step", "solver/pieces_kept.c",
      "s->stale_load = s->stale_ends = true;", "s->stale_ends = true;"},
     "chatter --scheme bdf2 --n 40 --k 0.02"},
    {{"axial_step_unchanged", "solver/plain_axial.c", "    numbers_of(a);\n    a->field.k = k;\n",
      "    numbers_of(a);\n    (void)k;\n"},
     "chatter --scheme bdf2 --solver plain --n 10 --k 0.02"},
    {{"bound_of_the_last_stage", "solver/stages.c", "return path->penetration[i];",
      "return path->penetration[path->count - 1];"},
     "chatter --scheme sdirk2 --n 10 --k 0.02"},
    {{"bound_between_stages_by_a_chord", "solver/stages.c", "s * s * (3 - 2 * s) * path->end[0]",
      "s * path->end[0]"},
     "chatter --scheme bdf2 --n 10 --k 0.02"},
    {{"switch_passed", "solver/adaptive.c", "    if (!s->status)\n        margin_after(k, s);",
      "    if (!s->status)\n        margin_after(longest, s);"},
     "release --scheme adaptive --n 10 --k 0.1"},
    {{"regime_is_always_closed", "solver/stages.c",
      "return tip->contact_force > 0 ? BR_REGIME_CLOSED : BR_REGIME_OPEN;",
      "return tip->contact_force >= 0 ? BR_REGIME_CLOSED : BR_REGIME_OPEN;"},
     "impact --scheme bdf2 --n 10 --k 0.01"},
    {{"held_slip_with_half_the_bound", "solver/stages.c",
      "m->regime[BR_BENDING] == BR_REGIME_FORWARD)\n        return state->bound;",
      "m->regime[BR_BENDING] == BR_REGIME_FORWARD)\n        return 0.5 * state->bound;"},
     "chatter --scheme adaptive --n 10 --k 0.1"},
};

enum { PLANTED_MARCHES = sizeof planted_marches / sizeof *planted_marches };

#endif
