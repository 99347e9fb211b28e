/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A report's errors over h at fixed k, and over k at fixed n. The study's lists are ascending. */
#include <math.h>
#include <string.h>

#include "base/words.h"
#include "plots/beam/pictures.h"
#include "solver/scene.h"
#include "study/fit/report.h"

/* The number that is drawn for a cell; NaN: a gap. */
typedef double of_cell(const struct br_report *r, size_t cell);

static double error_of(const struct br_report *r, size_t cell)
{
    const struct br_cell *c = &r->fitted->cell[cell];
    return c->flag[BR_PART_TOTAL] == BR_FLAG_FAILED ? (double)NAN : c->error[BR_PART_TOTAL];
}

static double printed_of(const struct br_report *r, size_t cell)
{
    return r->printed[cell];
}

/* The relative difference of the error and the joint fit. */
static double misfit_of(const struct br_report *r, size_t cell)
{
    const struct br_study *s = r->fitted;
    const struct br_resolution at = s->cell[cell].at;
    const double size[] = {br_mesh_size(s->scene, at.n), br_time_step(s->scene, at.steps)};
    const double ref[] = {br_reference_mesh(s), br_reference_step(s)};
    return -1 + error_of(r, cell) / br_joint_model(&r->fits[BR_PART_TOTAL].joint, size, ref);
}

/* Adds the points of a series along an axis, at index `at` of the other axis. */
static void add_points(const struct br_report *r, int axis, size_t at, of_cell *value,
                       struct br_series *series)
{
    const struct br_study *study = r->fitted;
    for (size_t i = 0; i < br_axis_count(study, axis); i++) {
        const size_t cell = br_axis_cell(study, axis, i, at);
        const enum br_flag flag = study->cell[cell].flag[BR_PART_TOTAL];
        const bool flagged = flag != BR_FLAG_NONE && value != printed_of;
        br_point_add(series, br_axis_size(study->scene, axis, study->cell[cell].at), value(r, cell),
                     flagged ? br_flag_name(flag) : NULL);
    }
}

/* The hue of entry i of a list, for at most BR_HUES entries, evenly spread; 0: none. */
static size_t hue_of(size_t i, size_t count)
{
    if (count <= BR_HUES)
        return i + 1;
    for (size_t hue = 0; hue < BR_HUES; hue++)
        if (i == hue * (count - 1) / (BR_HUES - 1))
            return hue + 1;
    return 0;
}

/* "k = 0.01 s" or "n = 100": the curve over an axis, at index `at` of the other axis. */
static const char *name_curve(const struct br_report *r, int axis, size_t at, char name[40])
{
    if (axis == BR_AXIS_SPACE)
        snprintf(name, 40, "k = %.3g s", br_time_step(r->fitted->scene, r->fitted->steps[at]));
    else
        snprintf(name, 40, "n = %zu", r->fitted->n[at]);
    return name;
}

/* Adds the curves along an axis, one for each entry of the other axis. */
static void add_curves(const struct br_report *r, int axis, of_cell *value, struct br_figure *f)
{
    const size_t count = br_axis_count(r->fitted, 1 - axis);
    char name[40];
    for (size_t i = 0; i < count; i++)
        add_points(r, axis, i, value,
                   br_series_add(f, hue_of(i, count) ? BR_PEN_CURVE : BR_PEN_OTHERS, "%s",
                                 name_curve(r, axis, i, name)));
}

static struct br_panel *add_panel(const struct br_report *r, int axis, struct br_figure *f)
{
    const struct br_study *s = r->fitted;
    const struct br_norm *norm = s->norm;
    const bool space = axis == BR_AXIS_SPACE;
    struct br_panel *p = br_panel_add(f, true, space ? "mesh size h (m)" : "time step k (s)",
                                      "%s (%s)", norm->symbol, norm->unit_markup);
    BR_SAY(p->top_label, space ? "elements n" : "steps N");
    for (size_t i = 0; i < br_axis_count(s, axis); i++)
        br_point_add(&p->top,
                     space ? br_mesh_size(s->scene, s->n[i]) : br_time_step(s->scene, s->steps[i]),
                     (double)(space ? s->n : s->steps)[i], NULL);
    return p;
}

/* "total: order in h 2.00 [1.99, 2.01], in k not measurable", and by what where it is not the
 * total's. */
static void say_orders(const struct br_report *r, enum br_part part, char text[256])
{
    char number[64];
    br_append(strcpy(text, ""), 256, "%s: order", br_part_names[part]);
    for (int axis = 0; axis < BR_AXES; axis++) {
        const struct br_observed_order *o = &r->observed[part][axis];
        if (!o->points)
            continue;
        const bool observed = isfinite(o->order.value);
        const bool other = observed && strcmp(o->by, r->observed[BR_PART_TOTAL][axis].by) != 0;
        br_append(text, 256, "%s in %s %s%s%s", text[strlen(text) - 1] == 'r' ? "" : ",",
                  br_axis_letters[axis],
                  observed ? br_order_text(&o->order, number, sizeof number) : "not measurable",
                  other ? " by " : "", other ? o->by : "");
    }
}

static void fill_h(const struct br_report *r, struct br_figure *f)
{
    say_orders(r, BR_PART_TOTAL, f->note[0]);
    BR_SAY(f->note[1], "A curve is flat where the error of the time step is larger than that of "
                       "the mesh.");
    add_panel(r, BR_AXIS_SPACE, f);
    add_curves(r, BR_AXIS_SPACE, error_of, f);
}

/* The second panel has the residuals of the fit, since the curves over k may coincide. */
static void fill_k(const struct br_report *r, struct br_figure *f)
{
    const struct br_joint_fit *fit = &r->fits[BR_PART_TOTAL].joint;
    say_orders(r, BR_PART_TOTAL, f->note[0]);
    add_panel(r, BR_AXIS_TIME, f);
    add_curves(r, BR_AXIS_TIME, error_of, f);
    if (!fit->converged || !br_joint_describes(fit))
        return;
    struct br_panel *p = add_panel(r, BR_AXIS_TIME, f);
    p->log_y = false;
    BR_SAY(p->y_label, "error / joint fit - 1");
    add_curves(r, BR_AXIS_TIME, misfit_of, f);
}

/* ---- the orders ---- */

/* "error, L2 norm (m^{3/2})", or "difference, L2 norm ..." where that is what shows the orders. */
static void name_errors(const struct br_report *r, enum br_axis axis, enum br_part parts,
                        struct br_panel *p)
{
    static const char difference[] = "difference", error[] = "error";
    const struct br_norm *norm = r->fitted->norm;
    enum br_part differences = 0;
    for (enum br_part part = 0; part < parts; part++)
        differences += strncmp(r->observed[part][axis].by, difference, strlen(difference)) == 0;
    BR_SAY(p->y_label, "%s%s (%s)",
           differences == 0       ? error
           : differences == parts ? difference
                                  : "error or difference",
           norm->symbol + strlen(error), norm->unit_markup);
}

/* Each part with what its order was found from, and the slopes of theory. */
static void add_orders(const struct br_report *r, enum br_axis axis, struct br_figure *f)
{
    const struct br_study *s = r->fitted;
    const bool both = s->scene->axial.modelled && s->scene->bending.modelled;
    const enum br_part parts = both ? BR_PARTS : 1;
    const double whole = axis == BR_AXIS_SPACE ? s->scene->length : s->scene->duration;
    const struct br_observed_order *most = &r->observed[BR_PART_TOTAL][axis];
    struct br_panel *p = add_panel(r, (int)axis, f);
    const struct br_series *line[BR_PARTS];
    name_errors(r, axis, parts, p);
    BR_SAY(p->title, "%s", most->by);
    for (enum br_part part = 0; part < parts; part++) {
        const struct br_observed_order *o = &r->observed[part][axis];
        most = o->points > most->points ? o : most;
        line[part] = br_points_draw(f, br_part_names[part], o->point, o->points, true);
    }
    p->top.count = 0; /* the sizes of the orders, not of the grid */
    for (size_t i = 0; i < most->points; i++)
        br_point_add(&p->top, most->point[i].z, round(whole / most->point[i].z), NULL);
    for (enum br_part part = 0; part < parts; part++)
        br_slope_add(f, line[part], r->observed[part][axis].theory.formal);
}

static void fill_orders(const struct br_report *r, struct br_figure *f)
{
    const struct br_scene *scene = r->fitted->scene;
    const bool both = scene->axial.modelled && scene->bending.modelled;
    BR_SAY(f->hollow, "not in the order");
    for (enum br_part part = 0; part < (both ? BR_PARTS : 1); part++)
        say_orders(r, part, f->note[part]);
    for (enum br_axis axis = 0; axis < BR_AXES; axis++)
        if (r->observed[BR_PART_TOTAL][axis].points)
            add_orders(r, axis, f);
}

/* The hue shows whose error it is, the mark which curve it is. */
static void add_both(const struct br_report *r, int axis, struct br_figure *f)
{
    const size_t count = br_axis_count(r->fitted, 1 - axis);
    add_panel(r, axis, f);
    for (size_t i = 0; i < 2 * count; i++) {
        const size_t hue = hue_of(i / 2, count);
        struct br_series *s =
            br_series_add(f, hue ? BR_PEN_CURVE : BR_PEN_OTHERS, i % 2 ? "printed" : "computed");
        s->mark = hue;
        add_points(r, axis, i / 2, i % 2 ? printed_of : error_of, s);
    }
}

/* The name of the curve that a mark stands for in a panel; "": there is none. */
static const char *say_mark(const struct br_report *r, int axis, size_t hue, char name[40])
{
    const size_t count = br_axis_count(r->fitted, 1 - axis);
    name[0] = '\0';
    for (size_t i = 0; i < count; i++)
        if (hue_of(i, count) == hue)
            name_curve(r, axis, i, name);
    return name;
}

/* Adds a key of the marks: over k they are meshes, over h time steps. */
static void fill_printed(const struct br_report *r, struct br_figure *f)
{
    if (!r->printed)
        return;
    f->one_y = true;
    add_both(r, BR_AXIS_TIME, f);
    add_both(r, BR_AXIS_SPACE, f);
    for (size_t hue = 1; hue <= BR_HUES; hue++) {
        char texts[BR_AXES][40];
        const char *mesh = say_mark(r, BR_AXIS_TIME, hue, texts[0]);
        const char *step = say_mark(r, BR_AXIS_SPACE, hue, texts[1]);
        if (*mesh || *step)
            br_series_add(f, BR_PEN_SIGNS, "%s%s%s%s%s", *mesh ? "left " : "", mesh,
                          *mesh && *step ? ", " : "", *step ? "right " : "", step)
                ->mark = hue;
    }
}

const struct br_convergence_picture br_convergence_pictures[] = {
    {"orders",
     "The errors or differences that show the orders in h and k, the fitted line and its 95 % band.",
     "Orders in h and k", fill_orders},
    {"h", "The error against the mesh size h, one curve per time step k.",
     "Errors over the mesh size h", fill_h},
    {"k", "The error against the time step k, one curve per number of elements n.",
     "Errors over the time step k", fill_k},
    {"printed", "The computed and the printed errors against the time step k and the mesh size h.",
     "Errors, computed and printed", fill_printed},
    {0}};

struct br_figure br_convergence_draw(const struct br_convergence_picture *picture,
                                     const struct br_report *r)
{
    const struct br_study *study = r->fitted;
    struct br_figure f = {.hollow = "not in the fits"};
    BR_SAY(f.stem, "%.400s-%s", r->name, picture->name);
    BR_SAY(f.title, "%s. %s", r->caption, picture->short_title);
    if (study->reference_kind->nests)
        BR_SAY(f.about, "%s Reference: n = %zu elements, N = %zu steps", picture->title,
               study->reference.n, study->reference.steps);
    else
        BR_SAY(f.about, "%s Reference: %.120s", picture->title, study->reference_kind->title);
    picture->fill(r, &f);
    return f;
}
