#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# All commands whose output is looked at, each started once in a folder that has the files of docs/orders/ and
# docs/trade/: the rows of commands.txt, what the pages of docs/, README and the program's help print. Of a row,
# exit code, standard output, standard error and files are those that NAME.txt has. What a page shows of an output
# is what it is (shown.awk). An example ends with 0, and says something without a nan. $BEAMRATE is the program
# with the stand-ins of stand_ins.c, for rows and what pages show; there is no gnuplot. $PROGRAM is the program itself,
# for all others: beside it is beamrate-orders.
# usage: run.sh            rows but the long ones, and what pages show in text that is not "long"; examples that are
#                          the same commands
#        run.sh --rest     all other examples; files that are printed pass their checks
#        run.sh NAME...    these rows alone, which may be long
#        run.sh --update   rewrites rows and pages where they differ, and says which
set -u
: "${BEAMRATE:?is the program}"
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/bin" "$folder/files"
beamrate=$(readlink -f "$BEAMRATE")
ln -s "$beamrate" "$folder/bin/beamrate"
ln -s "$beamrate" "$folder/bin/beamrate-orders"
export BEAMRATE_DATA="${BEAMRATE_DATA:-$here/../..}" LC_ALL=C
cp "$BEAMRATE_DATA"/docs/orders/* "$BEAMRATE_DATA"/docs/trade/*.csv "$folder/files"
mode=rows wanted=
case ${1:-} in
--update) mode=update ;;
--rest) mode=rest ;;
?*) mode=names wanted=" $* " ;;
esac

# ---- the list ----

tab='	'
# NAME, marks, COMMAND, files to compare
grep -v '^#' "$here/commands.txt" | sed -n 's/ *| */|/g; s/ *$//; /|/p' | tr '|' "$tab" |
    awk -F '\t' -v OFS='\t' '{ marks = $1; sub(/^[^ ]* */, "", marks); sub(/ .*/, "", $1); print $1, marks " ", $2, $3 }' \
        >"$folder/all_rows"
awk -F '\t' -v mode=$mode -v wanted="$wanted" '{ long = index($2, "long ") }
    mode == "update" || (mode == "rows" ? !long : index(wanted, " " $1 " "))' \
    "$folder/all_rows" >"$folder/rows"

list_pages() {
    PATH=$folder/bin:$PATH
    beamrate --help >"$folder/help"
    awk -v mode=help -v at=--help -f "$here/pages.awk" "$folder/help"
    for command in $(sed -n '/^Commands:/,/^$/s/^  \([a-z][a-z]*\) .*/\1/p' "$folder/help"); do
        beamrate "$command" --help >"$folder/help" || echo "bad${tab}$command${tab}echo --help fails; false"
        grep -q '^  beamrate ' "$folder/help" || echo "bad${tab}$command${tab}echo --help has no example; false"
        awk -v mode=help -v at="$command" -f "$here/pages.awk" "$folder/help"
    done
    awk -v mode=page -v files="$folder/files" -f "$here/pages.awk" "$BEAMRATE_DATA"/README.md "$BEAMRATE_DATA"/docs/*.md
}

: >"$folder/examples"
: >"$folder/shown"
if [ $mode != names ]; then
    (list_pages) >"$folder/all"
    grep -E '^(shown|later)' "$folder/all" | sort -t "$tab" -k 3 >"$folder/shown"
    grep -vE '^(shown|later)' "$folder/all" | awk -F '\t' '!seen[$3]++' >"$folder/examples"
    grep '^shown' "$folder/shown" | cat "$folder/all_rows" - | cut -f 3 >"$folder/known"
fi

# ---- running ----

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

# Runs a command line by these programs alone; its output goes to out and err.
run() {
    rm -rf "$folder/work" && cp -a "$folder/files" "$folder/work" && cd "$folder/work" || exit 99
    (PATH="$folder/bin"; eval "$1") >../out 2>../err </dev/null
    code=$?
}

# Of a file in JSON, what is in no other format; test_document has that the formats agree.
facts() {
    awk '/^ "/ { skip = /^ "(answer|tables|about_tables|notes|pictures|verdicts|provenance)":/ } /^}/ { skip = 0 } !skip'
}

# Prints all that a row's command has left, these files among it.
print_left() { # FILES
    echo "exit code $code"
    echo "==== standard output"
    mask <../out
    echo "==== standard error"
    mask <../err
    for file in $1; do
        echo "==== $file"
        case $file in
        *.dat) awk -f "$here/digest.awk" "$file" | mask ;;
        *.json) facts <"$file" | mask ;;
        *) if [ -f "$file" ]; then mask <"$file"; else echo "is not there"; fi ;;
        esac
    done
}
# What stands before a row, so that it is folded: pictures, and the row that the name begins with (run of run_bdf2).
first_of() { # NAME
    first=$here/${1%%_*}.txt
    [ "$first" != "$here/$1.txt" ] && [ -e "$first" ] || first=/dev/null
    sed "s/^==== /==== ${1%%_*}: /" "$first" | cat "$here/made/figures.txt" -
}

number=0 failed=0
report() { # WHETHER WHAT: the file `why` has the reason
    number=$((number + 1))
    if [ "$1" -eq 0 ]; then
        echo "ok $number - $2"
    else
        failed=$((failed + 1))
        echo "not ok $number - $2"
        head -60 "$folder/why" | sed 's/^/# /'
    fi
}

compare_row() { # NAME MARKS FILES
    tolerance='' round_off='' counts=''
    for mark in $2; do
        case $mark in round-off) round_off=yes ;; counts) counts=yes ;; long) ;; *) tolerance=$mark ;; esac
    done
    print_left "$3" >"$folder/new"
    first_of "$1" >"$folder/first"
    stored=$here/$1.txt
    [ -e "$stored" ] || stored=/dev/null
    awk -f "$here/unfold.awk" "$folder/first" "$stored" >"$folder/stored"
    awk -v tolerance="$tolerance" -v round_off=$round_off -v counts=$counts -f "$here/compare.awk" \
        "$folder/stored" "$folder/new" >"$folder/merged"
    same=$?
    if [ $mode = update ]; then
        [ $same -eq 0 ] || echo "# $1 is updated"
        awk -f "$here/fold.awk" "$folder/first" "$folder/merged" >"$here/$1.txt"
        same=0
    fi
    diff -U1 "$folder/stored" "$folder/merged" | sed 1,2d >"$folder/why"
    report $same "$1"
}

# What the example has printed says something, and no number in it is nan.
compare_example() { # WHERE COMMAND
    cat "$folder/out" "$folder/err" >"$folder/why"
    [ $code -eq 0 ] && case $2 in
    *--quiet* | *' -q'* | *--new* | *'>'*) ;;
    beamrate*) [ "$(wc -w <"$folder/why")" -ge 10 ] ;;
    esac && ! grep -qiw nan "$folder/why"
    report $? "${1##*/}: $2"
}

# Where a list has the command.
where() { # COMMAND LIST
    line=$1 awk -F '\t' '$3 == ENVIRON["line"] { print $2 }' "$2"
}

compare_shown() { # COMMAND
    where "$1" "$folder/shown" >"$folder/pages"
    cat "$folder/out" "$folder/err" >"$folder/today"
    while read -r page; do
        awk -v command="$1" -f "$here/shown.awk" "$folder/today" "$page" >"$folder/renewed" 2>"$folder/why"
        same=$?
        if [ $same -ne 0 ] && [ $mode = update ]; then
            cat "$folder/renewed" >"$page"
            awk -v command="$1" -f "$here/shown.awk" "$folder/today" "$page" >"$folder/renewed" 2>"$folder/why"
            same=$?
        fi
        report $same "${page##*/} shows: $1"
    done <"$folder/pages"
}

# Examples that are this command, which has run.
compare_the_same() { # COMMAND
    where "$1" "$folder/examples" >"$folder/places"
    while read -r place; do compare_example "$place" "$1"; done <"$folder/places"
    compare_shown "$1"
}

# ---- the comparisons themselves ----

compare() {
    echo "$1" >"$folder/old"; echo "$2" >"$folder/new"
    awk -v tolerance="${3:-}" -v round_off="${4:-}" -v counts="${5:-}" -f "$here/compare.awk" "$folder/old" "$folder/new" \
        >/dev/null && same="$same $1=$2"
}

echo "TAP version 13"
same=
compare 1.50000000000 1.50000000100; compare 1.50000000000 1.50000001000
compare 1.50000000000 1.50000001000 1e-6; compare 3e-14 4e-14; compare 3e-14 4e-14 '' yes; compare 3e-14 -3e-14
compare 3e-14 3e-12 '' yes; compare 3e-14 nan '' yes; compare 3e-14 -nan; compare 3e-12 0.0 '' yes
compare '7e-11 %' '1e-10 %' '' yes; compare 7e-11 1e-10 '' yes; compare 7 8; compare 0.0 1e-16
compare '< 4e-17 m' '2.4e-17 m' '' yes; compare '< 4e-17' 2.4e-17
compare 40 43 '' '' yes; compare 40 45 '' '' yes; compare 10 11 '' '' yes; compare 101 99 '' '' yes; compare 40 43
compare 0.0 1e-16 '' yes; compare 2.5000000001e-13 2.5000000002e-13
echo "$same" >"$folder/why"
[ "$same" = ' 1.50000000000=1.50000000100 1.50000000000=1.50000001000 3e-14=4e-14 3e-14=4e-14 7e-11 %=1e-10 % 0.0=1e-16 < 4e-17 m=2.4e-17 m 40=43 101=99 0.0=1e-16 2.5000000001e-13=2.5000000002e-13' ]
report $? comparison
printf 'ran on avx2:\n  a  1.50  in  2e-14 of\nb 2\nthe long\nend\n' >"$folder/today"
same=
for shown in 'a 1.50' 'a 1.51' 'b 3' 'b 2 the' 'b 2|a 1.50' 'a 1.50|b 2' '...' 'ran on ...' 'in 9e-14' 'in -2e-14' \
    'in 9e-13' 'in nan' 'ran on avx' 'the|long end' 'the long end more' 'ran on 2:'; do
    echo '```text|$ beamrate x|'"$shown"'|```' | tr '|' '\n' >"$folder/page"
    awk -v command='beamrate x' -f "$here/shown.awk" "$folder/today" "$folder/page" >"$folder/why" 2>&1 && same="$same $shown,"
done
echo "$same" >"$folder/why"
[ "$same" = ' a 1.50, b 2 the, a 1.50|b 2, ..., ran on ..., in 9e-14, in -2e-14, the|long end,' ]
report $? "comparison of what is shown"
printf '==== a\n1\n2\n3\n4\n' >"$folder/first"
same=
for text in '1|2|3' '1|2' '2|3|4' '==== b|x|1|2|3|4||1|2|3|x|1|2|3' 'x|||y'; do
    echo "$text" | tr '|' '\n' >"$folder/whole"
    awk -f "$here/fold.awk" "$folder/first" "$folder/whole" >"$folder/folded"
    awk -f "$here/unfold.awk" "$folder/first" "$folder/folded" | cmp -s - "$folder/whole" || echo "not unfolded: $text"
    same="$same $(tr '\n' '&' <"$folder/folded")"
done >"$folder/why"
echo "$same" >>"$folder/why"
[ "$same" = ' [lines 1 to 3 of a]& 1&2& [lines 2 to 4 of a]& ==== b&x&[lines 1 to 4 of a]&&[lines 1 to 3 of a]&[lines 1 to 4 of b]& x&[2 empty lines]&y&' ]
report $? folding
printf '# t\n\n# index 0: a\n# x | y\n1 2 -\n3 4 s\n\n\n# index 1: b\n# x | y\n5 6 -\n' |
    awk -f "$here/digest.awk" >"$folder/why"
[ "$(tr '\n' '&' <"$folder/why")" = '# t&1 empty, # index 0: a x | y: 2 points, sums 7 10, - s&2 empty, # index 1: b =: 1 points, sums 5 6&' ]
report $? digest

# ---- rows, and what pages show ----

while IFS="$tab" read -r name marks command files; do
    run "$command"
    compare_row "$name" "$marks" "$files"
    compare_the_same "$command"
done <"$folder/rows"
if [ $mode = rows ] || [ $mode = update ]; then
    [ $mode = rows ] && kind=shown || kind=
    cut -f 3 "$folder/all_rows" >"$folder/known_rows"
    grep "^$kind" "$folder/shown" | cut -f 3 | grep -vxFf "$folder/known_rows" | uniq >"$folder/lines"
    while IFS= read -r line; do
        run "$line"
        compare_the_same "$line"
    done <"$folder/lines"
fi

# Numbers of what is stored, derived from others of it.
if [ $mode != rest ]; then
    set -- "$here/held.txt"
    for stored in "$here"/*.txt; do
        case $stored in */held.txt | */commands.txt) ;; *) set -- "$@" "$stored" ;; esac
    done
    awk -f "$here/derive.awk" "$@" >"$folder/why"
    report $? "derived numbers"
fi

# ---- all other examples ----

# unless TEXT WITHOUT WITHOUT WORDS: adds the words to a line that has the text and neither of two
# others. Those that the suite runs elsewhere are asked for their help, which reads the options.
unless() {
    case $line in
    *"$2"* | *"$3"*) ;;
    *"$1"*) line="$line $4" ;;
    esac
}

shorten() {
    unless 'beamrate tables' ' --n ' ' -n ' '--n 5,10 --k 0.1,0.05 --reference fine:20,0.05'
    unless ' --split --methods' ' --help' ' -h ' --help
    unless ' --split' ' --n ' ' -n ' '--n 10'
    case $line in
    *' --error 1e'* | *' --seconds '*)
        unless 'beamrate trade' ' --methods' ' --help' '--methods euler+implicit,adaptive+p2' ;;
    *.csv* | *--trust*) ;;
    *) unless 'beamrate trade' ' --n ' ' -n ' '--n 10 --k 0.1,0.05 --methods euler,bdf2' ;;
    esac
    unless 'beamrate extremes' ' --help' ' -h ' --help
    unless 'beamrate figures' ' --help' ' -h ' --help
    unless ' 1e-4 --check' ' --help' ' -h ' --help
    for command in tables study trade; do
        unless "beamrate $command" ' --no-plots' ' --help' --no-plots
    done
}

# What the examples take for granted, and one scene for --all.
prepare() {
    mkdir -p "$folder/few/study/scenes"
    cp "$BEAMRATE_DATA"/study/scenes/example3.yaml "$folder/few/study/scenes"
    cd "$folder/files" && cc -o poisson poisson.c -lm &&
        beamrate scenes example3 >my_scene.yaml &&
        beamrate check my_scene.yaml --quiet --json old.json && cp old.json orders-of-last-month.json &&
        beamrate study example2 -n 4,8,16 -k 0.1,0.05,0.025 --no-plots --quiet
}

# In a copy of the folder; a scene that is to be made is not there yet.
run_example() {
    rm -rf "$folder/work" && cp -a "$folder/files" "$folder/work" && cd "$folder/work" || exit 99
    case $line in *--new*) rm my_scene.yaml ;; esac
    (
        case $line in *--all*) export BEAMRATE_DATA="$folder/few" ;; esac
        beamrate=beamrate sh -c "$line"
    ) >../out 2>../err </dev/null
    code=$?
}

# Every scene and study file that is printed or lies in docs/orders/ passes its check, in an example or here.
check_files() {
    cd "$folder/files" || exit 99
    for scene in *.yaml; do
        ! grep -q " check $scene" "$folder/others" || continue
        needs=$(sed -n 's/^# needs \([^ ]*\).*/\1/p' "$scene")
        if [ "$needs" ] && ! command -v "$needs" >/dev/null; then
            report 0 "left out, $needs is not installed: $scene"
        else
            beamrate check "$scene" --trust >"$folder/why" 2>&1 </dev/null
            report $? "check $scene"
        fi
    done
}

if [ $mode = rest ]; then
    : "${PROGRAM:?is the program itself}"
    ln -sf "$PROGRAM" "$folder/bin/beamrate"
    ln -sf "$(dirname "$PROGRAM")/beamrate-orders" "$folder/bin/beamrate-orders"
    PATH=$folder/bin:$PATH
    (prepare) >"$folder/why" 2>&1 || report 1 preparation
    grep '^later' "$folder/shown" | cat - "$folder/examples" >"$folder/all"
    awk -F '\t' 'NR == FNR { known[$0] = 1; next } !($3 in known) && !seen[$3]++' "$folder/known" "$folder/all" >"$folder/others"
    while IFS="$tab" read -r how where line; do
        case $line in
        mpirun*) report 0 "left to test_ranks: $line" && continue ;;
        esac
        case $how in long) line="$line --help" ;; short) shorten ;; esac
        run_example
        compare_example "$where" "$line"
        [ "$how" != later ] || compare_shown "$line"
    done <"$folder/others"
    check_files
    [ "$(wc -l <"$folder/others")" -gt 70 ] && [ "$(wc -l <"$folder/shown")" -ge 6 ]
    report $? "pages have been read"
fi
echo "1..$number"
[ $failed -eq 0 ] || { echo "# where the new output is right: ./bootstrap update"; exit 1; }
