/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the environment says of how the program was started. */
#ifndef BR_STUDY_RANKS_LAUNCHER_H
#define BR_STUDY_RANKS_LAUNCHER_H

/* A job of several processes, as its launcher tells each of them. */
struct br_launch {
    const char *launcher; /* its name, for messages; NULL: the process was started alone */
    int size;             /* processes; 1 where it was started alone */
    int rank;             /* of this one, from 0 */
};

struct br_launch br_launch_read(void);

#endif
