/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A failing allocation on demand, in the whole process and in all its libraries. */
#ifndef BR_TESTS_FAULTS_H
#define BR_TESTS_FAULTS_H

/* The n-th allocation from now on fails, n >= 1; LONG_MAX: none; -1: none, and they are not
 * counted. Returns how many were counted since the call before. */
long br_memory_fails_at(long n);

#endif
