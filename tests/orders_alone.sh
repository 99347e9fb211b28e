#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# beamrate-orders, $BEAMRATE_ORDERS: it answers, refuses and checks; where $BEAMRATE is the program with
# the beam, both print and write the same bytes.
set -u
: "${BEAMRATE_ORDERS:?is the program}"
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
export LC_ALL=C
failures=0
fails() {
    echo "$*" >&2
    failures=$((failures + 1))
}

printf 'n,L2,H1\n10,1e-1,1\n20,2.5e-2,0.5\n40,6.25e-3,0.25\n80,1.5625e-3,0.125\n' >errors.csv
printf 'h,drag\n0.4,1.16\n0.2,1.04\n0.1,1.01\n' >values.csv
printf 'table: errors.csv\nverify:\n  L2: h 2 +- 0.1\n  H1: h 1 +- 0.1\n' >study.yaml
printf 'table: errors.csv\nverify:\n  L2: h 3 +- 0.1\n' >fails.yaml
printf "run: /bin/sh -c 'echo e {n}'\nn: 10, 20, 40\nread: {e: 'e ([0-9]+)'}\n" >run.yaml

# ends CODE WORDS...: the program ends with CODE; the words are a command line.
ends() {
    code=$1
    shift
    "$BEAMRATE_ORDERS" "$@" >out 2>err
    got=$?
    [ $got = "$code" ] || fails "beamrate-orders $*: exit code $got, expected $code: $(cat out err)"
    [ "${BEAMRATE-}" ] || return 0
    rm -rf trade # results: not those of an earlier run
    "$BEAMRATE" "$@" >out_beam 2>err_beam
    got=$?
    for file in out out_beam err err_beam; do # without its time, and the program's own name
        sed -i 's/; [0-9.]* s$/; SECONDS/; s/then type: .*beamrate\(-orders\)*/then type: PROGRAM/' $file
    done
    if [ $got != "$code" ] || ! cmp -s out out_beam || ! cmp -s err err_beam; then
        fails "beamrate-orders $*: not what beamrate prints"
    fi
}

# says TEXT: the last program printed this.
says() {
    grep -qF -e "$1" out err || fails "not printed: $1"
}

ends 0 orders errors.csv --threads 1
says '2.00'
ends 0 orders values.csv --value drag --formal-order 2
says '1.00'
ends 0 orders errors.csv --expect 'L2: h 2 +- 0.1'
says PASS
ends 1 orders errors.csv --expect 'L2: h 1 +- 0.1'
ends 2 orders nothing.csv
ends 2 orders run.yaml
says 'orders run.yaml --trust'
ends 0 check study.yaml --quiet
ends 1 check fails.yaml --quiet
printf 'n,L2,seconds\n10,1e-1,1\n20,2.5e-2,4\n40,6.25e-3,16\n' >costs.csv
ends 0 trade costs.csv
says 'Cheapest to 1e-2: costs, n = 40, 16 s.'
ends 2 trade costs.csv errors.csv
says 'errors.csv: found no column of a cost'
ends 2 trade run.yaml
says 'trade run.yaml --trust'
BEAMRATE='' ends 2 trade costs.csv --threads 2
says 'runs are timed one at a time'
BEAMRATE='' ends 2 trade costs.csv --jobs 2
says 'runs are timed one at a time'
BEAMRATE='' ends 2 trade costs.csv example1
BEAMRATE='' ends 2 trade
says 'no program is given'
"$BEAMRATE_ORDERS" check - --quiet <study.yaml || fails "a study of standard input: its table is not found"

# What it alone says: it knows no scene.
[ "${BEAMRATE-}" ] && "$BEAMRATE" check example1 --quiet
BEAMRATE='' ends 2 check example1
BEAMRATE='' ends 2 run example1
says "'run' is a command of the program beamrate, not of beamrate-orders"
for command in $([ -z "${BEAMRATE-}" ] || "$BEAMRATE" help | sed -n 's/^  \([a-z][a-z]*\)  .*/\1/p'); do
    "$BEAMRATE_ORDERS" help | grep -q "^  $command " || BEAMRATE='' ends 2 "$command"
    grep -q 'is no command' err && fails "'$command' is unknown to beamrate-orders"
done
BEAMRATE='' ends 2 errors.csv
says 'did you mean: beamrate-orders orders errors.csv'
BEAMRATE='' ends 2 check errors.csv
says 'orders of a table: beamrate-orders orders errors.csv'
BEAMRATE='' ends 0 help
says 'beamrate-orders orders errors.csv'
for command in orders check trade help; do # an example can be pasted
    "$BEAMRATE_ORDERS" "$command" --help | sed -n '/^Examples:/,/^$/p' >examples
    grep -q '^  ' examples || fails "$command: no example"
    grep -v -e '^Examples:$' -e '^$' -e "^  beamrate-orders $command" examples && fails "$command: that example"
done
"$BEAMRATE_ORDERS" help --help | grep -q methods && fails "help: topics that only beamrate has"

# Files: the same but for what says which program wrote them.
for program in "$BEAMRATE_ORDERS" "${BEAMRATE-}"; do
    [ "$program" ] || continue
    "$program" orders errors.csv --no-plots --quiet --expect 'L2: h 2 +- 0.1' --out "out-${program##*/}" ||
        fails "$program: exit code $?"
done
if [ "${BEAMRATE-}" ]; then
    (cd out-beamrate-orders && cat ./*.csv) >a
    (cd out-beamrate && cat ./*.csv) >b
    cmp -s a b || fails "tables differ: $(diff a b | head -5)"
    [ -s a ] || fails "no table was written"
fi
[ $failures -eq 0 ]
