/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/certificate_parts.h"

#include <float.h>
#include <math.h>

/* ---- verdicts ---- */

static const struct {
    const char *what;
    size_t offset;
} entries[] = {
    {"the residual of the axial equation (27)", offsetof(struct br_certificate, axial_residual)},
    {"the residual of the bending equation (28)",
     offsetof(struct br_certificate, bending_residual)},
    {"the update of the displacement", offsetof(struct br_certificate, update)},
    {"the distance from the friction law (12)", offsetof(struct br_certificate, friction)},
    {"the distance from the contact law (10)", offsetof(struct br_certificate, contact)},
};
enum { ENTRIES = sizeof entries / sizeof *entries };

static double entry(const struct br_certificate *c, size_t i)
{
    return *(const double *)((const char *)c + entries[i].offset);
}

enum br_status br_certificate_check(const struct br_certificate *certificate,
                                    const struct br_certificate *limits, struct br_error *err)
{
    for (size_t i = 0; i < ENTRIES; i++)
        if (!(entry(certificate, i) <= entry(limits, i)))
            return br_fail(err, BR_VERDICT, "%s is %.3g, expected at most %.3g", entries[i].what,
                           entry(certificate, i), entry(limits, i));
    return BR_OK;
}

void br_certificate_merge(struct br_certificate *worst, const struct br_certificate *other)
{
    for (size_t i = 0; i < ENTRIES; i++) {
        double *value = (double *)((char *)worst + entries[i].offset);
        *value = br_worse_of(*value, entry(other, i));
    }
}

/* Of an adaptive step that ends at a switch, relative to the tip's force or way; seen are 7e-14. */
static const double switch_accuracy = 1e-12;

/* The first adaptive step is 1e-7 of the duration: of a beam that starts bent, inertia is then all
 * that balances, and the velocities that riccati finds have 8 digits. */
static const double small_steps = 64;

/* The laws are scalar, and right to some of the tip's last bits; an update or a sum
 * over the nodes is right to n of them. */
struct br_certificate br_certificate_limits(const struct br_time_scheme *scheme, size_t n,
                                            double round_off)
{
    const double nodes = (double)n + 1;
    const double sums = 64 * DBL_EPSILON * nodes + round_off;
    const double laws = sums + (scheme->adaptive ? switch_accuracy : 0);
    const double small = scheme->adaptive ? small_steps : 1;
    return (struct br_certificate){
        .axial_residual = 64 * DBL_EPSILON * nodes + 16 * round_off,
        .bending_residual = small * (64 * DBL_EPSILON * nodes * nodes + 16 * round_off),
        .update = sums,
        .friction = laws,
        .contact = laws,
    };
}
