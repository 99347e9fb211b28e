/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/clock.h"
#include "solver/linear/linear_solver.h"
#include "solver/march.h"
#include "solver/scene.h"
#include "study/estimate/warnings.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

/* Nodal arrays of a march beside its solvers, bytes an element. */
static const double nodal_arrays = 80;

static const double day = 86400, most_days = 36525; /* a century */

double br_march_bytes(const struct br_planned_march *o)
{
    const double states = br_time_scheme_kept(o->method->scheme);
    double element = nodal_arrays;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_field field =
            br_field_of_scene(o->scene, kind, o->n, 1, o->method->axial_degree);
        const struct br_linear_solver *l = br_method_solver(o->method, &field);
        if (o->scene->field[kind].modelled)
            element += br_by_element_of(&l->bytes, &field) +
                       states * br_by_element_of(&l->state_bytes, &field);
    }
    return element * (double)o->n;
}

double br_march_seconds(const struct br_planned_march *o)
{
    if (o->method->scheme->adaptive)
        return 0;
    return 1e-9 * (double)o->steps * br_method_cost(o->method, o->scene, o->n);
}

double br_march_pace(const struct br_planned_march *o)
{
    enum { MESH = 400, STEPS = 400 };
    const size_t n = o->n < MESH ? o->n : MESH;
    struct br_march *march;
    struct br_error err;
    if (o->method->scheme->adaptive || br_march_create(&march, o->scene, n, STEPS, o->method, &err))
        return 1;
    const double begun = br_thread_seconds();
    enum br_status status = BR_OK;
    for (int i = 0; i < STEPS && !status; i++)
        status = br_march_step(march, &err);
    const double spent = br_thread_seconds() - begun;
    br_march_free(march);
    return status ? 1 : spent / (1e-9 * STEPS * br_method_cost(o->method, o->scene, n));
}

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

static double group_limit(void)
{
    const double most = read_bytes("/sys/fs/cgroup/memory.max", "", 1);
    const double used = read_bytes("/sys/fs/cgroup/memory.current", "", 1);
    return isfinite(most) && isfinite(used) ? fmax(most - used, 0) : most;
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

enum br_status br_check_resources(const struct br_planned_march *o, struct br_warnings *w,
                                  struct br_error *err)
{
    const enum br_status status = br_fits_memory(o, br_memory_available(), err);
    return status ? status : check_time(o, w, err);
}
