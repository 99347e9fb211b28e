/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A report's errors over h at fixed k, and over k at fixed n. */
#include <math.h>

#include "plots/pictures.h"
#include "study/fit/report.h"
#include "study/scene/quote.h"

enum axis { OVER_H, OVER_K };

static enum axis other(enum axis axis)
{
    return axis == OVER_H ? OVER_K : OVER_H;
}

/* The study's list along an axis: n over h, steps over k; *count of them. */
static const size_t *list_of(const struct br_report *r, enum axis axis, size_t *count)
{
    const struct br_study *study = br_report_fitted(r);
    *count = axis == OVER_H ? study->n_count : study->k_count;
    return axis == OVER_H ? study->n : study->steps;
}

/* h or k, m or s. */
static double value_of(const struct br_report *r, enum axis axis, size_t entry)
{
    const struct br_scene *scene = br_report_fitted(r)->scene;
    return axis == OVER_H ? br_mesh_size(scene, entry) : br_time_step(scene, entry);
}

/* The place of the smallest entry of a list that is larger than `after`, or `count`. */
static size_t next(const size_t *list, size_t count, size_t after)
{
    size_t best = count;
    for (size_t i = 0; i < count; i++)
        if (list[i] > after && (best == count || list[i] < list[best]))
            best = i;
    return best;
}

static size_t distinct(const size_t *list, size_t count)
{
    size_t found = 0;
    for (size_t i = next(list, count, 0); i < count; i = next(list, count, list[i]))
        found++;
    return found;
}

static size_t largest(const struct br_report *r, enum axis axis)
{
    size_t count, best = 0;
    const size_t *list = list_of(r, axis, &count);
    for (size_t i = 1; i < count; i++)
        if (list[i] > list[best])
            best = i;
    return best;
}

/* ---- curves ---- */

/* What is drawn of a cell; NaN: a gap. */
typedef double of_cell(const struct br_report *r, size_t cell, enum br_part part);

static double error_of(const struct br_report *r, size_t cell, enum br_part part)
{
    const struct br_cell *c = &br_report_fitted(r)->cell[cell];
    return c->flag[part] == BR_FLAG_FAILED ? (double)NAN : c->error[part];
}

static double printed_of(const struct br_report *r, size_t cell, enum br_part part)
{
    (void)part;
    return r->printed[cell];
}

/* How far the error is from what the joint fit says, relative. */
static double misfit_of(const struct br_report *r, size_t cell, enum br_part part)
{
    const struct br_study *s = br_report_fitted(r);
    const struct br_resolution at = s->cell[cell].at;
    return -1 + error_of(r, cell, part) /
                    br_joint_model(&r->fits[part].joint, br_mesh_size(s->scene, at.n),
                                   br_time_step(s->scene, at.steps), br_reference_mesh(s),
                                   br_reference_step(s));
}

/* The points of a series along an axis, at the place `fixed` of the other axis' list. */
static void add_points(const struct br_report *r, enum axis axis, size_t fixed, of_cell *value,
                       enum br_part part, struct br_series *series)
{
    const struct br_study *study = br_report_fitted(r);
    size_t count;
    const size_t *list = list_of(r, axis, &count);
    for (size_t i = next(list, count, 0); i < count; i = next(list, count, list[i])) {
        const size_t cell =
            axis == OVER_H ? i * study->k_count + fixed : fixed * study->k_count + i;
        const enum br_flag flag = study->cell[cell].flag[part];
        const bool flagged = flag != BR_FLAG_NONE && value != printed_of;
        br_point_add(series, value_of(r, axis, list[i]), value(r, cell, part),
                     flagged ? br_flag_name(flag) : NULL);
    }
}

/* Curves along an axis, one for each entry of the other axis' list. */
static void add_curves(const struct br_report *r, enum axis axis, of_cell *value,
                       struct br_panel *panel)
{
    size_t count, curve = 0;
    const size_t *list = list_of(r, other(axis), &count);
    const size_t curves = distinct(list, count);
    for (size_t i = next(list, count, 0); i < count; i = next(list, count, list[i])) {
        const size_t hue = br_hue_of(curve++, curves);
        struct br_series *s =
            axis == OVER_H
                ? br_series_add(panel, BR_PEN_CURVE, "k = %.3g s", value_of(r, OVER_K, list[i]))
                : br_series_add(panel, BR_PEN_CURVE, "n = %zu", list[i]);
        if (s) {
            s->pen = hue ? BR_PEN_CURVE : BR_PEN_OTHERS;
            s->hue = hue;
        }
        add_points(r, axis, i, value, BR_PART_TOTAL, s);
    }
}

/* ---- panels ---- */

static struct br_panel *add_panel(const struct br_report *r, enum axis axis, struct br_figure *f)
{
    const struct br_norm *norm = br_report_fitted(r)->norm;
    struct br_panel *p = br_panel_add(f);
    size_t count;
    const size_t *list = list_of(r, axis, &count);
    p->log_x = p->log_y = true;
    BR_SAY(p->x_label, axis == OVER_H ? "mesh size h (m)" : "time step k (s)");
    BR_SAY(p->y_label, "%s (%s)", norm->symbol, norm->unit_markup);
    BR_SAY(p->top_label, axis == OVER_H ? "elements n" : "steps N");
    for (size_t i = next(list, count, 0); i < count; i = next(list, count, list[i]))
        br_point_add(&p->top, value_of(r, axis, list[i]), (double)list[i], NULL);
    return p;
}

/* Orders in h: the bounds of the theory, and what the elements can do on smooth solutions, in the
 * norm: one order less for each derivative. */
static void add_guides(const struct br_report *r, struct br_panel *p)
{
    const struct br_study *study = br_report_fitted(r);
    br_guide_add(p, 0.5, "1/2  bound (26)");
    br_guide_add(p, 1, "1  Remark 2.5");
    if (study->scene->axial.modelled && !study->norm->energy)
        br_guide_add(p, 2, "2  axial, P1");
    if (study->scene->bending.modelled)
        br_guide_add(p, study->norm->energy ? 2 : 4,
                     study->norm->energy ? "2  bending, Hermite" : "4  bending, Hermite");
}

/* "Joint fit (95 %), total: order 2.00 [1.99, 2.01] in h, ..." */
static void say_fit(const struct br_report *r, enum br_part part, char *text, size_t size)
{
    const struct br_joint_fit *fit = &r->fits[part].joint;
    const bool described = fit->converged && br_joint_describes(fit);
    const struct br_estimate *order[] = {&fit->p, &fit->q};
    const char *before = "";
    size_t used = (size_t)snprintf(text, size, "Joint fit (95 %%), %s: %s", br_part_names[part],
                                   !fit->converged ? "none could be made"
                                   : described     ? "order"
                                                   : "does not describe these errors");
    for (int i = 0; i < 2 && described; i++) {
        char number[64];
        if (!br_order_determined(order[i]))
            continue;
        used += (size_t)snprintf(text + used, size - used, "%s %s in %s", before,
                                 br_order_text(order[i], number, sizeof number), i ? "k" : "h");
        before = ",";
    }
}

/* ---- the pictures ---- */

static bool always(const struct br_report *r)
{
    return br_report_fitted(r)->n_count > 0 && br_report_fitted(r)->k_count > 0;
}

static void fill_h(const struct br_report *r, struct br_figure *f)
{
    struct br_panel *p = add_panel(r, OVER_H, f);
    say_fit(r, BR_PART_TOTAL, f->note[0], sizeof f->note[0]);
    add_guides(r, p);
    add_curves(r, OVER_H, error_of, p);
}

/* Whether the curves over k lie on one another: at most of the time steps the errors on all meshes
 * are within a factor of 1.5. */
static bool coincide(const struct br_report *r)
{
    const struct br_study *s = br_report_fitted(r);
    size_t close = 0, judged = 0;
    for (size_t j = 0; j < s->k_count; j++) {
        double low = INFINITY, high = 0;
        for (size_t i = 0; i < s->n_count; i++) {
            const double error = error_of(r, i * s->k_count + j, BR_PART_TOTAL);
            low = fmin(low, error);
            high = fmax(high, error);
        }
        judged += high > 0;
        close += high > 0 && high < 1.5 * low;
    }
    return distinct(s->n, s->n_count) > 1 && 2 * close > judged;
}

/* Where the curves cannot be told apart, their ratio to the fit stands beside them. */
static void fill_k(const struct br_report *r, struct br_figure *f)
{
    const struct br_joint_fit *fit = &r->fits[BR_PART_TOTAL].joint;
    struct br_panel *p = add_panel(r, OVER_K, f);
    say_fit(r, BR_PART_TOTAL, f->note[0], sizeof f->note[0]);
    br_guide_add(p, 1, "1");
    add_curves(r, OVER_K, error_of, p);
    if (!fit->converged || !br_joint_describes(fit) || !coincide(r))
        return;
    p = add_panel(r, OVER_K, f);
    p->log_y = false;
    f->one_key = true;
    BR_SAY(p->y_label, "error / joint fit - 1");
    add_curves(r, OVER_K, misfit_of, p);
}

static bool has_parts(const struct br_report *r)
{
    const struct br_scene *scene = br_report_fitted(r)->scene;
    return always(r) && scene->axial.modelled && scene->bending.modelled;
}

static void add_parts(const struct br_report *r, enum axis axis, struct br_panel *p)
{
    for (enum br_part part = BR_PART_TOTAL; part < BR_PARTS; part++)
        add_points(r, axis, largest(r, other(axis)), error_of, part,
                   br_series_add(p, BR_PEN_CURVE, "%s", br_part_names[part]));
}

static void fill_parts(const struct br_report *r, struct br_figure *f)
{
    const struct br_study *study = br_report_fitted(r);
    say_fit(r, BR_PART_AXIAL, f->note[0], sizeof f->note[0]);
    say_fit(r, BR_PART_BENDING, f->note[1], sizeof f->note[1]);
    f->one_key = true;
    struct br_panel *p = add_panel(r, OVER_H, f);
    BR_SAY(p->x_label, "mesh size h (m), at k = %.4g s",
           value_of(r, OVER_K, study->steps[largest(r, OVER_K)]));
    br_guide_add(p, 1, "1");
    br_guide_add(p, 2, "2");
    br_guide_add(p, 4, "4");
    add_parts(r, OVER_H, p);
    p = add_panel(r, OVER_K, f);
    BR_SAY(p->x_label, "time step k (s), at n = %zu", study->n[largest(r, OVER_H)]);
    br_guide_add(p, 1, "1");
    add_parts(r, OVER_K, p);
}

static bool has_printed(const struct br_report *r)
{
    return always(r) && r->printed;
}

/* A curve in the hue of whose error it is, with the mark of its place. */
static void repaint(struct br_series *s, size_t hue)
{
    if (s->pen == BR_PEN_OTHERS)
        return;
    s->mark = s->hue;
    s->hue = hue;
    s->title[0] = '\0';
}

/* Our errors in the first hue, printed ones in the second; a key of the marks. */
static void add_both(const struct br_report *r, enum axis axis, struct br_panel *p)
{
    add_curves(r, axis, printed_of, p);
    const size_t curves = p->count;
    add_curves(r, axis, error_of, p);
    for (size_t i = 0; i < p->count; i++) {
        const struct br_series *s = p->series[i];
        if (i < curves && s->pen != BR_PEN_OTHERS) {
            struct br_series *sign = br_series_add(p, BR_PEN_SIGNS, "%s", s->title);
            if (sign)
                sign->mark = s->hue;
        }
        if (i < 2 * curves)
            repaint(p->series[i], i < curves ? 2 : 1);
    }
    struct br_series *whose[] = {br_series_add(p, BR_PEN_LINE, "computed"),
                                 br_series_add(p, BR_PEN_LINE, "printed")};
    for (size_t i = 0; i < 2 && whose[i]; i++) {
        whose[i]->pen = BR_PEN_LINE;
        whose[i]->hue = 1 + i;
    }
}

static void fill_printed(const struct br_report *r, struct br_figure *f)
{
    f->one_y = true;
    add_both(r, OVER_K, add_panel(r, OVER_K, f));
    add_both(r, OVER_H, add_panel(r, OVER_H, f));
}

static const struct br_convergence_picture
    over_h = {"h", "The error against the mesh size h, one curve per time step k.", always, fill_h},
    over_k = {"k", "The error against the time step k, one curve per number of elements n.", always,
              fill_k},
    parts = {"parts", "The error's axial and bending parts against h and k, the other one finest.",
             has_parts, fill_parts},
    printed = {"printed",
               "The computed and the printed errors against the time step k and the mesh size h.",
               has_printed, fill_printed};

const struct br_convergence_picture *const br_convergence_pictures[] = {&over_h, &over_k, &parts,
                                                                        &printed, NULL};

enum br_status br_convergence_draw(const struct br_convergence_picture *picture,
                                   const struct br_report *r, struct br_figure *f,
                                   struct br_error *err)
{
    const struct br_study *study = br_report_fitted(r);
    *f = (struct br_figure){0};
    if (!br_is_name(r->name))
        return br_fail(err, BR_BAD_INPUT,
                       "the report's name is \"%s\", expected the beginning of a file name",
                       r->name);
    BR_SAY(f->stem, "%.400s-%s", r->name, picture->name);
    BR_SAY(f->title, "%s", r->caption);
    BR_SAY(f->hollow, "not in the fits");
    if (study->judge->nests)
        BR_SAY(f->about, "%s Reference: n = %zu elements, N = %zu steps", picture->title,
               study->reference.n, study->reference.steps);
    else
        BR_SAY(f->about, "%s Reference: %.120s", picture->title, study->judge->title);
    picture->fill(r, f);
    return br_figure_check(f, err);
}
