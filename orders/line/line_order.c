/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orders/line/line_order.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "orders/line/mixture.h"

/* ---- rows ---- */

double br_row_loss(double ratio, double p, double *slope)
{
    const double decay = ratio > 0 ? p * log(ratio) : 0;
    *slope = 0;
    if (ratio == 0)
        return 0;
    *slope = fabs(decay) < 1e-4 ? log(ratio) / 2 : log(ratio) / expm1(-decay) * -1 - 1 / p;
    return fabs(decay) < 1e-8 ? log(-log(ratio))
                              : fmax(decay, 0) + log(-expm1(-fabs(decay)) / fabs(p));
}

/* The regression over all rows; where errors are differences the loss depends on its slope. */
static double regress_all(const struct br_rows *r, double p)
{
    double x = 0, y = 0, xx = 0, xy = 0, slope;
    const double n = (double)r->count;
    for (size_t i = 0; i < r->count; i++) {
        const double log_z = r->x[i], log_e = r->y[i] - br_row_loss(r->ratio[i], p, &slope);
        x += log_z, y += log_e, xx += log_z * log_z, xy += log_z * log_e;
    }
    return (xy - x * y / n) / (xx - x * x / n);
}

static bool has_error(const struct br_point *p)
{
    return p->error > 0 && isfinite(p->error);
}

static bool usable(const struct br_point *p)
{
    return !p->flag && has_error(p);
}

/* The standard deviation of an error over the error. */
static double scatter(const struct br_point *p)
{
    return p->deviation / p->error;
}

/* The loss is linear about this order. */
static void bring_to_line(struct br_rows *r, double order)
{
    r->order = order;
    for (size_t i = 0; i < r->count; i++) {
        double slope;
        r->y[i] = r->error[i] - (br_row_loss(r->ratio[i], order, &slope) - slope * order);
        r->x[i] = log(r->z[i]) + slope;
    }
}

static void take_rows(struct br_rows *r, const struct br_point *point, size_t count)
{
    double finest = NAN, least = INFINITY;
    for (size_t i = 0; i < count; i++)
        if (usable(&point[i])) {
            finest = point[i].z;
            least = scatter(&point[i]) > 0 && isfinite(scatter(&point[i]))
                        ? fmin(least, scatter(&point[i]))
                        : 0;
        }
    const bool weighted = least > 0 && isfinite(least);
    for (size_t i = 0; i < count; i++) {
        const struct br_point *p = &point[i];
        if (!usable(p))
            continue;
        r->index[r->count] = i;
        r->z[r->count] = p->z / finest;
        r->x[r->count] = log(p->z / finest);
        r->ratio[r->count] = p->z_against / p->z;
        r->given[r->count] = weighted ? pow(least / scatter(p), 2) : 1;
        r->rounded[r->count] = pow(p->rounding / p->error, 2) / 3;
        r->error[r->count] = log(p->error);
        r->y[r->count++] = log(p->error);
    }
    if (r->count < 2)
        return;
    r->order = 1;
    for (int turn = 0; turn < 30; turn++)
        r->order = regress_all(r, r->order);
    bring_to_line(r, r->order);
}

/* ---- laws ---- */

/* The middle of a cell of parameters (below) describes the whole cell to about this. */
static const double cell_scatter = 8e-3;

/* Parts of less weight than e^-7.7 of the best are not kept. */
static const double kept = 7.7;

/* The next term of a difference, relative to that of the error itself. */
static double next_of_difference(const struct br_rows *r, size_t i, double s)
{
    if (r->ratio[i] == 0)
        return 1;
    const double p = r->order, log_ratio = log(r->ratio[i]);
    if (fabs(p * log_ratio) < 1e-8)
        return 1;
    return expm1((p + s) * log_ratio) / expm1(p * log_ratio);
}

/* A logarithm to this power or a lower one is the law of differences of values itself. */
enum { OF_VALUES = -2 };

/* Sets what all members of a family have in common. */
static void set_family(const struct br_rows *r, const struct br_family *f)
{
    for (size_t i = 0; i < r->count; i++) {
        const double log_z = log(r->z[i]);
        const bool differs = r->ratio[i] > 0 && f->s > OF_VALUES;
        r->place[i] =
            (struct br_law_place){.log_z = log_z,
                                  .power = exp(f->s * log_z) * next_of_difference(r, i, f->s),
                                  .finest = exp(r->y[r->count - 1] - r->y[i]),
                                  .finer = differs ? -log(r->ratio[i]) : 0,
                                  .lost = differs ? pow(r->ratio[i], r->order) : 0};
        r->curve[i] = f->curve > 0
                          ? pow(r->z[i] / r->z[0], f->curve) * next_of_difference(r, i, f->curve)
                          : 0;
    }
}

/* Sets the correction of row i by a law with this parameter. */
static void bend(const struct br_rows *r, size_t i, const struct br_family *f, double parameter)
{
    const struct br_law_bend b = br_law_bend(f, parameter, &r->place[i]);
    r->bent[i] = r->y[i] - b.correction;
    r->weight[i] = b.weight * r->given[i];
    r->log_density[i] = b.density ? 0.5 * log(r->weight[i]) : r->log_given[i];
    r->change[i] = b.change;
}

/* Adds a law with one parameter. */
static void add_law(struct br_mixture *all, const struct br_rows *r, const struct br_family *f,
                    double parameter, double log_prior)
{
    for (size_t i = 0; i < r->count; i++)
        bend(r, i, f, parameter);
    const double crosses = br_law_log_prior(f, parameter, r->z[0]);
    const struct br_law_place finest = {
        .log_z = all->far, .power = exp(f->s * all->far), .finest = 1};
    const double there = isfinite(all->far) ? br_law_bend(f, parameter, &finest).correction : 0;
    const bool small = f->law == BR_LAW_CANCEL && crosses == 0;
    const bool has_floor = f->law == BR_LAW_FLOOR || f->law == BR_LAW_FLOOR_SQUARES;
    br_window_all(all, r,
                  (struct br_law_part){
                      .there = isfinite(there) ? there : 0,
                      .curve_there = f->curve > 0 ? exp(f->curve * (all->far - log(r->z[0]))) : 0,
                      .law = small ? BR_LAW_NEXT : f->law,
                      .weight = log_prior + crosses,
                      .floor = has_floor ? parameter * exp(r->y[r->count - 1]) : 0});
}

/* log e = log C - b n^g with n = 1/z: a line over another x, whose slope is the order at the middle
 * row. */
static void add_exponentials(struct br_mixture *all, const struct br_rows *r)
{
    static const double powers[] = {1, 0.5, 1. / 3};
    static const double range =
        2.4; /* of n; within less, a power with a next term looks the same */
    const size_t n = r->count, middle = n / 2, least = isfinite(all->far) ? 5 : 4;
    const bool shows = n >= least && r->z[0] >= range;
    for (size_t k = 0; k < sizeof powers / sizeof *powers && shows; k++) {
        struct br_rows e = *r;
        e.x = r->other;
        br_rows_plain(r);
        for (size_t i = 0; i < n; i++)
            e.x[i] = -pow(r->z[middle] / r->z[i], powers[k]) / powers[k];
        e.order = (e.y[0] - e.y[n - 1]) / (e.x[0] - e.x[n - 1]);
        const double far = all->far;
        all->far = -pow(r->z[middle] / exp(far), powers[k]) / powers[k];
        br_window_all(all, &e,
                      (struct br_law_part){.law = BR_LAW_EXPONENTIAL,
                                           .weight = log(br_priors.exponential),
                                           .power = powers[k]});
        all->far = far;
    }
}

/* Parameters are first tried in cells, within which a law changes by about the same amount. Cells
 * that may matter are split, as finely as their misfit asks for: where it is much more than what
 * the middle of a part leaves of the part, that is enough. */
enum { MOST_CELLS = 80, LEVELS = 7, SPLIT = 3 };
static const double cell = 0.32, widest = 0.64; /* of the logarithm of the parameter */
static const double matters = 10;               /* logarithm of the weight below the best one's */

struct cell {
    double from, width;    /* of the logarithm of the parameter */
    double slope;          /* how much the correction changes with it, from row to row */
    struct br_windows box; /* the windows that matter in it */
};

/* The search in the laws of all families. rough: of what may matter. */
struct search {
    struct br_mixture *all, rough;
    const struct br_rows *r;
    struct cell cell[BR_FAMILIES][MOST_CELLS];
    size_t count[BR_FAMILIES];
    double top[LEVELS]; /* the largest weight of all, by the size of parts */
};

static double slope_at(const struct br_rows *r, const struct br_family *f, double parameter)
{
    double least = INFINITY, most = 0;
    for (size_t i = 0; i < r->count; i++) {
        const struct br_law_bend b = br_law_bend(f, parameter, &r->place[i]);
        least = fmin(least, b.slope);
        most = isnan(b.correction) ? 1 : fmax(most, b.slope);
    }
    return fmin(1, most - least);
}

static void make_cells(const struct br_rows *r, const struct br_family *f, struct cell *c,
                       size_t *count)
{
    const double end = log(f->high);
    *count = 0;
    for (double from = log(f->low); from < end && *count < MOST_CELLS;
         from += c[*count - 1].width) {
        const double slope = slope_at(r, f, exp(from));
        const double width = fmin(fmax(cell, fmin(widest, 0.8 * cell / slope)), end - from);
        c[(*count)++] = (struct cell){.from = from, .width = width, .slope = slope};
    }
}

/* Adds the middle of a cell. */
static void add_member(struct br_mixture *all, const struct br_rows *r, const struct br_family *f,
                       const struct cell *c)
{
    const bool stays = br_law_is_floor(f->law);
    const double parameter = exp(c->from + c->width / 2), share = c->width / log(f->high / f->low);
    const bool of_values = f->law == BR_LAW_LOGARITHM && f->s <= OF_VALUES;
    if ((all->few && (stays || parameter < br_priors.few_next)) || /* two differences show none */
        (of_values && isnan(all->far)))
        return;
    add_law(all, r, f, parameter,
            log(f->prior * share * (stays && isfinite(all->far) ? br_priors.values_stay : 1)));
}

/* Which windows matter in a part of a cell, where its middle leaves so much of it. */
static void try_part(struct search *s, const struct br_family *f, struct cell *c, int level)
{
    static const struct br_windows no_window = {
        .best = -INFINITY, .first = SIZE_MAX, .last = SIZE_MAX};
    s->rough.found = no_window;
    s->rough.best = s->top[level];
    s->rough.within_cell = cell_scatter / pow(SPLIT, level);
    add_member(&s->rough, s->r, f, c);
    s->top[level] = s->rough.best;
    c->box = s->rough.found;
}

/* Of a few cells of each family all windows are tried, of the others those that may matter. */
static void try_cells(struct search *s)
{
    enum { FEW = 8 };
    static const double may_matter = 20;
    struct br_windows found = {.best = -INFINITY, .first = SIZE_MAX, .last = SIZE_MAX};
    for (size_t f = 0; f < BR_FAMILIES; f++) {
        set_family(s->r, &br_families[f]);
        make_cells(s->r, &br_families[f], s->cell[f], &s->count[f]);
        for (size_t i = 0; i < s->count[f]; i += FEW) {
            s->rough.keeps = may_matter;
            try_part(s, &br_families[f], &s->cell[f][i], 0);
            br_windows_join(&found, &s->rough.found);
        }
    }
    s->rough.within = found;
    s->rough.keeps = matters + 2;
    for (size_t f = 0; f < BR_FAMILIES; f++) {
        set_family(s->r, &br_families[f]);
        for (size_t i = 0; i < s->count[f]; i++)
            try_part(s, &br_families[f], &s->cell[f][i], 0);
    }
}

/* Adds what matters of a cell, or of a part of it. */
static void descend(struct search *s, const struct br_family *f, const struct cell *c, int level)
{
    static const double enough = 12; /* so many times what the middle of a part leaves of it */
    const double scatter = cell_scatter / pow(SPLIT, level);
    if (!(c->box.best > s->top[level] - matters))
        return;
    if (level + 1 == LEVELS || s->all->few || c->box.misfit > enough * scatter) {
        s->all->within = c->box;
        s->all->within_cell = fmin(scatter, cell_scatter * c->slope * c->width / cell);
        add_member(s->all, s->r, f, c);
        return;
    }
    const double parts = fmax(1, ceil(c->slope * c->width / cell * pow(SPLIT, level + 1)));
    for (double j = 0; j < parts; j++) {
        struct cell part = *c;
        part.width = c->width / parts;
        part.from += j * part.width;
        s->rough.within = c->box;
        try_part(s, f, &part, level + 1);
        descend(s, f, &part, level + 1);
    }
}

static void add_laws(struct br_mixture *all, const struct br_rows *r, double log_prior)
{
    static const struct br_family power = {.law = BR_LAW_POWER};
    struct search s = {.all = all,
                       .r = r,
                       .rough = {.best = -INFINITY,
                                 .only_best = true,
                                 .rows = r->count,
                                 .far = all->far,
                                 .few = all->few,
                                 .finest = all->finest,
                                 .log_gamma = all->log_gamma}};
    all->prior = log_prior;
    all->keeps = kept;
    all->within = s.rough.within = (struct br_windows){
        .first_most = r->count - (all->few ? 2 : 3), .last_most = r->count - 1, .outlier = true};
    all->within_cell = 0;
    set_family(r, &power);
    add_law(all, r, &power, 0, log(br_priors.power * (all->few ? br_priors.few_power : 1)));
    for (int level = 0; level < LEVELS; level++) {
        s.rough.best = -INFINITY;
        s.rough.within_cell = cell_scatter / pow(SPLIT, level);
        add_law(&s.rough, r, &power, 0, log(br_priors.power));
        s.top[level] = s.rough.best;
    }
    try_cells(&s);
    br_kinks_add(all, r);
    add_exponentials(all, r);
    br_window_drifts(all, r);
    for (size_t f = 0; f < BR_FAMILIES; f++) {
        set_family(r, &br_families[f]);
        for (size_t i = 0; i < s.count[f]; i++)
            descend(&s, &br_families[f], &s.cell[f][i], 0);
    }
}

/* ---- the order ---- */

/* Keeps the parts of this g of the exponential law, 0: of all others; their weights are then 1. */
static void keep(struct br_mixture *all, double g)
{
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < all->count; i++)
        if (all->part[i].power == g) {
            sum += all->part[i].weight;
            all->part[count++] = all->part[i];
        }
    all->count = count;
    for (size_t i = 0; i < count; i++)
        all->part[i].weight /= sum;
}

/* b of exp(-b n^g), g of the most probable part. */
static void find_rate(struct br_mixture *all, const struct br_rows *r, double finest,
                      struct br_line_order *found)
{
    const double g = found->power = all->part[0].power;
    const double unit = g * pow(r->z[r->count / 2] * finest, -g);
    const struct br_estimate slope = br_mixture_estimate(all, &found->low99, &found->high99);
    found->rate = (struct br_estimate){slope.value / unit, slope.low / unit, slope.high / unit};
    found->low99 /= unit;
    found->high99 /= unit;
}

/* The distribution of what is left at the finest value, in the unit of the values: of a part with a
 * wide logarithm several nodes of equal probability. Parts that do not converge have none. */
static enum br_status take_left(const struct br_mixture *all, const struct br_rows *r,
                                struct br_mixture *left, struct br_error *err)
{
    enum { NODES = 8 };
    static const double node[NODES] = {-1.9, -1.0, -0.53, -0.17, 0.17, 0.53, 1.0, 1.9};
    static const double wide = 0.1, most = 7, between = 0.4;
    const size_t n = r->count;
    *left = (struct br_mixture){.part = br_allocate(NODES * all->count + 1, sizeof *left->part)};
    if (!left->part)
        return br_no_memory(err, "the limit");
    for (size_t i = 0; i < all->count; i++) {
        const struct br_law_part *p = &all->part[i];
        const double ratio = exp(all->far * p->mean); /* of the error to that before it */
        const size_t nodes = p->left_scale < wide ? 1 : NODES;
        double lost = 0;
        if (p->power == 0 && !(p->mean > 0.1))
            continue;
        for (size_t j = p->last + 1; j < n; j++)
            lost = fmax(lost, exp(r->error[j]));
        for (size_t j = 0; j < nodes; j++) {
            const double by = nodes > 1 ? fmax(-most, fmin(most, node[j] * p->left_scale)) : 0;
            const double e = exp(p->left + by);
            const double own = p->own * e * (1 - ratio) / ratio;
            struct br_law_part *q = &left->part[left->count++];
            *q = *p;
            q->mean = e;
            q->scale = hypot(hypot(e * p->left_scale * (nodes > 1 ? between : 1), own), lost);
            q->weight = p->weight / (double)nodes;
        }
    }
    keep(left, all->count ? all->part[0].power : 0);
    return BR_OK;
}

/* Orders below the first are none. Values whose differences show less than the second, and may show
 * none, have no limit. */
static const double surely_falls = 0.1, least_convergence = 0.55;

/* Whether the order may be zero. No law with a correction has an order below that of a floor, so
 * that what falls as the inverse of a logarithm takes the next larger orders. */
static bool may_stay(const struct br_line_order *found, bool values)
{
    static const double small = 0.4, smallest = 0.3;
    const struct br_estimate *order = &found->order;
    if (found->law[BR_LAW_POWER] > 0.5) /* values may grow as log log n */
        return values && order->value < smallest && !(order->low > surely_falls);
    return order->low < small;
}

static void describe(struct br_mixture *all, const struct br_rows *r, double finest,
                     struct br_line_order *found)
{
    for (size_t i = 0; i < all->count; i++)
        found->law[all->part[i].law] += all->part[i].weight;
    br_mixture_thin(all);
    const bool exponential = found->law[BR_LAW_EXPONENTIAL] > 0.5;
    size_t first = 0;
    while (exponential && all->part[first].power == 0)
        first++;
    keep(all, exponential ? all->part[first].power : 0);
    const struct br_law_part *likely = &all->part[0];
    if (exponential)
        find_rate(all, r, finest, found);
    else if (!all->few)
        found->order = br_mixture_estimate(all, &found->low99, &found->high99);
    found->converges = exponential ? 1 : 1 - br_mixture_below(all, all->few ? 0.2 : surely_falls);
    found->diverges = exponential ? 0 : br_mixture_below(all, 0);
    for (size_t i = 0; i < all->count; i++) { /* differences that stay make a logarithm */
        const enum br_law law = all->part[i].law;
        if (isfinite(all->far) && (law == BR_LAW_FLOOR || law == BR_LAW_FLOOR_SQUARES))
            found->converges -= all->part[i].weight;
    }
    if (may_stay(found, isfinite(all->far))) {
        found->converges = found->order.value < least_convergence ? 0 : found->converges;
        found->order.low = fmin(found->order.low, 0);
        found->low99 = fmin(found->low99, -surely_falls);
    }
    found->first = r->index[likely->first];
    found->last = r->index[likely->last];
    if (likely->outlier < r->count)
        found->outlier = r->index[likely->outlier];
    found->floor = likely->floor;
}

/* The weights of errors that scatter by the same, not relative to themselves (1), or back (-1). */
static void weigh_absolute(struct br_rows *r, double sign)
{
    for (size_t i = 0; i < r->count; i++) {
        r->given[i] *= exp(2 * sign * (r->error[i] - r->error[0]));
        r->log_given[i] = 0.5 * log(r->given[i]);
    }
}

/* The mixture of all laws of rows that are brought to a line. */
static void mix(struct br_mixture *all, struct br_rows *r)
{
    const double absolute = isfinite(all->far) && !all->few ? br_priors.absolute : 0;
    all->count = 0;
    all->best = -INFINITY;
    all->finest = 1;
    br_window_take_noise(r);
    for (size_t i = 0; i < r->count; i++)
        r->log_given[i] = 0.5 * log(r->given[i]);
    add_laws(all, r, log(1 - absolute));
    if (absolute > 0) {
        weigh_absolute(r, 1);
        all->finest = r->given[r->count - 1];
        add_laws(all, r, log(absolute));
        weigh_absolute(r, -1);
    }
    if (all->count)
        br_mixture_normalise(all);
}

/* Where the order of differences is another one than that of the regression of all rows, as beside
 * a coarse row that is far off, they are brought to a line about it. */
static void explain(struct br_mixture *all, struct br_rows *r)
{
    enum { TURNS = 2 };
    static const double near = 0.1;
    mix(all, r);
    for (int turn = 0; turn < TURNS && all->count && isfinite(all->far) && !all->few; turn++) {
        const double order = br_mixture_estimate(all, NULL, NULL).value;
        if (!(fabs(order - r->order) > near))
            return;
        bring_to_line(r, order);
        mix(all, r);
    }
}

int br_by_size(const void *a, const void *b)
{
    const struct br_point *x = a, *y = b;
    return (x->z < y->z) - (x->z > y->z);
}

enum br_status br_line_order_find(const struct br_point *point, size_t count,
                                  struct br_line_order *found, struct br_error *err)
{
    enum { ARRAYS = 18 };
    *found = (struct br_line_order){.order = {NAN, NAN, NAN},
                                    .rate = {NAN, NAN, NAN},
                                    .power = NAN,
                                    .left = {NAN, NAN, NAN},
                                    .low99 = NAN,
                                    .high99 = NAN,
                                    .last = count ? count - 1 : 0,
                                    .outlier = count};
    double *room = br_allocate(ARRAYS * count + 1, sizeof *room);
    size_t *index = br_allocate(count + 1, sizeof *index);
    struct br_law_place *place = br_allocate(count + 1, sizeof *place);
    struct br_mixture all = {.best = -INFINITY};
    enum br_status status = room && index && place ? BR_OK : br_no_memory(err, "the order");
    if (!status) {
        struct br_rows r = {.index = index, .z = room, .place = place};
        double **const array[] = {&r.x,           &r.y,        &r.ratio,    &r.bent,     &r.weight,
                                  &r.log_density, &r.change,   &r.given,    &r.curve,    &r.rounded,
                                  &r.noise,       &r.other,    &r.behind_x, &r.behind_y, &r.error,
                                  &r.log_gamma,   &r.log_given};
        for (size_t i = 0; i + 1 < ARRAYS; i++)
            *array[i] = room + (i + 1) * count;
        take_rows(&r, point, count);
        const struct br_point *finest = r.count ? &point[index[r.count - 1]] : NULL;
        all.far =
            finest && finest->z_against > 0 ? log(finest->z_against / finest->z) : (double)NAN;
        all.few = r.count == 2 && isfinite(all.far);
        if ((r.count >= 3 || all.few) && isfinite(r.order)) {
            for (size_t i = 1; i < r.count; i++)
                r.log_gamma[i] = lgamma_r((double)i / 2, &(int){0}); /* lgamma writes a global */
            all.log_gamma = r.log_gamma;
            explain(&all, &r);
        }
        if (all.starved)
            status = br_no_memory(err, "the order");
        else if (all.count)
            describe(&all, &r, finest->z, found);
        struct br_mixture left = {.part = NULL};
        if (!status && all.count && isfinite(all.far))
            status = take_left(&all, &r, &left, err);
        if (!status && left.count)
            found->left = br_mixture_estimate(&left, NULL, NULL);
        free(left.part);
    }
    free(all.part);
    free(place);
    free(index);
    free(room);
    return status;
}

struct br_estimate br_exponential_factor(const struct br_line_order *found)
{
    const struct br_estimate *b = &found->rate;
    return found->power == 1 ? (struct br_estimate){exp(b->value), exp(b->low), exp(b->high)}
                             : (struct br_estimate){NAN, NAN, NAN};
}

/* ---- which rows count ---- */

/* A level below this share of the coarsest error that counts is taken for round-off. */
static const double deep = 1e-6;

enum br_flag br_line_order_flag(const struct br_line_order *found, const struct br_point *point,
                                size_t i)
{
    const bool floors = found->law[BR_LAW_FLOOR] + found->law[BR_LAW_FLOOR_SQUARES] > 0.5;
    const struct br_point *last = &point[found->last];
    if (i < found->first)
        return BR_FLAG_COARSE;
    if (i == found->outlier)
        return BR_FLAG_OUTLIER;
    if (i <= found->last && !(floors && point[i].error < 2 * found->floor))
        return BR_FLAG_NONE;
    if (i > found->last &&
        point[i].error < 1.05 * last->error * pow(point[i].z / last->z, found->order.value))
        return BR_FLAG_OUTLIER;
    return point[i].error <= deep * point[found->first].error ? BR_FLAG_ROUND_OFF : BR_FLAG_STALLED;
}

double br_point_rate(const struct br_point *coarse, const struct br_point *fine)
{
    static const double steepest = 60;
    const double falls = log(coarse->error / fine->error), ratio = log(coarse->z / fine->z);
    double low = -steepest, high = steepest, slope;
    if (!has_error(coarse) || !has_error(fine))
        return NAN;
    if (coarse->z_against == 0 && fine->z_against == 0)
        return falls / ratio;
    while (high - low > 1e-14 * steepest) {
        const double p = (low + high) / 2;
        const double lost = br_row_loss(coarse->z_against / coarse->z, p, &slope) -
                            br_row_loss(fine->z_against / fine->z, p, &slope);
        *(p * ratio + lost < falls ? &low : &high) = p;
    }
    return low > -steepest && high < steepest ? (low + high) / 2 : NAN;
}

/* ---- the line of an order ---- */

/* The logarithm of a point's share of an error of order p. Its constant factor is not that of the
 * error itself, and |z^p - z_against^p| also has a share of an order of zero or less. */
static double log_share(const struct br_point *point, double p)
{
    double slope;
    return p * log(point->z) + br_row_loss(point->z_against / point->z, p, &slope);
}

static double line_at(const struct br_point *point, size_t count, size_t i, double p)
{
    double sum = 0, counts = 0;
    for (size_t j = 0; j < count; j++)
        if (usable(&point[j])) {
            sum += log(point[j].error) - log_share(&point[j], p);
            counts++;
        }
    return exp(log_share(&point[i], p) + sum / counts);
}

struct br_estimate br_line_fit(const struct br_point *point, size_t count, size_t i,
                               const struct br_estimate *order)
{
    const double fit = line_at(point, count, i, order->value),
                 a = line_at(point, count, i, order->low),
                 b = line_at(point, count, i, order->high);
    if (!(isfinite(a) && isfinite(b)))
        return (struct br_estimate){fit, NAN, NAN};
    return (struct br_estimate){fit, fmin(fit, fmin(a, b)), fmax(fit, fmax(a, b))};
}
