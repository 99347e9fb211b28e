/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a march takes, memory and time, told before it begins. */
#ifndef BR_STUDY_FORESEE_RESOURCES_H
#define BR_STUDY_FORESEE_RESOURCES_H

#include "study/foresee/warnings.h"

/* Bytes that a march needs at most, from what elements were measured to take. */
double br_march_bytes(const struct br_planned_march *planned);

/* Seconds that a march takes, about, in one thread; those of steps by a tolerance are not known:
 * 0. */
double br_march_seconds(const struct br_planned_march *planned);

/* Bytes that may still be had: the least of what the machine has (MemAvailable of /proc/meminfo),
 * of the limit of the address space (RLIMIT_AS) and of the control group; INFINITY: not known. */
double br_memory_available(void);

/* Refuses (BR_NO_MEMORY) a march that does not fit into a memory of so many bytes, with the
 * figures. */
enum br_status br_fits_memory(const struct br_planned_march *planned, double available,
                              struct br_error *err);

#endif
