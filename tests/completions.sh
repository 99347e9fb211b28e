#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What bash completes: every command, option, value and scene; and that zsh takes the same script, in a
# terminal of its own. $BEAMRATE is the program.
set -u
for tool in zsh shellcheck; do command -v $tool >/dev/null || echo "skipped: $tool is not installed"; done

failures=0
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
cd "$work" || exit 1
touch mine.yaml mine.txt folded.txt
mkdir folder
"$BEAMRATE" completions bash >beamrate.bash || exit 1
# shellcheck disable=SC1091
. ./beamrate.bash

# offers EXPECTED WORD...: the last word is being typed; EXPECTED, among others, is offered.
offers() {
    local expected=$1
    shift
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
    _beamrate
    case " ${COMPREPLY[*]} " in *" $expected "*) return ;; esac
    echo "bash: $*: offers '${COMPREPLY[*]}', expected '$expected'"
    failures=$((failures + 1))
}

# The same: nothing but EXPECTED.
offers_only() {
    local expected=$1
    offers "$@"
    [ "${COMPREPLY[*]}" = "$expected" ] && return
    echo "bash: $*: offers '${COMPREPLY[*]}', expected nothing but it"
    failures=$((failures + 1))
}

commands=$("$BEAMRATE" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
[ "$(echo "$commands" | wc -w)" -ge 5 ] || exit 1
for command in $commands; do
    offers_only "$command" beamrate "${command%?}"
    offers "$command" beamrate help ''
    "$BEAMRATE" "$command" --help | sed -nE 's/^ {2,6}(-., )?(--[-a-z]+)( ([A-Z]+))?.*/\2=\4/p' >arguments
    grep -q -e --help= arguments || failures=$((failures + 1))
    [ -z "$(sort arguments | uniq -d)" ] || failures=$((failures + 1)) # each once
    while IFS='=' read -r option argument; do
        offers "$option" beamrate "$command" "$option"
        case $argument in
        FILE) offers mine.txt beamrate "$command" "$option" m ;;
        DIR) offers_only folder beamrate "$command" "$option" '' ;;
        esac
    done <arguments
done
names() { "$BEAMRATE" help methods | sed -n "/^$1:/,/^[-A-Z]/s/^  \([-a-z0-9]*\)[: ].*/\1/p"; }
for option in --scheme --contact --friction --norm --format --kernel; do
    for name in $(names "$option"); do
        offers "$name" beamrate study example1 "$option" ''
        offers "$name" beamrate study example1 "$option" = ''
    done
done
for scene in $("$BEAMRATE" scenes | sed 's/ .*//'); do
    offers "$scene" beamrate study "$scene"
    offers "$scene" beamrate check example1 ''
done
offers_only riccati beamrate tables --solver r
offers_only umfpack beamrate tables --solver = u
offers_only riccati beamrate tables --solver = ri
offers riccati beamrate tables --solver =
offers 'fine:' beamrate study example1 --reference f
offers 'l2,tip' beamrate study example1 --norm l2,
offers 'l2,tip,energy' beamrate study example1 --norm l2,tip,e
offers_only 'csv,latex' beamrate study example1 --format = csv,l
offers_only mine.yaml beamrate study mine
offers_only '--version' beamrate --v
offers bash beamrate completions ''
offers mine.txt beamrate orders mi
offers mine.txt beamrate trade mi
offers example1 beamrate trade ex
offers_only stability beamrate extremes floors stab
offers methods beamrate help ''
offers_only folder beamrate study -o ''

if command -v zsh >/dev/null; then
    cat >pressed.zsh <<'END'
zmodload zsh/zpty
zpty z 'zsh -f -i'
zpty -w z 'PS1=; stty cols 200; autoload -Uz compinit bashcompinit; compinit -u -D; bashcompinit; . ./beamrate.bash'
zpty -w z 'show() { print -r -- "LINE<$BUFFER>"; BUFFER=; zle .accept-line }; zle -N show'
zpty -w z 'setopt no_list_ambiguous; bindkey "^X" show; print READY-"$((1 + 1))"'
zpty -r -m z out '*READY-2*'
while IFS= read -r line; do # what is on the screen after TAB
    zpty -w -n z "$line"$'\t\x18'
    zpty -r -m z out '*LINE<*>*'
    print -r -- "${out//$'\r'/} KEYS<$line>"
done
END
    # KEYS|the line after TAB, or a part of the list that is shown
    while IFS='|' read -r keys expected; do
        echo "$keys" | timeout 600 zsh -f pressed.zsh 2>&1 | grep -qF -- "$expected" && continue
        echo "zsh: $keys: expected '$expected'"
        failures=$((failures + 1))
    done <<'END'
beamrate st|LINE<beamrate study >
beamrate study --nor|LINE<beamrate study --norm >
beamrate check --solver um|LINE<beamrate check --solver umfpack >
beamrate study --norm l2,t|LINE<beamrate study --norm l2,tip >
beamrate study --reference fi|LINE<beamrate study --reference fine: >
beamrate study mov|LINE<beamrate study moving_load >
beamrate study mi|LINE<beamrate study mine.yaml >
beamrate check --junit fol|folded.txt
beamrate check -o fo|LINE<beamrate check -o folder >
beamrate orders mine.t|LINE<beamrate orders mine.txt >
END
fi
if command -v shellcheck >/dev/null; then
    shellcheck -s bash beamrate.bash || failures=$((failures + 1))
fi
[ "$failures" -eq 0 ]
