# SPDX-License-Identifier: GPL-3.0-or-later
# Of the data of a picture prints each block of points as one line: how many empty lines precede it, its index and
# title, its columns ("=" where they are those of the block before), how many points it has, the sum of each
# column's numbers, weighted 1, 2, 3, ..., so that their order counts, and the flags in their order, if any.
function end_block(    i, text) {
    if (!points)
        return
    text = (before + 0) " empty, " title " " (columns == last ? "=" : columns) ": " points " points, sums"
    for (i = 1; i <= numbers; i++)
        text = text sprintf(" %.15g", sum[i])
    print text (flags ~ /[^ -]/ ? "," flags : "")
    last = columns
    points = numbers = before = 0
    title = columns = flags = ""
    split("", sum)
}

/^# index/ { end_block(); title = $0; before = empty; empty = 0; next }
/^#/ && title != "" && columns == "" { columns = substr($0, 3); next }
/^#/ { end_block(); print; next }
!NF { end_block(); empty++; next }
{
    points++
    for (i = 1; i <= NF; i++)
        if ($i ~ /^[-+]?[0-9.]+(e[-+][0-9]+)?$/) {
            sum[i] += points * $i
            numbers = i > numbers ? i : numbers
        } else
            flags = flags " " $i
}
END { end_block(); if (empty) print empty " empty" }
