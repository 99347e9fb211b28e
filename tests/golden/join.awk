# SPDX-License-Identifier: GPL-3.0-or-later
# Brings the innermost brackets of JSON, as the cells of a table, to a line each.

function put_held(    i) {
    for (i = 1; i <= held; i++)
        print line[i]
    held = 0
}

/^ *("[^"]*": )?[{[]$/ { put_held(); line[held = 1] = $0; next }
!held { print; next }
{ line[++held] = $0 }
/^ *[]}],?$/ {
    for (i = 2; i <= held; i++) {
        sub(/^ */, " ", line[i])
        line[1] = line[1] line[i]
    }
    held = 1
    put_held()
}
END { put_held() }
