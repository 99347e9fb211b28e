/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bugs as exact replacements of source text. Each text stands exactly once in its file: where it
 * does not any more, the test says so. */
#ifndef PLANTED_BUGS_H
#define PLANTED_BUGS_H

struct planted_bug {
    const char *name, *file, *text, *instead;
};

static const struct planted_bug planted_bugs[] = {
    /* ---- the step ---- */
    {"load_at_the_old_time", "solver/march.c", "time_level(m, m->done + 1), err);",
     "time_level(m, m->done), err);"},
    {"friction_bound_lagged", "solver/march.c",
     ".bound = br_friction_bound(m->scene, penetration(m)),",
     ".bound = br_friction_bound(m->scene, br_penetration(&m->scene->contact, m->tip.displacement - "
     "m->part[BR_AXIAL].field.k * m->tip.velocity[BR_AXIAL])),"},
    {"friction_sign", "solver/march.c",
     "m->tip.velocity[BR_BENDING] = part->solver->finish(part->state, m->tip.friction_force);",
     "m->tip.velocity[BR_BENDING] = part->solver->finish(part->state, -m->tip.friction_force);"},
    {"contact_sign", "solver/march.c", "part->solver->finish(part->state, m->tip.contact_force);",
     "part->solver->finish(part->state, -m->tip.contact_force);"},
    {"contact_force_is_never_renewed", "solver/march.c",
     "m->tip.displacement = part->solver->tip_displacement(part->state);", ""},
    {"initial_velocity_forgotten", "solver/march.c",
     "part->solver->set(part->state, nodal, nodal + size);",
     "memset(nodal + size, 0, size * sizeof *nodal), "
     "part->solver->set(part->state, nodal, nodal + size);"},
    {"initial_displacement_forgotten", "solver/march.c",
     "part->solver->set(part->state, nodal, nodal + size);",
     "memset(nodal, 0, size * sizeof *nodal), part->solver->set(part->state, nodal, nodal + size);"},
    {"friction_forgotten", "solver/march.c",
     "m->scene->friction.law == BR_FRICTIONLESS ? 0 : m->method.friction->force(&friction);",
     "0; (void)m->method.friction->force(&friction);"},
    {"bound_of_the_lagged_contact_force", "solver/march.c",
     "contact->modelled && m->method.contact->at_new_step && contact->stiffness > 0",
     "contact->modelled && contact->stiffness > 0"},

    {"bound_from_the_contact_force", "solver/march.c",
     "return m->tip.contact_force / contact->stiffness;", "return m->tip.contact_force;"},
    {"bound_with_the_gap_in_it", "solver/march.c",
     "return m->tip.contact_force / contact->stiffness;",
     "return m->tip.contact_force / contact->stiffness + contact->gap;"},
    {"mu_for_tresca_alone", "solver/march.c",
     ".regularisation = m->scene->friction.regularisation,",
     ".regularisation = m->scene->friction.law == BR_COULOMB ? 1e-9 : "
     "m->scene->friction.regularisation,"},
    {"load_without_its_length", "solver/field.c", ".h = s->length / (double)n,",
     ".h = 1 / (double)n,"},

    /* ---- the laws at the tip ---- */
    {"gap_ignored", "solver/contact.c", "const double depth = displacement - contact->gap;",
     "const double depth = displacement;"},
    {"contact_that_pulls", "solver/contact.c", "return depth < 0 ? 0 : depth;", "return depth;"},
    {"implicit_contact_too_stiff", "solver/contact.c",
     "contact->stiffness * depth / (1 + contact->stiffness * s->k * s->compliance);",
     "contact->stiffness * depth;"},
    {"implicit_contact_without_its_step", "solver/contact.c",
     "s->displacement + s->k * s->free_velocity", "s->displacement"},
    {"lagged_contact_half_as_stiff", "solver/contact.c",
     "return contact->stiffness * br_penetration(contact, s->displacement);",
     "return 0.5 * contact->stiffness * br_penetration(contact, s->displacement);"},
    {"mu_ignored", "solver/friction.c",
     "const double denominator = s->regularisation + s->bound * s->compliance;",
     "const double denominator = s->bound * s->compliance;"},
    {"mu_doubled", "solver/friction.c",
     "const double denominator = s->regularisation + s->bound * s->compliance;",
     "const double denominator = 2 * s->regularisation + s->bound * s->compliance;"},
    {"friction_in_one_direction_only", "solver/friction.c",
     "return lambda < -bound ? -bound : lambda;", "return lambda < -bound ? 0 : lambda;"},
    {"friction_without_bound_one_way", "solver/friction.c",
     "return lambda < -bound ? -bound : lambda;", "return lambda;"},
    {"coulomb_as_tresca", "solver/friction.c", "return scene->friction.coefficient * penetration;",
     "return scene->friction.coefficient;"},
    {"tresca_bound_one_percent_high", "solver/friction.c", "return scene->friction.coefficient;",
     "return 1.01 * scene->friction.coefficient;"},
    {"stick_with_the_wrong_compliance", "solver/friction.c",
     "return clamp(s->free_velocity / s->compliance, s->bound);",
     "return clamp(0.5 * s->free_velocity / s->compliance, s->bound);"},

    {"mu_with_the_bound_of_another_scene", "solver/friction.c",
     "s->regularisation + s->bound * s->compliance;", "s->regularisation + 8 * s->compliance;"},

    /* ---- element integrals ---- */
    {"axial_mass_lumped", "solver/field.c", "{{1.0 / 3, 1.0 / 6}, {1.0 / 6, 1.0 / 3}};",
     "{{1.0 / 2, 0}, {0, 1.0 / 2}};"},
    {"bending_mass_entry", "solver/field.c", "{156.0 / 420, 22.0 / 420, 54.0 / 420, -13.0 / 420},",
     "{156.0 / 420, 22.0 / 420, 54.0 / 420, -12.0 / 420},"},
    {"bending_mass_lumped", "solver/field.c",
     "{156.0 / 420, 22.0 / 420, 54.0 / 420, -13.0 / 420},\n"
     "    {22.0 / 420, 4.0 / 420, 13.0 / 420, -3.0 / 420},\n"
     "    {54.0 / 420, 13.0 / 420, 156.0 / 420, -22.0 / 420},\n"
     "    {-13.0 / 420, -3.0 / 420, -22.0 / 420, 4.0 / 420},",
     "{0.5, 0, 0, 0}, {0, 1.0 / 24, 0, 0}, {0, 0, 0.5, 0}, {0, 0, 0, 1.0 / 24},"},
    {"rotary_mass_entry", "solver/field.c", "{22.0 / 420, 4.0 / 420, 13.0 / 420, -3.0 / 420},",
     "{22.0 / 420, 5.0 / 420, 13.0 / 420, -3.0 / 420},"},
    {"uniform_load_without_moments", "solver/field.c", "{1.0 / 2, 1.0 / 12, 1.0 / 2, -1.0 / 12};",
     "{1.0 / 2, 0, 1.0 / 2, 0};"},
    {"uniform_load_moment_sign", "solver/field.c", "{1.0 / 2, 1.0 / 12, 1.0 / 2, -1.0 / 12};",
     "{1.0 / 2, 1.0 / 12, 1.0 / 2, 1.0 / 12};"},
    {"gauss_weight", "solver/field.c",
     "0.11846344252809454376, 0.23931433524968323402, 0.28444444444444444444,",
     "0.11846344252809454376, 0.23931433524968323402, 0.28484444444444444444,"},
    {"shape_function", "solver/field.c", "shape[1] = xi * eta * eta;", "shape[1] = xi * xi * eta;"},
    {"load_off_by_one_element", "solver/field.c",
     "x[i] = field->h * ((double)(i / GAUSS) + gauss_x[i % GAUSS]);",
     "x[i] = field->h * ((double)(i / GAUSS + 1) + gauss_x[i % GAUSS]);"},
    {"initial_slope_not_scaled", "solver/field.c", "nodal[2 * i + 1] = field->h * f[i];",
     "nodal[2 * i + 1] = f[i];"},
    {"initial_data_off_by_one_node", "solver/field.c", "x[i] = field->h * (double)i;",
     "x[i] = field->h * (double)(i > 0 ? i - 1 : 0);"},

    /* ---- loads ---- */
    {"tip_moment_not_scaled", "solver/load.c", "load->drive.tip[1] = moment / field->h;",
     "load->drive.tip[1] = moment;"},
    {"tip_force_at_the_wrong_unknown", "solver/load.c",
     "&load->tip_force, \"tip force\", t, &load->drive.tip[0], err);",
     "&load->tip_force, \"tip force\", t, &load->drive.tip[field->kind == BR_BENDING], err);"},
    {"moving_load_assembled_once", "solver/load.c",
     "if (!status && load->space && load->functions.space.uses_t) {",
     "if (!status && load->space && load->functions.space.uses_t && t < 2e-3) {"},
    {"tip_force_forgotten", "solver/load.c",
     "if (!status &&\n        !(br_function_is_zero(&load->tip_force)",
     "if (!status && 0 && !(br_function_is_zero(&load->tip_force)"},

    {"tip_moment_of_a_beam_of_one_metre", "solver/load.c",
     "load->drive.tip[1] = moment / field->h;", "load->drive.tip[1] = moment * (double)field->n;"},
    {"history_forgotten_beside_a_shape", "solver/load.c",
     "if (load->space)\n        status = evaluate(",
     "if (load->space && !load->functions.space.uses_x)\n        status = evaluate("},
    {"static_load_never_assembled", "solver/load.c",
     "return br_assemble_load(field, &load->functions.space, 0, load->space, err);",
     "return load->functions.space.uses_x ? BR_OK : br_assemble_load(field, "
     "&load->functions.space, 0, load->space, err);"},
    {"tip_force_without_a_load_lost", "solver/load.c",
     "if (!status &&\n        !(br_function_is_zero(&load->tip_force)",
     "if (!status && load->space && !(br_function_is_zero(&load->tip_force)"},

    /* ---- the flexibility form, bending ---- */
    {"bending_stiffness_entry", "solver/riccati_bending.c", "stiff / (3 * h * h * h)}",
     "stiff / (2 * h * h * h)}"},
    {"bending_viscosity_dropped", "solver/riccati_bending.c",
     "const real stiff = (real)field->viscosity + (real)field->k * field->stiffness;",
     "const real stiff = (real)field->k * field->stiffness;"},
    {"bending_stiffness_dropped", "solver/riccati_bending.c",
     "b->alpha = field->stiffness / (field->viscosity + field->k * field->stiffness);",
     "b->alpha = 0;"},
    {"bending_control_sign", "solver/riccati_bending.c", "{{{0.5L, -1.0L / 6}, {1, 0}}}",
     "{{{0.5L, 1.0L / 6}, {1, 0}}}"},
    {"bending_clamp_turns", "solver/riccati_bending.c",
     "br_pair y = {0, 0}; /* the increment's nodal state */",
     "br_pair y = {0, 1e-3 * force * b->compliance}; /* the increment's nodal state */"},
    {"bending_off_by_one_element", "solver/riccati_bending.c",
     "for (size_t i = field->n; i-- > 0;)\n        if (!recursion_step(&rec, &b->gain[i]))",
     "b->gain[0] = (struct gain){0};\n    for (size_t i = field->n; i-- > 1;)\n"
     "        if (!recursion_step(&rec, &b->gain[i]))"},
    {"bending_inertia_dropped", "solver/riccati_bending.c",
     "e->strain = alpha * e->curvature + rate;", "e->strain = alpha * e->curvature;"},
    {"bending_displacement_with_the_old_rate", "solver/riccati_bending.c",
     "e->curvature += k * rate;", "e->curvature += k * (rate - kappa);"},
    {"bending_tip_force_sign", "solver/riccati_bending.c",
     "const br_pair drive = e->drive + force * gain->tip;",
     "const br_pair drive = e->drive - force * gain->tip;"},
    {"bending_compliance_wrong", "solver/riccati_bending.c",
     "rec->compliance += zeta[0] * q[0] + zeta[1] * q[1];", "rec->compliance += zeta[0] * q[0];"},
    {"bending_last_load_lost", "solver/riccati_bending.c",
     "br_pair p = -scaled_load(load, b->n, factor) - ", "br_pair p = -"},
    {"bending_contact_at_the_wrong_node", "solver/riccati_bending.c",
     "*velocity = b->tip_velocity + (tip[0] + tip[1]);", "*velocity = b->tip_velocity + tip[0];"},
    {"bending_feedback_term_lost", "solver/riccati_bending.c", "rec->p = add(&p, &krk, 1);",
     "rec->p = p;"},

    {"bending_tip_starts_at_rest", "solver/riccati_bending.c",
     "    b->tip_velocity = velocity[2 * b->n];\n", ""},

    /* ---- the flexibility form, axial ---- */
    {"axial_mass_factor", "solver/riccati_axial.c", "field->density * field->h / field->k / 6;",
     "field->density * field->h / field->k / 4;"},
    {"axial_mass_lumped_in_the_recursion", "solver/riccati_axial.c",
     "const long double q = 2 * m + p;\n        const long double s = r + q;",
     "const long double q = 3 * m + p;\n        const long double s = r + q;\n"
     "        if (s > 0) {\n            const long double z = influence / s;\n"
     "            compliance += z * influence;\n            influence *= r / s;\n"
     "            p = 3 * m + q * (r / s) * (r / s) + r * (q / s) * (q / s);\n"
     "            a->gain[i] = (struct gain){(double)(r / s), (double)(q / s), (double)(1 / s), "
     "(double)z};\n            continue;\n        }"},
    {"axial_viscosity_dropped", "solver/riccati_axial.c",
     "((long double)field->viscosity + (long double)field->k * field->stiffness) / field->h;",
     "((long double)field->k * field->stiffness) / field->h;"},
    {"axial_stale_alpha", "solver/riccati_axial.c",
     "a->alpha = field->stiffness / (field->viscosity + field->k * field->stiffness);",
     "a->alpha = field->stiffness / field->viscosity;"},
    {"axial_displacement_half_a_step_on", "solver/riccati_axial.c", "e->elongation += k * rate;",
     "e->elongation += 0.5 * k * rate;"},
    {"axial_contact_one_node_off", "solver/riccati_axial.c",
     "u += e->elongation;\n        v += rate;",
     "u += i + 1 < a->n ? e->elongation : 0;\n        v += rate;"},
    {"axial_load_off_by_one", "solver/riccati_axial.c", "factor * load[stride * i]);",
     "factor * load[stride * (i + 1)]);"},
    {"axial_coupling_mass_sign", "solver/riccati_axial.c",
     "const long double feedback = (q + m) / s;", "const long double feedback = (q - m) / s;"},

    {"axial_tip_starts_at_rest", "solver/riccati_axial.c",
     "    a->tip_velocity = velocity[a->n];\n", ""},

    /* ---- the stiffness form ---- */
    {"stiffness_entry_sign", "solver/umfpack.c", "second[MOST] = {6, 3, -6, 3};",
     "second[MOST] = {6, 3, -6, -3};"},
    {"stiffness_old_velocity_missing", "solver/umfpack.c", "s->rhs[first + a] += momentum / f->k;",
     "(void)momentum;"},
    {"stiffness_clamp_forgotten", "solver/umfpack.c",
     "if (p < s->unknowns || q < s->unknowns)\n                    continue;",
     "if (p < s->unknowns || q < s->unknowns)\n                    continue;\n"
     "                if (i == 0 && a < 2 * s->unknowns)\n                    continue;"},
    {"stiffness_slope_clamped_on_one_side", "solver/umfpack.c",
     "value[count++] = mass_entry(f, a, b) / f->k + stiff * stiffness_entry(f, a, b);",
     "value[count++] = mass_entry(f, a, b) / f->k + stiff * stiffness_entry(f, a, b) * "
     "(i == 0 && f->kind == BR_BENDING && a != b ? 0 : 1);"},
    {"stiffness_factorisation_stale", "solver/umfpack.c",
     "const double stiff = f->viscosity + f->k * f->stiffness;",
     "static double stale;\n    if (stale == 0)\n        stale = f->k;\n"
     "    const double stiff = f->viscosity + stale * f->stiffness;"},
    {"stiffness_displacement_not_moved", "solver/umfpack.c",
     "s->displacement[i] += s->field.k * s->velocity[i];",
     "s->displacement[i] += s->field.k * s->free_velocity[i];"},
    {"stiffness_elastic_force_halved", "solver/umfpack.c",
     "const double force = f->stiffness / f->h * (u[1] - u[0]);",
     "const double force = 0.5 * f->stiffness / f->h * (u[1] - u[0]);"},
    {"stiffness_velocity_without_the_tip_force", "solver/umfpack.c",
     "memcpy(velocity, s->velocity, bytes);", "memcpy(velocity, s->free_velocity, bytes);"},
    {"stiffness_starts_at_rest", "solver/umfpack.c",
     "    memcpy(s->velocity, velocity, bytes);\n}\n\nstatic void stiffness_get",
     "    (void)velocity;\n}\n\nstatic void stiffness_get"},
    {"stiffness_compliance_one_node_off", "solver/umfpack.c",
     "    return s->tip_response[tip_index(s)];\n",
     "    return s->tip_response[tip_index(s) - (s->field.kind == BR_AXIAL)];\n"},

    /* ---- what is measured ---- */
    {"strain_rate_one_and_a_half_percent_off", "solver/modes.c", "modes[e] = root / h * strain[e];",
     "modes[e] = root / h * strain[e] * 1.015;"},
};

enum { PLANTED_BUGS = sizeof planted_bugs / sizeof *planted_bugs };

#endif
