# SPDX-License-Identifier: GPL-3.0-or-later
# usage: awk -f shown.awk OUTPUT PAGE: looks at what a page shows of the output of a command. A block of it
# begins with the line "$ COMMAND"; -v command says which command OUTPUT is of. Each further line has to stand
# in the output, in this order, but for blanks and ends of lines; lines between may be left out. The word ...
# stands for any one word, and a number below 1e-11, which is round-off, for 16 times and a sixteenth of it.
# Prints the page, with the output's numbers where they differ. Exit code 1: some differ, or words do; standard
# error has the lines.
function same(shown, found,    a, b) {
    if (shown == found "" || shown == "...")
        return 1
    if ((shown found) ~ /[^-+.0-9e]/ || shown !~ /[0-9]/ || found !~ /[0-9]/)
        return 0
    a = shown < 0 ? -shown : shown + 0
    b = found < 0 ? -found : found + 0
    return a < 1e-11 && b < 1e-11 && a <= 16 * b && b <= 16 * a
}

function form(word) { gsub(/[-+]?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?/, "#", word); return word }

# The place of a line's words in the output, from `at` on; 0: they are not there.
function find(words, count, formally,    i, j) {
    for (i = at; i + count - 1 <= total; i++) {
        for (j = 1; j <= count; j++)
            if (!(same(words[j], word[i + j - 1]) || (formally && form(words[j]) == form(word[i + j - 1]))))
                break
        if (j > count)
            return i
    }
    return 0
}

# The line anew, as the output has it, or else with the page's own ends of lines.
function renew(place, words, count,    text, j) {
    if (begins[place] && begins[place + count] && $0 !~ /\.\.\./)
        return line[begins[place]]
    match($0, /^ */)
    text = substr($0, 1, RLENGTH)
    for (j = 1; j <= count; j++)
        text = text (j > 1 ? " " : "") (words[j] == "..." ? "..." : word[place + j - 1])
    return text
}

FILENAME == ARGV[1] {
    line[FNR] = $0
    for (i = 1; i <= NF; i++) {
        word[++total] = $i
        if (i == 1)
            begins[total] = FNR
    }
    begins[total + 1] = FNR + 1
    next
}
/^```/ { inside = !inside; first = inside; shows = 0 }
inside && !first && begun { begun = 0; shows = $0 == "$ " command; at = 1; if (shows) { print; next } }
first { first = 0; begun = 1 }
inside && shows && NF {
    count = split($0, words)
    place = find(words, count, 0)
    if (!place) {
        print FILENAME ":" FNR ": not in the output: " $0 >"/dev/stderr"
        differ = 1
        place = find(words, count, 1)
        if (place)
            $0 = renew(place, words, count)
    }
    if (place)
        at = place + count
}
{ print }
END { exit differ }
