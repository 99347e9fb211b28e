/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/costs.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

/* The number after a word in a file, times its unit in bytes; INFINITY: not found. */
static double read_bytes(const char *path, const char *word, double unit)
{
    char line[256];
    double value = INFINITY;
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file)) {
        double found;
        if (strncmp(line, word, strlen(word)) == 0 &&
            sscanf(line + strlen(word), "%lf", &found) == 1)
            value = found * unit;
    }
    if (file)
        fclose(file);
    return value;
}

/* Control groups, version 2 and 1: what is before the path of this process's group in its line of
 * /proc/self/cgroup, and the files of a group. */
static const struct groups {
    const char *before, *folder, *limit, *used, *cached;
} versions[] = {
    {"::", "/sys/fs/cgroup", "memory.max", "memory.current", "inactive_file "},
    {":memory:", "/sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes",
     "total_inactive_file "},
};

static double of_group(const struct groups *g, const char *path, const char *name, const char *word)
{
    char file[4400];
    snprintf(file, sizeof file, "%s%s/%s", g->folder, path, name);
    return read_bytes(file, word, 1);
}

/* What a group leaves. Files that are only cached give way. */
static double left_by(const struct groups *g, const char *path)
{
    const double limit = of_group(g, path, g->limit, ""), used = of_group(g, path, g->used, "");
    const double cached = of_group(g, path, "memory.stat", g->cached);
    if (!isfinite(limit) || !isfinite(used))
        return limit;
    return fmin(limit, fmax(limit - used + (isfinite(cached) ? cached : 0), 0));
}

/* What this process's group and each group around it leave. */
static double group_limit(void)
{
    char line[4096];
    double least = INFINITY;
    FILE *file = fopen("/proc/self/cgroup", "r");
    while (file && fgets(line, sizeof line, file))
        for (size_t i = 0; i < sizeof versions / sizeof *versions; i++) {
            const struct groups *g = &versions[i];
            char *path = line + strcspn(line, ":");
            if (strncmp(path, g->before, strlen(g->before)) != 0)
                continue;
            path += strlen(g->before);
            for (char *end = path + strcspn(path, "\n"); end; end = strrchr(path, '/')) {
                *end = '\0';
                least = fmin(least, left_by(g, path));
            }
        }
    if (file)
        fclose(file);
    return least;
}

/* The free part of the address space. */
static double address_space(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return INFINITY;
    const double used = read_bytes("/proc/self/status", "VmSize:", 1024);
    return fmax((double)limit.rlim_cur - (isfinite(used) ? used : 0), 0);
}

double br_memory_available(void)
{
    const double machine = read_bytes("/proc/meminfo", "MemAvailable:", 1024);
    return fmin(machine, fmin(group_limit(), address_space()));
}

enum br_status br_fits_memory(const struct br_planned_march *o, double available,
                              struct br_error *err)
{
    const double bytes = br_march_bytes(o);
    if (bytes <= available)
        return BR_OK;
    const double fit = floor(available / (bytes / (double)o->n));
    return br_fail(err, BR_NO_MEMORY,
                   "n = %zu elements take about %.3g GB (%.0f bytes each), %.3g GB are available: "
                   "expected at most %.3g elements",
                   o->n, bytes / 1e9, bytes / (double)o->n, available / 1e9, fit);
}

enum br_status br_fit_together(const struct br_study *studies, size_t count, double available,
                               struct br_error *err)
{
    struct br_costs w = {.together = true};
    for (size_t i = 0; i < count; i++)
        br_costs_add_study(&w, &studies[i]);
    if (w.bytes <= available)
        return BR_OK;
    return br_fail(
        err, BR_NO_MEMORY,
        "%zu march%s at once take%s about %.3g GB, %.3g GB are available: expected fewer "
        "of them, fewer elements, or longer steps",
        w.marches, w.marches == 1 ? "" : "es", w.marches == 1 ? "s" : "", w.bytes / 1e9,
        available / 1e9);
}
