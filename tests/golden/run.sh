#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the command lines of commands.txt, each in an empty folder, and compares exit code, standard
# output, standard error and files with what is stored in NAME.txt. $BEAMRATE is a program with the
# stand-ins of stand_ins.c; there is no gnuplot.
# usage: run.sh [--update] [NAME...]     --update rewrites what differs, and says which
set -u
: "${BEAMRATE:?is the program}"
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/bin"
ln -s "$(readlink -f "$BEAMRATE")" "$folder/bin/beamrate"
export BEAMRATE_DATA="${BEAMRATE_DATA:-$here/../..}" LC_ALL=C
update=
[ "${1:-}" = --update ] && update=yes && shift
wanted=" $* "

# Without what no two runs have in common, seconds on the wall, and an axis that begins at round-off; of
# JSON a row of a table is a line.
mask() {
    sed -E -e "s|$BEAMRATE_DATA/||g" -e 's/[0-9a-f]{64}/HASH/g' \
        -e 's/"(version|commit)": ("[^"]*"|[0-9]+)/"\1": MASKED/' \
        -e 's/"(wall_seconds|seconds)": [0-9.]+e-[6-9]/"\1": MASKED/' \
        -e 's/^(set yrange) \[[0-9.]+e-1[2-9]:.*/\1 ROUND-OFF/' \
        -e '/^  (avx[0-9a-z]*|portable) /d' |
        awk -f "$here/join.awk"
}

# Runs a command line and prints all that it leaves, these files among it; of a script for gnuplot
# what the first one has not.
run() {
    rm -rf "$folder/work" && mkdir "$folder/work" && cd "$folder/work" || exit 99
    (PATH="$folder/bin"; eval "$1") >../out 2>../err
    echo "exit code $?"
    echo "==== standard output"
    mask <../out
    echo "==== standard error"
    mask <../err
    script=
    for file in $2; do
        echo "==== $file"
        if [ ! -f "$file" ]; then
            echo "is not there"
        elif [ "$script" ] && [ "${file%.gp}" != "$file" ]; then
            grep -vxFf "$script" "$file" | mask
        else
            mask <"$file"
        fi
        case $file in *.gp) script=${script:-$file} ;; esac
    done
    cd "$here" || exit 99
}

# The comparison itself: which of these numbers are the same?
compare() {
    echo "$1" >"$folder/old"; echo "$2" >"$folder/new"
    awk -v tolerance="${3:-}" -v round_off="${4:-}" -v counts="${5:-}" -f "$here/compare.awk" "$folder/old" "$folder/new" \
        >/dev/null && same="$same $1=$2"
}
same=
compare 1.50000000000 1.50000000100; compare 1.50000000000 1.50000001000
compare 1.50000000000 1.50000001000 1e-6; compare 3e-14 4e-14; compare 3e-14 4e-14 '' yes; compare 3e-14 -3e-14
compare 3e-14 3e-12 '' yes; compare 3e-14 nan '' yes; compare 3e-14 -nan; compare 3e-12 0.0 '' yes
compare '7e-11 %' '1e-10 %' '' yes; compare 7e-11 1e-10 '' yes; compare 7 8; compare 0.0 1e-16
compare '< 4e-17 m' '2.4e-17 m' '' yes; compare '< 4e-17' 2.4e-17
compare 40 43 '' '' yes; compare 40 45 '' '' yes; compare 10 11 '' '' yes; compare 101 99 '' '' yes; compare 40 43
compare 0.0 1e-16 '' yes; compare 2.5000000001e-13 2.5000000002e-13

number=1 failed=0
echo "TAP version 13"
if [ "$same" = ' 1.50000000000=1.50000000100 1.50000000000=1.50000001000 3e-14=4e-14 3e-14=4e-14 7e-11 %=1e-10 % 0.0=1e-16 < 4e-17 m=2.4e-17 m 40=43 101=99 0.0=1e-16 2.5000000001e-13=2.5000000002e-13' ]; then
    echo "ok 1 - comparison"
else
    failed=1
    echo "not ok 1 - comparison"
    echo "#   same:$same"
fi
while IFS='|' read -r name command files; do
    set -- $name
    name=${1:-} tolerance= round_off= counts= long=
    for mark in ${2:-} ${3:-}; do
        case $mark in round-off) round_off=yes ;; counts) counts=yes ;; long) long=yes ;; *) tolerance=$mark ;; esac
    done
    case $name in '' | '#'*) continue ;; esac
    case $wanted in '  ') [ -z "$long" ] || [ "$update" ] || continue ;; *" $name "*) ;; *) continue ;; esac
    number=$((number + 1))
    run "$(echo "$command" | sed 's/^ *//; s/ *$//')" "$files" >"$folder/new"
    touch "$folder/empty"
    stored=$here/$name.txt
    [ -e "$stored" ] || stored=$folder/empty
    if awk -v tolerance="$tolerance" -v round_off=$round_off -v counts=$counts -f "$here/compare.awk" \
        "$stored" "$folder/new" >"$folder/merged"; then
        echo "ok $number - $name"
    elif [ "$update" ]; then
        cp "$folder/new" "$here/$name.txt"
        echo "ok $number - $name # updated"
    else
        failed=$((failed + 1))
        echo "not ok $number - $name"
        diff -U1 "$stored" "$folder/merged" | sed -n '3,60s/^/# /p'
    fi
done <"$here/commands.txt"
# Numbers of what is stored, derived from others of it.
set -- "$here/held.txt"
for stored in "$here"/*.txt; do
    case $stored in */held.txt | */commands.txt) ;; *) set -- "$@" "$stored" ;; esac
done
number=$((number + 1))
if awk -f "$here/derive.awk" "$@" >"$folder/wrong"; then
    echo "ok $number - derived numbers"
else
    failed=$((failed + 1))
    echo "not ok $number - derived numbers"
    sed 's/^/# /' "$folder/wrong"
fi
echo "1..$number"
[ $failed -eq 0 ] || { echo "# where the new output is right: ./bootstrap update"; exit 1; }
