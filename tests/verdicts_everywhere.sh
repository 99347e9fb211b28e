#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Whether 'beamrate check --all' says the same everywhere: 20 runs, 1 to 8 threads, GCC and Clang, -O0
# to -O3, with and without fused multiply-add, and under valgrind (two scenes). The same: every verdict,
# every order to 1 % of its tolerance, every constant to 0.1 %.
# usage: tests/verdicts_everywhere.sh [FOLDER]   builds there; about a quarter of an hour on 4 cores
set -eu
root=$(dirname -- "$(readlink -f -- "$0")")/..
folder=${1:-$(mktemp -d)}
mkdir -p "$folder"
export BEAMRATE_DATA=$root
failures=0

build() { # NAME COMPILER OPTION...
    local name=$1 compiler=$2
    shift 2
    [ -d "$folder/$name" ] || CC=$compiler meson setup "$folder/$name" "$root" -Dtests=disabled "$@" >/dev/null
    ninja -C "$folder/$name" cli/beamrate >/dev/null
}

compare() { # NAME COMMAND...: exit code 0, and nothing but the cost has moved
    local name=$1 code=0 said
    shift
    said=$("$@" --compare "$folder/first.json" 2>/dev/null) || code=$?
    if [ $code -ne 0 ] || grep -qE '^(note|warning|serious) .*: (order|constant|verdict|gone|new)' <<<"$said"; then
        echo "differs: $name (exit code $code)"
        failures=$((failures + 1))
    else
        echo "the same: $name"
    fi
}

build gcc-O3 gcc -Doptimization=3
program=$folder/gcc-O3/cli/beamrate
"$program" check --all --quiet --json "$folder/first.json"

for run in $(seq 20); do compare "run $run" "$program" check --all; done
for threads in 1 2 3 4 5 6 7 8; do compare "$threads threads" "$program" check --all --threads $threads; done
for compiler in gcc clang; do
    for level in 0 1 2 3; do
        for fma in '' -DBR_NO_FMA; do
            name=$compiler-O$level$fma
            build "$name" $compiler -Doptimization=$level ${fma:+-Dc_args=$fma}
            compare "$name" "$folder/$name/cli/beamrate" check --all
        done
    done
done
if command -v valgrind >/dev/null; then
    build valgrind gcc -Doptimization=1
    compare valgrind valgrind --quiet --error-exitcode=99 "$folder/valgrind/cli/beamrate" check \
        example3 mms_stick --threads 1
fi
echo "$failures differ"
[ $failures -eq 0 ]
