#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Every example that the program's help, the README and the pages of docs/ print works as it stands.
# $BEAMRATE is the program, beside it is beamrate-orders, $BEAMRATE_DATA is the source tree.
#
# A block of a page that begins with ```sh is run line by line. One that begins with ```sh long would
# take minutes: of its lines only the command and the names of the options are tried. A block of YAML
# whose first line is a remark that begins with NAME.yaml is that file, and passes 'check'; the first
# line of any other one is a remark that begins with "part". A file that says "# needs PROGRAM" is
# checked where that program is. A block of text begins with "$ COMMAND", and shows lines of what that
# prints (shown.awk).
# usage: examples.sh [--update]     --update writes the numbers of these blocks anew
set -u
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/beamrate examples XXXXXX") || exit 99
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 99
mkdir bin files few few/study few/study/scenes
ln -s "$BEAMRATE" bin/beamrate
ln -s "$(dirname "$BEAMRATE")/beamrate-orders" bin
PATH=$work/bin:$PATH
export PATH

# ---- what is printed: how, where and which line, once each ----

# pages NAME FILE...: those of one page, or of several. One that ends with a backslash goes on in the
# next; of a variable that holds the program the $ is left out, and a remark, which would swallow what
# is added to the line.
pages() {
    awk -v mode="$1" -v at="$2" -v scenes="$work/files/" '
        FNR == 1 && mode == "page" { at = FILENAME; how = ""; inside = 0 }
        mode == "help" { how = "short" }
        /^```/ && mode == "page" {
            inside = !inside
            how = $0 == "```sh" ? "short" : $0 == "```sh long" ? "long" : substr($0, 4)
            file = whole = ""
            first = 1
            next
        }
        first && inside && (how == "" || how == "text") {
            sub(/^\$ /, "")
            print (/^beamrate(-orders)? / ? "shown\t" at "\t" $0 : "bad\t" at "\techo line " FNR ": no command")
        }
        how == "yaml" && first && /^# [a-z_]+\.yaml/ { file = scenes $2; sub(/\.yaml.*/, ".yaml", file) }
        how == "yaml" && first && !file && !/^# part/ { print "bad\t" at "\techo line " FNR ": YAML without a name" }
        { first = 0 }
        how == "yaml" && file { print >file }
        how != "short" && how != "long" { next }
        {
            sub(/^ */, "")
            if (whole == "" && !/^(\$?beamrate(-orders)?|mpirun|cc) /)
                next
            whole = whole $0
            if (sub(/\\$/, "", whole))
                next
            sub(/ # .*/, "", whole)
            sub(/^\$/, "", whole)
            sub(/ *$/, "", whole)
            print how "\t" at "\t" whole
            whole = ""
        }' "$3"
}

commands=$(beamrate --help | sed -n '/^Commands:/,/^$/s/^  \([a-z][a-z]*\) .*/\1/p')
{
    beamrate --help | pages help --help -
    for command in $commands; do
        beamrate "$command" --help >help || echo "bad	$command	--help fails"
        grep -q '^  beamrate ' help || echo "bad	$command	--help has no example"
        pages help "$command" help
    done
    for page in "$BEAMRATE_DATA"/README.md "$BEAMRATE_DATA"/docs/*.md; do
        pages page '' "$page"
    done
} >all
grep -v '^shown' all | awk -F '\t' '!seen[$3]++' >examples
grep '^shown' all | sort -t '	' -k 3 >shown

# ---- running them ----

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

# What the examples take for granted, one scene for --all, and the files of docs/orders/ and docs/trade/.
cp "$BEAMRATE_DATA"/study/scenes/example3.yaml few/study/scenes
(
    cd files && cp "$BEAMRATE_DATA"/docs/orders/* "$BEAMRATE_DATA"/docs/trade/*.csv . &&
        cc -o poisson poisson.c -lm &&
        beamrate scenes example3 >my_scene.yaml &&
        beamrate check my_scene.yaml --quiet --json old.json && cp old.json orders-of-last-month.json &&
        beamrate study example2 -n 4,8,16 -k 0.1,0.05,0.025 --no-plots --quiet
) >output 2>&1 || { cat output; exit 99; }

# What the line has printed says something, and no number in it is nan.
speaks() {
    case $line in
    *--quiet* | *' -q'* | *--new* | *'>'*) ;;
    beamrate*) [ "$(wc -w <output)" -ge 10 ] || { echo "# it printed next to nothing"; return 1; } ;;
    esac
    ! grep -niw nan output | sed 's/^/# /' | grep .
}

update=
[ "${1:-}" = --update ] && update=yes && : >examples

# In a copy of the folder; a scene that is to be made is not there yet.
number=0
while IFS='	' read -r how origin line; do
    number=$((number + 1))
    case $line in
    mpirun*) # left to test_ranks
        echo "ok $number - left to test_ranks: $line"
        continue
        ;;
    esac
    if [ "$how" = long ]; then line="$line --help"; else shorten; fi
    rm -rf here && cp -a files here
    case $line in *--new*) rm here/my_scene.yaml ;; esac
    (
        cd here && case $line in *--all*) export BEAMRATE_DATA="$work/few" ;; esac
        beamrate=beamrate sh -c "$line"
    ) >output 2>&1 </dev/null && [ "$how" != bad ] && speaks && echo "ok $number - ${origin##*/}: $line" &&
        continue
    echo "not ok $number - ${origin##*/}: $line"
    sed 's/^/# /' output
done <examples
# What pages show of an output is what it is today. First of all: what is seen to differ?
printf 'ran on avx2:\n  a  1.50  in  2e-14 of\nb 2\nthe long\nend\n' >today
seen=
for shown in 'a 1.50' 'a 1.51' 'b 3' 'b 2 the' 'b 2|a 1.50' 'a 1.50|b 2' '...' 'ran on ...' 'in 9e-14' 'in -2e-14' \
    'in 9e-13' 'in nan' 'ran on avx' 'the|long end' 'the long end more' 'ran on 2:'; do
    echo '```text|$ beamrate x|'"$shown"'|```' | tr '|' '\n' >page
    awk -v command='beamrate x' -f "$here/shown.awk" today page >output 2>&1 && seen="$seen $shown,"
done
number=$((number + 1))
[ "$seen" = ' a 1.50, b 2 the, a 1.50|b 2, ..., ran on ..., in 9e-14, in -2e-14, the|long end,' ] || echo "not \c"
echo "ok $number - comparison of what is shown"
ran=
while IFS='	' read -r how page line; do
    number=$((number + 1))
    if [ "$line" != "$ran" ]; then
        rm -rf here && cp -a files here
        (cd here && sh -c "$line") >today 2>&1 </dev/null
        ran=$line
    fi
    if awk -v command="$line" -f "$here/shown.awk" today "$page" >renewed 2>output; then
        echo "ok $number - ${page##*/} shows: $line"
        continue
    fi
    echo "not ok $number - ${page##*/} shows: $line"
    sed 's/^/# /' output
    [ "$update" ] && cat renewed >"$page"
    echo "# other numbers: ./bootstrap update; other words: by hand"
done <shown
[ "$update" ] && exit
# Every scene and study file that is printed or lies in docs/orders/ passes its check.
for scene in files/*.yaml; do
    number=$((number + 1))
    needs=$(sed -n 's/^# needs \([^ ]*\).*/\1/p' "$scene")
    if [ "$needs" ] && ! command -v "$needs" >/dev/null; then
        echo "ok $number - left out, $needs is not installed: ${scene##*/}"
    elif (cd files && beamrate check "${scene##*/}" --trust) >output 2>&1 </dev/null; then
        echo "ok $number - check ${scene##*/}"
    else
        echo "not ok $number - check ${scene##*/}"
        sed 's/^/# /' output
    fi
done
echo "1..$number"
[ "$(wc -w <examples)" -gt 100 ] && [ "$(wc -l <shown)" -ge 6 ]
