/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/instruction_set.h"

#include <string.h>

#if defined __x86_64__ && !defined BR_NO_FMA
#define SUPPORTS(feature) __builtin_cpu_supports(feature)
#else
#define SUPPORTS(feature) false
#endif

bool br_has_avx512(void)
{
    return SUPPORTS("avx512f") && SUPPORTS("avx512dq") && SUPPORTS("avx512vl");
}

bool br_has_avx2(void)
{
    return SUPPORTS("avx2") && SUPPORTS("fma");
}

bool br_has_portable(void)
{
    return true;
}

static const struct {
    const char *name;
    bool (*available)(void);
} sets[] = {
#define ROW(set) {#set, br_has_##set},
    BR_INSTRUCTION_SETS(ROW)};

size_t br_instruction_set_best(void)
{
    size_t set = 0;
    while (!sets[set].available())
        set++;
    return set;
}

size_t br_instruction_set_find(const char *name)
{
    size_t set = 0;
    while (set < sizeof sets / sizeof *sets && strcmp(sets[set].name, name) != 0)
        set++;
    return set;
}
