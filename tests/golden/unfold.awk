# SPDX-License-Identifier: GPL-3.0-or-later
# usage: awk -f unfold.awk FIRST STORED: prints what fold.awk has folded.
function put(text) {
    if (text ~ /^==== /) {
        part = substr(text, 6)
        lines = 0
    }
    else
        line[part, ++lines] = text
    if (FILENAME != ARGV[1])
        print text
}

FILENAME == ARGV[1] { put($0); next }
/^\[lines [0-9]+ to [0-9]+ of .*\]$/ {
    of = $0
    sub(/^\[lines [0-9]+ to [0-9]+ of /, "", of)
    sub(/\]$/, "", of)
    for (i = $2 + 0; i <= $4 + 0; i++)
        put(line[of, i])
    next
}
/^\[[0-9]+ empty lines\]$/ {
    for (i = substr($1, 2) + 0; i > 0; i--)
        put("")
    next
}
{ put($0) }
