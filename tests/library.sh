#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The library as others find it: installed below a folder, found by pkg-config, used outside of the
# tree; its numbers are the program's, digit by digit. usage: library.sh BUILD SOURCE
# $BEAMRATE is the program, $CC a compiler, $PYTHON one with numpy (python3).
# shellcheck disable=SC2016,SC2046,SC2086 # lists of words, and what eval expands
set -u
build=$1 source=$2
: "${BEAMRATE:?is the program}"
folder=$(mktemp -d)
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
    [ "$(wc -l <documented)" -gt 20 ] && diff documented exported
}
check "what is exported is what is documented" symbols

# One version in all places, and its first number in the name that programs ask for.
versions() {
    local version=${1%% *}
    echo "program $version, pkg-config $(package --modversion)"
    [ "$(package --modversion)" = "$version" ] &&
        grep -q "define BEAMRATE_VERSION \"$version\"" "$prefix/include/beamrate/version.h" &&
        [ -e "$libraries/libbeamrate.so.$version" ] &&
        readelf -d "$libraries/libbeamrate.so" | grep -F "[libbeamrate.so.${version%%.*}]"
}
said=$("$BEAMRATE" --version)
check "one version" versions "${said#beamrate }"

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

# The same numbers as a program says them: as NAME VALUES.
program_numbers() {
    "$BEAMRATE" run example2 -n 20 --steps 40 --fields axial,bending --quiet --json run.json &&
        "$BEAMRATE" study example2 -n 10,20,40 --steps 20,40,80 --no-plots --quiet --out study ||
        return
    sed -En '/"displacement"/,/\}/s/^ *"(axial|bending)": ([^,]*),?$/tip.\1 \2/p
        s/^  "((contact|friction)_force)": ([^,]*),?$/\1 \3/p' run.json
    awk -F, '$2 == "total" { print "error", $3, $5, $7 }' study/example2.csv
    awk -F, '$1 == "total" { print "q", $9, $10, $11 }' study/example2-fits.csv
}
# The same digits: numbers that are equal as they are read.
normalized() { awk '{ for (i = 2; i <= NF; i++) $i = sprintf("%.17g", $i); print }' "$1"; }
same_numbers() { # FILE
    grep -E '^(tip|contact|friction|error|q)' "$1" >ours
    normalized ours >a && normalized program >b && [ "$(wc -l <b)" -eq 14 ] && diff a b
}
check "the program's numbers" eval 'program_numbers >program'
check "the example runs" eval './example example2 >shared.txt'
check "its numbers are the program's" same_numbers shared.txt
check "the static one prints the same" eval './static example2 | cmp - shared.txt'

# What is installed is enough: its scenes, its program, no file of the source.
alone() {
    export BEAMRATE_DATA=$prefix/share/beamrate
    ./example example2 | cmp - shared.txt && "$prefix/bin/beamrate" scenes | grep -q '^example2 ' &&
        "$prefix/bin/beamrate" run example2 -n 4 --k 0.1 --quiet
}
check "what is installed is enough" eval '(alone)'

# A refusal names file, line and key; nothing is printed but by the example itself.
refusal() {
    printf 'length: 1 m\nduration: -1 s\n' >wrong.yaml
    ! ./example wrong.yaml >out 2>err && cat err &&
        grep -q '^example: wrong.yaml:2: duration: found -1 s, expected' err &&
        [ "$(wc -l <err)" -eq 1 ] && [ "$(wc -l <out)" -eq 1 ]
}
check "a wrong scene is refused by file, line and key" refusal

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
assert count > 80, count
END
        "$python" layout.py "$header" >layout.c && ${CC:-cc} $(package --cflags) layout.c -o layout &&
        ./layout
}
refused_in_python() {
    cat >refused.py <<'END'
import copy, ctypes, os, pickle, signal, time, warnings
import numpy as np
import beamrate as br

signal.signal(signal.SIGINT, signal.default_int_handler)  # a job in the background ignores it

def refused(text, call):
    try:
        call()
    except (br.BadInput, IndexError, OverflowError, TypeError) as error:
        assert text in str(error), (text, str(error))
    else:
        raise AssertionError(f"not refused: {text}")

scene = br.Scene("example2")
march = br.March(scene, 4, 8)
refused("wrong:2: duration: found", lambda: br.Scene("wrong", "length: 1 m\nduration: -1 s\n"))
refused("at most the 8 that are left", lambda: march.step(9))
refused("at least 0", lambda: march.step(-1))
refused("n: found 4.5, expected a whole number", lambda: br.Study(scene, [4.5], [8]))
refused("contiguous", lambda: march.get(br.BENDING, np.empty((5, 4))[:, ::2]))
refused("field: found 2, expected at most 1", lambda: march.get(2))
refused("field: found -1", lambda: march.get(-1))
refused("name: found None", lambda: br.Scene(None))
for other in (None, march, "example2"):
    refused("scene: found", lambda: br.March(other, 4, 4))
    refused("scene: found", lambda: br.Study(other, [4], [4]))
    refused("scene: found", lambda: br.Check(other))
refused("a handle of kind 'scene'", lambda: br._call("march_create", ctypes.byref(ctypes.c_void_p()),
        march, ctypes.c_size_t(4), ctypes.c_size_t(4), None))
for duplicate in (copy.copy, copy.deepcopy, pickle.dumps):
    refused("a Scene is not copied", lambda: duplicate(scene))
refused("scene: found NULL", lambda: br.Scene.__new__(br.Scene).foresee(4, 4))
refused("n: found 18446744073709551620, expected at most", lambda: br.March(scene, 2**64 + 4, 4))
refused("threads: found 1000000000, expected at most 1024",
        lambda: br.Study(scene, [4], [4], threads=10**9))
refused("threads: found -1", lambda: br.Check(scene, threads=-1))
refused("scheme: found 'bdf2\\x00nonsense'", lambda: br.March(scene, 4, 4, scheme="bdf2\0nonsense"))
refused("scheme: found None", lambda: br.March(scene, 4, 4, scheme=None))
refused("fine: found (1, 2, 3)", lambda: br.Study(scene, [4], [4], fine=(1, 2, 3)))
refused("n: found 4, expected a list", lambda: br.Study(scene, 4, [4]))
refused("progress: found 3", lambda: br.Study(scene, [4], [4], progress=3))
masked = np.ma.array([16.0, 4.0, 1.0], mask=[0, 1, 0])
refused("number: found masked_array", lambda: br.Orders(masked, h=[4, 2, 1]))
refused("h: found masked_array", lambda: br.Orders([16, 4, 1], h=masked))
refused("number: found array([16.+1.j", lambda: br.Orders([16 + 1j, 4, 1], h=[4, 2, 1]))
refused("without a mask", lambda: march.get(br.BENDING, np.ma.zeros((5, 2))))
orders = br.Orders([16, 4, 1], h=[4, 2, 1])
refused("axis: found -1", lambda: orders.check((-1, 2, 0.1)))
refused("expectations: found none", lambda: orders.check())
refused("differ in length", lambda: br.Orders([1, 2, 3], h=[1, 2]))
refused("numbers:2", lambda: br.Orders([3, -2, 1], h=[3, 2, 1]))
study = br.Study(scene, [2, 4, 8], [8], reference="exact", norm="tip", axial_degree=2)
cell = study.cell[2][0]
del study
rod = "title: a rod\nlength: 2 m\nduration: 4 s\ndensity: 1 kg/m\naxial: {stiffness: 1 N, viscosity: 1 N s, load: 't [N/m]'}\n"
study = br.Study(br.Scene("rod", rod), [2, 4], [8, 16])
assert list(study.h) == [1, 0.5] and list(study.k) == [0.5, 0.25]
assert cell.flag == ["", "", ""] or all(isinstance(f, str) for f in cell.flag)
try:
    br.Study(scene, [2, 4, 8], [8, 16], progress=lambda share: 1 / 0)
except ZeroDivisionError:
    pass
else:
    raise AssertionError("an exception of progress is lost")

def interrupt(share):  # from any thread, as Ctrl-C comes
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(0.01)

for run in (lambda: br.Study(scene, [200, 400], [2000, 4000], progress=interrupt),
            lambda: br.Check(scene, progress=interrupt)):
    try:
        run()
    except KeyboardInterrupt:
        pass
    else:
        raise AssertionError("Ctrl-C is lost")

with warnings.catch_warnings():
    warnings.simplefilter("ignore", DeprecationWarning)  # from 3.12 on: threads and a fork
    child = os.fork()  # after studies in threads
if child == 0:
    again = br.Study(scene, [2, 4, 8], [8], reference="exact", norm="tip", axial_degree=2, threads=2)
    os._exit(0 if again.cell[2][0].tip == cell.tip else 1)
assert os.waitpid(child, 0)[1] == 0
END
    timeout 120 "$python" refused.py 2>noise && cat noise && [ ! -s noise ]
}
export PYTHONPATH=$prefix/share/beamrate/python${PYTHONPATH:+:$PYTHONPATH}
python=${PYTHON:-python3}
if "$python" -c 'import numpy' 2>/dev/null; then
    check "Python's structs are the header's" layouts
    check "the example in Python runs" eval '"$python" "$source/docs/library/example.py" >py.txt'
    check "its numbers are the program's" same_numbers py.txt
    check "Python refuses, too" refused_in_python
    check "orders in Python" "$python" -W error "$source/tests/library_orders.py"
    for module in pandas matplotlib; do
        if "$python" -c "import $module" 2>/dev/null; then
            check "orders in Python, $module" "$python" "$source/tests/library_orders.py" $module
        else
            skip "orders in Python, $module" "no python3 with $module"
        fi
    done
else
    for what in "Python's structs are the header's" "the example in Python" "Python refuses, too" \
        "orders in Python" "orders in Python, pandas" "orders in Python, matplotlib"; do
        skip "$what" "no python3 with numpy"
    done
fi
echo "1..$number"
[ "$failures" -eq 0 ]
