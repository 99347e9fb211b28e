/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops are written once, in the vector extension of GCC and Clang, and compiled for each
 * instruction set; this file is contracted (sweep.h). */
#include "solver/sweep_kernel.h"

#include <string.h>

typedef double vec __attribute__((vector_size(8 * BR_LANES)));

#define INLINE static inline __attribute__((always_inline))

INLINE void load(const double *from, vec *to)
{
    memcpy(to, __builtin_assume_aligned(from, 8 * BR_LANES), sizeof *to);
}

INLINE void store(const vec *from, double *to)
{
    memcpy(__builtin_assume_aligned(to, 8 * BR_LANES), from, sizeof *from);
}

/* x in all lanes: x - 0 is x, so this is no more than a broadcast. */
#define ALL(x) ((x) - (vec){0})

/* The entries of T and G that are not 0 or 1, so that the loops need not multiply by those. */
static const double bending_g[2][2] = {{0.5, -1.0 / 6}, {1, 0}};

/* G'p and T y + G kappa, with their zeros and ones left out */
INLINE void control_transposed(int d, const vec *p, vec *out)
{
    out[0] = p[0];
    if (d == 1)
        return;
    out[0] = ALL(bending_g[0][0]) * p[0] + p[1];
    out[1] = ALL(bending_g[0][1]) * p[0];
}

INLINE void carry(int d, vec *y, const vec *kappa)
{
    if (d == 1) {
        y[0] += kappa[0];
        return;
    }
    y[0] += y[1] + (ALL(bending_g[0][0]) * kappa[0] + ALL(bending_g[0][1]) * kappa[1]);
    y[1] += kappa[0];
}

/* G kappa */
INLINE void control(int d, const vec *kappa, vec *out)
{
    out[0] = kappa[0];
    if (d == 1)
        return;
    out[0] = ALL(bending_g[0][0]) * kappa[0] + ALL(bending_g[0][1]) * kappa[1];
    out[1] = kappa[0];
}

/* sum += matrix x, d by d. (Vectors are passed by address: how they go by value depends on the
 * instruction set.) */
INLINE void add_product(int d, const double *matrix, const vec *x, vec *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = d; j-- > 0;)
            sum[i] += ALL(matrix[i * d + j]) * x[j];
}

/* sum += matrix' x */
INLINE void add_transposed_product(int d, const double *matrix, const vec *x, vec *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = d; j-- > 0;)
            sum[i] += ALL(matrix[j * d + i]) * x[j];
}

/* s = R g + G'p + factor sigma,    p = A'p - K'R g */
INLINE void sweep_left(const struct br_sweep *s, int d, bool loaded, bool lanewise)
{
    vec p[2], r[2];
    for (int i = 0; i < d; i++) {
        load(s->right + i * BR_LANES, &p[i]);
        r[i] = ALL(s->r[i]);
    }
    for (size_t e = 0; e < s->length; e++) {
        const double *gain = s->table.gain + e * (size_t)(4 * d * d);
        const double *state = s->state + e * (size_t)(2 * d) * BR_LANES;
        double *scratch = s->scratch + e * (size_t)d * BR_LANES;
        const size_t first = e * (size_t)d;
        vec g[2], sum[2], next[2];
        control_transposed(d, p, sum);
        for (int i = 0; i < d; i++) {
            load(state + i * BR_LANES, &g[i]);
            if (loaded && lanewise) {
                vec sigma;
                load(s->load + (first + (size_t)i) * BR_LANES, &sigma);
                sum[i] += ALL(s->factor) * sigma;
            } else if (loaded)
                sum[i] += ALL(s->factor * s->load[first + (size_t)i]);
            sum[i] += r[i] * g[i];
            store(&sum[i], scratch + i * BR_LANES);
            next[i] = ALL(0.0);
        }
        add_product(d, gain + d * d, g, next); /* the table has -K'R and A' */
        add_product(d, gain, p, next);
        for (int i = 0; i < d; i++)
            p[i] = next[i];
    }
}

/* kappa = -(K y + S^-1 s), the new state, and what it adds to q and z */
INLINE void sweep_right(const struct br_sweep *s, int d)
{
    const vec alpha = ALL(s->alpha), k = ALL(s->k);
    vec y[2], q[2], z[2], velocity[2], displacement = ALL(0.0);
    for (int i = 0; i < d; i++) {
        load(s->left + i * BR_LANES, &y[i]);
        q[i] = z[i] = velocity[i] = ALL(0.0);
    }
    for (size_t e = s->length; e-- > 0;) {
        const double *gain = s->table.gain + e * (size_t)(4 * d * d);
        const double *weight = s->table.weight + e * (size_t)(2 * d * d);
        double *state = s->state + e * (size_t)(2 * d) * BR_LANES;
        const double *scratch = s->scratch + e * (size_t)d * BR_LANES;
        vec drive[2], kappa[2], g[2], rate[2], next[2];
        for (int i = 0; i < d; i++) {
            load(scratch + i * BR_LANES, &drive[i]);
            kappa[i] = ALL(0.0);
        }
        add_product(d, gain + 2 * d * d, drive, kappa); /* the table has -S^-1 and -K */
        control(d, kappa, next);
        add_transposed_product(d, gain, y, next); /* y = A y - G S^-1 s: the shortest chain */
        add_product(d, gain + 3 * d * d, y, kappa);
        for (int i = 0; i < d; i++)
            y[i] = next[i];
        for (int i = 0; i < d; i++) {
            vec w;
            load(state + i * BR_LANES, &g[i]);
            load(state + (d + i) * BR_LANES, &w);
            rate[i] = (g[i] - alpha * w) + kappa[i];
            w += k * rate[i];
            g[i] = alpha * w + rate[i];
            if (d == 1)
                displacement += w;
            store(&g[i], state + i * BR_LANES);
            store(&w, state + (d + i) * BR_LANES);
        }
        carry(d, velocity, rate);
        add_product(d, weight, g, z);
        add_product(d, weight + d * d, g, q);
    }
    for (int i = 0; i < d; i++) {
        store(&q[i], s->q + i * BR_LANES);
        store(&z[i], s->z + i * BR_LANES);
        store(&velocity[i], s->velocity + i * BR_LANES);
    }
    if (d == 1)
        store(&displacement, s->displacement);
}

INLINE void step_of(const struct br_sweep *s, int d)
{
    if (!s->load)
        sweep_left(s, d, false, false);
    else if (s->lanewise)
        sweep_left(s, d, true, true);
    else
        sweep_left(s, d, true, false);
    sweep_right(s, d);
}

INLINE void step(const struct br_sweep *s)
{
    if (s->d == 1)
        step_of(s, 1);
    else
        step_of(s, 2);
}

INLINE void carry_of(const struct br_sweep *s, int d, double *out)
{
    vec y[2] = {ALL(0.0), ALL(0.0)};
    for (size_t e = s->length; e-- > 0;) {
        const double *state = s->state + e * (size_t)(2 * d) * BR_LANES;
        vec kappa[2];
        for (int i = 0; i < d; i++)
            load(state + (d + i) * BR_LANES, &kappa[i]);
        carry(d, y, kappa);
    }
    for (int i = 0; i < d; i++)
        store(&y[i], out + i * BR_LANES);
}

INLINE void carry_all(const struct br_sweep *s, double *out)
{
    if (s->d == 1)
        carry_of(s, 1, out);
    else
        carry_of(s, 2, out);
}

#define KERNEL(suffix, label, attributes, condition)                                           \
    attributes static void step_##suffix(const struct br_sweep *s)                             \
    {                                                                                          \
        step(s);                                                                               \
    }                                                                                          \
    attributes static void carry_##suffix(const struct br_sweep *s, double *y)                 \
    {                                                                                          \
        carry_all(s, y);                                                                       \
    }                                                                                          \
    static bool available_##suffix(void)                                                       \
    {                                                                                          \
        return condition;                                                                      \
    }                                                                                          \
    static const struct br_kernel kernel_##suffix = {label, available_##suffix, step_##suffix, \
                                                     carry_##suffix};

#if defined __x86_64__ && !defined BR_NO_FMA
KERNEL(avx512, "avx512", __attribute__((target("avx512f,avx512dq,avx512vl,fma,avx2"))),
       __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl"))
KERNEL(avx2, "avx2", __attribute__((target("avx2,fma"))),
       __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
#endif
KERNEL(portable, "portable", , true)

const struct br_kernel *const br_kernels[] = {
#if defined __x86_64__ && !defined BR_NO_FMA
    &kernel_avx512,
    &kernel_avx2,
#endif
    &kernel_portable,
    NULL,
};

const struct br_kernel *br_kernel_best(void)
{
    const struct br_kernel *const *kernel = br_kernels;
    while (!(*kernel)->available())
        kernel++;
    return *kernel;
}

const struct br_kernel *br_kernel_find(const char *name)
{
    for (const struct br_kernel *const *kernel = br_kernels; *kernel; kernel++)
        if (strcmp((*kernel)->name, name) == 0)
            return *kernel;
    return NULL;
}
