#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Every link between pages leads to a file, and to a heading where it names one; every file that a
# page names in backquotes with its folder is there; so is every br_name in backquotes, in a header or
# source; and every test is built. usage: links.sh ROOT
set -u
root=$1
failures=0

complain() {
    echo "$1: $2" >&2
    failures=$((failures + 1))
}

# The anchors of a page, as GitHub makes them of its headings.
anchors() {
    sed -n '/^```/,/^```/d; s/^##* //p' "$1" | tr 'A-Z' 'a-z' | sed "s/[^a-z0-9 _-]//g; s/ /-/g"
}

# The targets of a page's links.
targets() {
    sed '/^```/,/^```/d' "$1" | grep -o '](\([^)]*\))' | sed 's/^](//; s/)$//'
}

# What stands in backquotes and begins with one of our folders.
names() {
    sed '/^```/,/^```/d' "$1" | grep -o '`[^` ]*`' | tr -d '`' |
        grep -E '^(base|orders|solver|reference|study|tables|plots|cli|tests|docs)/[a-z0-9_/.-]*$'
}

# Functions, types and arrays of ours in backquotes.
symbols() {
    sed '/^```/,/^```/d' "$1" | grep -o '`br_[a-z0-9_]*`' | tr -d '`' | sort -u
}

check_link() { # PAGE TARGET
    case $2 in
    http://* | https://* | mailto:*) return ;;
    esac
    file=${2%%#*}
    path=$root/$(dirname "$1")/$file
    [ -n "$file" ] || path=$root/$1
    if [ ! -e "$path" ]; then
        complain "$1" "no such file: $2"
    elif [ "$file" != "$2" ] && ! anchors "$path" | grep -qxF -- "${2#*#}"; then
        complain "$1" "no such heading: $2"
    fi
}

pages=0
for page in "$root"/*.md "$root"/docs/*.md "$root"/docs/decisions/*.md "$root"/solver/*.md; do
    page=${page#"$root"/}
    pages=$((pages + 1))
    for target in $(targets "$root/$page"); do
        check_link "$page" "$target"
    done
    [ "$page" != CHANGELOG.md ] || continue # tells of files that were
    for name in $(names "$root/$page"); do
        [ -e "$root/$name" ] || complain "$page" "no such file: $name"
    done
    for name in $(symbols "$root/$page"); do
        grep -rqw --include='*.[ch]' "$name" "$root/base" "$root/orders" "$root/solver" "$root/reference" "$root/study" \
            "$root/tables" "$root/plots" "$root/cli" || complain "$page" "no such name: $name"
    done
done
for test in "$root"/tests/test_*.c; do
    name=$(basename "$test" .c)
    name=${name#test_}
    grep -qE "'(test_)?($name|${name#exact_})['.]" "$root/tests/meson.build" ||
        complain tests/meson.build "no test: $name"
done
[ $pages -gt 10 ] || complain links.sh "only $pages pages in $root"
[ "$failures" -eq 0 ] || exit 1
