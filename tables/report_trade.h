/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reports of `beamrate trade`. Each begins the document and puts all into it but pictures. */
#ifndef BR_TABLES_REPORT_TRADE_H
#define BR_TABLES_REPORT_TRADE_H

#include "study/trade/trade.h"
#include "tables/document.h"

/* One scene: the cheapest way to each error, the seconds of each method to these, the Pareto front,
 * and for programs all trials. The document has the scene's name. */
void br_report_trade(const struct br_trade *trade, const struct br_provenance *provenance,
                     struct br_document *d);

/* Several scenes in one norm: the cheapest ways alone. The document's name is "summary". */
void br_report_trade_summary(const struct br_trade *const *trade, size_t scenes,
                             const struct br_provenance *provenance, struct br_document *d);

#endif
