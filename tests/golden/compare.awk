# SPDX-License-Identifier: GPL-3.0-or-later
# usage: awk [-v tolerance=1e-6] [-v round_off=yes] [-v counts=yes] -f compare.awk STORED FOUND: prints
# FOUND, with the lines of STORED where they are the same; exit code 1 where some are not. Texts are equal
# to the byte, counts exactly. Other numbers are equal to a relative tolerance, 1e-9 where none is given,
# or to one unit of the last digit of the one that is printed with more digits. Bits depend on processor,
# compiler and LAPACK: fits magnify that to some 1e-7. Where round-off is measured, what is below 1e-11
# may be 16 times what is stored, or a sixteenth of it. Where it decides counts, those above 20 may be a
# tenth off. Blanks may differ only beside numbers that differ.
BEGIN {
    tolerance = tolerance ? tolerance : 1e-9
    last_bits = tolerance > 1e-9 || round_off ? 1e-13 : 1e-14 # of differences of numbers near 1
}

# Adding 0 makes a number of a text: texts are compared by letters.
function abs(x) { x += 0; return x < 0 ? -x : x }

# One unit of the last printed digit.
function unit(number,    parts, mantissa) {
    split(tolower(number), parts, "e")
    mantissa = parts[1]
    sub(/^[^.]*\.?/, "", mantissa)
    return 10 ^ (parts[2] - length(mantissa))
}

function is_count(number) { return number !~ /[.eE]/ }

# one: of which the numbers are parts, 0.01 where a percent sign follows.
function close_enough(a, b, one,    ulp, larger, smaller) {
    if (a == b "")
        return 1
    if (is_count(a) && is_count(b))
        return counts && a + 0 > 20 && abs(a - b) <= 0.1 * a
    larger = abs(a) > abs(b) ? abs(a) : abs(b)
    smaller = abs(a) > abs(b) ? abs(b) : abs(a)
    if (smaller * one < 1e-11 && round_off)
        return larger <= 16 * smaller + 1e-15
    if (abs(a - b) <= tolerance * larger || (smaller >= 1e-11 && abs(a - b) <= last_bits))
        return 1
    ulp = unit(a) < unit(b) ? unit(a) : unit(b)
    return abs(a - b) <= 1.001 * ulp
}

# The next number of a line; the text before it goes to `before`, what is behind it to `rest`.
function next_number(line) {
    if (!match(line, /[-+]?[0-9]+(\.[0-9]+)?([eE][-+]?[0-9]+)?/)) {
        before = line
        rest = ""
        return ""
    }
    before = substr(line, 1, RSTART - 1)
    rest = substr(line, RSTART + RLENGTH)
    return substr(line, RSTART, RLENGTH)
}

# LaTeX's powers of ten as all others write them: 1.5\cdot10^{-3} is 1.5e-3}. A bound of round-off is a
# number of round-off: < 4.3e-17 may be 2.4e-17.
function plain(line) {
    gsub(/\\cdot10\^\{/, "e", line)
    while (round_off && match(line, /< [0-9.]+e-1[2-9]/))
        line = substr(line, 1, RSTART - 1) substr(line, RSTART + 2)
    return line
}

function squeezed(text) { gsub(/ +/, " ", text); sub(/ $/, "", text); return text }

function same(a, b,    x, y, one, text_a, text_b, moved) {
    if (a == b)
        return 1
    a = plain(a); b = plain(b)
    for (; a != "" || b != "";) {
        x = next_number(a); text_a = before; a = rest
        y = next_number(b); text_b = before; b = rest
        one = rest ~ /^ ?%/ ? 0.01 : 1
        if (squeezed(text_a) != squeezed(text_b) || (x == "") != (y == "") || !close_enough(x, y, one))
            return 0
        moved = moved || x != y ""
    }
    return moved
}

FILENAME == ARGV[1] { stored[lines = FNR] = $0 }
FILENAME == ARGV[2] { found[others = FNR] = $0 }
END {
    for (i = 1; i <= others; i++) {
        known = i <= lines && same(stored[i], found[i])
        differ = differ || !known
        print known ? stored[i] : found[i]
    }
    exit differ || lines != others
}
