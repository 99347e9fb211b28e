/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/foresee/warnings.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "study/foresee/warn_contact.h"

extern const struct br_warning_source br_warn_bounce, br_warn_initial, br_warn_load,
    br_warn_load_space, br_warn_prediction, br_warn_resources;

const struct br_warning_source *const br_warning_sources[] = {
    &br_warn_resources,  &br_warn_contact, &br_warn_bounce,     &br_warn_load,
    &br_warn_load_space, &br_warn_initial, &br_warn_prediction, NULL,
};

const char *br_warning_word(enum br_warning_kind kind)
{
    static const char *const words[] = {
#define X(name, word) [name] = word,
        BR_WARNING_LIST(X)
#undef X
    };
    return words[kind];
}

const struct br_warning *br_warnings_find(const struct br_warnings *w, enum br_warning_kind kind)
{
    for (size_t i = 0; i < w->count; i++)
        if (w->list[i].kind == kind)
            return &w->list[i];
    return NULL;
}

const char *br_unseen(struct br_warnings *w, enum br_warning_kind kind, double missed, double size,
                      double large)
{
    const double ratio = missed / size, share = missed == 0 ? 0 : isnan(ratio) ? INFINITY : ratio;
    w->unseen[kind] = fmax(w->unseen[kind], share);
    if (share <= large)
        return NULL;
    if (share > 0.995)
        return share > 1.005 ? "more than all" : "all";
    snprintf(w->share, sizeof w->share, "%.2g %%", 100 * share);
    return w->share;
}

void br_warn(struct br_warnings *w, enum br_warning_kind kind, const char *remedy,
             const char *format, ...)
{
    for (size_t i = 0; i < w->count; i++)
        if (w->list[i].kind == kind) {
            w->list[i].more++;
            return;
        }
    struct br_warning *added = &w->list[w->count++];
    *added = (struct br_warning){.kind = kind};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(added->text, sizeof added->text, format, arguments);
    va_end(arguments);
    snprintf(added->remedy, sizeof added->remedy, "%s", remedy ? remedy : "");
}

/* Asks those that are cheap, or those that are not. */
static enum br_status ask(const struct br_planned_march *planned, bool every, struct br_warnings *w,
                          struct br_error *err)
{
    for (const struct br_warning_source *const *s = br_warning_sources; *s; s++) {
        const enum br_status status = (*s)->every == every ? (*s)->look(planned, w, err) : BR_OK;
        if (status)
            return status;
    }
    return BR_OK;
}

enum br_status br_look_ahead(const struct br_planned_march *planned, struct br_warnings *w,
                             struct br_error *err)
{
    const enum br_status status = ask(planned, true, w, err);
    return status ? status : ask(planned, false, w, err);
}

enum br_status br_look_ahead_cheaply(const struct br_planned_march *planned, struct br_warnings *w,
                                     struct br_error *err)
{
    return ask(planned, true, w, err);
}

enum br_status br_look_at_loads(const struct br_planned_march *planned, struct br_warnings *w,
                                struct br_error *err)
{
    enum br_status status = br_warn_load.look(planned, w, err);
    status = status ? status : br_warn_load_space.look(planned, w, err);
    return status ? status : br_warn_initial.look(planned, w, err);
}
