#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What bootstrap installs and when, on a made-up Debian: a second start asks for nothing. Arguments:
# bootstrap. No command but those below is in its PATH.
set -u

failures=0
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
mkdir "$work/bin" || exit 1
for tool in sh env cat grep sed dirname readlink mkdir rm; do
    ln -s "$(command -v $tool)" "$work/bin/$tool" || exit 1
done

# made NAME: a program from standard input, which finds the folder in $W.
made() {
    { printf '#!/bin/sh\nW=%s\n' "$work" && cat; } >"$work/bin/$1"
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
made gnuplot </dev/null
made meson <<'END'
[ "$1" != setup ] || mkdir -p "$2/meson-private"
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

every_package=$(sed -n '/^packages="/,/"$/s/^\([a-z][-a-z0-9]*\) .*/\1/p' "$1")
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

# starts CODE CALLS WHAT: bootstrap ends with CODE, after so many calls of apt-get and sudo.
starts() {
    local code=0 calls
    : >"$work/calls"
    PATH=$work/bin "$work/tree/bootstrap" build >"$work/said" 2>&1 </dev/null || code=$?
    calls=$(wc -l <"$work/calls")
    [ "$code" -eq "$1" ] && [ "$calls" -eq "$2" ] && return
    echo "$3: exit code $code after $calls calls, expected $1 after $2"
    sed 's/^/    /' "$work/calls" "$work/said"
    failures=$((failures + 1))
}

machine "$1"
starts 0 0 'everything is there'

machine "$1" gnuplot-nox
starts 0 0 'an optional program is there, from another package'

machine "$1" libhdf5-dev libopenmpi-dev
starts 0 6 'two optional packages are not to be had'
starts 0 0 'the same again'
echo libopenmpi-dev >"$work/to_be_had"
rm "$work/tree/build/not-installed"
starts 0 6 'one of them is, now'
starts 0 0 'and stays'
grep -q '^libopenmpi-dev$' "$work/installed" || failures=$((failures + 1))

machine "$1" libgsl-dev libhdf5-dev
echo libgsl-dev >"$work/to_be_had"
starts 0 6 'a needed package beside an optional one that is not to be had'
starts 0 0 'the same again'

machine "$1" libgsl-dev
starts 3 4 'a needed package is not to be had'
starts 3 4 'and is tried again'

[ "$failures" -eq 0 ]
