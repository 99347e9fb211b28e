/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/verdicts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/orders/sha256.h"
#include "study/scene/quote.h"

void br_study_file_clear(struct br_study_file *f)
{
    br_orders_clear(&f->orders);
    br_numbers_clear(&f->numbers);
    br_orders_request_clear(&f->request);
}

/* ---- trust ---- */

/* The file that remembers the sums of study files whose commands may be run (out); false: there is
 * no place for one. */
static bool place_of_trust(char path[4096], bool make)
{
    const char *state = getenv("XDG_STATE_HOME"), *home = getenv("HOME");
    char folder[4000];
    if (state && *state == '/')
        snprintf(folder, sizeof folder, "%.3900s/beamrate", state);
    else if (home && *home == '/')
        snprintf(folder, sizeof folder, "%.3900s/.local/state/beamrate", home);
    else
        return false;
    snprintf(path, 4096, "%s/trusted", folder);
    return !make || br_make_folders(folder, 0700, &make);
}

static bool is_trusted(const char *sum)
{
    char path[4096], line[128];
    FILE *file = place_of_trust(path, false) ? fopen(path, "re") : NULL;
    bool found = false;
    while (file && !found && fgets(line, sizeof line, file))
        found = strncmp(line, sum, strlen(sum)) == 0;
    if (file)
        fclose(file);
    return found;
}

static void remember(const char *sum)
{
    char path[4096];
    FILE *file = place_of_trust(path, true) ? fopen(path, "ae") : NULL;
    if (!file || fprintf(file, "%s\n", sum) < 0)
        fprintf(stderr, "beamrate: warning: that the study file is trusted could not be kept\n");
    if (file)
        fclose(file);
}

static enum br_status check_trust(const struct br_orders_request *request, const char *text,
                                  const struct br_options *options, struct br_error *err)
{
    struct br_sha256 s;
    char sum[BR_SHA256_TEXT], command[400], path[400];
    br_sha256_start(&s);
    br_sha256_add(&s, text, strlen(text));
    br_sha256_end(&s, sum);
    br_quoted(command, sizeof command, &br_for_text, request->command);
    const bool trusted = is_trusted(sum);
    if (!trusted && !br_option_given(options, BR_OPT_TRUST))
        return br_fail(err, BR_BAD_INPUT,
                       "%s: it runs the command '%s', and is not trusted yet: read it, then give "
                       "--trust once",
                       request->path, command);
    if (!trusted)
        remember(sum);
    if (br_option_given(options, BR_OPT_QUIET))
        return BR_OK;
    fprintf(stderr, "beamrate: %s runs %s\n",
            br_quoted(path, sizeof path, &br_for_text, request->path), command);
    return BR_OK;
}

/* ---- reading and running ---- */

enum br_status br_study_file_read(const char *path, const char *text,
                                  const struct br_options *options, struct br_study_file *f,
                                  struct br_error *err)
{
    if (br_orders_request_read(path, text, &f->request, err))
        return err->status;
    return f->request.command ? check_trust(&f->request, text, options, err) : BR_OK;
}

struct br_check br_study_file_check(struct br_study_file *f, const struct br_options *o)
{
    struct br_orders_request *r = &f->request;
    r->jobs = (int)br_option_number(o, BR_OPT_THREADS, 0);
    r->kept = br_option_text(o, BR_OPT_KEEP);
    r->anew = !br_option_given(o, BR_OPT_RESUME);
    struct br_check check = {.path = r->path,
                             .name = r->title     ? r->title
                                     : r->command ? r->command
                                                  : r->path};
    br_orders_problem(r, check.problem);
    return check;
}

enum br_status br_study_file_run(struct br_study_file *f, struct br_check *check,
                                 struct br_error *err)
{
    struct br_orders_request *r = &f->request;
    const enum br_status status = br_orders_read(r, &f->numbers, err);
    for (size_t i = 0; i < f->numbers.rows; i++)
        check->seconds += isfinite(f->numbers.row[i].seconds) ? f->numbers.row[i].seconds : 0;
    if (status || br_orders_find(&f->numbers, r->formal, &f->orders, err))
        return err->status;
    return br_orders_check(&f->orders, r->expectation, r->expectations, check, err);
}
