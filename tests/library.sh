#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The library as others find it: installed below a folder, found by pkg-config, used outside of the
# tree; its numbers are the program's, digit by digit. usage: library.sh BUILD SOURCE
# $BEAMRATE is the program, $CC a compiler, $PYTHON one with numpy (python3).
# shellcheck disable=SC2016,SC2046,SC2086 # lists of words, and what eval expands
set -u
build=$1 source=$2
: "${BEAMRATE:?is the program}"
folder=$(mktemp -d -p /tmp) # pkg-config cannot give a folder with blanks to all shells
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
number=0 failures=0

# WHAT COMMAND...: a case, which passes if the command does.
check() {
    local what=$1
    shift
    number=$((number + 1))
    if "$@" >log 2>&1; then
        echo "ok $number - $what"
    else
        echo "not ok $number - $what"
        sed 's/^/# /' log
        failures=$((failures + 1))
    fi
}

skip() { # WHAT WHY
    number=$((number + 1))
    echo "ok $number - $1 # SKIP $2"
}

# ---- what is installed ----

check "meson install" meson install -C "$build" --no-rebuild --destdir "$folder/root" \
    --tags runtime,devel,python-runtime
PKG_CONFIG_PATH=$(dirname "$(find "$folder/root" -name beamrate.pc)")
export PKG_CONFIG_PATH
package() { pkg-config "$@" beamrate; }
prefix=$(cd "$(package --variable=prefix)" && pwd)
libraries=$(cd "$(package --variable=libdir)" && pwd)
header=$prefix/include/beamrate/beamrate.h
export LD_LIBRARY_PATH=$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}

# Every function of the header leaves the shared library, and nothing else does.
symbols() {
    grep -oE '\bbeamrate_[a-z_]+\(' "$header" | tr -d '(' | sort -u >documented
    nm -D --defined-only "$libraries/libbeamrate.so" | awk '$2 != "A" { print $3 }' |
        sed 's/@.*//' | sort >exported
    [ "$(wc -l <documented)" -ge 13 ] && diff documented exported
}
check "what is exported is what is documented" symbols

# One version in all places, and the number of the ABI in the name that programs ask for.
versions() {
    local version=${1%% *}
    echo "program $version, pkg-config $(package --modversion)"
    [ "$(package --modversion)" = "$version" ] &&
        grep -q "define BEAMRATE_VERSION \"$version\"" "$prefix/include/beamrate/version.h" &&
        [ -e "$libraries/libbeamrate.so.1.${version#*.}" ] &&
        readelf -d "$libraries/libbeamrate.so" | grep -F "[libbeamrate.so.1]" &&
        grep -F "libbeamrate.so.1*" "$source/debian/libbeamrate1.install" && grep -F "libbeamrate.so.1." "$header"
}
said=$("$BEAMRATE" --version)
check "one version" versions "${said#beamrate }"

# Nothing of the beam's: no linear algebra, no vectors, no scenes.
needs() {
    readelf -d "$libraries/libbeamrate.so" | sed -n 's/.*NEEDED.*\[\(lib[a-z]*\).*/\1/p' | sort | tee needed
    [ "$(grep -vcE '^lib(c|m|gsl|gslcblas|jansson|yaml|pthread)$' needed)" -eq 0 ] && grep -q libgsl needed &&
        ! grep -E 'scene|march' "$header"
}
check "it needs GSL, Jansson and libyaml alone" needs

# ---- in C ----

headers() { # COMPILER...
    "$@" -pedantic -Wall -Wextra -Werror $(package --cflags) -c
}
echo '#include <beamrate/beamrate.h>' | tee alone.c >alone.cc
check "the header stands alone in C99" headers ${CC:-cc} -std=c99 alone.c
if command -v c++ >/dev/null; then
    check "the header stands alone in C++" headers c++ alone.cc
else
    skip "the header stands alone in C++" "c++ is not installed"
fi

check "the example builds outside of the tree" ${CC:-cc} -Wall -Wextra -Werror \
    "$source/docs/library/example.c" $(package --cflags --libs) -o example
check "the example builds with the static library" ${CC:-cc} "$source/docs/library/example.c" \
    $(package --cflags) "$libraries/libbeamrate.a" \
    $(package --static --libs | sed 's/-lbeamrate//') -o static

# The same numbers as the program says them: as NAME VALUES, with the same digits.
printf 'h,error\n0.1,0.0101\n0.05,0.00252\n0.025,0.00063\n0.0125,0.000157\n' >table.csv
program_numbers() {
    "$BEAMRATE" orders table.csv --quiet --json - >orders.json || return
    sed -n '/"orders": \[/,/\]/s/^ *"\(order\|low\|high\)": \([^,]*\),$/\2/p' orders.json | xargs echo order
}
normalized() { awk '{ for (i = 2; i <= NF; i++) $i = sprintf("%.17g", $i); print }' "$1"; }
same_numbers() { # FILE
    grep '^order' "$1" >ours
    normalized ours >a && normalized program >b && [ "$(wc -w <b)" -eq 4 ] && diff a b
}
check "the program's numbers" eval 'program_numbers >program'
check "the example runs" eval './example table.csv >shared.txt && grep "^verdict PASS$" shared.txt'
check "its numbers are the program's" same_numbers shared.txt
check "the static one prints the same" eval './static table.csv | cmp - shared.txt'

# What is installed is enough: no file of the source.
alone() {
    export BEAMRATE_DATA=$prefix/share/beamrate
    ./example | grep -q '^verdict PASS$' && "$prefix/bin/beamrate" scenes | grep -q '^example2 ' &&
        "$prefix/bin/beamrate" run example2 -n 4 --k 0.1 --quiet
}
check "what is installed is enough" eval '(alone)'

# A refusal names table, line and column; nothing is printed but by the example itself.
refusal() {
    printf 'h,error\n4,16\n2,-4\n1,1\n' >wrong.csv
    ! ./example wrong.csv >out 2>err && cat err &&
        grep -q '^example: wrong.csv:3: error: found -4, expected' err &&
        [ "$(wc -l <err)" -eq 1 ] && [ "$(wc -l <out)" -eq 1 ]
}
check "a wrong table is refused by name, line and column" refusal

# ---- in Python ----

# Sizes of all structs that both have, and where their members are.
layouts() {
    cat >layout.py <<'END'
import ctypes, re, sys
import beamrate
names = re.findall(r"^struct (beamrate_\w+) \{", open(sys.argv[1]).read(), re.M)
print("#include <beamrate/beamrate.h>\n#include <stdio.h>\nint main(void)\n{")
count = 0
for name in names:
    struct = getattr(beamrate, "_" + "".join(w.capitalize() for w in name.split("_")[1:]))
    members = [(m, getattr(struct, m).offset, getattr(struct, m).size) for m, _ in struct._fields_]
    print(f'    if (sizeof(struct {name}) != {ctypes.sizeof(struct)}) return puts("{name}"), 1;')
    for m, offset, size in members:
        count += 1
        print(f'    if (offsetof(struct {name}, {m}) != {offset} || '
              f'sizeof((struct {name} *)0)->{m} != {size}) return puts("{name}.{m}"), 1;')
print("}")
assert count > 50, count
END
        "$python" layout.py "$header" >layout.c && ${CC:-cc} $(package --cflags) layout.c -o layout &&
        ./layout
}
refused_in_python() {
    cat >refused.py <<'END'
import copy, ctypes, os, pickle
import numpy as np
import beamrate as br

def refused(text, call, status=None):
    try:
        call()
    except (br.BadInput, TypeError) as error:
        assert text in str(error), (text, str(error))
        assert getattr(error, "status", None) == status, (text, error.status)
    else:
        raise AssertionError(f"not refused: {text}")

second = (br.SPACE, 2, 0.1)
masked = np.ma.array([16.0, 4.0, 1.0], mask=[0, 1, 0])
refused("number: found masked_array", lambda: br.Orders(masked, h=[4, 2, 1]))
refused("h: found masked_array", lambda: br.Orders([16, 4, 1], h=masked))
refused("number: found array([16.+1.j", lambda: br.Orders([16 + 1j, 4, 1], h=[4, 2, 1]))
orders = br.Orders([16, 4, 1], h=[4, 2, 1])
check = orders.check(second)
for duplicate in (copy.copy, copy.deepcopy, pickle.dumps):
    refused("a Orders is not copied", lambda: duplicate(orders))
for other in (check, None, br.Orders.__new__(br.Orders)):
    refused("orders: found", lambda: br.Check(other, 0, [second]), 1)
refused("axis: found -1", lambda: orders.check((-1, 2, 0.1)))
refused("axis: found 18446744073709551616", lambda: orders.line(2**64))
refused("axis: found 0.5, expected a whole number", lambda: orders.line(0.5))
refused("expectations: found none", lambda: orders.check(), 1)
refused("differ in length", lambda: br.Orders([1, 2, 3], h=[1, 2]))
refused("numbers:2", lambda: br.Orders([3, -2, 1], h=[3, 2, 1]), 1)

class NoMemory:  # in place of the library
    def beamrate_orders_find(self, *arguments):
        arguments[-1]._obj.status, arguments[-1]._obj.message = 3, b"out of memory"
        return 3

library, br._lib = br._lib, NoMemory()
try:
    br._call("orders_find")
except br.BadInput:
    raise AssertionError("an end of memory is no bad input")
except br.Error as error:
    assert (error.status, str(error)) == (3, "out of memory"), error
else:
    raise AssertionError("an end of memory is no success")
br._lib = library

child = os.fork()
if child == 0:
    again = br.Orders([16, 4, 1], h=[4, 2, 1])
    os._exit(0 if (again.order, again.check(second).passed) == (orders.order, check.passed) else 1)
assert os.waitpid(child, 0)[1] == 0
END
    timeout 600 "$python" refused.py 2>noise && cat noise && [ ! -s noise ]
}
# The page's loop over the program, by any Python.
loop() {
    awk '/^```python/ { inside = 1; text = ""; next } /^```/ { if (inside && text ~ /subprocess/) printf "%s", text
        inside = 0 } inside { text = text $0 "\n" }' "$source/docs/library.md" >loop.py
    PATH=$prefix/bin:$PATH "$python" loop.py >loop.txt && cat loop.txt &&
        [ "$(wc -l <loop.txt)" -eq 13 ] && ! grep -E 'None|nan' loop.txt &&
        tail -n 1 loop.txt | LC_ALL=C awk '{ exit !($2 < 2 && 2 < $3 && $3 - $2 < 0.5) }'
}
export PYTHONPATH=$prefix/share/beamrate/python${PYTHONPATH:+:$PYTHONPATH}
python=${PYTHON:-python3}
check "the loop of the page" loop
if "$python" -c 'import numpy' 2>/dev/null; then
    check "Python's structs are the header's" layouts
    check "the example in Python runs" eval '"$python" "$source/docs/library/example.py" >py.txt'
    check "its numbers are the program's" same_numbers py.txt
    check "Python refuses, too" refused_in_python
    check "orders in Python" "$python" -W error "$source/tests/library_orders.py"
    if "$python" -c 'import pytest' 2>/dev/null; then
        check "the plugin of pytest" "$python" "$source/tests/library_pytest.py" -p beamrate_pytest
    else
        skip "the plugin of pytest" "no python3 with pytest"
    fi
    for module in pandas matplotlib; do
        if "$python" -c "import $module" 2>/dev/null; then
            check "orders in Python, $module" "$python" "$source/tests/library_orders.py" $module
        else
            skip "orders in Python, $module" "no python3 with $module"
        fi
    done
else
    for what in "Python's structs are the header's" "the example in Python" "Python refuses, too" \
        "orders in Python" "the plugin of pytest" "orders in Python, pandas" "orders in Python, matplotlib"; do
        skip "$what" "no python3 with numpy"
    done
fi
echo "1..$number"
[ "$failures" -eq 0 ]
