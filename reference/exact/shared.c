/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/shared.h"

#include <pthread.h>
#include <stdint.h>

#include "reference/exact/solution.h"

/* A scene is known by its address, which is its own as long as somebody has the solution. */
struct loan {
    const struct br_scene *scene;
    struct br_exact_options options;
    struct br_exact *exact;
    size_t users;
    struct loan *next;
};

static struct loan *loans;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static size_t most_modes(const struct br_exact_options *o)
{
    return o->max_modes ? o->max_modes : SIZE_MAX;
}

static bool below(const struct br_exact *exact, size_t limit)
{
    for (size_t i = 0; i < BR_EXACT_FIELDS; i++)
        if (exact->solution->field[i] && !(exact->report[i].modes < limit))
            return false;
    return true;
}

/* Whether a loan is what `o` would give: a limit to the modes that was not met changes nothing. */
static bool serves(const struct loan *loan, const struct br_scene *scene,
                   const struct br_exact_options *o)
{
    const struct br_exact_options *l = &loan->options;
    const bool same = l->tolerance == o->tolerance && l->acceptable == o->acceptable &&
                      l->rate_tolerance == o->rate_tolerance && l->max_steps == o->max_steps;
    return loan->scene == scene && same &&
           (most_modes(l) == most_modes(o) ||
            (below(loan->exact, most_modes(l)) && below(loan->exact, most_modes(o))));
}

static const struct br_exact *find(const struct br_scene *scene, const struct br_exact_options *o)
{
    const struct br_exact *found = NULL;
    pthread_mutex_lock(&lock);
    for (struct loan *loan = loans; loan && !found; loan = loan->next)
        if (serves(loan, scene, o)) {
            loan->users++;
            found = loan->exact;
        }
    pthread_mutex_unlock(&lock);
    return found;
}

enum br_status br_exact_borrow(const struct br_exact **out, const struct br_scene *scene,
                               const struct br_exact_options *options, struct br_error *err)
{
    *out = find(scene, options);
    if (*out)
        return BR_OK;
    struct loan *loan = br_allocate(1, sizeof *loan);
    if (!loan)
        return br_no_memory(err, "the exact solution");
    *loan = (struct loan){.scene = scene, .options = *options, .users = 1};
    const enum br_status status = br_exact_create(&loan->exact, scene, options, err);
    if (status) {
        free(loan);
        return status;
    }
    pthread_mutex_lock(&lock);
    loan->next = loans;
    loans = loan;
    pthread_mutex_unlock(&lock);
    *out = loan->exact;
    return BR_OK;
}

void br_exact_give_back(const struct br_exact *exact)
{
    struct loan *last = NULL;
    pthread_mutex_lock(&lock);
    for (struct loan **at = &loans; exact && *at; at = &(*at)->next)
        if ((*at)->exact == exact) {
            if (--(*at)->users == 0) {
                last = *at;
                *at = last->next;
            }
            break;
        }
    pthread_mutex_unlock(&lock);
    if (last)
        br_exact_free(last->exact);
    free(last);
}
