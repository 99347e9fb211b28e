#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# beamrate-orders as ./bootstrap release makes it: linked without shared libraries, it answers in an empty
# folder that is its whole file system.
# usage: alone.sh MESON SOURCES
set -eu
for library in gsl yaml jansson popt; do
    [ -n "$(find /usr/lib -name "lib$library.a" | head -n 1)" ] ||
        { echo "skipped: lib$library.a is not installed" && exit 77; }
done
if [ "$(id -u)" -eq 0 ]; then
    as_root() { "$@"; }
elif unshare -r true 2>/dev/null; then
    as_root() { unshare -r "$@"; }
else
    echo "skipped: chroot needs root" && exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
{ "$1" setup "$folder/build" "$2" --buildtype=release --prefer-static -Doptimization=0 -Dbeam=disabled \
    -Dtests=disabled -Dlibrary=false -Dc_link_args=-static &&
    "$1" compile -C "$folder/build" cli/beamrate-orders; } >"$folder/log" 2>&1 ||
    { tail -n 20 "$folder/log" && exit 1; }
mkdir "$folder/root"
cp "$folder/build/cli/beamrate-orders" "$folder/root"
printf 'n,L2\n10,1e-1\n20,2.5e-2\n40,6.25e-3\n80,1.5625e-3\n' >"$folder/root/errors.csv"
as_root chroot "$folder/root" /beamrate-orders orders /errors.csv --expect 'L2: h 2 +- 0.1' >"$folder/out"
grep -q PASS "$folder/out" || { cat "$folder/out" && exit 1; }
size=$(($(wc -c <"$folder/root/beamrate-orders") / 1024))
echo "$size KiB"
