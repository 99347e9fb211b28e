# SPDX-License-Identifier: GPL-3.0-or-later
# usage: awk -f derive.awk held.txt NAME.txt...: derives numbers of stored outputs from others of the same
# output, by the columns of its tables in CSV: rates from errors and sizes, shares and sums of parts, velocities
# from displacements, the bound of friction, the grid convergence index, what two printed errors need. A stored
# output without such a number has to stand in held.txt: "NAME: who derives its numbers". Exit code 1, and a line
# of each number that is not what it should be, of each output that nobody derives, and of rows of held.txt that
# are not needed.
function wrong(what) { bad = 1; print FILENAME ":" FNR ": " what }

function has(name) { return (name in at) && field[at[name]] != "" }
function of(name) { return field[at[name]] + 0 }
function magnitude(x) { return x < 0 ? -x : x }

# Whether the number of a column is this one, to a part of `size`.
function expect(name, value, size,    found) {
    found = of(name)
    derived[output]++
    if (!(magnitude(found - value) <= 1e-9 * size + 1e-300))
        wrong(name " is " field[at[name]] ", derived: " sprintf("%.17g", value))
}
function expect_that(holds, what) { derived[output]++; if (!holds) wrong(what) }

# The fields of a line of CSV.
function split_csv(line,    n, text) {
    split("", field)
    for (n = 1; ; n++) {
        if (match(line, /^"([^"]|"")*"/)) {
            text = substr(line, 2, RLENGTH - 2)
            gsub(/""/, "\"", text)
        } else {
            match(line, /^[^,]*/)
            text = substr(line, 1, RLENGTH)
        }
        field[n] = text
        line = substr(line, RLENGTH + 1)
        if (line == "")
            return n
        line = substr(line, 2)
    }
}

function begin_table(    n, i, name, base) {
    split("", at); split("", error_at); split("", coarser); split("", sum); split("", rate)
    columns = n = split_csv($0)
    before = ""
    for (i = 1; i <= n; i++) {
        name = field[i]
        sub(/ \[.*\]$/, "", name)
        at[name] = i
    }
}

# A rate along h or k: of the last row of the same quantity and the same other size.
function check_rate(axis, other, number, key, group,    last) {
    if (!(axis in at) || !has(axis) || number == "")
        return
    group = key SUBSEP axis SUBSEP (other in at ? field[at[other]] : "")
    if (("rate_" axis) in at && has("rate_" axis)) {
        last = coarser[group]
        if (last != "")
            expect("rate_" axis, log(error_at[group] / number) / log(last / of(axis)), 1)
        else
            wrong("a rate without a row before")
    }
    coarser[group] = of(axis)
    error_at[group] = number
}

function check_split(    group, part, i, name) {
    group = field[at["run"]] SUBSEP field[at["norm"]]
    part = field[at["part"]]
    if (field[at["applies"]] != "true")
        return
    for (i = 1; i <= split("error axial bending axial_tip bending_tip", name, " "); i++) {
        if (part == "sum")
            expect(name[i], sum[group, name[i]], magnitude(of(name[i])))
        else if (part != "whole")
            sum[group, name[i]] += of(name[i])
        if (part == "whole" && i > 3) # parts telescope
            expect(name[i], sum[group, name[i]], 1e-3)
    }
    if (part == "whole") # a triangle's longest side
        expect_that(of("error") <= sum[group, "error"] * (1 + 1e-9), "the parts do not reach the whole error")
    else if (has("share"))
        shares[++count_shares] = field[at["share"]] SUBSEP field[at["error"]]
    if (part == "sum") {
        for (i = 1; i <= count_shares; i++) {
            split(shares[i], name, SUBSEP)
            expect_that(magnitude(name[1] * of("error") - name[2]) <= 1e-9 * of("error"), "a share of the sum is not its error over it")
        }
        count_shares = 0
    }
}

# The velocity of implicit Euler, and the law of friction.
function check_history(    k, i, name) {
    if (before != "" && of("step") == before + 1) {
        k = of("t") - last_t
        for (i = 1; i <= split("u w", name, " "); i++)
            if (has(name[i]) && has(name[i] "_t"))
                expect(name[i] "_t", (of(name[i]) - last[name[i]]) / k, 1)
    }
    if (has("friction_force") && has("friction_bound"))
        expect_that(magnitude(of("friction_force")) <= of("friction_bound") * (1 + 1e-12), "the friction force is beyond its bound")
    last_t = of("t"); last["u"] = of("u"); last["w"] = of("w")
    before = of("step")
}

function check_row(    key, column, low, a, b) {
    key = ("part" in at ? field[at["part"]] : "") SUBSEP ("reference" in at ? field[at["reference"]] : "") \
        SUBSEP ("quantity" in at ? field[at["quantity"]] : "")
    if ("rate_h" in at || "rate_k" in at) {
        if (has("error")) {
            check_rate("h", "k", of("error"), key)
            check_rate("k", "h", of("error"), key)
        }
        if (has("value") && has("h")) { # of values: the differences of neighbours are like C (h^p - h'^p)
            if (rate[1] != "")
                expect_that(magnitude((size[2] ^ rate[1] - size[1] ^ rate[1]) / (size[1] ^ rate[1] - of("h") ^ rate[1]) / ((value[2] - value[1]) / (value[1] - of("value"))) - 1) <= 1e-9, "the rate of the row before")
            size[2] = size[1]; value[2] = value[1]
            size[1] = of("h"); value[1] = of("value"); rate[1] = has("rate_h") ? of("rate_h") : ""
        }
    }
    if (has("n") && has("h"))
        expect_that(magnitude(of("n") * of("h") - 1) <= 1e-12, "h is not 1/n")
    if (has("steps") && has("k") && has("h") && has("error")) {
        if (!((output, "T") in scale))
            scale[output, "T"] = of("steps") * of("k")
        expect_that(magnitude(of("steps") * of("k") / scale[output, "T"] - 1) <= 1e-12, "k is not T/steps")
    }
    if (has("steps_or_levels") && has("k")) {
        if (!((output, "T") in scale))
            scale[output, "T"] = of("steps_or_levels") * of("k")
        expect("k", scale[output, "T"] / of("steps_or_levels"), of("k"))
    }
    if (has("relative_error") && has("error") && has("scale"))
        expect("relative_error", of("error") / of("scale"), of("relative_error"))
    if (has("digits_per_second") && has("relative_error"))
        expect("digits_per_second", -log(of("relative_error")) / log(10) / of("seconds"), of("digits_per_second"))
    if (has("error") && has("axial") && has("bending") && has("scale"))
        expect_that(of("error") <= (of("axial") + of("bending")) * (1 + 1e-9), "the error is more than its two parts")
    if ("applies" in at)
        check_split()
    if ("friction_bound" in at && "contact_force" in at)
        check_history()
    if (has("printed_a") && has("least")) {
        a = of("printed_a"); b = of("printed_b")
        expect_that(of("least") <= magnitude(a - b) && of("least") > magnitude(a - b) - 1e-3 * (a + b), "least is not the difference, less what rounding leaves")
        expect_that(of("most") >= a + b && of("most") < (a + b) * (1 + 1e-3), "most is not the sum, and what rounding leaves")
        expect_that((field[at["contradiction"]] == "true") == (of("distance") < of("least") || of("distance") > of("most")), "a contradiction that is none, or none that is one")
    }
    if (has("gci_fine") && has("r21") && has("e_a")) {
        expect("gci_fine", 1.25 * of("e_a") / (exp(of("p") * log(of("r21"))) - 1), of("gci_fine"))
        expect_that(magnitude(of("phi_ext")) > 0 && of("low") <= of("limit") && of("limit") <= of("high"), "a limit outside its interval")
    }
    for (column in at) # an estimate lies in its interval
        if (column ~ /_low$/) {
            low = column
            sub(/_low$/, "", low)
            if (has(column) && has(low) && has(low "_high"))
                expect_that(of(column) <= of(low) && of(low) <= of(low "_high"), low " is not within its interval")
        }
    if (has("points") && has("degrees_of_freedom"))
        expect_that(of("points") - of("degrees_of_freedom") >= 2, "fewer points than unknowns")
}

FNR == 1 { output = FILENAME; sub(/.*\//, "", output); sub(/\.txt$/, "", output); kind = "" }
output == "held" {
    if (match($0, /^[a-z0-9_]+: ./)) {
        held[substr($0, 1, index($0, ":") - 1)] = FNR
    }
    next
}
FNR == 1 { outputs[output] = 1 }
/^==== / { kind = /\.csv$/ ? "head" : ""; next }
kind == "head" { begin_table(); kind = "rows"; next }
kind == "rows" && !/^#/ { split_csv($0); check_row() }
END {
    for (o in outputs) {
        if (!(o in held) && !derived[o]) {
            bad = 1
            print o ": nobody derives its numbers: see held.txt"
        }
        if (verbose)
            print o, derived[o] + 0
    }
    for (o in held)
        if (!(o in outputs) || derived[o]) {
            bad = 1
            print "held.txt:" held[o] ": " o (o in outputs ? " is derived here" : " is no stored output")
        }
    exit bad
}
