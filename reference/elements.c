/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/elements.h"

const int br_rod_mass[2][2] = {{2, 1}, {1, 2}};
const int br_rod3_mass[3][3] = {{4, 2, -1}, {2, 16, 2}, {-1, 2, 4}};
const int br_beam_mass[4][4] = {
    {156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}};
const int br_rod_stiffness[2][2] = {{1, -1}, {-1, 1}};
const int br_rod3_stiffness[3][3] = {{7, -8, 1}, {-8, 16, -8}, {1, -8, 7}};
const int br_beam_stiffness[4][4] = {
    {12, 6, -12, 6}, {6, 4, -6, 2}, {-12, -6, 12, -6}, {6, 2, -6, 4}};
