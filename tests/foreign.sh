#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Real programs of others, and their studies in docs/orders/: in C, with and without a bug, Python,
# FreeFem++ and Octave, where these are installed; a program that fails in each way; beamrate itself.
# $BEAMRATE is the program, $BEAMRATE_DATA the project, $CC a compiler.
set -u
: "${BEAMRATE:?is the program}" "${BEAMRATE_DATA:?is the project}"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
cp "$BEAMRATE_DATA"/docs/orders/* .
mkdir bin
ln -s "$BEAMRATE" bin/beamrate
export PATH="$folder/bin:$PATH"
failures=0

complain() {
    echo "FAILED: $1"
    sed 's/^/    /' output
    failures=$((failures + 1))
}

# The last command's output, whose lines are broken at blanks.
says() { # TEXT COMMAND
    [ -z "$1" ] || grep -qF -- "$1" whole || complain "does not say '$1': $2"
}

# Its exit code, and a text that it prints.
expect() { # CODE TEXT COMMAND...
    local code=$1 text=$2
    shift 2
    "$@" >output 2>&1
    local found=$?
    tr -s ' \n' ' ' <output >whole
    [ $found -eq "$code" ] || complain "exit code $found, expected $code: $*"
    says "$text" "$*"
}

# ---- studies of real programs ----

study() { # NAME PASSES
    expect 0 "$2 PASS, 0 FAIL, 0 INCONCLUSIVE" beamrate check "$1.yaml" --trust
}

has() { # PROGRAM
    command -v "$1" >/dev/null && return
    echo "skipped: $1 is not installed"
    return 1
}

# The derivative at the end to first order: what is left out is half a cell's load.
plant_bug() {
    sed 's|h \* exp(1) + h \* h / 2 \* f(1)|h * exp(1)|' poisson.c >planted.c
    ! cmp -s poisson.c planted.c || complain "poisson.c has no place for the bug"
    ${CC:-cc} -O1 -o poisson planted.c -lm || complain "planted.c cannot be compiled"
}

${CC:-cc} -O1 -o poisson poisson.c -lm || complain "poisson.c cannot be compiled"
expect 2 "then type: beamrate check poisson.yaml --trust" beamrate check poisson.yaml
study poisson 2
expect 0 "0 serious" beamrate check poisson.yaml --trust --compare baseline.json
expect 0 "2 PASS" beamrate check poisson.yaml --trust --compare new.json --update-baseline
expect 0 "0 serious" beamrate check poisson.yaml --trust --compare new.json
plant_bug
expect 1 "FAIL Poisson's equation, finite differences in C, space max (poisson.yaml:11): the order, 1.0" \
    beamrate check poisson.yaml --trust
expect 1 "PASS before, FAIL now" beamrate check poisson.yaml --trust --compare new.json
expect 1 "max: order 1.0" beamrate orders poisson.yaml --trust --out planted
cp planted/orders.gp whole
says "mesh size h = 1/n" "the picture"
says "Order of max: 1.0" "the picture"
# What the page says.
page=$BEAMRATE_DATA/docs/your-own-solver.md
sed -n '/^title: Poisson/,/^```/p' "$page" | sed '$d' >printed
grep -v '^#' poisson.yaml | diff printed - >output || complain "$page has another poisson.yaml"
expect 0 "drag: limit 24.9370 [24.9321, 24.9419], p = 1.91, GCI 0.03 % of the finest value, asymptotic 1.001: monotone" \
    beamrate orders drag.csv --value drag
expect 0 "l2: order 2.000 [1.999, 2.002]: half the mesh size, a quarter of the error" beamrate orders errors.csv
printf 'h [m]\tdrag [N]\n0.4\t3\n0.2\t3.3\n0.1\t3.4\n' >units.tsv
expect 0 "drag: limit 3.44 [3.29, 4.93], p = 1.58, GCI 1.8 %" beamrate orders units.tsv --value drag --out units
printf 'cells,cd\n2500,3\n10000,3.3\n40000,3.4\n' >cells.csv
expect 0 "p = 1.58 (2-D assumed; --dimension 1 gives 0.79, 3 gives 2.38), GCI" \
    beamrate orders cells.csv --value cd
expect 0 "p = 1.58, GCI" beamrate orders cells.csv --value cd --dimension 2
cp units/orders.gp whole
says "mesh size h (m)" "the picture"
says "drag (N)" "the picture"
has python3 && study heat 2
has FreeFem++ && study freefem 4
has octave-cli && study pendulum 1

# ---- a program that fails at one resolution ----

cat >bad.sh <<'END'
#!/bin/sh
if [ "$2" = 8 ]; then
    case $1 in
    fails) echo err=0.1; echo singular matrix >&2; exit 3 ;;
    hangs) sleep 3600 ;;
    nan) echo err=nan; exit 0 ;;
    nothing) exit 0 ;;
    comma) echo err=1,5; exit 0 ;;
    esac
fi
echo "err=$((1000000 / ($2 * $2)))e-6"
END
chmod +x bad.sh

fails() { # HOW MESSAGE
    local words=(orders --run "./bad.sh $1 {n}" --n 4,8,16,32,64 --read 'err=err=(.+)' --time-limit 3)
    expect 3 "1 of 5 runs failed; the first, n = 8: $2" beamrate "${words[@]}"
    says "err: order 2.0" "orders, bad.sh $1"
    says "1 of 5 left out, the first at n = 8 (failed)" "orders, bad.sh $1"
    expect 3 "1 of 5 runs failed; the first, n = 8: $2" beamrate "${words[@]}" --expect 'err: h 2 +- 0.1'
    says "PASS" "orders, bad.sh $1, with an expectation"
}

# Without a number in any run, no hint speaks of values that stay the same.
none_has_a_number() {
    expect 3 "err: order in h not measurable. 3 of 3 left out" \
        beamrate orders --run './bad.sh never {n}' --n 4,16,32 --read 'err=other=(.+)'
}

# A study file's failed run: the verdict is of the others, and the exit code says it.
failed_run_of_a_study() {
    cat >bad.yaml <<'END'
run: ./bad.sh fails {n}
n: 4, 8, 16, 32, 64
read:
  err: err=(.+)
verify:
  err: h 2 +- 0.1
END
    expect 3 "bad.yaml: 1 of 5 runs failed; the first, n = 8: exit code 3" beamrate check bad.yaml --trust
    says "left out: n = 8 (failed)" "check bad.yaml"
    says "1 PASS" "check bad.yaml"
}

expect 0 "err: order 2.00" \
    beamrate orders --run './bad.sh never {n}' --n 4,8,16,32,64 --read 'err=err=(.+)'
expect 0 "5 of 5 runs are from an earlier start, and were not run again." \
    beamrate orders --run './bad.sh never {n}' --n 4,8,16,32,64 --read 'err=err=(.+)' --resume
none_has_a_number
failed_run_of_a_study
fails fails "exit code 3; it printed: singular matrix"
fails hangs "it did not end within 3 s; it printed nothing"
fails nan "err: found 'nan', expected a finite number"
fails nothing "err: 'err=(.+)' matches nothing in the output"
fails comma "err: found '1,5', expected a finite number"

# ---- beamrate as a program of others ----

# A number of a row of a CSV file: by its place, or a line of a table.
field() { # FILE LINE-PATTERN COLUMN
    awk -F, -v pattern="$2" -v column="$3" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == column) at = i }
        NR > 1 && $0 ~ pattern { print $at; exit }' "$1"
}

near() { # WHAT A B TOLERANCE
    awk -v a="$2" -v b="$3" -v t="$4" 'BEGIN { d = a - b; exit !(a != "" && b != "" && d * d <= t * t) }' ||
        complain "$1: $2, expected $3 to $4"
}

k=0.02,0.01,0.005,0.0025,0.00125
run='beamrate run example2 --n 10 --k {k} --quiet --json -'
read=/tip/displacement/axial
expect 0 "" beamrate study example2 --n 10 --k $k --norm tip --no-plots --quiet --out study
slope=$(awk -F, '/^exact,axial,/ { x = log($6); y = log($7); n++; sx += x; sy += y; xx += x * x; xy += x * y }
    END { printf "%.9g", (n * xy - sx * sy) / (n * xx - sx * sx) }' study/example2-tip.csv)

# Of the study's own cells, line by line.
sed -n '1p; /^exact,axial,/p' study/example2-tip.csv >cells.csv
expect 0 "half the time step, half the error" beamrate orders cells.csv --error error --no-plots --out cells
order=$(field cells/orders.csv '^error,k' order)
near "the order of the study's cells" "$order" 1 1e-4
near "its slope, a regression of all" "$order" "$slope" 1e-3

# Of the tip at the end, whose exact value the study tells, and without that.
exact=$(field study/example2-tip-tips.csv '^axial' 'reference [m]')
cat >tip.sh <<END
#!/bin/sh
beamrate run example2 --n 10 --k \$1 --quiet --json tip.json
tr -d ' ",' <tip.json | awk -F: '/^tip:/ { within = 1 }
    within && /^axial:/ { d = \$2 - ($exact); print "error", d < 0 ? -d : d; exit }'
END
chmod +x tip.sh
expect 0 "half the time step, half the error" beamrate orders --run './tip.sh {k}' --k $k --read 'tip=error (.+)' \
    --no-plots --out errors
near "the order of the tip's errors" "$(field errors/orders.csv '^tip,k' order)" "$order" 1e-5
expect 0 "monotone convergence" beamrate orders --run "$run" --k $k --read "tip=json:$read" \
    --value tip --formal-order 1 --no-plots --out values
near "the order of the tip's values" "$(field values/orders.csv '^tip,k' order)" "$order" 5e-3
near "the limit of the tip's values" "$(field values/orders-limits.csv '^tip,k' limit)" "$exact" 1e-6

[ "$failures" -eq 0 ]
