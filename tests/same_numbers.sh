#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The answer, the table, the JSON and the verdict of the same data state the same numbers: of a line
# with rows that do not count, a grid with a joint fit, a grid without one, and values, also on a
# grid.
# usage: same_numbers.sh; $BEAMRATE is the program
set -u
: "${BEAMRATE:?is the program}"
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 99
number=0

report() { # NAME WHAT: fails if the file `why` has lines
    number=$((number + 1))
    [ -s why ] && { sed 's/^/# /' why; printf 'not '; failed=yes; }
    echo "ok $number - $1: $2"
}

# "h 2.00 1.99 2.00" for each order of an answer; "-" where it states none.
orders_of() {
    tr '\n' ' ' <"$1" | tr -s ' ' | grep -oE 'order( in [hk])? -?[0-9.]+ \[-?[0-9.]+, -?[0-9.]+\]' |
        sed -E -e 's/order [^i]/order in h &/; s/in h order/in h/' \
            -e 's/order in ([hk]) (\S+) \[(\S+), (\S+)\]/\1 \2 \3 \4/' | sort
}

# The same from lines "h ORDER LOW HIGH", rounded as the orders of $1 are, each to its own digits. No
# interval is printed with a width of zero: its ends are then one digit apart from the order.
as_printed() { # ANSWER NUMBERS
    awk 'NR == FNR { printed[$1] = $2; next }
        ($1 in printed) { d = length(printed[$1]) - index(printed[$1], ".")
            zero = sprintf("%.*f", d, $3) == sprintf("%.*f", d, $4) ? 10 ^ -d : 0
            printf "%s %.*f %.*f %.*f\n", $1, d, $2, d, $3 - zero, d, $4 + zero }' "$1" "$2" | sort
}

# "h ORDER LOW HIGH VERDICT" of each case in the JSON of a verdict.
cases_of() {
    awk -F'[:,]' '/"tables"/ { on = 1 } /"points": \[/ { on = 0 }
        on && /"study"/ { axis = /space/ ? "h" : "k" }
        on && /"order"/ { order = $2 } on && /"low"/ { low = $2 } on && /"high"/ { high = $2 }
        on && /"verdict"/ { gsub(/[" ]/, "", $2); verdict = $2 }
        on && /"ceiling"/ { print axis, order, low, high, verdict }' "$1"
}

# The numbers of the keys $3 in each row of table $2 in JSON $1, one a line; "-" for null.
in_json() {
    awk -F'[:,]' -v table="\"$2\": [" -v keys=" $3 " '{ sub(/^ */, "") }
        index($0, table) == 1 { on = !/\[\]/ } /^\],?$/ { on = 0 }
        on { gsub(/"/, "", $1); gsub(/ /, "", $2) }
        on && index(keys, " " $1 " ") { print $2 == "null" ? "-" : $2 }' "$1"
}

# The numbers in the rows of the table of the text $1 whose title begins with $2, one a line, without
# names and sizes.
in_table() {
    awk -v title="$2" 'index($0, title) == 1 { on = 1; next } !NF { on = 0 }
        on && on++ { # a name may have blanks, one each
            sub(/^([^ ]| [^ ])*  +/, ""); gsub(/[a-zA-Z]+ = [^ ]+/, ""); gsub(/[][,]/, " "); print }' "$1" |
        tr -s ' ' '\n' | grep -E '^(-|-?[0-9.]+(e[-+][0-9]+)?)$'
}

# The numbers of the answer $1 that the table $2 has, too; those in % over 100.
in_answer() {
    tr '\n' ' ' <"$1" | tr -s ' ' | grep -oE "$2" | tr -d '[],;:' |
        awk '{ for (i = 1; i <= NF; i++) if ($i ~ /^-?[0-9]/) print $i (($(i + 1) == "%") ? " 100" : "") }'
}

# Fails where a printed number of $1 ("NUMBER" or "NUMBER FACTOR") is not that in the same line of $2.
agree() { # PRINTED EXACT
    paste -d' ' "$1" "$2" | awk '{ exact = $NF * (NF == 3 ? $2 : 1); at = index($1, "e")
        digits = at ? substr($1, 1, at - 1) : $1; point = index(digits, ".")
        last = 10 ^ ((at ? substr($1, at + 1) : 0) - (point ? length(digits) - point : 0))
        off = $1 - exact; if (off < 0) off = -off
        share = last > 9e-5 && last < 2e-4 ? 1.000001 : 0.500001 # a width of zero, as above
        if (NF < 2 || ($1 == "-") != ($NF == "-") || !(off <= share * last)) print }'
    [ -s "$1" ] || echo "found no number"
}

# What the joint fit, or the limits, say in the text, in the JSON and in the table.
details() { # NAME
    case $1 in
    grid | hidden)
        in_json all.json joint "order_h order_h_low order_h_high order_k order_k_low order_k_high \
            c_h c_k rows misfit" | grep -v '^-$' >exact
        in_table text "Joint fit" | grep -v '^-$' >shown
        agree shown exact >why
        report "$1" "the table of joint fits is that in JSON"
        in_json all.json joint "order_h order_h_low order_h_high order_k order_k_low order_k_high \
            rows misfit" | grep -v '^-$' >exact
        in_answer text 'order in [hk] -?[0-9.]+ \[-?[0-9.]+, -?[0-9.]+\]|fit of [0-9]+ rows|misfit [^ ]+ %' >shown
        agree shown exact >why
        report "$1" "the answer states that joint fit"
        ;;
    values | both)
        keys='limit low high p gci_fine gci_coarse asymptotic'
        [ "$1" = both ] || keys="$keys r21 r32 phi_ext e_a e_ext gci_limited"
        in_json all.json limits "$keys" >exact
        in_table text "Limits of values" >shown
        agree shown exact >why
        report "$1" "the table of limits is that in JSON"
        if [ "$1" = values ]; then
            in_json all.json limits "limit low high p gci_fine asymptotic" >exact
        else
            in_json all.json limits "limit low high" | tail -3 >exact
        fi
        sed '/^Read: /q' text >head # the table of limits has these words, too
        in_answer head 'limit [^ ]+ \[[^ ]+, [^ ]+\]|, p = [0-9.]+|GCI [^ ]+ %[^,]*, asymptotic [0-9.]+' >shown
        agree shown exact >why
        report "$1" "the answer states that limit"
        ;;
    esac
}

compare() { # NAME EXPECTATION OPTION...
    name=$1 expect=$2
    shift 2
    "$BEAMRATE" orders "$name.txt" "$@" >text 2>err || { cat err >why && report "$name" answer; }
    "$BEAMRATE" orders "$name.txt" "$@" -q --json all.json
    "$BEAMRATE" orders "$name.txt" "$@" --expect "$expect" --json case.json >verdict 2>err
    orders_of text >answer
    [ -s answer ] && : >why || echo "no order" >why
    report "$name" "there is an answer"
    sed -n '/"answer"/,/\]/p' all.json >json && orders_of json >from_json
    diff answer from_json >why
    report "$name" "the answer in JSON is that in the text"
    cases_of case.json >cases && as_printed answer cases >from_cases
    diff answer from_cases >why
    report "$name" "the verdict is on the order of the answer"
    details "$name"
    : >why
    while read -r _ order low high outcome; do
        grep -qE "(^| )$outcome( |\$)" verdict || echo "no row of $outcome" >>why
        case $order in
        null) [ "$outcome" = INCONCLUSIVE ] || echo "$outcome without an order" >>why ;;
        *) awk -v o="$order" -v l="$low" -v h="$high" 'BEGIN { exit !(l <= o && o <= h) }' ||
            echo "$order is not between $low and $high" >>why ;;
        esac
    done <cases
    report "$name" "its row of the table has that verdict"
}

# Rows in another order, drawn from the seed: the same text. Errors or values that are 1024 times as many:
# the same orders.
rearranged() { # NAME OPTION...
    name=$1
    shift
    cp "$name.txt" table.txt
    "$BEAMRATE" orders table.txt "$@" >text 2>&1
    orders_of text >answer
    { sed 1q "$name.txt"; sed 1d "$name.txt" | awk -v seed="$seed" 'BEGIN { srand(seed) } { print rand(), $0 }' | sort | cut -d' ' -f2-; } >table.txt
    cmp -s table.txt "$name.txt" && echo "the same order" >why || : >why
    "$BEAMRATE" orders table.txt "$@" 2>&1 | diff text - >>why
    report "$name" "rows in another order"
    awk 'NR > 1 { $NF = sprintf("%.17g", 1024 * $NF) } { print }' "$name.txt" >table.txt
    "$BEAMRATE" orders table.txt "$@" >text 2>&1
    orders_of text | diff answer - >why
    report "$name" "errors in another unit"
}

# An order, a constant and sizes that are drawn: the order is found to a thousandth.
power() { # NUMBER
    awk -v seed="$((seed + $1))" 'BEGIN { srand(seed); p = 0.5 + 3.5 * rand(); c = exp(20 * rand() - 10)
        print "h e" >"table.txt"
        for (h = rand() + 0.1; ++i <= 6; h /= 1.4 + rand()) printf "%.17g %.17g\n", h, c * h ^ p >"table.txt"
        print p }' >p
    "$BEAMRATE" orders table.txt >text 2>&1
    orders_of text | awk -v p="$(cat p)" '{ off = $2 - p; ok = off < 6e-3 && off > -6e-3 && $3 <= p + 5e-4 && p - 5e-4 <= $4 }
        END { if (NR != 1 || !ok) print "the order is " p ", found: " $0 }' >why
    report power "order $(cat p)"
}

cat >line.txt <<'END'
n l2
5 9e-2
10 1e-2
20 2.52e-3
40 6.26e-4
80 1.57e-4
160 3.93e-5
320 4.0e-8
END
awk 'BEGIN { print "n k l2"; srand(7)
    for (n = 10; n < 100; n *= 2) for (k = .1; k > .01; k /= 2) {
        a = 2 / n ^ 2; b = .3 * k
        printf "%d %g %.5e\n", n, k, sqrt(a * a + .6 * a * b + b * b) } }' >grid.txt
awk 'BEGIN { print "n k l2"
    for (n = 10; n < 100; n *= 2) for (k = .1; k > .01; k /= 2)
        printf "%d %g %.5e\n", n, k, 1e-6 / n ^ 2 + .3 * k }' >hidden.txt
awk 'BEGIN { print "n drag"
    for (n = 10; n < 200; n *= 2) printf "%d %.9g\n", n, 1.5 + 3 / n ^ 2 * (1 + 3 / n) }' >values.txt
awk 'BEGIN { print "n k drag"
    for (n = 10; n < 200; n *= 2) for (k = .1; k > .01; k /= 2)
        printf "%d %g %.9g\n", n, k, 1.5 + 3 / n ^ 2 * (1 + 3 / n) + k }' >both.txt

echo 'TAP version 13'
failed=
compare line 'l2: h 2 +- 0.1'
compare grid 'l2: h 2 +- 0.1, k 1 +- 0.1'
compare hidden 'l2: h 2 +- 0.1, k 1 +- 0.1'
compare values 'drag: h 2 +- 0.1' --value drag
compare both 'drag: h 2 +- 0.1, k 1 +- 0.1' --value drag
seed=${BR_TEST_SEED:-1}
[ -z "${BR_TEST_LONG:-}" ] || seed=${BR_TEST_SEED:-$(date +%s)}
echo "# seed $seed"
for name in line grid hidden; do rearranged $name; done
for name in values both; do rearranged $name --value drag; done
for i in 1 2 3 4 5; do power "$i"; done
echo "1..$number"
[ -z "$failed" ]
