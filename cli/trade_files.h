/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scenes of a trade, and the files that come of it. */
#ifndef BR_CLI_TRADE_FILES_H
#define BR_CLI_TRADE_FILES_H

#include "cli/option.h"
#include "cli/picture_files.h"
#include "study/trade/trade.h"
#include "tables/document.h"

/* A scene on its way; not to be moved once its trade is laid out. Begins as zeros. */
struct br_trade_item {
    char path[1024]; /* the scene's file */
    char *text;      /* its contents */
    struct br_scene scene;
    struct br_printed printed; /* the paper's table of it; empty: none */
    size_t *steps;             /* as --k has them; owned */
    struct br_provenance provenance;
    struct br_trade trade;
};

/* Reads a scene, and the printed table of a bundled one that has it. Fails with BR_BAD_INPUT or
 * BR_NO_MEMORY; clear the item even then. */
enum br_status br_trade_item_read(struct br_trade_item *item, const char *scene,
                                  struct br_error *err);
void br_trade_item_clear(struct br_trade_item *item);

/* The files of all items. Begins with the first three, the rest zeros. */
struct br_trade_files {
    struct br_trade_item *item; /* items; borrowed */
    size_t items;
    const struct br_options *options;
    struct br_document *document; /* of each item, then of all; owned */
    struct br_output output;
    struct br_picture_files pictures;
};

/* Makes the folder, so call it before a long computation. Fails with BR_BAD_INPUT. Discard the
 * files even then. */
enum br_status br_trade_files_open(struct br_trade_files *files, int threads, struct br_error *err);

/* Shows the tables on the terminal and writes everything, whole or not at all. */
enum br_status br_trade_files_write(struct br_trade_files *files, struct br_error *err);

/* Removes what has not been put in place, and releases the rest. */
void br_trade_files_discard(struct br_trade_files *files);

#endif
