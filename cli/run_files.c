/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/run.h"

#include <math.h>
#include <string.h>

#include "cli/documents.h"

enum br_status br_run_files_open(struct br_run_files *f, const char *folder,
                                 const struct br_fields_request *request, struct br_error *err)
{
    struct br_fields_request fields = *request;
    if (br_output_open(&f->output, folder, err) ||
        br_output_file(&f->output, "history.csv", &f->history, err))
        return err->status;
    br_history_csv_head(f->history);
    f->scene = request->scene;
    f->format = br_fields_formats[0];
    snprintf(f->path, sizeof f->path, "%s/%s", f->output.staging, f->format->file_name);
    fields.path = f->path;
    return f->format->open(&f->fields, &fields, err);
}

/* What is not modelled is an empty field, not a zero. */
static enum br_status write_row(void *self, const struct br_history_row *row, struct br_error *err)
{
    struct br_run_files *f = self;
    struct br_history_row told = *row;
    if (!f->scene->axial.modelled)
        told.displacement[BR_AXIAL] = told.velocity[BR_AXIAL] = NAN;
    if (!f->scene->bending.modelled)
        told.displacement[BR_BENDING] = told.velocity[BR_BENDING] = NAN;
    if (!f->scene->contact.modelled)
        told.contact_force = NAN;
    if (f->scene->friction.law == BR_FRICTIONLESS)
        told.friction_force = told.friction_bound = NAN;
    br_history_csv_row(f->history, &told);
    return ferror(f->history) ? br_fail(err, BR_IO, "history.csv could not be written") : BR_OK;
}

static enum br_status write_look(void *self, const struct br_march *march,
                                 const struct br_history_row *row, struct br_error *err)
{
    struct br_run_files *f = self;
    return f->format->look(f->fields, march, row, err);
}

struct br_history_observer br_run_files_observer(struct br_run_files *f)
{
    return (struct br_history_observer){.self = f, .row = write_row, .look = write_look};
}

static enum br_status close_history(struct br_run_files *f, const char *stopped,
                                    struct br_error *err)
{
    FILE *history = f->history;
    f->history = NULL;
    if (stopped)
        br_history_csv_stopped(history, stopped);
    return br_output_close(history, "history.csv", err);
}

static enum br_status close_fields(struct br_run_files *f, const char *stopped,
                                   struct br_error *err)
{
    struct br_fields_file *fields = f->fields;
    f->fields = NULL;
    return f->format->close(fields, stopped, err);
}

enum br_status br_run_files_commit(struct br_run_files *f, const struct br_document *summary,
                                   const char *stopped, struct br_error *err)
{
    const bool failed = close_history(f, stopped, err) || close_fields(f, stopped, err) ||
                        br_documents_write_as(&f->output, &br_document_text, summary, err) ||
                        br_documents_write_as(&f->output, &br_document_json, summary, err) ||
                        br_documents_write_page(&f->output, summary, 1, err) ||
                        br_output_commit(&f->output, err);
    return failed ? err->status : BR_OK;
}

void br_run_files_discard(struct br_run_files *f)
{
    if (f->history)
        fclose(f->history);
    f->history = NULL;
    if (f->format)
        close_fields(f, NULL, NULL);
    br_output_discard(&f->output);
}
