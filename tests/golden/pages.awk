# SPDX-License-Identifier: GPL-3.0-or-later
# usage: awk -v mode=page|help -v at=WHERE -v files=FOLDER -f pages.awk [PAGE]: prints the commands of a page of docs/,
# or of a command's help, a line each: KIND, tab, where, tab, COMMAND. A block of a page that begins with ```sh holds
# commands ("short"). The ones of ```sh long would take minutes. One of YAML whose first line is a remark that
# begins with NAME.yaml goes to that file in FOLDER; the first line of any other is a remark that begins with
# "part". One of text begins with "$ COMMAND", and shows what that prints ("shown", of ```text long "later"). A command that ends with a
# backslash goes on in the next line; of a variable that holds the program the $ is left out, and so is a remark.
FNR == 1 && mode == "page" { at = FILENAME; how = ""; inside = 0 }
mode == "help" { how = "short" }
/^```/ && mode == "page" {
    inside = !inside
    how = $0 == "```sh" ? "short" : $0 == "```sh long" ? "long" : substr($0, 4)
    file = whole = ""
    first = 1
    next
}
first && inside && how ~ /^(text( long)?)?$/ {
    sub(/^\$ /, "")
    print (/^beamrate(-orders)? / ? (how ~ /long/ ? "later\t" : "shown\t") at "\t" $0 : "bad\t" at "\techo line " FNR ": no command; false")
}
how == "yaml" && first && /^# [a-z_]+\.yaml/ { file = files "/" $2; sub(/\.yaml.*/, ".yaml", file) }
how == "yaml" && first && !file && !/^# part/ { print "bad\t" at "\techo line " FNR ": YAML without a name; false" }
{ first = 0 }
how == "yaml" && file { print >file }
how != "short" && how != "long" { next }
{
    sub(/^ */, "")
    if (whole == "" && !/^(\$?beamrate(-orders)?|mpirun|cc) /)
        next
    whole = whole $0
    if (sub(/\\$/, "", whole))
        next
    sub(/ # .*/, "", whole)
    sub(/^\$/, "", whole)
    sub(/ *$/, "", whole)
    print how "\t" at "\t" whole
    whole = ""
}
