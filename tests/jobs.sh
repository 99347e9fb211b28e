#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The action and the job for solvers of others do as they say: the lines that they run, one step after
# the other as GitHub does, on docs/orders/poisson.c, with and without a bug. What they build stands in
# for the program. usage: jobs.sh SOURCE
# $BEAMRATE_ORDERS is the program, $CC a compiler.
# shellcheck disable=SC2016 # what others expand
set -u
source=$1
: "${BEAMRATE_ORDERS:?is the program}"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
export LC_ALL=C
failures=0

mkdir -p release/beamrate-0 bin work && cp -r "$source/docs/orders" work/
cat >release/beamrate-0/bootstrap <<'END'
#!/bin/sh
[ "$1" = orders ] && cli=${0%/*}/build/orders/cli && mkdir -p "$cli" && ln -s "$BEAMRATE_ORDERS" "$cli/beamrate-orders"
END
cat >bin/curl <<'END'
#!/bin/sh
while [ $# -gt 1 ]; do
    [ "$1" = --output ] && to=$2
    shift
done
cp "${1#file://}" "$to"
END
chmod +x release/beamrate-0/bootstrap bin/curl
tar -C release -czf beamrate.tar.gz beamrate-0

# steps FILE: writes what each step runs to step.1, step.2, ...
steps() {
    rm -f step.*
    sed 's/\${{ inputs.folder }}/orders/' "$1" | awk '
        { match($0, /^ */); at = RLENGTH }
        block && (at > indent || !NF) { print >file; next }
        { block = 0 }
        /^ *- / { place = "." }
        /^ *working-directory: / { place = $2 }
        /^ *run: / {
            file = "step." ++n
            print "cd " place >file
            block = $0 ~ /run: \|$/
            indent = at
            if (!block) { sub(/^ *run: /, ""); print >file }
        }'
}

# job CODE TEXT: the steps end with this exit code, and one of their reports has the text.
job() {
    local code=0 step
    rm -rf runner && mkdir runner
    : >github_path
    : >summary
    for step in step.*; do
        (
            cd work || exit 99
            PATH=$(tr '\n' : <../github_path)$folder/bin:$PATH
            GITHUB_ACTION_PATH=$folder/release/beamrate-0 GITHUB_PATH=$folder/github_path RUNNER_TEMP=$folder/runner \
                GITHUB_STEP_SUMMARY=$folder/summary TABLE=$table EXPECT=$expect DIMENSION='' OPTIONS='--threads 1' STUDY=$study \
                BEAMRATE_ARCHIVE=file://$folder/beamrate.tar.gz \
                BEAMRATE_SHA256=$(sha256sum <../beamrate.tar.gz | cut -d' ' -f1) bash -eo pipefail "../$step"
        ) >>log 2>&1 || code=$?
        [ $code -eq 0 ] || break
    done
    rm -rf release/beamrate-0/build
    [ $code -eq "$1" ] && grep -qF -- "$2" summary log && return
    echo "FAILED: $what: exit code $code, expected $1 and '$2'"
    cat log summary
    failures=$((failures + 1))
}

table='' study=poisson.yaml expect=''
for what in action.yml docs/ci/your-solver.yml; do
    steps "$source/$what"
    : >log
    [ "$(cat step.* | wc -l)" -ge 5 ] || { echo "FAILED: $what has too few lines" && failures=1; }
    ${CC:-cc} -O1 -o work/orders/poisson work/orders/poisson.c -lm || exit 1
    job 0 '2 PASS'
    sed -i 's|h \* exp(1) + h \* h / 2 \* f(1)|h * exp(1)|' work/orders/poisson.c
    ${CC:-cc} -O1 -o work/orders/poisson work/orders/poisson.c -lm || exit 1
    job 1 'the order, 1.0'
    cp "$source/docs/orders/poisson.c" work/orders/
done
what='action.yml with a table' table=errors.csv study='' expect='l2: h 2 +- 0.1'
steps "$source/action.yml"
printf 'n,l2\n10,1e-1\n20,2.5e-2\n40,6.25e-3\n80,1.5625e-3\n' >work/orders/errors.csv
job 0 '1 PASS'
printf 'n,l2\n10,1e-1\n20,5e-2\n40,2.5e-2\n80,1.25e-2\n' >work/orders/errors.csv
job 1 'the order, 1.0'
what='action.yml with a table and a file' study=poisson.yaml
job 2 "found 'file' beside 'table'"
study=''
steps "$source/docs/ci/your-solver.yml"
what='a wrong checksum'
sed -i 's/echo "\$BEAMRATE_SHA256/echo "0$BEAMRATE_SHA256/' step.1
job 1 'no properly formatted'
[ "$failures" -eq 0 ]
