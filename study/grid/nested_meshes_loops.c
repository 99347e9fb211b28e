/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One kernel, for the instruction set BR_SET: this file is compiled for each (meson.build), and
 * contracted (solver/instruction_set.h). */
#include "solver/vectors.h"
#include "study/grid/nested_meshes.h"

/* ---- vectors, and how they get the modes of a view ---- */

/* Whole vectors of elements whose ratio is 1, 2 or 4 are loaded as they lie in memory and sorted by
 * shuffles; other ratios, and the elements left over at the end, are collected one by one. */

#define LANES WIDTH

enum { MOST = BR_MOST_MODES, MOST_RATIO = 4 };

/* EACH: f of each lane. EVEN, ODD: the values of a and b with even or odd index. SHIFT: the values
 * of a from the second on, then the first of b. */
#if LANES == 8
#define EACH(f) f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7)
#define EVEN(a, b) SHUFFLE(a, b, 0, 2, 4, 6, 8, 10, 12, 14)
#define ODD(a, b) SHUFFLE(a, b, 1, 3, 5, 7, 9, 11, 13, 15)
#define SHIFT(a, b) SHUFFLE(a, b, 1, 2, 3, 4, 5, 6, 7, 8)
#elif LANES == 4
#define EACH(f) f(0), f(1), f(2), f(3)
#define EVEN(a, b) SHUFFLE(a, b, 0, 2, 4, 6)
#define ODD(a, b) SHUFFLE(a, b, 1, 3, 5, 7)
#define SHIFT(a, b) SHUFFLE(a, b, 1, 2, 3, 4)
#else
#define EACH(f) f(0), f(1)
#define EVEN(a, b) SHUFFLE(a, b, 0, 2)
#define ODD(a, b) SHUFFLE(a, b, 1, 3)
#define SHIFT(a, b) SHUFFLE(a, b, 1, 2)
#endif

/* Loads `count` vectors, `apart` values from each other, as one row of values, and sorts them:
 * vector i gets the values i, i + count, ... of the row. count: a power of two. */
INLINE void load_sorted(int count, const double *from, int stride, vec *x)
{
    for (int i = 0; i < count; i++)
        x[i] = load(from + i * stride);
    for (int done = 1; done < count; done *= 2) {
        vec next[MOST * MOST_RATIO];
        for (int i = 0; i < count / 2; i++) {
            next[i] = EVEN(x[2 * i], x[2 * i + 1]);
            next[i + count / 2] = ODD(x[2 * i], x[2 * i + 1]);
        }
        for (int i = 0; i < count; i++)
            x[i] = next[i];
    }
}

/* Unknowns per node of elements with `modes` modes. */
INLINE int unknowns_of(int modes)
{
    return (modes + 1) / 2;
}

/* The index of value i of an element among the values of its two nodes. With three modes the second
 * value, the bubble of the element before, is left out. */
INLINE int node_value_of(int modes, int i)
{
    return modes == 3 && i > 0 ? i + 1 : i;
}

/* The nodes of all children of a vector of elements: value[j][i] of child j's two nodes. */
INLINE void fetch_nodes(int modes, int ratio, const double *from, vec value[][MOST])
{
    const int unknowns = unknowns_of(modes), count = ratio * unknowns;
    vec node[MOST / 2 * (MOST_RATIO + 1)];
    load_sorted(count, from, LANES, node);
    for (int i = 0; i < unknowns; i++) {
        const vec next = ALL(from[count * LANES + i]);
        node[count + i] = SHIFT(node[i], next);
    }
    for (int j = 0; j < ratio; j++)
        for (int i = 0; i < modes; i++)
            value[j][i] = node[j * unknowns + node_value_of(modes, i)];
}

/* As load_sorted for adjacent vectors, but for any count. */
INLINE void load_elements(int count, const double *from, vec *x)
{
    if (count != 3) {
        load_sorted(count, from, LANES, x);
        return;
    }
#define AT(l) from[(l)*3 + i]
    for (int i = 0; i < count; i++)
        x[i] = (vec){EACH(AT)};
#undef AT
}

/* The values of all children of a vector of elements from `first` on, value[j] those of child j. */
INLINE void fetch(const struct br_view *v, enum br_layout layout, int modes, int ratio,
                  size_t first, vec value[][MOST])
{
    vec row[MOST * MOST_RATIO];
    const double *from = v->values + first * (size_t)(modes * ratio);
    switch (layout) {
    case BR_BY_NODE:
        fetch_nodes(modes, ratio, v->values + first * (size_t)(unknowns_of(modes) * ratio), value);
        return;
    case BR_BY_ELEMENT:
        load_elements(ratio * modes, from, row);
        for (int j = 0; j < ratio; j++)
            for (int i = 0; i < modes; i++)
                value[j][i] = row[j * modes + i];
        return;
    case BR_IN_LANES:
        for (int i = 0; i < modes; i++) {
            load_sorted(ratio, from + i * LANES, modes * LANES, row);
            for (int j = 0; j < ratio; j++)
                value[j][i] = row[j];
        }
    }
}

/* Elements that are collected one by one: e, e + stride, ..., `live` of them. */
struct few {
    size_t e, stride, live;
};

/* Collects their values; zeros in the other lanes. */
INLINE void collect(const struct br_view *v, enum br_layout layout, int modes,
                    const struct few *few, vec *value)
{
    static const double zeros[MOST * LANES];
    const size_t width = (size_t)(layout == BR_BY_NODE ? unknowns_of(modes) : modes);
    const int step = layout == BR_IN_LANES ? LANES : 1;
    const double *from[LANES];
    for (size_t l = 0; l < LANES; l++) {
        const size_t e = few->e + l * few->stride;
        from[l] = layout == BR_IN_LANES ? v->values + e / LANES * LANES * width + e % LANES
                                        : v->values + e * width;
        if (l >= few->live)
            from[l] = zeros;
    }
#define AT(l) from[l][(layout == BR_BY_NODE ? node_value_of(modes, i) : i) * step]
    for (int i = 0; i < modes; i++)
        value[i] = (vec){EACH(AT)};
#undef AT
}

/* Values -> modes without their scales, in place (solver/modes.h). */
INLINE void combine(enum br_layout layout, int modes, vec *x)
{
    if (layout == BR_BY_NODE && modes == 2) {
        const vec sum = x[0] + x[1], difference = x[1] - x[0];
        x[0] = sum;
        x[1] = difference;
    } else if (layout == BR_BY_NODE && modes == 3) {
        const vec sum = x[0] + x[1] - ALL(1.0 / 3) * x[2], difference = x[1] - x[0];
        x[0] = sum;
        x[1] = difference;
    } else if (layout == BR_BY_NODE) {
        const vec w = x[0] + x[2], d = x[2] - x[0], s = x[1] + x[3], c = x[3] - x[1];
        x[0] = w - ALL(1.0 / 6) * c;
        x[1] = d - ALL(1.0 / 12) * s;
        x[2] = c;
        x[3] = s - ALL(2.0) * d;
    }
}

/* Values -> modes, in place. */
INLINE void make_modes(const double *scale, enum br_layout layout, int modes, vec *x)
{
    combine(layout, modes, x);
    for (int i = 0; i < modes && layout != BR_IN_LANES; i++)
        x[i] *= ALL(scale[i]);
}

/* ---- the kernel ---- */

/* The children j and ratio - 1 - j are mirror images, and so are their transfers: those from even
 * modes to odd ones and back differ in sign. Half of the work is saved by taking the sum s and the
 * difference d of the two. */
INLINE void mirror(int modes, vec *first, vec *last)
{
    for (int i = 0; i < modes; i++) {
        const vec s = first[i] + last[i], d = first[i] - last[i];
        first[i] = s;
        last[i] = d;
    }
}

/* sum += E' x, of two such children, or of the middle one with s = d = x */
INLINE void add_children(int modes, const double *transfer, const vec *s, const vec *d, vec *sum)
{
    for (int i = 0; i < modes; i++)
        for (int m = i; m < modes; m++)
            sum[m] += ALL(transfer[i * modes + m]) * ((m - i) % 2 ? d[i] : s[i]);
}

/* loss += 2 (x - E sum)^2, of both together; twice the sum is given */
INLINE void add_losses(int modes, const double *transfer, const vec *s, const vec *d,
                       const vec *twice, vec *loss)
{
    for (int i = 0; i < modes; i++) {
        vec rest[2] = {s[i], d[i]};
        for (int m = i; m < modes; m++)
            rest[(m - i) % 2] -= ALL(transfer[i * modes + m]) * twice[m];
        loss[i] += rest[0] * rest[0];
        loss[i] += rest[1] * rest[1];
    }
}

/* The same for the middle child. */
INLINE void add_loss(int modes, const double *transfer, const vec *x, const vec *sum, vec *loss)
{
    for (int i = 0; i < modes; i++) {
        vec rest = x[i];
        for (int m = i; m < modes; m++)
            rest -= ALL(transfer[i * modes + m]) * sum[m];
        loss[i] += (rest + rest) * rest;
    }
}

/* Transfers for modes without their scales: diag(scale) E, and diag(scale)^-1 E for the loss, whose
 * scale is applied at the end. Local copies: the compiler then knows that no store changes them. */
struct scaled {
    double scale[MOST], sum[MOST_RATIO / 2 * MOST * MOST], loss[MOST_RATIO / 2 * MOST * MOST];
};

INLINE void scale_transfers(const struct br_projecting *p, int modes, int ratio, struct scaled *t)
{
    for (int i = 0; i < modes; i++)
        t->scale[i] = p->fine.scale[i];
    for (int i = 0; i < ratio / 2 * modes * modes; i++) {
        const double scale = t->scale[i / modes % modes];
        t->sum[i] = p->transfer[i] * scale;
        t->loss[i] = p->transfer[i] / scale;
    }
}

/* A vector of elements of a level; the loss of each mode is without the square of its scale. */
INLINE void project_vector(const struct br_projecting *p, const struct scaled *t,
                           enum br_layout layout, int modes, int ratio, size_t first, vec *loss)
{
    const double *loss_transfer = layout == BR_IN_LANES ? t->sum : t->loss; /* without scales */
    const int square = modes * modes;
    vec x[MOST_RATIO][MOST], sum[MOST], twice[MOST];
    fetch(&p->fine, layout, modes, ratio, first, x);
    for (int j = 0; j < ratio; j++)
        combine(layout, modes, x[j]);
    for (int i = 0; i < modes; i++)
        sum[i] = ratio == 1 ? ALL(t->scale[i]) * x[0][i] : ALL(0.0);
    for (int j = 0; j < ratio / 2; j++) {
        mirror(modes, x[j], x[ratio - 1 - j]);
        add_children(modes, t->sum + j * square, x[j], x[ratio - 1 - j], sum);
    }
    for (int i = 0; i < modes; i++)
        twice[i] = sum[i] + sum[i];
    for (int j = 0; j < ratio / 2; j++)
        add_losses(modes, loss_transfer + j * square, x[j], x[ratio - 1 - j], twice, loss);
    for (int i = 0; i < modes; i++)
        store(sum[i], p->coarse + first * (size_t)modes + i * LANES);
}

/* The children j and ratio - 1 - j of few elements, mirrored, or the middle child twice. */
INLINE void collect_children(const struct br_projecting *p, enum br_layout layout, int modes,
                             const struct few *few, size_t j, vec x[2][MOST])
{
    const bool middle = 2 * j + 1 == p->ratio;
    for (int last = 0; last < (middle ? 1 : 2); last++) {
        const struct few children = {
            .e = few->e * p->ratio + (last ? p->ratio - 1 - j : j),
            .stride = p->ratio,
            .live = few->live,
        };
        collect(&p->fine, layout, modes, &children, x[last]);
        make_modes(p->fine.scale, layout, modes, x[last]);
    }
    if (!middle) {
        mirror(modes, x[0], x[1]);
        return;
    }
    for (int i = 0; i < modes; i++)
        x[1][i] = x[0][i];
}

/* Few elements, with any ratio. Of very many children only the last ones are kept. */
INLINE void project_few(const struct br_projecting *p, enum br_layout layout, int modes,
                        const struct few *few, vec *loss)
{
    const size_t square = (size_t)(modes * modes);
    enum { KEPT = 8 };
    vec kept[KEPT][2][MOST], sum[MOST], twice[MOST];
    for (int i = 0; i < modes; i++)
        sum[i] = ALL(0.0);
    for (size_t j = 0; 2 * j < p->ratio; j++) {
        vec(*x)[MOST] = kept[j % KEPT];
        collect_children(p, layout, modes, few, j, x);
        add_children(modes, p->transfer + j * square, x[0], x[1], sum);
    }
    for (int i = 0; i < modes; i++)
        twice[i] = sum[i] + sum[i];
    for (size_t j = 0; 2 * j < p->ratio; j++) {
        vec(*x)[MOST] = kept[j % KEPT];
        if (p->ratio > 2 * KEPT)
            collect_children(p, layout, modes, few, j, x);
        if (2 * j + 1 < p->ratio)
            add_losses(modes, p->transfer + j * square, x[0], x[1], twice, loss);
        else
            add_loss(modes, p->transfer + j * square, x[0], sum, loss);
    }
    for (int i = 0; i < modes; i++)
        store(sum[i], p->coarse + few->e * (size_t)modes + i * LANES);
}

/* All whole vectors of a level. */
INLINE void project_whole(const struct br_projecting *p, enum br_layout layout, int modes,
                          int ratio, vec *loss)
{
    const struct br_projecting local = *p;
    struct scaled t;
    vec unscaled[MOST] = {ALL(0.0)};
    scale_transfers(p, modes, ratio, &t);
    for (size_t e = 0; e + LANES <= p->n; e += LANES)
        project_vector(&local, &t, layout, modes, ratio, e, unscaled);
    for (int i = 0; i < modes; i++)
        loss[i] += ALL(t.scale[i] * t.scale[i]) * unscaled[i];
}

INLINE void project_layout(const struct br_projecting *p, enum br_layout layout, int modes,
                           vec *loss)
{
    size_t e = p->n - p->n % LANES;
    if (p->ratio == 1)
        project_whole(p, layout, modes, 1, loss);
    else if (p->ratio == 2 && layout != BR_BY_ELEMENT)
        project_whole(p, layout, modes, 2, loss);
    else if (p->ratio == 4 && layout != BR_BY_ELEMENT)
        project_whole(p, layout, modes, 4, loss);
    else
        e = 0;
    for (; e < p->n; e += LANES) {
        const size_t rest = p->n - e;
        project_few(p, layout, modes, &(struct few){e, 1, rest < LANES ? rest : LANES}, loss);
    }
}

INLINE double total(int modes, const vec *x)
{
    vec sum = x[0];
    for (int i = 1; i < modes; i++)
        sum += x[i];
    double lane[LANES];
    store(sum, lane);
    for (int width = LANES / 2; width > 0; width /= 2)
        for (int l = 0; l < width; l++)
            lane[l] += lane[l + width];
    return lane[0];
}

INLINE double project_modes(const struct br_projecting *p, int modes)
{
    vec loss[MOST] = {ALL(0.0)};
    if (p->fine.layout == BR_BY_ELEMENT)
        project_layout(p, BR_BY_ELEMENT, modes, loss);
    else if (p->fine.layout == BR_IN_LANES)
        project_layout(p, BR_IN_LANES, modes, loss);
    else if (modes > 1)
        project_layout(p, BR_BY_NODE, modes, loss);
    return total(modes, loss) / 2;
}

static double project(const struct br_projecting *p)
{
    switch (p->fine.modes) {
    case 1:
        return project_modes(p, 1);
    case 2:
        return project_modes(p, 2);
    case 3:
        return project_modes(p, 3);
    default:
        return project_modes(p, 4);
    }
}

/* sum += (x - b)^2 */
INLINE void add_difference(int modes, const vec *x, const double *b, vec *sum)
{
    for (int i = 0; i < modes; i++) {
        vec other;
        other = load(b + i * LANES);
        const vec difference = x[i] - other;
        sum[i] += difference * difference;
    }
}

INLINE void distance_layout(const struct br_view *a, size_t n, const double *b,
                            enum br_layout layout, int modes, vec *sum)
{
    size_t e = 0;
    vec x[1][MOST] = {{ALL(0.0)}};
    for (; e + LANES <= n; e += LANES) {
        fetch(a, layout, modes, 1, e, x);
        make_modes(a->scale, layout, modes, x[0]);
        add_difference(modes, x[0], b + e * (size_t)modes, sum);
    }
    if (e < n) {
        collect(a, layout, modes, &(struct few){e, 1, n - e}, x[0]);
        make_modes(a->scale, layout, modes, x[0]);
        add_difference(modes, x[0], b + e * (size_t)modes, sum);
    }
}

INLINE double distance_modes(const struct br_view *a, size_t n, const double *b, int modes)
{
    vec sum[MOST] = {ALL(0.0)};
    if (a->layout == BR_BY_ELEMENT)
        distance_layout(a, n, b, BR_BY_ELEMENT, modes, sum);
    else if (a->layout == BR_IN_LANES)
        distance_layout(a, n, b, BR_IN_LANES, modes, sum);
    else if (modes > 1)
        distance_layout(a, n, b, BR_BY_NODE, modes, sum);
    return total(modes, sum);
}

static double distance(const struct br_view *a, size_t n, const double *b)
{
    switch (a->modes) {
    case 1:
        return distance_modes(a, n, b, 1);
    case 2:
        return distance_modes(a, n, b, 2);
    case 3:
        return distance_modes(a, n, b, 3);
    default:
        return distance_modes(a, n, b, 4);
    }
}

const struct br_nested_meshes_kernel BR_JOIN(br_nested_meshes_, BR_SET) = {
    .name = BR_QUOTE(BR_SET),
    .lanes = LANES,
    .available = BR_JOIN(br_has_, BR_SET),
    .project = project,
    .distance = distance,
};
