#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# `pip install .` into a new environment of Python, without a network: the module with its library, and
# the program with its scenes, which need nothing of the source any more. usage: pip.sh SOURCE
# $BEAMRATE is the program of the build, $PYTHON a python3 with numpy (python3).
set -u
source=$1 python=${PYTHON:-python3}
: "${BEAMRATE:?is the program}"
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
[ -x new/bin/beamrate ] || { echo "FAILED: the wheel has no program" && exit 1; }
check diff <("$BEAMRATE" --version | sed -n '1s/ (.*//p') <(new/bin/beamrate --version | sed -n '1s/ (.*//p')
check new/bin/beamrate run example2 -n 4 --k 0.1 --quiet
check new/bin/beamrate tables --n 5,10 --k 0.1,0.05 --reference fine:20,0.05 --no-plots --quiet --out tables
check new/bin/python -W error library_orders.py
check new/bin/python -c '
import importlib.metadata, beamrate
assert importlib.metadata.version("beamrate") == beamrate.__version__
assert abs(beamrate.orders([4, 1, .25, .0625], n=[1, 2, 4, 8]).order - 2) < 1e-3'
check mv new moved # an environment as a whole
check moved/bin/beamrate run example2 -n 4 --k 0.1 --quiet
[ "$failures" -eq 0 ]
