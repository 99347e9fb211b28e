/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/foresee/resources.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

/* Nodal arrays of a march beside its solvers, bytes an element. */
static const double nodal_arrays = 80;

/* s a solve, however few the elements. */
static const double solve_overhead = 1e-6;

static const double day = 86400, most_days = 36525; /* a century */

double br_march_bytes(const struct br_planned_march *o)
{
    const struct br_linear_solver *l = o->method->solver;
    const bool quadratic = o->method->axial_degree == 2;
    const double states = br_time_scheme_kept(o->method->scheme);
    double element = nodal_arrays;
    if (o->scene->axial.modelled)
        element += (quadratic ? l->bytes.quadratic : l->bytes.axial) +
                   states * (quadratic ? l->state_bytes.quadratic : l->state_bytes.axial);
    if (o->scene->bending.modelled)
        element += l->bytes.bending + states * l->state_bytes.bending;
    return element * (double)o->n;
}

double br_march_seconds(const struct br_planned_march *o)
{
    if (o->method->scheme->adaptive)
        return 0;
    const double solves = (double)o->steps * br_time_scheme_stages(o->method->scheme);
    return solves * (solve_overhead + 1e-9 * o->method->solver->nanoseconds * (double)o->n);
}

/* The number behind a word in a file, in so many bytes; INFINITY: it is not there. */
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

static double group_limit(void)
{
    static const char group[] = "/sys/fs/cgroup/";
    char path[64];
    snprintf(path, sizeof path, "%smemory.max", group);
    const double most = read_bytes(path, "", 1);
    snprintf(path, sizeof path, "%smemory.current", group);
    const double used = read_bytes(path, "", 1);
    return isfinite(most) && isfinite(used) ? fmax(most - used, 0) : most;
}

/* What is left of the address space. */
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

static double study_bytes(const struct br_study *s, size_t *marches)
{
    double bytes = 0;
    for (size_t i = 0; i < s->n_count; i++)
        for (size_t j = 0; j < (s->path ? 1 : s->k_count); j++, ++*marches) {
            const struct br_planned_march cell = {
                .scene = s->scene, .method = &s->method, .n = s->n[i]};
            bytes += br_march_bytes(&cell);
        }
    const struct br_planned_march fine = {
        .scene = s->scene, .method = &s->reference_method, .n = s->reference.n};
    if (!s->judge || !s->judge->nests)
        return bytes;
    ++*marches;
    return bytes + br_march_bytes(&fine);
}

enum br_status br_fit_together(const struct br_study *studies, size_t count, double available,
                               struct br_error *err)
{
    double bytes = 0;
    size_t marches = 0;
    for (size_t i = 0; i < count; i++)
        bytes += study_bytes(&studies[i], &marches);
    if (bytes <= available)
        return BR_OK;
    return br_fail(err, BR_NO_MEMORY,
                   "%zu marches at once take about %.3g GB, %.3g GB are available: expected fewer "
                   "of them, or fewer elements",
                   marches, bytes / 1e9, available / 1e9);
}

static enum br_status check_time(const struct br_planned_march *o, struct br_warnings *w,
                                 struct br_error *err)
{
    const double days = br_march_seconds(o) / day;
    if (days > most_days)
        return br_fail(err, BR_BAD_INPUT,
                       "n = %zu and %zu steps take about %.2g years, expected at most a hundred: "
                       "longer steps or fewer elements",
                       o->n, o->steps, days / 365.25);
    if (days > 1)
        br_warn(w, BR_WARN_LONG, "longer steps or fewer elements, or a scheme of higher order",
                "n = %zu and %zu steps take about %.2g days", o->n, o->steps, days);
    return BR_OK;
}

static enum br_status look(const struct br_planned_march *o, struct br_warnings *w,
                           struct br_error *err)
{
    const enum br_status status = br_fits_memory(o, br_memory_available(), err);
    return status ? status : check_time(o, w, err);
}

const struct br_warning_source br_warn_resources = {
    .title = "memory and time",
    .every = true,
    .look = look,
};
