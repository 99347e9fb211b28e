/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The warning of a lagged contact that gains energy within its stability limit, against marches. */
#include <math.h>
#include <stdio.h>

#include "reference/energy/energy.h"
#include "study/estimate/warnings.h"
#include "study/run/run.h"
#include "study/scene/file.h"
#include "support.h"

/* The share of what was put into the axial field that a march of it has added at its most. */
static double added(const struct br_scene *scene, size_t n, size_t steps)
{
    const struct br_method method = br_method_default();
    struct br_error err = {0};
    struct br_energy start, now;
    struct br_work work;
    struct br_energy_meter *meter;
    double share = 0;
    struct br_march *march = br_test_march(scene, n, steps, &method);
    MUST(br_energy_meter_create(&meter, march, scene, &method, &err));
    for (size_t i = 0; i < steps; i++) {
        MUST(br_march_step(march, &err));
        br_energy_meter_step(meter);
        br_energy_meter_read(meter, &start, &now, &work);
        const double put_in = br_energy_put_in(&start, &work, BR_AXIAL);
        if (put_in > 0)
            share = fmax(share, br_energy_added(&work, BR_AXIAL) / put_in);
    }
    br_energy_meter_free(meter);
    br_march_free(march);
    return share;
}

static bool is_warned(const struct br_scene *scene, const char *contact, size_t steps)
{
    struct br_method method = br_method_default();
    struct br_warnings w = {0};
    struct br_error err;
    method.contact = br_contact_rule_find(contact);
    const struct br_planned_march o = {.scene = scene, .method = &method, .n = 40, .steps = steps};
    MUST(br_check_ahead_cheaply(&o, &w, &err));
    return br_test_warning(&w, BR_WARN_BOUNCE);
}

/* Of the bundled scenes those are warned of that do gain energy on a finer mesh, at the steps of
 * `run` and at fewer. */
TEST(test_bounce)
{
    enum { N = 40 };
    static const size_t steps[] = {200, 1000};
    char **name;
    size_t count, warned[2] = {0};
    struct br_error err;
    MUST(br_scene_list(&name, &count, &err));
    for (size_t i = 0; i < count; i++) {
        struct br_scene scene = br_test_bundled(name[i]);
        for (size_t j = 0; j < 2 && scene.contact.modelled; j++) {
            struct br_scene axial;
            assert_false(is_warned(&scene, "implicit", steps[j]));
            if (!is_warned(&scene, "lagged", steps[j]))
                continue;
            MUST(br_model_select(&scene, BR_WANT_AXIAL, &axial, &err));
            const double share = added(&axial, N, steps[j]);
            print_message("# %s, %zu steps: %.3g\n", name[i], steps[j], share);
            assert_true(share > 0.003);
            warned[j]++;
        }
        br_scene_clear(&scene);
    }
    br_scene_list_free(name, count);
    assert_true(warned[0] >= 2 && warned[1] == 1);
}
