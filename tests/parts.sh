#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The optional parts where only half of each is there: mpicc without mpi.h, as FreeFem++ leaves it, and a
# gnuplot that does not run. The build leaves them out and says why; one that is demanded is an error
# that names the package. usage: parts.sh SOURCE
set -u
source=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
number=0 failures=0

# made NAME: a program from standard input.
mkdir bin
made() { { echo '#!/bin/sh' && cat; } >"bin/$1" && chmod +x "bin/$1"; }
made mpicc <<'END_OF_PROGRAM'
case $* in
*--showme:version*) echo 'mpicc: Open MPI 4.1.4 (Language: C)' >&2 ;;
*--showme:link*) echo '-lmpi' ;;
*--showme*) echo "-I/usr/lib/openmpi/include" ;;
*) exit 1 ;;
esac
END_OF_PROGRAM
made gnuplot <<'END_OF_PROGRAM'
echo 'gnuplot: error while loading shared libraries: libX.so' >&2
exit 127
END_OF_PROGRAM
made pkg-config <<END_OF_PROGRAM
case " \$* " in *' ompi'* | *' mpi'*) exit 1 ;; esac
exec "$(command -v pkg-config)" "\$@"
END_OF_PROGRAM
unset MPICC

# configures CODE TEXT OPTION...: Meson's exit code, and a text that it prints.
configures() {
    local code=0 expected=$1 text=$2
    shift 2
    number=$((number + 1))
    rm -rf build
    PATH=$folder/bin:$PATH meson setup build "$source" "$@" >said 2>&1 || code=$?
    if [ $((code != 0)) -eq "$expected" ] && grep -qE -- "$text" said; then
        echo "ok $number - $* says '$text'"
    else
        echo "not ok $number - $*: exit code $code, expected $expected and '$text'"
        tail -n 40 said | sed 's/^/# /'
        failures=$((failures + 1))
    fi
}
says() { # TEXT: the last configuration, too
    number=$((number + 1))
    if grep -qE -- "$1" said; then
        echo "ok $number - it says '$1'"
    else
        echo "not ok $number - it does not say '$1'"
        failures=$((failures + 1))
    fi
}

configures 0 '^ +more machines \(MPI\) +: NO: .*mpi\.h; Debian has it in the package libopenmpi-dev' -Dtests=disabled
says '^Message: left out: more machines \(MPI\): .*mpi\.h'
says "^ +pictures \(gnuplot\) +: NO: $folder/bin/gnuplot --version fails"
says '^ +tests +: NO: -Dtests=disabled'
configures 1 'ERROR: .*-Dmpi=enabled: .*mpi\.h; .*libopenmpi-dev' -Dmpi=enabled -Dtests=disabled
echo "1..$number"
[ "$failures" -eq 0 ]
