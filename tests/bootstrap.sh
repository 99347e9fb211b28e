#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What bootstrap installs and when, on a made-up Debian: a second start asks for nothing. Arguments:
# bootstrap. No command but those below is in its PATH.
# shellcheck disable=SC2016 # what a made-up program expands
set -u
unset CC BUILD # of whoever runs this

failures=0
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
mkdir "$work/bin" || exit 1
for tool in sh env cat grep sed awk sort tail dirname readlink mkdir rm; do
    ln -s "$(command -v $tool)" "$work/bin/$tool" || exit 1
done

# made NAME: a program from standard input, which finds the folder in $W.
made() {
    { printf '#!/bin/sh\nW="%s"\n' "$work" && cat; } >"$work/bin/$1"
    chmod +x "$work/bin/$1"
}
made id <<'END'
echo 1000
END
made sudo <<'END'
echo sudo >>"$W/calls"
exec "$@"
END
made pkg-config <<'END'
exit 1
END
made cc </dev/null
made ninja </dev/null
made bash </dev/null
made ps </dev/null
made gnuplot </dev/null
# Keeps what was chosen, as Meson does; has one test, which passes.
made meson <<'END'
if [ "$1" = test ]; then
    mkdir -p "$3/meson-logs"
    echo '{"stdout": "ok 1 - a", "result": "OK"}' >"$3/meson-logs/testlog.json"
fi
case "$*" in *--clearcache) : >"$W/cleared" ;; esac
[ "$1" = setup ] || exit 0
echo "$*" >>"$W/set_ups"
mkdir -p "$2/meson-private"
echo rules >"$2/build.ninja"
for word; do
    case $word in -D*=enabled) word=${word#-D} && echo "${word%=*} = enabled" ;; esac
done >>"$2/meson-private/cmd_line.txt"
END
made dpkg-query <<'END'
for package; do :; done
grep -qx "$package" "$W/installed" && echo 'install ok installed'
END
# Installs all or none of the packages of its last arguments, by what is to be had.
made apt-get <<'END'
echo "$*" >>"$W/calls"
case " $* " in *' update '*) exit 0 ;; esac
while [ "$1" != --no-install-recommends ]; do shift; done
shift
for package; do grep -qx "$package" "$W/to_be_had" || exit 100; done
printf '%s\n' "$@" >>"$W/installed"
END

every_package=$(sed -n '/^\(test_\|beam_\)*packages="/,/"$/s/^\([a-z][-a-z0-9]*\) .*/\1/p' "$1")
[ "$(echo "$every_package" | wc -w)" -ge 10 ] || exit 1

# machine WITHOUT...: a new tree, on a machine with all packages but these; nothing is to be had yet.
machine() {
    rm -rf "$work/tree" "$work/installed" "$work/to_be_had"
    mkdir "$work/tree" && cp "$1" "$work/tree/bootstrap"
    shift
    : >"$work/to_be_had"
    echo "$every_package" >"$work/installed"
    for package; do sed -i "/^$package\$/d" "$work/installed"; done
}

# starts CODE CALLS WHAT [ARGUMENT...]: bootstrap (build) ends with CODE, after so many calls of
# apt-get and sudo.
starts() {
    local code=0 calls expected=("${@:1:3}")
    : >"$work/calls"
    : >"$work/set_ups"
    shift 3
    [ $# -gt 0 ] || set -- build
    PATH=$work/bin "$work/tree/bootstrap" "$@" >"$work/said" 2>&1 </dev/null || code=$?
    set -- "${expected[@]}"
    calls=$(wc -l <"$work/calls")
    [ "$code" -eq "$1" ] && [ "$calls" -eq "$2" ] && return
    echo "$3: exit code $code after $calls calls, expected $1 after $2"
    sed 's/^/    /' "$work/calls" "$work/said"
    failures=$((failures + 1))
}

machine "$1"
starts 0 0 'everything is there'

made pkg-config <<'END'
[ "$2" = jq ] # which has a module of its own
END
machine "$1" jq
starts 0 6 'a program whose module only is there' test
made pkg-config <<'END'
exit 1
END

machine "$1" gnuplot-nox
starts 0 0 'an optional program is there, from another package'

machine "$1" python3-numpy libxml2-utils
starts 0 0 'what the program does not need'
starts 0 8 'two optional packages are not to be had' test
starts 0 0 'the same again' test
echo libxml2-utils >"$work/to_be_had"
rm "$work/tree/build/not-installed"
starts 0 8 'one of them is, now' test
starts 0 0 'and stays' test
grep -q '^libxml2-utils$' "$work/installed" || failures=$((failures + 1))

machine "$1" libgsl-dev libcmocka-dev python3-numpy
printf '%s\n' libgsl-dev libcmocka-dev >"$work/to_be_had"
starts 0 8 'needed packages beside an optional one that is not to be had' test
starts 0 0 'the same again' test

machine "$1" jq
mkdir "$work/tree/build" && echo jq-common >"$work/tree/build/not-installed"
echo jq >"$work/to_be_had"
starts 0 4 'a package whose name begins one that was given up' test
grep -q '^jq$' "$work/installed" || failures=$((failures + 1))

machine "$1" libgsl-dev
starts 3 4 'a needed package is not to be had'
starts 3 4 'and is tried again'

machine "$1" libgsl-dev gnuplot-nox
rm "$work/bin/gnuplot"
printf '%s\n' libgsl-dev gnuplot-nox >"$work/to_be_had"
starts 0 4 'all at once'
made gnuplot </dev/null

# configured WHAT [WORD]: the last start configured with this word in Meson's command, or not at all.
configured() {
    [ "$(wc -l <"$work/set_ups")" -eq $(($# - 1)) ] && grep -q -e "${2-}" "$work/set_ups" /dev/null
    [ $? -eq $((2 - $#)) ] && return
    echo "$1: configured as follows, expected ${2-nothing}"
    sed 's/^/    /' "$work/set_ups"
    failures=$((failures + 1))
}

machine "$1" libcmocka-dev
starts 0 0 'the program alone'
configured 'the program alone' '--buildtype=release$'
starts 0 0 'the program again'
configured 'the program again'
starts 3 4 'a part that is not to be had' --with mpi build
echo libopenmpi-dev >"$work/to_be_had"
made mpirun </dev/null
echo 'exit 1' | made mpicc
starts 0 4 'a part whose compiler finds no header' --with=mpi build
configured 'a part' '-Dmpi=enabled --reconfigure$'
[ -e "$work/cleared" ] || failures=$((failures + 1))
made mpicc <<'END'
for source; do :; done
[ "$source" != - ]
END
starts 0 0 'the same part' --with mpi build
configured 'the same part'
echo libcmocka-dev >"$work/to_be_had"
starts 0 4 'its tests' test
configured 'its tests' '-Dtests=enabled --reconfigure$'
echo zsh >"$work/to_be_had" && sed -i /^zsh/d "$work/installed"
starts 0 4 'a package more' test
configured 'what was installed is looked for' '--reconfigure$'
BUILD=$work/elsewhere starts 0 0 'a folder of its own' build
configured 'a folder of its own' "^setup $work/elsewhere "
CC=clang BUILD=$work/clang starts 3 4 'Clang is a package'
grep -q ' clang$' "$work/calls" || failures=$((failures + 1))

machine "$1" libsuitesparse-dev liblapacke-dev libblas-dev libsleef-dev libcmocka-dev
starts 0 0 'the general part alone' orders
configured 'the general part alone' '-Dbeam=disabled'
starts 0 0 'the general part again' orders
configured 'the general part again'
CC=acc starts 2 0 'CC is no program'
starts 2 0 'an unknown part' --with gpu build
starts 2 0 'a part that is gone' --with ida build

# What is generated is written anew by the programs that know it.
machine "$1"
mkdir -p "$work/tree/tests" "$work/tree/docs" "$work/tree/build/release/cli"
printf '#!/bin/sh\necho the page "$@"\n' >"$work/tree/build/release/cli/beamrate"
chmod +x "$work/tree/build/release/cli/beamrate"
for tool in meson ninja; do
    sed -i "1a echo $tool \${BR_TEST_UPDATE-} \$* >>\"$work/made_anew\"" "$work/bin/$tool"
done
starts 0 0 'all that is generated' update
for text in 'ninja .* update-golden' 'meson 1 test .* --suite stored'; do
    grep -q "^$text" "$work/made_anew" && continue
    echo "an update without '$text'"
    failures=$((failures + 1))
done
[ "$(cat "$work/tree/docs/options.md" "$work/tree/docs/beamrate.1")" = 'the page help markdown
the page help man' ] || failures=$((failures + 1))

# prints LINES WHAT: the last start has printed so many lines, and what apt-get, Meson and Ninja say is
# not among them.
prints() {
    [ "$(wc -l <"$work/said")" -eq "$1" ] && ! grep -q noise "$work/said" && return
    echo "$2: printed as follows, expected $1 lines without noise"
    sed 's/^/    /' "$work/said"
    failures=$((failures + 1))
}
ln -s "$(command -v seq)" "$work/bin/seq"
for tool in meson ninja apt-get; do
    sed -i '2a [ "$1" = --version ] || { seq 200 | sed "s/^/noise /" && echo noise >\&2; }' "$work/bin/$tool"
done
machine "$1" libgsl-dev
echo libgsl-dev >"$work/to_be_had"
starts 0 4 'much noise'
prints 3 'installs, configures, builds'
grep -q 'installing 1 package: libgsl-dev$' "$work/said" || failures=$((failures + 1))
starts 0 0 'much noise again'
prints 1 'builds'
made meson <<'END'
[ "$1" != compile ] || { seq 200 | sed 's/^/noise /' && echo 'x.c:1: error' >&2 && exit 1; }
END
starts 1 0 'a build that fails'
for text in 'x.c:1: error' 'noise 200' "the whole log: $work/tree/build/bootstrap.log"; do
    grep -qF "$text" "$work/said" && continue
    echo "a build that fails: does not show '$text'"
    failures=$((failures + 1))
done

# A message that quotes "\nnot ok 2" is no failed case.
mkdir -p "$work/log/meson-logs"
printf '%s\n' '{"stdout": "# has \\\\nnot ok 2\nok 1 - a\nnot ok 2 - b\n", "result": "FAIL"}' \
    >"$work/log/meson-logs/testlog.json"
eval "$(sed -n '/^count_cases()/,/^}/p' "${0%/*}/../bootstrap")"
eval "$(sed -n '/^list_skipped()/,/^}/p' "${0%/*}/../bootstrap")"
count=$(build=$work/log count_cases 1)
[ "$count" = '1 passed, 1 failed' ] || {
    echo "the count of one good and one bad case is '$count'"
    failures=$((failures + 1))
}

# A program that crashes or hangs counts as a failed case, also where none of its cases failed.
cat >"$work/log/meson-logs/testlog.json" <<'END'
{"stdout": "ok 1 - a\n", "result": "OK"}
{"stdout": "ok 1 - b\n", "result": "FAIL"}
{"stdout": "", "result": "TIMEOUT"}
{"stdout": "said\n", "result": "OK"}
END
count=$(build=$work/log count_cases 1)
[ "$count" = '3 passed, 2 failed' ] || {
    echo "the count of a crash and a hang is '$count'"
    failures=$((failures + 1))
}

# What is skipped, in each form.
cat >"$work/log/meson-logs/testlog.json" <<'END'
{"name": "beamrate:cli / a", "stdout": "1..2\nok 1 - b\n# skipped: no \"x\"\nok 2 - c # SKIP no y\n", "result": "OK"}
{"name": "d", "stdout": "skipped: no z\n", "result": "SKIP", "returncode": 77}
{"name": "cli+f - beamrate:f", "stdout": "skipped: no f\n", "result": "SKIP", "returncode": 77}
{"name": "e", "stdout": "is skipped: no\nok 1 - skipped: no\n", "result": "OK"}
END
skipped=$(build=$work/log list_skipped)
[ "$skipped" = 'skipped: a: c # SKIP no y
skipped: a: no x
skipped: d: no z
skipped: f: no f' ] || {
    echo "skipped is listed as '$skipped'"
    failures=$((failures + 1))
}

[ "$failures" -eq 0 ]
