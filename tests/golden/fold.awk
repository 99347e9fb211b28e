# SPDX-License-Identifier: GPL-3.0-or-later
# usage: awk -f fold.awk FIRST OUTPUT: prints OUTPUT; but of three lines or more that stand before, in this order, in
# FIRST or in a file of OUTPUT, only which they are, and of empty lines their number. So what has to be the same
# twice, as a report on the screen and in its file, is seen to be. A table in CSV stays as it is: derive.awk reads it.

# How many lines from `from` on are those from `at` on.
function same(at, from,    count) {
    while (at + count < from && from + count <= lines && line[at + count] == line[from + count] && !(line[from + count] ~ /^==== /))
        count++
    return count
}

# The most lines from i on that stand before: their number, and the first of them in `found`.
function longest(i,    most, count, k, places, place) {
    places = split(stands[line[i]], place, " ")
    for (k = 1; k <= places; k++) {
        count = same(place[k], i)
        if (count > most) {
            most = count
            found = place[k]
        }
    }
    return most
}

/^==== / { part = $0; sub(/^==== /, "", part); begin = lines + 1 }
{ line[++lines] = $0; of[lines] = part; number[lines] = lines - begin }
FILENAME == ARGV[1] { first = lines }
END {
    for (i = 1; i <= lines; i++) {
        count = i > first && line[i] != "" && !(of[i] ~ /\.csv$/) ? longest(i) : 0
        if (count >= 3)
            print "[lines " number[found] " to " number[found] + count - 1 " of " of[found] "]"
        else {
            for (count = 1; line[i] == "" && i + count <= lines && line[i + count] == ""; count++)
                ;
            if (i > first)
                print (count > 1 ? "[" count " empty lines]" : line[i])
        }
        for (last = i + count; i < last; i++)
            stands[line[i]] = stands[line[i]] " " i
        i--
    }
}
