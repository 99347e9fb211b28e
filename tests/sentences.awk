# The literals of C sources that read as text, of at least `words` words: FILE, a tabulator, the literal as
# it stands in the source. Literals that follow each other are one.
function flush(    rest, count) {
    rest = text
    gsub(/%[-+ #0-9.*]*[a-z]|\\[a-z]/, " ", rest)
    count = gsub(/[A-Za-z][a-z]+/, "", rest)
    if (count >= words)
        print FILENAME "\t" text
    text = ""
}
FNR == 1 { text = ""; comment = 0 }
/^[ \t]*#[ \t]*include/ { next }
{
    line = $0
    while (line != "") {
        if (comment) {
            if (!(at = index(line, "*/")))
                next
            line = substr(line, at + 2)
            comment = 0
        }
        if (!match(line, /^[ \t\\]*("([^"\\]|\\.)*"|'([^'\\]|\\.)*'|\/\*|\/\/|PRI[a-zA-Z0-9]+|[A-Za-z_0-9]+|[^ \t])/))
            next
        token = substr(line, 1, RLENGTH)
        line = substr(line, RLENGTH + 1)
        sub(/^[ \t\\]+/, "", token)
        if (token == "//")
            next
        else if (token == "/*")
            comment = 1
        else if (token ~ /^"/)
            text = text substr(token, 2, length(token) - 2)
        else if (token !~ /^PRI/ && text != "")
            flush()
    }
}
