/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/trade_files.h"

#include <stdio.h>
#include <string.h>

#include "cli/documents.h"
#include "cli/provenance.h"
#include "plots/pictures.h"
#include "study/scene/file.h"
#include "tables/reports.h"

/* ---- scenes ---- */

/* Only the bundled scene itself is what the paper printed a table of. */
static enum br_status read_printed(struct br_trade_item *item, struct br_error *err)
{
    static const struct {
        const char *scene, *table;
    } tables[] = {{"study/scenes/example1.yaml", "reference/printed/table1.csv"},
                  {"study/scenes/example2.yaml", "reference/printed/table2.csv"}};
    enum br_status status = BR_OK;
    for (size_t i = 0; i < sizeof tables / sizeof *tables && !status; i++) {
        char path[1024];
        br_data_path(tables[i].scene, path, sizeof path);
        if (strcmp(path, item->path) != 0)
            continue;
        br_data_path(tables[i].table, path, sizeof path);
        status = br_printed_read(path, &item->printed, err);
    }
    return status;
}

enum br_status br_trade_item_read(struct br_trade_item *item, const char *scene,
                                  struct br_error *err)
{
    enum br_status status =
        br_scene_open(scene, item->path, sizeof item->path, &item->text, &item->scene, err);
    if (!status)
        status = read_printed(item, err);
    return status;
}

void br_trade_item_clear(struct br_trade_item *item)
{
    br_trade_clear(&item->trade);
    br_printed_clear(&item->printed);
    br_scene_clear(&item->scene);
    free(item->steps);
    free(item->text);
}

/* ---- files ---- */

enum br_status br_trade_files_open(struct br_trade_files *f, int threads, struct br_error *err)
{
    f->document = br_allocate(f->items + 1, sizeof *f->document);
    if (!f->document)
        return br_no_memory(err, "the reports");
    for (size_t i = 0; i < f->items; i++) {
        struct br_trade_item *item = &f->item[i];
        br_provenance_fill(&item->provenance, threads);
        item->provenance.scene_path = item->path;
        item->provenance.scene_text = item->text;
    }
    return br_output_open(&f->output, br_option_text(f->options, BR_OPT_OUT), err);
}

/* How many documents there are: of the scenes, and where there are several one of all. */
static size_t documents(const struct br_trade_files *f)
{
    return f->items > 1 ? f->items + 1 : f->items;
}

static enum br_status build(struct br_trade_files *f, struct br_error *err)
{
    const struct br_trade **trade = br_allocate(f->items, sizeof *trade);
    enum br_status status = trade ? BR_OK : br_no_memory(err, "the reports");
    for (size_t i = 0; i < f->items && !status; i++) {
        trade[i] = &f->item[i].trade;
        br_report_trade(trade[i], &f->item[i].provenance, &f->document[i]);
        status = br_document_status(&f->document[i], err);
    }
    if (!status && f->items > 1)
        br_report_trade_summary(trade, f->items, &f->item->provenance, &f->document[f->items]);
    free(trade);
    return status;
}

static enum br_status draw(struct br_trade_files *f, const struct br_trade_picture *picture,
                           size_t item, struct br_error *err)
{
    struct br_figure figure;
    struct br_document *d = &f->document[item];
    enum br_status status =
        br_trade_draw(picture, &f->item[item].trade, d->name, d->caption, &figure, err);
    if (!status) {
        br_put_picture(d, figure.stem, picture->title);
        status = br_picture_files_draw(&f->pictures, &figure, err);
    }
    br_figure_clear(&figure);
    return status;
}

static enum br_status draw_all(struct br_trade_files *f, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < f->items && !status && !br_option_given(f->options, BR_OPT_NO_PLOTS);
         i++)
        for (const struct br_trade_picture *const *p = br_trade_pictures; *p && !status; p++)
            if (br_trade_picture_applies(*p, &f->item[i].trade))
                status = draw(f, *p, i, err);
    return status;
}

/* The pictures first: they are rendered while the tables are written. */
enum br_status br_trade_files_write(struct br_trade_files *f, struct br_error *err)
{
    f->pictures.output = &f->output;
    enum br_status status = build(f, err);
    if (!status)
        status = draw_all(f, err);
    if (!status)
        status = br_documents_write(&f->pictures, f->options, f->document, documents(f), err);
    const enum br_status drawn = br_picture_files_finish(&f->pictures, status ? NULL : err);
    if (!status)
        status = drawn;
    if (status)
        return status;
    if (!br_option_given(f->options, BR_OPT_QUIET))
        status = br_documents_show(f->document, documents(f), err);
    if (!status)
        status = br_output_commit(&f->output, err);
    if (!status && !br_option_given(f->options, BR_OPT_QUIET))
        br_output_announce(&f->output);
    return status;
}

void br_trade_files_discard(struct br_trade_files *f)
{
    br_output_discard(&f->output);
    for (size_t i = 0; f->document && i <= f->items; i++)
        br_document_clear(&f->document[i]);
    free(f->document);
    f->document = NULL;
}
