#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Who includes whom: a folder includes itself and folders below it, nothing includes tests/, and no
# file includes itself through others. base/ knows no one; solver/ and orders/ know base/ alone.
# tables/, plots/ and cli/ know nothing of the beam, but for their folders beam/ and the program that
# has it. Rooms of study/ include what `rooms` says and no more, and docs/architecture.md shows this
# list. No tag br_... is defined twice, in tests/ neither. It first tries small trees with mistakes,
# which it must find.
# usage: includes.sh ROOT [--draw]    --draw: prints the list for the docs, and does nothing else
set -u

# A folder: what its files may include, and with a - what of that they may not. Of the file and the
# folders above it the deepest one that stands here counts. The exact solution checks the solver, so
# it takes only the scene and the form of a solution from it (docs/architecture.md).
rules='
base: base/
orders: base/ orders/ version.h
solver: base/ solver/
reference: base/ solver/ reference/
study: base/ orders/ solver/ reference/ study/
tables: base/ orders/ tables/ -tables/beam/
plots: base/ orders/ plots/ -plots/beam/
tables/beam: base/ orders/ solver/ reference/ study/ tables/
plots/beam: base/ orders/ solver/ reference/ study/ plots/
cli: base/ orders/ tables/ plots/ cli/ build_info.h -tables/beam/ -plots/beam/ -cli/beam/
cli/beam: base/ orders/ solver/ reference/ study/ tables/ plots/ cli/
cli/main.c: cli/
reference/exact: solver/box.h base/clock.h solver/function.h solver/kind.h solver/modes.h solver/proof.h solver/scene.h
reference/exact: base/blas.h base/status.h solver/instruction_set.h solver/vectors.h reference/
'

# The rooms of study/. Each includes only rooms that stand above it here.
rooms='
known:
scene: known
grid: scene
fit: grid
ranks: grid
run:
estimate: grid run
verify: fit grid scene
trade: estimate fit grid scene
extremes: run scene
paper: grid run scene
'

# The list as docs/architecture.md has it.
graph=$(echo "$rooms" | awk -F ': *' '$1 != "" { printf "    %-9s %s\n", $1, $2 }' | sed 's/ *$//')
if [ "${2-}" = --draw ]; then
    echo "$graph"
    exit 0
fi

# Prints each mistake of the tree in ROOT; at the end, how many files it has read. WHOLE: each arrow
# of `rooms` must have an include.
draw() { # ROOT [WHOLE]
    (cd "$1" && find base orders solver reference study tables plots cli -name '*.[ch]' 2>/dev/null | sort) |
        awk -v root="$1/" -v rules="$rules" -v rooms="$rooms" -v whole="${2-}" '
function allows(folder, target,    i, allowing) {
    for (i = 1; i <= allowed[folder]; i++) {
        if (index("-" target, may[folder, i]) == 1)
            return 0
        allowing = allowing || index(target, may[folder, i]) == 1
    }
    return allowing
}

# Between two rooms of study/ there must be an arrow.
function check_rooms(file, target,    from, to) {
    split(file, from, "/")
    split(target, to, "/")
    if (from[1] != "study" || to[1] != "study" || from[2] == to[2])
        return
    if (!(from[2] in place))
        print file ": study/" from[2] "/ is no room of the list"
    else if (!((from[2], to[2]) in arrow))
        print file " -> " target ": study/" from[2] "/ may not include this"
    used[from[2], to[2]] = 1
}

# The file, or the deepest folder above it, that has a rule must allow the target.
function check(file, target,    folder) {
    check_rooms(file, target)
    folder = file
    while (!(folder in allowed) && sub("/[^/]*$", "", folder))
        ;
    if (folder in allowed && !allows(folder, target))
        print file " -> " target ": " folder "/ may not include this"
}

function read_includes(file,    line) {
    while ((getline line < (root file)) > 0)
        if (sub(/^[ \t]*#[ \t]*include[ \t]*/, "", line) &&
            (line ~ /^"/ || line ~ /^<(solver|reference|study|tables|plots|cli|tests)\//)) {
            line = substr(line, 2)
            sub(/[">].*/, "", line)
            check(file, line)
            target[file, ++targets[file]] = line
        }
    close(root file)
}

# Depth first. seen: 1 on the path to here, 2 done.
function follow(file, path,    i, next_file) {
    seen[file] = 1
    for (i = 1; i <= targets[file]; i++) {
        next_file = target[file, i]
        if (seen[next_file] == 1)
            print "circle: " substr(path, index(path, " " next_file " ") + 1) "-> " next_file
        else if (!seen[next_file])
            follow(next_file, path "-> " next_file " ")
    }
    seen[file] = 2
}

BEGIN {
    for (count = split(rules, line_of, "\n"); count > 0; count--) {
        words = split(line_of[count], word, /:? /)
        for (i = 2; i <= words; i++)
            may[word[1], ++allowed[word[1]]] = word[i]
    }
    count = split(rooms, line_of, "\n")
    for (l = 1; l <= count; l++) {
        words = split(line_of[l], word, /:? /)
        sub(":", "", word[1])
        for (i = 2; i <= words; i++) {
            if (!(word[i] in place))
                print "the list: " word[i] " does not stand above " word[1]
            arrow[word[1], word[i]] = 1
        }
        place[word[1]] = l
    }
}
{ file_of[NR] = $0; read_includes($0) }
END {
    for (f = 1; f <= NR; f++)
        if (!seen[file_of[f]])
            follow(file_of[f], " " file_of[f] " ")
    for (pair in arrow)
        if (whole && !(pair in used)) {
            split(pair, word, SUBSEP)
            print "the list: no file of study/" word[1] "/ includes study/" word[2] "/ any more"
        }
    print NR " files"
}'
}

# Prints each tag br_... of the tree in ROOT that two files, or two places of one, define.
twice() { # ROOT
    (cd "$1" && find base orders solver reference study tables plots cli tests -name '*.[ch]' 2>/dev/null |
        xargs sed -n -E 's/^ *(static |const |typedef )*(struct|union|enum) (br_[a-z0-9_]+) *\{.*/\3/p' |
        sort | uniq -d)
}

# ---- the small trees ----

tree=$(mktemp -d) || exit 1
trap 'rm -rf "$tree"' EXIT
failures=0

# FILE INCLUDED: adds a file that includes another one to the small tree.
plant() {
    mkdir -p "$tree/$(dirname "$1")"
    echo "#include \"$2\"" >> "$tree/$1"
}

# What draw must print of the small tree, which is then empty again.
expect() { # TEXT
    got=$(draw "$tree")
    if [ "$got" != "$1" ]; then
        printf 'expected of the small tree:\n%s\nfound:\n%s\n' "$1" "$got" >&2
        failures=$((failures + 1))
    fi
    rm -rf "${tree:?}"/*
}

plant solver/linear/a.c solver/b.h
plant reference/exact/a.c solver/scene.h
plant reference/a.c solver/b.h
plant study/grid/a.c reference/a.h
plant tables/a.c orders/a.h
plant tables/beam/a.c study/a.h
plant tables/beam/a.c tables/a.h
plant plots/a.c plots/b.h
plant plots/beam/a.c solver/b.h
plant cli/a.c plots/a.h
plant cli/a.c build_info.h
plant cli/main.c cli/beam/a.h
plant cli/beam/a.c plots/beam/a.h
expect '11 files'

for upward in 'base/a.c orders/a.h' 'orders/a.c solver/a.h' 'solver/a.c orders/a.h' 'solver/a.c reference/a.h' 'reference/a.h study/a.h' 'study/x/a.c tables/a.h' \
    'tables/a.c plots/a.h' 'tables/a.c study/a.h' 'tables/a.c solver/a.h' 'tables/a.c tables/beam/a.h' \
    'plots/a.c tables/a.h' 'plots/a.c study/a.h' 'plots/a.c solver/a.h' 'plots/a.c plots/beam/a.h' \
    'tables/beam/a.c plots/a.h' 'tables/beam/a.c plots/beam/a.h' 'plots/beam/a.c tables/a.h' \
    'tables/beam/a.c cli/a.h' 'plots/beam/a.c cli/a.h' 'cli/a.c tests/a.h' \
    'cli/a.c study/a.h' 'cli/a.c tables/beam/a.h' 'cli/a.c plots/beam/a.h' 'cli/a.c cli/beam/a.h' \
    'cli/beam/a.c tests/a.h' \
    'solver/a.c ../study/a.h' 'solver/a.c a.h'; do
    folder=${upward%/* *}
    plant "${upward% *}" "${upward#* }"
    expect "${upward% *} -> ${upward#* }: ${folder%/x}/ may not include this
1 files"
done

# Every arrow between rooms that points up the list, and every one of the list.
above=
upward=
for room in $(echo "$rooms" | sed 's/:.*//'); do
    for other in $above; do
        plant "study/$other/to_$room.c" "study/$room/a.h"
        upward="$upward
study/$other/to_$room.c -> study/$room/a.h: study/$other/ may not include this"
    done
    above="$above $room"
done
expect "$(echo "$upward" | sed 1d | sort)
55 files"
for arrow in $(echo "$rooms" | awk -F ': *' '{ split($2, to, " "); for (i in to) print $1 "/" to[i] }'); do
    plant "study/${arrow%/*}/to_${arrow#*/}.c" "study/${arrow#*/}/a.h"
done
expect "$(echo "$rooms" | sed 's/.*://' | wc -w) files"

plant study/attic/a.c study/known/a.h
expect 'study/attic/a.c: study/attic/ is no room of the list
1 files'

mkdir -p "$tree/solver" "$tree/tests"
printf 'struct br_a {\nstruct br_b *b;\nenum br_c { C };\n' > "$tree/solver/a.h"
printf 'static const struct br_c { int c; } one;\nstruct br_a;\n' > "$tree/tests/b.c"
[ "$(twice "$tree")" = br_c ] || { echo "a tag with two meanings was not found" >&2; failures=$((failures + 1)); }
rm -rf "${tree:?}"/*

right=$rooms
rooms=$(echo "$rooms" | sed 's/^scene: .*/& grid/')
plant study/scene/a.c study/grid/a.h
expect 'the list: grid does not stand above scene
1 files'
rooms='
known:
scene: known
'
plant study/scene/a.c solver/a.h
plant study/scene/b.c study/scene/a.h
found=$(draw "$tree" whole)
expect '2 files'
[ "$found" = 'the list: no file of study/scene/ includes study/known/ any more
2 files' ] || { echo "an arrow without an include was not found: $found" >&2; failures=$((failures + 1)); }
rooms=$right

plant reference/exact/a.c solver/field.h
expect 'reference/exact/a.c -> solver/field.h: reference/exact/ may not include this
1 files'

plant solver/a.c solver/b.h
plant solver/b.h solver/c.h
plant solver/c.h solver/d.h
plant solver/d.h solver/b.h
expect 'circle: solver/b.h -> solver/c.h -> solver/d.h -> solver/b.h
4 files'

plant solver/a.h solver/a.h
expect 'circle: solver/a.h -> solver/a.h
1 files'

# ---- the tree ----

found=$(draw "$1" whole)
mistakes=$(echo "$found" | sed '$d')
files=$(echo "$found" | sed '$!d; s/ files//')
[ -z "$mistakes" ] || echo "$mistakes" >&2
[ "$files" -gt 280 ] || echo "only $files files in $1" >&2
shown=$(awk '/^    known$/ { on = 1 } on && !NF { exit } on' "$1/docs/architecture.md")
if [ "$shown" != "$graph" ]; then
    echo "docs/architecture.md: the rooms of study/ differ from tests/includes.sh --draw:" >&2
    printf '%s\n' "$graph" >&2
    failures=$((failures + 1))
fi
# The path to a cell of a table: no more than 12 files, none longer than 250 lines.
path=$(sed -n '/^## From a scene/,/^Other files/s/^[0-9]*\. \*\*.* in `\([^`]*\.c\)`).*/\1/p' \
    "$1/docs/architecture.md" | sort -u)
long=$(cd "$1" && LC_ALL=C wc -l $path 2>&1 | awk '!($1 <= 250) && $2 != "total"')
if [ "$(echo "$path" | wc -l)" != 12 ] || [ -n "$long" ]; then
    echo "docs/architecture.md: the path to a cell must have 12 files of at most 250 lines:" >&2
    printf '%s\n' "${long:-$path}" >&2
    failures=$((failures + 1))
fi
tags=$(twice "$1")
[ -z "$tags" ] || { echo "tags with two meanings:" $tags >&2; failures=$((failures + 1)); }
[ -z "$mistakes" ] && [ "$files" -gt 280 ] && [ "$failures" -eq 0 ]
