#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# That the libraries of the general part need nothing of the beam: each symbol br_... and beamrate_...
# that one of them needs is defined in one of them. With a library of the beam among them, which is
# tried first, it must find some.
# usage: without_beam.sh NM OF-BEAM LIBRARY...
set -u
nm=$1 of_beam=$2
shift 2

# The symbols that are needed and not defined.
missing() { # LIBRARY...
    "$nm" "$@" | awk 'NF < 2 || $NF !~ /^(br|beamrate)_/ { next }
        $(NF - 1) ~ /^[Uwv]$/ { needs[$NF] = 1; next }
        { defines[$NF] = 1; count++ }
        END {
            if (!(count > 100))
                print "only " count + 0 " symbols are defined"
            for (name in needs)
                if (!(name in defines))
                    print name
        }' | sort
}

[ "$(missing "$@" "$of_beam" | grep -c '^br_')" -gt 10 ] ||
    { echo "what $of_beam needs was not found" >&2; exit 1; }
found=$(missing "$@")
[ -z "$found" ] || { echo "the general part needs:" $found >&2; exit 1; }
