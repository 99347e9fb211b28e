# SPDX-License-Identifier: GPL-3.0-or-later
# Of the data of a picture prints the texts, and of each block of points one line: how many there are, the sum
# of each column's numbers, weighted 1, 2, 3, ..., so that the order counts, and the flags, in their order.
function end_block(    i, text) {
    if (!points)
        return
    text = points " points, sums"
    for (i = 1; i <= columns; i++)
        text = text sprintf(" %.15g", sum[i])
    print text (flags ~ /[^ -]/ ? "," flags : "")
    points = columns = 0
    flags = ""
    split("", sum)
}

/^#/ { end_block(); print; next }
!NF { end_block(); empty++; next }
{
    if (empty) # which of the blocks belong together
        print "[" empty " empty lines]"
    empty = 0
    points++
    for (i = 1; i <= NF; i++)
        if ($i ~ /^[-+]?[0-9.]+(e[-+][0-9]+)?$/) {
            sum[i] += points * $i
            columns = i > columns ? i : columns
        } else
            flags = flags " " $i
}
END { end_block(); if (empty) print "[" empty " empty lines]" }
