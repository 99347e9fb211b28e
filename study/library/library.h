/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of the library share: handles, and what surrounds each call from outside. */
#ifndef BR_STUDY_LIBRARY_LIBRARY_H
#define BR_STUDY_LIBRARY_LIBRARY_H

#include <locale.h>
#include <pthread.h>
#include <stdatomic.h>

#include "study/fit/fit.h"
#include "study/grid/observer.h"
#include "study/library/beamrate.h"
#include "study/verify/verify.h"

struct beamrate_scene {
    char *path; /* for messages; owned */
    struct br_scene scene;
    struct br_verify verify;
};

/* ---- around a call ---- */

/* From the beginning of a call to its end GSL returns its errors, and numbers are read and written
 * as in the locale "C". */
struct br_visit {
    locale_t locale;       /* of the thread before */
    struct br_error err;   /* what the call fails with */
    struct br_scene scene; /* a copy: a function's instance is for one thread at a time
                              (solver/function.h), and what predicts, proves or solves exactly
                              evaluates the scene's own; its texts are borrowed */
};

/* scene: what is copied; NULL: nothing. Fails with BR_NO_MEMORY; end it even then. */
enum br_status br_visit_begin(struct br_visit *visit, const struct beamrate_scene *scene);

/* Returns the status as the caller knows it, and fills *err (out; may be NULL). */
enum beamrate_status br_visit_end(struct br_visit *visit, enum br_status status,
                                  struct beamrate_error *err);

/* The body of a call that makes a handle (out): `fill`, which may use *handle, visit.scene, the
 * copy of `scene`, and &visit.err, makes it of zeros, and what it fails with, the call does. */
#define BR_MAKE_HANDLE(handle, release, scene, fill)                      \
    struct br_visit visit;                                                \
    enum br_status made = br_visit_begin(&visit, scene);                  \
    *(handle) = made ? NULL : br_allocate(1, sizeof **(handle));          \
    if (!made)                                                            \
        made = *(handle) ? (fill) : br_no_memory(&visit.err, "a handle"); \
    if (made) {                                                           \
        release(*(handle));                                               \
        *(handle) = NULL;                                                 \
    }                                                                     \
    return br_visit_end(&visit, made, err)

/* ---- what callers give ---- */

/* Reads a list of keys and values (beamrate.h); NULL: the default. Fails with BR_BAD_INPUT. */
enum br_status br_library_method(const char *const *list, struct br_method *method,
                                 struct br_error *err);

/* The caller's observer as ours has it. */
struct br_library_watch {
    const struct beamrate_observer *theirs; /* NULL: nobody */
    struct br_observer ours;                /* points to this */
    atomic_bool stopped;
    pthread_mutex_t one_at_a_time;
};
void br_library_watch_begin(struct br_library_watch *watch,
                            const struct beamrate_observer *observer);
void br_library_watch_end(struct br_library_watch *watch);

/* ---- what callers get ---- */

struct beamrate_estimate br_library_estimate(struct br_estimate estimate);
struct beamrate_fit br_library_fit(const struct br_joint_fit *fit);

#endif
