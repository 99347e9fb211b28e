/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/library/library.h"

#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/scene/method_fields.h"

const char *beamrate_version(void)
{
    return BEAMRATE_VERSION;
}

/* ---- the beginning and end of a call ---- */

/* GSL has one error handler for all threads, and the default one ends the process. So the first
 * call removes the handler, and the last call that ends restores it. Changes that functions of the
 * program make to the handler in between have no effect. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static size_t calls_now;
static gsl_error_handler_t *their_handler;

void br_call_begin(struct br_call *call)
{
    *call = (struct br_call){.err = {0}};
    pthread_mutex_lock(&lock);
    if (calls_now++ == 0)
        their_handler = gsl_set_error_handler_off();
    pthread_mutex_unlock(&lock);
    call->locale = uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0)); /* never fails: static */
}

enum br_status br_call_take_scene(struct br_call *call, const struct beamrate_scene *scene)
{
    if (br_handle_check(scene, BR_HANDLE_SCENE, "scene", &call->err))
        return call->err.status;
    call->scene = scene->scene;
    struct br_function *f;
    for (size_t i = 0; (f = br_scene_function(&call->scene, i)); i++) {
        const struct br_function theirs = *f;
        *f = (struct br_function){0};
        if (!call->err.status)
            br_function_clone(&theirs, f, &call->err);
    }
    return call->err.status;
}

bool br_handle_is(const void *handle, enum br_handle kind)
{
    return handle && *(const enum br_handle *)handle == kind;
}

enum br_status br_handle_check(const void *handle, enum br_handle kind, const char *name,
                               struct br_error *err)
{
    static const char *const titles[] = {"scene", "march", "study", "check", "orders"};
    return br_handle_is(handle, kind)
               ? BR_OK
               : br_fail(err, BR_BAD_INPUT, "%s: found %s, expected a handle of kind '%s'", name,
                         handle ? "something else" : "NULL", titles[kind - BR_HANDLE_SCENE]);
}

static const enum beamrate_status statuses[] = {
    [BR_OK] = BEAMRATE_OK,
    [BR_VERDICT] = BEAMRATE_BAD_INPUT, /* a verdict is a result: no call returns this */
    [BR_BAD_INPUT] = BEAMRATE_BAD_INPUT,
    [BR_UNSUPPORTED] = BEAMRATE_UNSUPPORTED,
    [BR_NO_MEMORY] = BEAMRATE_NO_MEMORY,
    [BR_SINGULAR] = BEAMRATE_SINGULAR,
    [BR_NOT_FINITE] = BEAMRATE_NOT_FINITE,
    [BR_IO] = BEAMRATE_IO,
    [BR_INTERRUPTED] = BEAMRATE_INTERRUPTED,
};

enum beamrate_status br_call_end(struct br_call *call, enum br_status status,
                                 struct beamrate_error *err)
{
    struct br_function *f;
    for (size_t i = 0; (f = br_scene_function(&call->scene, i)); i++)
        br_function_free(f);
    uselocale(call->locale);
    pthread_mutex_lock(&lock);
    if (--calls_now == 0)
        gsl_set_error_handler(their_handler);
    pthread_mutex_unlock(&lock);
    if (err) {
        err->status = statuses[status];
        snprintf(err->message, sizeof err->message, "%s", status ? call->err.message : "");
    }
    return statuses[status];
}

/* ---- from callers ---- */

static enum br_status refuse_key(const char *key, struct br_error *err)
{
    char keys[400] = "";
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++)
        br_append(keys, sizeof keys, "%s%s", i ? ", " : "",
                  br_method_field_key(&br_method_fields[i]));
    return br_fail(err, BR_BAD_INPUT, "method: found '%.200s', expected one of: %s", key, keys);
}

enum br_status br_library_method(const char *const *list, struct br_method *method,
                                 struct br_error *err)
{
    const char *text[BR_METHOD_FIELDS] = {NULL};
    const struct br_method *const methods[] = {method};
    *method = br_method_default();
    for (const char *const *at = list; at && *at; at += 2) {
        size_t i = 0;
        while (i < BR_METHOD_FIELDS && strcmp(at[0], br_method_field_key(&br_method_fields[i])))
            i++;
        if (i == BR_METHOD_FIELDS)
            return refuse_key(at[0], err);
        if (text[i] || !at[1])
            return br_fail(err, BR_BAD_INPUT, "method: %s: %s, expected a value", at[0],
                           text[i] ? "found it twice" : "found the end of the list");
        text[i] = at[1];
    }
    const enum br_status status = br_method_read(text, BR_METHOD_IN_SCENE, method, err);
    return status ? status : br_method_check_used(text, BR_METHOD_IN_SCENE, methods, 1, err);
}

/* If another thread is in this function, the report is left out. */
static void progress(void *self, double share)
{
    struct br_library_watch *w = self;
    if (pthread_mutex_trylock(&w->one_at_a_time) != 0)
        return;
    if (w->theirs->progress && w->theirs->progress(w->theirs->self, share) != 0)
        atomic_store(&w->stopped, true);
    pthread_mutex_unlock(&w->one_at_a_time);
}

/* While the exact reference is prepared, no march has started. */
static void preparing(void *self, double share)
{
    (void)share;
    progress(self, 0);
}

static bool stop(void *self)
{
    struct br_library_watch *w = self;
    return atomic_load(&w->stopped);
}

void br_library_watch_begin(struct br_library_watch *w, const struct beamrate_observer *observer)
{
    w->theirs = observer;
    w->ours =
        observer ? (struct br_observer){progress, stop, w, preparing, NULL} : (struct br_observer){0};
    atomic_init(&w->stopped, false);
    pthread_mutex_init(&w->one_at_a_time, NULL);
}

void br_library_watch_end(struct br_library_watch *w)
{
    pthread_mutex_destroy(&w->one_at_a_time);
}

/* ---- to callers ---- */

struct beamrate_estimate br_library_estimate(struct br_estimate e)
{
    return (struct beamrate_estimate){e.value, e.low, e.high};
}

struct beamrate_fit br_library_fit(const struct br_joint_fit *fit)
{
    const struct beamrate_estimate nothing = {NAN, NAN, NAN};
    if (!fit->converged)
        return (struct beamrate_fit){0,       nothing, nothing, nothing,
                                     nothing, nothing, NAN,     fit->points};
    return (struct beamrate_fit){
        .describes = br_joint_describes(fit),
        .p = br_library_estimate(fit->order[BR_AXIS_SPACE]),
        .c_h = br_library_estimate(fit->c[BR_AXIS_SPACE]),
        .q = br_library_estimate(fit->order[BR_AXIS_TIME]),
        .c_k = br_library_estimate(fit->c[BR_AXIS_TIME]),
        .r = br_library_estimate(fit->r),
        .misfit = fit->misfit,
        .points = fit->points,
    };
}
