#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Who includes whom: a room includes itself and rooms below it, nothing includes tests/, and no file
# includes itself through others. It first draws small trees with one mistake each, which it must
# find. usage: includes.sh ROOT
set -u

# A folder: what its files may include. The exact solution judges the solver, so it takes only the
# scene and the form of a solution from it (docs/architecture.md).
rules='
solver: solver/
reference: solver/ reference/
study: solver/ reference/ study/ version.h
tables: solver/ reference/ study/ tables/
plots: solver/ reference/ study/ plots/
cli: solver/ reference/ study/ tables/ plots/ cli/ build_info.h
reference/exact: solver/clock.h solver/function.h solver/modes.h solver/proof.h solver/scene.h
reference/exact: solver/status.h solver/instruction_set.h solver/vectors.h reference/
'

# Prints each mistake of the tree in ROOT; at the end, how many files it has read.
draw() { # ROOT
    (cd "$1" && find solver reference study tables plots cli -name '*.[ch]' 2>/dev/null | sort) |
        awk -v root="$1/" -v rules="$rules" '
function allows(folder, target,    i) {
    for (i = 1; i <= allowed[folder]; i++)
        if (index(target, may[folder, i]) == 1)
            return 1
    return 0
}

# Each folder above the file that has a rule must allow the target.
function check(file, target,    folder) {
    folder = file
    while (sub("/[^/]*$", "", folder))
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
}
{ file_of[NR] = $0; read_includes($0) }
END {
    for (f = 1; f <= NR; f++)
        if (!seen[file_of[f]])
            follow(file_of[f], " " file_of[f] " ")
    print NR " files"
}'
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
plant tables/a.c study/a.h
plant plots/a.c solver/b.h
plant cli/a.c plots/a.h
plant cli/a.c build_info.h
expect '7 files'

for upward in 'solver/a.c reference/a.h' 'reference/a.h study/a.h' 'study/x/a.c tables/a.h' \
    'tables/a.c plots/a.h' 'plots/a.c tables/a.h' 'plots/a.c cli/a.h' 'cli/a.c tests/a.h' \
    'solver/a.c ../study/a.h' 'solver/a.c a.h'; do
    plant "${upward% *}" "${upward#* }"
    expect "${upward% *} -> ${upward#* }: ${upward%%/*}/ may not include this
1 files"
done

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

found=$(draw "$1")
mistakes=$(echo "$found" | sed '$d')
files=$(echo "$found" | sed '$!d; s/ files//')
[ -z "$mistakes" ] || echo "$mistakes" >&2
[ "$files" -gt 280 ] || echo "only $files files in $1" >&2
[ -z "$mistakes" ] && [ "$files" -gt 280 ] && [ "$failures" -eq 0 ]
