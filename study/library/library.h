/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of the library share: handles, and the beginning and end of each call. */
#ifndef BR_STUDY_LIBRARY_LIBRARY_H
#define BR_STUDY_LIBRARY_LIBRARY_H

#include <locale.h>
#include <pthread.h>
#include <stdatomic.h>

#include "base/observer.h"
#include "orders/orders.h"
#include "solver/scene.h"
#include "study/fit/fit.h"
#include "study/library/beamrate.h"
#include "study/verify/verify.h"

/* Each handle begins with its kind, so that a handle of another kind is refused. */
enum br_handle {
    BR_HANDLE_SCENE = 0x6272,
    BR_HANDLE_MARCH,
    BR_HANDLE_STUDY,
    BR_HANDLE_CHECK,
    BR_HANDLE_ORDERS
};
bool br_handle_is(const void *handle, enum br_handle kind); /* false for NULL */

/* The same with a message, which calls the argument `name`. */
enum br_status br_handle_check(const void *handle, enum br_handle kind, const char *name,
                               struct br_error *err);

struct beamrate_scene {
    enum br_handle kind;
    char *path; /* for messages; owned */
    struct br_scene scene;
    struct br_verify verify;
};

struct beamrate_orders {
    enum br_handle kind;
    struct br_numbers numbers;
    struct br_orders orders;
    char *report; /* the last one; owned */
};

/* ---- the beginning and end of a call ---- */

/* The state of a call. During the call GSL returns its errors, and numbers are read and written as
 * in the locale "C". */
struct br_call {
    locale_t locale;       /* of the thread before the call */
    struct br_error err;   /* the error of the call */
    struct br_scene scene; /* a copy, since an instance of a function is for one thread at a time
                              (solver/function.h), and predictions, proofs and exact solutions
                              evaluate the scene's own functions; its texts are borrowed */
};

void br_call_begin(struct br_call *call);

/* Copies the caller's scene; once in a call. Fails with BR_NO_MEMORY, or BR_BAD_INPUT if it is no
 * scene. */
enum br_status br_call_take_scene(struct br_call *call, const struct beamrate_scene *scene);

/* Returns the status in the caller's numbers, and fills *err (out; may be NULL). */
enum beamrate_status br_call_end(struct br_call *call, enum br_status status,
                                 struct beamrate_error *err);

/* The body of a call that makes a handle (out) from zeros. `fill` may use *handle and call. If it
 * fails, the call fails. */
#define BR_MAKE_HANDLE(handle, handle_kind, release, fill)                                        \
    struct br_call call;                                                                          \
    br_call_begin(&call);                                                                         \
    if (!(handle))                                                                                \
        return br_call_end(                                                                       \
            &call, br_fail(&call.err, BR_BAD_INPUT, "found NULL, expected a place for a handle"), \
            err);                                                                                 \
    *(handle) = br_allocate(1, sizeof **(handle));                                                \
    if (*(handle))                                                                                \
        (*(handle))->kind = handle_kind;                                                          \
    const enum br_status made = *(handle) ? (fill) : br_no_memory(&call.err, "a handle");         \
    if (made) {                                                                                   \
        release(*(handle));                                                                       \
        *(handle) = NULL;                                                                         \
    }                                                                                             \
    return br_call_end(&call, made, err)

/* ---- from callers ---- */

/* Reads a list of keys and values (beamrate.h); NULL: the default. Fails with BR_BAD_INPUT. */
enum br_status br_library_method(const char *const *list, struct br_method *method,
                                 struct br_error *err);

/* The caller's observer, wrapped for the study. */
struct br_library_watch {
    const struct beamrate_observer *theirs; /* NULL: none */
    struct br_observer ours;                /* its self is this struct */
    atomic_bool stopped;
    pthread_mutex_t one_at_a_time;
};
void br_library_watch_begin(struct br_library_watch *watch,
                            const struct beamrate_observer *observer);
void br_library_watch_end(struct br_library_watch *watch);

/* ---- to callers ---- */

struct beamrate_estimate br_library_estimate(struct br_estimate estimate);
struct beamrate_fit br_library_fit(const struct br_joint_fit *fit);

#endif
