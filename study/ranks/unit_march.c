/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/ranks/unit_march.h"

#include <stdio.h>
#include <string.h>

#include "study/grid/lockstep.h"

/* ---- slices as studies ---- */

/* A slice is the whole study in which the cells of other slices take one step only: so the
 * reference is looked at on the same meshes and at the same time levels, and every bit is that of
 * the whole study. */
static enum br_status copy_cells(struct br_study *copy, const struct br_study *study,
                                 const size_t *owner, size_t slice, struct br_error *err)
{
    const size_t cells = br_study_cells(study);
    copy->cell = br_allocate(cells, sizeof *copy->cell);
    if (!copy->cell)
        return br_no_memory(err, "the table");
    for (size_t i = 0; i < cells; i++) {
        copy->cell[i] = study->cell[i];
        if (owner[i] != slice)
            copy->cell[i].at.steps = 1;
    }
    return BR_OK;
}

static size_t chain_length(const struct br_study *s)
{
    size_t length = 0;
    for (; s; s = s->next_norm)
        length++;
    return length;
}

/* The copies of a group's studies: the heads first, as br_lockstep takes them, then the rest of
 * their chains. */
struct group {
    const struct br_unit *unit;
    size_t units, studies;
    struct br_study *copy;
    size_t **owner; /* of each unit: whose the cells are */
};

static enum br_status copy_unit(struct group *g, const struct br_study *studies, size_t i,
                                size_t *next, struct br_error *err)
{
    const struct br_unit *unit = &g->unit[i];
    const struct br_study *head = &studies[unit->study];
    g->owner[i] = br_allocate(br_study_cells(head), sizeof **g->owner);
    if (!g->owner[i] || !(br_slice_cells(head, unit->slices, g->owner[i]) >= 0))
        return br_no_memory(err, "the cells of a slice");
    struct br_study *copy = &g->copy[i];
    enum br_status status = BR_OK;
    for (const struct br_study *s = head; s && !status; s = s->next_norm) {
        *copy = *s;
        status = copy_cells(copy, s, g->owner[i], unit->slice, err);
        copy->next_norm = s->next_norm ? &g->copy[(*next)++] : NULL;
        copy = copy->next_norm;
    }
    return status;
}

static enum br_status create_group(struct group *g, const struct br_study *studies,
                                   const struct br_units *units, size_t group, struct br_error *err)
{
    g->unit = &units->unit[units->first[group]];
    g->units = units->first[group + 1] - units->first[group];
    for (size_t i = 0; i < g->units; i++)
        g->studies += chain_length(&studies[g->unit[i].study]);
    g->copy = br_allocate(g->studies, sizeof *g->copy);
    g->owner = br_allocate(g->units, sizeof *g->owner);
    if (!g->copy || !g->owner)
        return br_no_memory(err, "a group of studies");
    size_t next = g->units;
    enum br_status status = BR_OK;
    for (size_t i = 0; i < g->units && !status; i++)
        status = copy_unit(g, studies, i, &next, err);
    return status;
}

static void clear_group(struct group *g)
{
    for (size_t i = 0; g->copy && i < g->studies; i++)
        br_study_clear(&g->copy[i]);
    for (size_t i = 0; g->owner && i < g->units; i++)
        free(g->owner[i]);
    free(g->copy);
    free(g->owner);
}

/* ---- parcels ---- */

/* What a study tells beside its cells. */
struct told {
    bool audited;
    struct br_judge_report judged_by;
    double reference_scale, reference_size[2], reference_error[BR_PARTS], reference_tip[2];
    struct br_error failure;
    size_t events; /* bytes that follow; 0: NULL */
};

static void pack(FILE *out, const struct br_study *s, const size_t *owner, size_t slice)
{
    struct told told;
    memset(&told, 0, sizeof told); /* the gaps, too */
    told.audited = s->auditor != NULL;
    told.judged_by = s->judged_by;
    told.reference_scale = s->reference_scale;
    memcpy(told.reference_size, s->reference_size, sizeof told.reference_size);
    memcpy(told.reference_error, s->reference_error, sizeof told.reference_error);
    memcpy(told.reference_tip, s->reference_tip, sizeof told.reference_tip);
    told.failure = s->failure;
    told.events = s->events ? strlen(s->events) + 1 : 0;
    fwrite(&told, sizeof told, 1, out);
    if (told.events)
        fwrite(s->events, 1, told.events, out);
    for (size_t i = 0; i < br_study_cells(s); i++)
        if (owner[i] == slice)
            fwrite(&s->cell[i], sizeof s->cell[i], 1, out);
}

static enum br_status pack_group(const struct group *g, struct br_parcel *parcel,
                                 struct br_error *err)
{
    FILE *out = open_memstream(&parcel->bytes, &parcel->size);
    if (!out)
        return br_no_memory(err, "the results");
    for (size_t i = 0; i < g->units; i++)
        for (const struct br_study *s = &g->copy[i]; s; s = s->next_norm)
            pack(out, s, g->owner[i], g->unit[i].slice);
    const bool failed = ferror(out);
    return fclose(out) != 0 || failed ? br_no_memory(err, "the results") : BR_OK;
}

enum br_status br_group_march(const struct br_study *studies, const struct br_units *units,
                              size_t group, int threads, const struct br_observer *observer,
                              struct br_parcel *parcel, struct br_error *err)
{
    struct group g = {0};
    *parcel = (struct br_parcel){0};
    enum br_status status = create_group(&g, studies, units, group, err);
    if (!status)
        status = br_lockstep(g.copy, g.units, threads, observer, err);
    if (!status)
        status = pack_group(&g, parcel, err);
    clear_group(&g);
    return status;
}

static bool take(struct br_parcel *parcel, void *to, size_t size)
{
    if (parcel->size - parcel->at < size)
        return false;
    memcpy(to, parcel->bytes + parcel->at, size);
    parcel->at += size;
    return true;
}

/* All slices tell the same of their study, but for times: the first one counts. */
static enum br_status unpack_told(struct br_study *s, bool first, struct br_parcel *parcel,
                                  struct br_error *err)
{
    struct told told;
    if (!take(parcel, &told, sizeof told) || parcel->size - parcel->at < told.events)
        return br_fail(err, BR_IO, "the results of another rank are cut off");
    const char *events = parcel->bytes + parcel->at;
    parcel->at += told.events;
    if (told.failure.status)
        s->failure = told.failure;
    if (!first)
        return BR_OK;
    s->auditor = told.audited ? s->auditor : NULL;
    s->judged_by = told.judged_by;
    s->reference_scale = told.reference_scale;
    memcpy(s->reference_size, told.reference_size, sizeof told.reference_size);
    memcpy(s->reference_error, told.reference_error, sizeof told.reference_error);
    memcpy(s->reference_tip, told.reference_tip, sizeof told.reference_tip);
    if (told.events && !(s->events = strndup(events, told.events)))
        return br_no_memory(err, "the events");
    return BR_OK;
}

static enum br_status unpack_unit(struct br_study *head, const struct br_unit *unit,
                                  const size_t *owner, struct br_parcel *parcel,
                                  struct br_error *err)
{
    for (struct br_study *s = head; s; s = s->next_norm) {
        const enum br_status status = unpack_told(s, unit->slice == 0, parcel, err);
        if (status)
            return status;
        for (size_t i = 0; i < br_study_cells(s); i++)
            if (owner[i] == unit->slice && !take(parcel, &s->cell[i], sizeof s->cell[i]))
                return br_fail(err, BR_IO, "the results of another rank are cut off");
    }
    return BR_OK;
}

enum br_status br_group_unpack(struct br_study *studies, const struct br_units *units, size_t group,
                               struct br_parcel *parcel, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = units->first[group]; i < units->first[group + 1] && !status; i++) {
        const struct br_unit *unit = &units->unit[i];
        struct br_study *head = &studies[unit->study];
        size_t *owner = br_allocate(br_study_cells(head), sizeof *owner);
        if (!owner || !(br_slice_cells(head, unit->slices, owner) >= 0))
            status = br_no_memory(err, "the cells of a slice");
        else
            status = unpack_unit(head, unit, owner, parcel, err);
        free(owner);
    }
    if (!status && parcel->at != parcel->size)
        status = br_fail(err, BR_IO, "the results of another rank are too long");
    return status;
}
