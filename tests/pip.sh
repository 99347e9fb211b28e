#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# `pip install .` into a new environment of Python, without a network: the module with its library, and
# beamrate-orders, which need nothing of the source any more. usage: pip.sh SOURCE
# $BEAMRATE_ORDERS is the program of the build, $PYTHON a python3 with numpy (python3).
set -u
source=$1 python=${PYTHON:-python3}
: "${BEAMRATE_ORDERS:?is the program}"
if ! "$python" -c 'import mesonpy, numpy, pip, venv' 2>/dev/null; then
    echo "skipped: no python3 with mesonpy, numpy, pip and venv"
    exit 0
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/source"
tar -C "$source" -c --exclude=./build --exclude=./.git --exclude=./results . |
    tar -C "$folder/source" -x || exit 1
cd "$folder" || exit 1
unset BEAMRATE_DATA BEAMRATE_LIBRARY PYTHONPATH LD_LIBRARY_PATH
failures=0
check() { # COMMAND...
    "$@" >log 2>&1 && return
    echo "FAILED: $*"
    tail -n 40 log
    failures=$((failures + 1))
}

"$python" -m venv --system-site-packages new || exit 1
check new/bin/pip install --no-build-isolation --no-deps --no-index ./source
check cp "$source/tests/library_orders.py" .
rm -rf source
[ -x new/bin/beamrate-orders ] || { echo "FAILED: the wheel has no program" && exit 1; }
check diff <("$BEAMRATE_ORDERS" --version | sed -n '1s/ (.*//p') \
    <(new/bin/beamrate-orders --version | sed -n '1s/ (.*//p')
printf 'n,e\n10,1e-1\n20,2.5e-2\n40,6.25e-3\n80,1.5625e-3\n' >errors.csv
check new/bin/beamrate-orders orders errors.csv --expect 'e: h 2 +- 0.1'
check new/bin/python -W error library_orders.py
check new/bin/python -c '
import importlib.metadata, beamrate
assert importlib.metadata.version("beamrate") == beamrate.__version__
assert abs(beamrate.orders([4, 1, .25, .0625], n=[1, 2, 4, 8]).order - 2) < 1e-3'
if new/bin/python -c 'import pytest' 2>/dev/null; then # by the entry point of the wheel
    check new/bin/python "$source/tests/library_pytest.py"
fi
check mv new moved # an environment as a whole
check moved/bin/beamrate-orders orders errors.csv
[ "$failures" -eq 0 ]
