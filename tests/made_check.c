/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "made_check.h"

void made_create(struct made_check *m)
{
    struct br_error err = {0};
    *m = (struct made_check){.scene = br_test_bare()};
    m->scene.bending.modelled = false;
    m->scene.axial.load = br_test_load("sin(x)*(1 + t)");
    MUST(br_verify_default(&m->scene, &m->verify, &err));
    m->verify.study[BR_VERIFY_JOINT].count = 4; /* the fifth cell costs more than all others */
    m->check = (struct br_check){
        .path = "made.yaml", .name = "made", .scene = &m->scene, .verify = &m->verify};
}

void made_clear(struct made_check *m)
{
    br_check_clear(&m->check);
    br_verify_clear(&m->verify);
    br_load_clear(&m->scene.axial.load);
}

void made_run(struct made_check *m, int threads)
{
    struct br_error err = {0};
    br_check_clear(&m->check);
    MUST(br_check_run(&m->check, 1, threads, NULL, &err));
}
