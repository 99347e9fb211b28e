#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What a digit costs in Poisson's equation: finite differences in C, SciPy's sparse solver where that is
# installed, and triangles of FreeFem++ where that is. usage: trade.sh [beamrate-orders]
set -eu
cd "$(dirname "$0")"
program=${1:-beamrate-orders}
cc -O2 -o fd fd.c -lm
set -- fd.yaml
! python3 -c 'import scipy' 2>/dev/null || set -- "$@" sparse2.yaml sparse4.yaml
! command -v FreeFem++ >/dev/null || set -- "$@" p1.yaml p2.yaml
"$program" trade "$@" --trust --out trade
