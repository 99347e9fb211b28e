/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/ranks/ranks.h"

/* The first launcher whose variables are set counts: mpirun in a Slurm job leaves Slurm's variables
 * as they are, which then count its daemons. SLURM_NTASKS is not read: a batch script has it, too.
 */
static const struct {
    const char *launcher, *size, *rank;
} launchers[] = {
    {"mpirun (Open MPI)", "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"},
    {"mpiexec (PMI)", "PMI_SIZE", "PMI_RANK"},
    {"srun (Slurm)", "SLURM_STEP_NUM_TASKS", "SLURM_PROCID"},
};

struct br_launch br_launch_read(void)
{
    for (size_t i = 0; i < sizeof launchers / sizeof *launchers; i++) {
        const char *size = getenv(launchers[i].size), *rank = getenv(launchers[i].rank);
        if (size && atoi(size) > 1)
            return (struct br_launch){launchers[i].launcher, atoi(size), rank ? atoi(rank) : 0};
        if (size)
            break;
    }
    return (struct br_launch){.size = 1};
}
