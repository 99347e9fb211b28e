#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# docs/options.md and docs/beamrate.1 are what the program writes of itself; roff takes the page, where
# it is installed. The files that name the version name the same; Debian's lists name what is installed.
# usage: manual.sh BUILD; $BEAMRATE is the program, $BEAMRATE_DATA the project.
set -u
command -v groff >/dev/null || echo "skipped: groff is not installed"

failures=0
for file in options.md beamrate.1; do
    case $file in
    *.md) topic=markdown ;;
    *) topic=man ;;
    esac
    "$BEAMRATE" help "$topic" | diff - "$BEAMRATE_DATA/docs/$file" && continue
    echo "docs/$file is stale: ./bootstrap update writes it anew"
    failures=$((failures + 1))
done
if grep -nE '.\.(SH|SS|TP|PP|B|nf|fi)( |$)' "$BEAMRATE_DATA/docs/beamrate.1"; then
    echo "docs/beamrate.1: a request of roff inside of a line"
    failures=$((failures + 1))
fi
if command -v groff >/dev/null; then
    errors=$(groff -man -Tutf8 -ww "$BEAMRATE_DATA/docs/beamrate.1" 2>&1 >/dev/null)
    [ -z "$errors" ] || { echo "$errors"; failures=$((failures + 1)); }
fi
# The version stands in the top meson.build; these repeat it, since others read them.
version=$("$BEAMRATE" --version | sed -n '1s/beamrate \([^ ]*\) .*/\1/p')
check() { # FILE LINE
    grep -qx "$2" "$BEAMRATE_DATA/$1" && return
    echo "$1: no line '$2', expected the version of meson.build"
    failures=$((failures + 1))
}
check CITATION.cff "version: $version"
check debian/changelog "beamrate ($version-1) .*"
check CHANGELOG.md "## $version - .*"
check action.yml "#   - uses: OWNER/beamrate@v$version"
check docs/ci/your-solver.yml "      BEAMRATE_ARCHIVE: https://example.org/beamrate-$version.tar.gz"
# Each path that a package of Debian takes is one that is installed.
installed=$(meson introspect --installed "$1" | tr , '\n')
for list in "$BEAMRATE_DATA"/debian/*.install; do
    grep -q libbeamrate.a <<<"$installed" || break # this build installs no library
    while read -r path _; do
        grep -q "/$(sed 's|^usr/||; s|\.|\\.|g; s|lib/\*/|lib[^ ]*/|; s|\*$||' <<<"$path")" <<<"$installed" && continue
        echo "$list: $path: nothing that is installed"
        failures=$((failures + 1))
    done <"$list"
done
# And each program is in a package, with a manual page.
for program in $(grep -oE '/bin/[a-z-]+"' <<<"$installed" | tr -d '"' | sort -u); do
    page=share/man/man1/${program##*/}.1
    { grep -q "/$page" <<<"$installed" || grep -q " usr/$page$" "$BEAMRATE_DATA"/debian/*.links; } || {
        echo "debian: usr$program has no manual page"
        failures=$((failures + 1))
    }
    grep -qx "usr$program" "$BEAMRATE_DATA"/debian/*.install && continue
    echo "debian: usr$program is in no package"
    failures=$((failures + 1))
done
[ "$failures" -eq 0 ]
