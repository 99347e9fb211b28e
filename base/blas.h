/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One thread for the BLAS. OpenBLAS shares even small matrices among threads of its own: sums then
 * follow the number of cores, idle threads spin, and each call takes 1 MiB of the stack. */
#ifndef BR_BASE_BLAS_H
#define BR_BASE_BLAS_H

/* Calls of LAPACK, BLAS or UMFPACK stand between these two, on any threads of ours. The number of
 * threads that the process had is set again when the last of them has left: it may be a user's. */
void br_blas_enter(void);
void br_blas_leave(void);

#endif
