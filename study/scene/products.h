/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A load as a sum of products F(x) G(t), which a march assembles once. */
#ifndef BR_STUDY_SCENE_PRODUCTS_H
#define BR_STUDY_SCENE_PRODUCTS_H

#include "solver/scene.h"
#include "study/scene/tree.h"

/* Multiplies out what is a sum of products: sums, signs, quotients and integer powers of products.
 * What mixes x and t, and the product of two sums that do (multiplied out, it may cancel), remains
 * one term f(x, t). f is taken over, even where it fails (BR_NO_MEMORY; *load is then zero). */
enum br_status br_products(struct br_function *f, struct br_load *load, struct br_error *err);

#endif
