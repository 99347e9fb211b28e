/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/trade_files.h"

#include <stdio.h>
#include <string.h>

#include "cli/provenance.h"
#include "plots/pictures.h"
#include "study/scene/file.h"

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
    if (!status)
        snprintf(item->caption, sizeof item->caption, "What a digit costs: %.400s",
                 item->scene.title);
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
    f->page = br_allocate(f->items, sizeof *f->page);
    if (!f->page)
        return br_no_memory(err, "the pages");
    for (size_t i = 0; i < f->items; i++) {
        struct br_trade_item *item = &f->item[i];
        br_provenance_fill(&item->provenance, threads);
        item->provenance.scene_path = item->path;
        item->provenance.scene_text = item->text;
        f->page[i] = (struct br_trade_page){
            .name = item->scene.name,
            .caption = item->caption,
            .trade = &item->trade,
            .provenance = &item->provenance,
        };
    }
    return br_output_open(&f->output, br_option_text(f->options, BR_OPT_OUT), err);
}

/* One table: of a page, or with pages > 1 their summary. */
static enum br_status write_table(struct br_trade_files *f, const struct br_page_emitter *e,
                                  const struct br_trade_page *page, size_t pages,
                                  struct br_error *err)
{
    char name[512];
    FILE *file;
    struct br_error closing = {0};
    snprintf(name, sizeof name, "%s%s", pages > 1 ? "summary" : page->name, e->extension);
    enum br_status status = br_output_file(&f->output, name, &file, err);
    if (status)
        return status;
    status = pages > 1 ? br_trade_summarise(e, file, page, pages, err)
                       : br_trade_emit(e, file, page, err);
    if (br_output_close(file, name, &closing) && !status)
        status = br_fail(err, closing.status, "%s", closing.message);
    return status;
}

static enum br_status write_tables(struct br_trade_files *f, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (const struct br_page_emitter *const *e = br_page_emitters; *e && !status; e++) {
        if (!br_format_wanted(f->options, (*e)->name))
            continue;
        for (size_t i = 0; i < f->items && !status; i++)
            status = write_table(f, *e, &f->page[i], 1, err);
        if (!status && f->items > 1)
            status = write_table(f, *e, f->page, f->items, err);
    }
    return status;
}

static enum br_status draw(struct br_trade_files *f, const struct br_trade_picture *picture,
                           const struct br_trade_page *page, struct br_error *err)
{
    struct br_figure figure;
    enum br_status status =
        br_trade_draw(picture, page->trade, page->name, page->caption, &figure, err);
    if (!status)
        status = br_picture_files_draw(&f->pictures, &figure, err);
    br_figure_clear(&figure);
    return status;
}

static enum br_status draw_all(struct br_trade_files *f, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < f->items && !status && !br_option_given(f->options, BR_OPT_NO_PLOTS);
         i++)
        for (const struct br_trade_picture *const *p = br_trade_pictures; *p && !status; p++)
            if (br_trade_picture_applies(*p, f->page[i].trade))
                status = draw(f, *p, &f->page[i], err);
    return status;
}

static enum br_status show(const struct br_trade_files *f, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < f->items && !status; i++) {
        status = br_trade_show(stdout, &f->page[i], err);
        putchar('\n');
    }
    if (f->items > 1 && !status)
        status = br_trade_summarise(&br_page_text, stdout, f->page, f->items, err);
    return status;
}

/* The pictures first: they are rendered while the tables are written. */
enum br_status br_trade_files_write(struct br_trade_files *f, struct br_error *err)
{
    f->pictures.output = &f->output;
    enum br_status status = draw_all(f, err);
    if (!status)
        status = write_tables(f, err);
    const enum br_status drawn = br_picture_files_finish(&f->pictures, status ? NULL : err);
    if (!status)
        status = drawn;
    if (status)
        return status;
    if (!br_option_given(f->options, BR_OPT_QUIET))
        status = show(f, err);
    if (!status)
        status = br_output_commit(&f->output, err);
    if (!status && !br_option_given(f->options, BR_OPT_QUIET))
        br_output_announce(&f->output);
    return status;
}

void br_trade_files_discard(struct br_trade_files *f)
{
    br_output_discard(&f->output);
    free(f->page);
    f->page = NULL;
}
