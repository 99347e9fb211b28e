#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: sentences.sh FOLDER
#
# What the program can print: the string literals of the product in FOLDER that have four words or more. The
# test fails if one of them, or a page, has a phrase that readers did not understand.
set -eu
export LC_ALL=C
cd "$1"
list=$(mktemp)
trap 'rm "$list"' EXIT

# A line each: the file, a tabulator, the literal as it is written; literals that follow each other are one.
# Scripts of gnuplot and styles of pages are left out.
# shellcheck disable=SC2016 # of awk
find base orders solver reference study tables plots cli -name '*.[ch]' | sort | xargs awk '
function flush(    rest, words, letters) {
    rest = text
    gsub(/%[-+ #0-9.*]*[a-zA-Z]|\\[a-z]/, " ", rest)
    words = gsub(/[A-Za-z][a-z]+/, "&", rest)
    letters = gsub(/[A-Za-z ]/, "&", rest)
    if (words >= 4 && letters >= 0.7 * length(text) && text !~ /unset |lc rgb|sprintf\(|var\(|set [a-z ]* %/)
        print FILENAME "\t" text
    text = ""
}
FNR == 1 { text = "" }
/^[ \t]*#[ \t]*include/ { next }
{
    line = $0
    if (comment && !(end = index(line, "*/")))
        next
    if (comment)
        line = substr(line, end + 2)
    comment = 0
    while (match(line, /^[ \t\\]*("([^"\\]|\\.)*"|'"'([^'\\\\]|\\\\.)*'"'|\/\*|PRI[a-zA-Z0-9]+|[A-Za-z_0-9]+|[^ \t])/)) {
        token = substr(line, 1, RLENGTH)
        line = substr(line, RLENGTH + 1)
        sub(/^[ \t\\]+/, "", token)
        if (token == "/*") {
            comment = !(end = index(line, "*/"))
            line = comment ? "" : substr(line, end + 2)
        } else if (token ~ /^"/)
            text = text substr(token, 2, length(token) - 2)
        else if (token !~ /^PRI/ && text != "")
            flush()
    }
}' >"$list"
[ "$(wc -l <"$list")" -ge 500 ] || { echo "found too few sentences" && exit 1; }

# Private words and riddles.
unclear='heeds?\b|[Jj]udged by|[Nn]obody asks|lost in what|waits for an|point against|cells alone|\bis told\b|do not see\b|as in theory\b|All .* cells count|Own error is about|[Oo]ut come|the dearest|the whole is .* of the sum'
status=0
grep -nE "$unclear" README.md docs/*.md && status=1
grep -nE "$unclear|	.*\b([Jj]udges?|tells?|told)\b" "$list" && status=1
[ $status = 0 ] || echo "these phrases are hard to understand: see tests/sentences.sh"
exit $status
