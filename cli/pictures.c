/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/run.h"

#include <string.h>
#include <unistd.h>

#include "cli/progress.h"
#include "study/scene/quote.h"
#include "study/scene/words.h"

/* All frames are kept with all nodes: 120 MB at most. */
enum { FRAMES = 120, MOST_ELEMENTS = 20000, ROWS = 2000 };

/* ---- where the movie goes ---- */

static const char extension[] = ".gif";

/* Splits dir/name.gif into folder and stem. */
static enum br_status split(struct br_pictures *p, char *folder, size_t size, struct br_error *err)
{
    const char *file = p->animate;
    const char *slash = strrchr(file, '/'), *name = slash ? slash + 1 : file;
    const int length = (int)strlen(name) - (int)strlen(extension);
    if (length < 0 || strcmp(name + length, extension) != 0)
        return br_fail(err, BR_BAD_INPUT,
                       "--animate: found '%s', expected a name that ends with %s", file, extension);
    snprintf(folder, size, "%.*s", slash ? (int)(slash - file) : 1, slash ? file : ".");
    if (slash == file)
        snprintf(folder, size, "/");
    snprintf(p->stem, sizeof p->stem, "%.*s", length, name);
    return br_is_name(p->stem)
               ? BR_OK
               : br_fail(err, BR_BAD_INPUT,
                         "--animate: found '%s', expected a file's name of letters, digits, blanks "
                         "and _ . - + that begins with a letter or digit",
                         file);
}

/* Another program may write there: its lock is waited for. */
static enum br_status open_folder(struct br_pictures *p, const char *folder, struct br_error *err)
{
    struct br_error inner = {0};
    p->output.waits = true;
    return br_output_open(&p->output, folder, &inner)
               ? br_fail(err, inner.status, "--animate %s", inner.message + strlen("--out: "))
               : BR_OK;
}

/* Opens the folder once to see that it can be written, and leaves it to --out and to others until
 * the movie is drawn. */
static enum br_status try_movie(struct br_pictures *p, struct br_error *err)
{
    char folder[sizeof p->output.folder];
    if (strlen(p->animate) >= sizeof folder)
        return br_fail(err, BR_BAD_INPUT, "--animate: the name is too long");
    if (p->n > MOST_ELEMENTS)
        return br_fail(err, BR_BAD_INPUT, "--animate: n is %zu, expected at most %d", p->n,
                       MOST_ELEMENTS);
    if (split(p, folder, sizeof folder, err) || open_folder(p, folder, err))
        return err->status;
    br_output_discard(&p->output);
    return BR_OK;
}

/* ---- what is kept ---- */

static enum br_status keep_step(void *self, const struct br_march *march,
                                const struct br_history_row *row, struct br_error *err)
{
    struct br_pictures *p = self;
    const bool last = row->step == p->steps;
    const bool frame = p->frames && (row->step % p->frames == 0 || last);
    const bool kept = p->rows && (row->step % p->rows == 0 || last);
    if (!frame && !kept)
        return BR_OK;
    struct br_history_row whole = *row;
    whole.displacement[BR_BENDING] = br_march_tip_displacement(march, BR_BENDING);
    if (frame && p->keep.sample(p->keep.self, march, &whole, err))
        return err->status;
    return kept ? p->keep.row(p->keep.self, &whole, err) : BR_OK;
}

enum br_status br_pictures_open(struct br_pictures *p, struct br_error *err)
{
    p->keep = br_history_recorder(&p->record, p->n);
    p->rows = p->history ? br_history_stride(p->steps, ROWS) : 0;
    p->frames = p->animate ? br_history_stride(p->steps, FRAMES) : 0;
    return p->animate ? try_movie(p, err) : BR_OK;
}

struct br_history_observer br_pictures_observer(struct br_pictures *p)
{
    return (struct br_history_observer){.self = p, .step = keep_step};
}

/* ---- drawing ---- */

static enum br_status render_movie(struct br_pictures *p, const char *script, struct br_error *err)
{
    struct br_gnuplot g;
    char path[2048];
    struct br_error why = {0};
    if (br_gnuplot_start(&g, p->output.staging, script, &p->missing, &why))
        return p->missing ? BR_OK : br_fail(err, why.status, "%s", why.message);
    g.observer = br_progress_start("drawing", p->quiet);
    g.pictures = p->record.samples;
    const enum br_status status = br_gnuplot_end(&g, err);
    br_progress_end();
    snprintf(path, sizeof path, "%s/%s%s", p->output.staging, p->stem, extension);
    return status ? status : br_picture_check(path, err);
}

static enum br_status draw_movie(struct br_pictures *p, struct br_error *err)
{
    const struct br_movie movie = {p->scene, &p->record, p->stem};
    char name[300], folder[sizeof p->output.folder];
    snprintf(folder, sizeof folder, "%s", p->output.folder);
    enum br_status status = open_folder(p, folder, err);
    if (status)
        return status;
    for (int script = 0; script < 2; script++) {
        FILE *file;
        snprintf(name, sizeof name, "%s%s", p->stem, script ? ".gp" : ".dat");
        if (br_output_file(&p->output, name, &file, err))
            return err->status;
        script ? br_movie_write_script(file, &movie) : br_movie_write_data(file, &movie);
        if (br_output_close(file, name, err))
            return err->status;
    }
    status = render_movie(p, name, err);
    if (br_signals_caught()) /* Ctrl-C ends gnuplot, too */
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    return status ? status : br_output_commit(&p->output, err);
}

enum br_status br_pictures_finish(struct br_pictures *p, struct br_error *err)
{
    if (p->animate && p->record.samples > 0 && draw_movie(p, err))
        return err->status;
    if (p->missing)
        fprintf(stderr, "beamrate: gnuplot is not installed: the animation is written as a script "
                        "(*.gp) and data, but not rendered\n");
    return BR_OK;
}

void br_pictures_discard(struct br_pictures *p)
{
    br_output_discard(&p->output);
    br_history_record_clear(&p->record);
}
