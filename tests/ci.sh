#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# .ci/run with a bootstrap that does as it is told: the last line adds up all passes, also where one
# hangs or crashes; a skip that is not expected fails, and so does one that is missing where all is
# hidden. usage: ci.sh SOURCE
set -u
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/tree" "$work/bin" || exit 1
cp -r "$source/.ci" "$work/tree/"
sed -n 's/^!\([^"]*\)"*$/skipped: \1/p' "$source/.ci/run" >"$work/skips"
[ "$(wc -l <"$work/skips")" -ge 10 ] || exit 1
for program in mkdocs c++ clang-format-14; do
    printf '#!/bin/sh\n' >"$work/bin/$program" && chmod +x "$work/bin/$program"
done
printf '#!/bin/sh\nexec "$@"\n' >"$work/tree/.ci/without" # what it hides, .ci/run itself sees
cp "$work/tree/.ci/without" "$work/tree/.ci/openblas"
# $FIRST, $SECOND and $THIRD are what the passes do; those with OpenBLAS and with sanitizers pass.
cat >"$work/tree/bootstrap" <<'END'
#!/bin/sh
case ${CC-}$* in
test) cat "$WORK/skips" && eval "$FIRST" ;;
'test blas '*) echo 5 passed, 0 failed ;;
'test columns '*) case $SETUP$BUILD in *address,undefined*/build/sanitized) echo 5 passed, 0 failed ;; esac ;;
'--with mpi test '*) eval "$SECOND" ;;
'clangtest '*) case $BUILD in */build/clang) eval "$THIRD" ;; esac ;;
esac
END
chmod +x "$work/tree/bootstrap"

failures=0
# adds_up LINE CODE FIRST SECOND THIRD: the last line and the exit code of the three.
adds_up() {
    local code=0 line
    WORK=$work FIRST=$3 SECOND=$4 THIRD=$5 PATH=$work/bin:$PATH CI_SECONDS=${seconds-60} \
        env -u CC "$work/tree/.ci/run" >"$work/out" 2>"$work/err" || code=$?
    line=$(tail -n 1 "$work/out")
    [ "$line" = "$1" ] && [ $((code != 0)) -eq "$2" ] && return
    echo "$3; $4; $5: ends with '$line' and exit code $code, expected '$1' and $2"
    sed 's/^/    /' "$work/out" "$work/err"
    failures=$((failures + 1))
}
good='echo 5 passed, 0 failed'
adds_up '25 passed, 0 failed' 0 "$good" "$good" "$good"
adds_up '25 passed, 2 failed' 1 "$good" 'echo 5 passed, 2 failed; exit 1' "$good"
adds_up '25 passed, 1 failed' 1 "$good" "$good" "$good; exit 3"
adds_up '20 passed, 1 failed' 1 "$good" 'kill -SEGV $$' "$good"
adds_up '25 passed, 1 failed' 1 "$good" "echo 'skipped: completions: zsh is not installed'; $good" "$good"
adds_up '25 passed, 0 failed' 0 "$good" "echo 'skipped: foreign: FreeFem++ is not installed'; $good" "$good"
seconds=5 adds_up '5 passed, 4 failed' 1 "$good" 'sleep 600' "$good"
sed -i 1d "$work/skips"
adds_up '25 passed, 1 failed' 1 "$good" "$good" "$good"
mkdir -p "$work/tree/build/sanitized/meson-logs"
echo 'a.c:1:2: runtime error: a report' >"$work/tree/build/sanitized/meson-logs/testlog.txt"
adds_up '25 passed, 2 failed' 1 "$good" "$good" "$good"
[ "$failures" -eq 0 ]
