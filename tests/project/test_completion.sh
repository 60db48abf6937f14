#!/bin/sh
# SPDX-License-Identifier: MIT
# Completion of all programs in bash, zsh and fish: every shell is asked for its completions of a line.
. tests/support/claims.sh
shells=$work/shells
mkdir -p "$shells/bash" "$shells/zsh" "$shells/fish" "$work/home"
for name in render gen convert compare bench; do
    "$bin/tractrix-$name" --help=bash >"$shells/bash/tractrix-$name"
    "$bin/tractrix-$name" --help=zsh >"$shells/zsh/_tractrix-$name"
    "$bin/tractrix-$name" --help=fish >"$shells/fish/tractrix-$name.fish"
done
for name in farm turntable compare-goldens; do
    scripts/help-pages bash "$bin/tractrix-$name" 0 >"$shells/bash/tractrix-$name"
    scripts/help-pages zsh "$bin/tractrix-$name" 0 >"$shells/zsh/_tractrix-$name"
    scripts/help-pages fish "$bin/tractrix-$name" 0 >"$shells/fish/tractrix-$name.fish"
done

# The completions of LINE, one on each line. bash gets the words as its line editor would split them: '=' is a word.
ask_bash() {
    # shellcheck disable=SC2016 # for the inner bash
    bash --norc -c 'source "$1"/"${2%% *}"; compopt() { :; }
        words=${2//=/ = }; [[ $words == *" " ]] && words+="\"\""; eval "COMP_WORDS=($words)"
        COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
        "_${2%% *}"; printf "%s\n" "${COMPREPLY[@]}"' - "$shells/bash" "$1"
}
ask_fish() {
    # shellcheck disable=SC2016 # for fish
    HOME=$work/home fish --no-config -c 'set fish_complete_path $argv[1]; complete -C $argv[2]' "$shells/fish" "$1" | cut -f1 | sed 's/^--[a-z-]*=//'
}

# offers LINE [WORD...]: every shell must offer exactly these words. The shells are asked at the end.
lines=0
offers() {
    lines=$((lines + 1))
    printf '%s' "$1" >"$work/line.$lines"
    printf '%s' "$claim" >"$work/claim.$lines"
    shift
    for word in "$@"; do echo "$word"; done | sort >"$work/expected.$lines"
}

# compare SHELL NUMBER: its completions are in $work/out. Files may come with or without their folder, folders with or
# without a slash.
compare() {
    sed 's|/$||; s|.*/||; /^$/d' "$work/out" | sort -u >"$work/offered"
    claim="$1: $(cat "$work/claim.$2")"
    if cmp -s "$work/offered" "$work/expected.$2"; then good; else
        bad "$(cat "$work/line.$2"): offers '$(tr '\n' ' ' <"$work/offered")', expected '$(tr '\n' ' ' <"$work/expected.$2")'"
    fi
}

ask_all() {
    PATH=$(cd "$bin" && pwd):$PATH
    for number in $(seq $lines); do
        ask_bash "$(cat "$work/line.$number")" >"$work/out" 2>"$work/err"
        compare bash "$number"
        command -v fish >/dev/null || continue
        ask_fish "$(cat "$work/line.$number")" >"$work/out" 2>"$work/err"
        compare fish "$number"
    done
    command -v zsh >/dev/null || return 0
    set --
    for number in $(seq $lines); do set -- "$@" "$(cat "$work/line.$number")"; done
    tests/support/complete_in_zsh "$shells/zsh" "$work/zsh" "$@" >"$work/out" 2>"$work/err" || bad "complete_in_zsh"
    for number in $(seq $lines); do
        cp "$work/zsh$number" "$work/out"
        compare zsh "$number"
    done
}
for shell in zsh fish; do command -v $shell >/dev/null || skip "no $shell"; done

claim "options"
offers "tractrix-render --turn" --turn-lights --turntable
offers "tractrix-render --transm" --transmission
offers "tractrix-compare --max-f" --max-failing-pixels --max-flip
offers "tractrix-bench --warm" --warm-up

claim "the words of an option, also behind '='"
offers "tractrix-render --raster " auto blocks compute quads
offers "tractrix-render --raster=b" blocks
offers "tractrix-render --algo e" emulation
offers "tractrix-render --color aub" auburn
offers "tractrix-render --help sc" scene schema
offers "tractrix-gen --kind cu" curls
offers "tractrix-convert --to-up " y z

claim "files and folders, as options' values and by themselves"
offers "tractrix-render --mesh assets/hea" head.obj
offers "tractrix-render assets/dem" demo.json demo.tfx
offers "tractrix-render -o asse" assets
offers "tractrix-compare --json READ" README.md
offers "tractrix-bench speed --reference sr" src

claim "nothing for a number"
offers "tractrix-render --frames 1"
offers "tractrix-bench --hair-density "

claim "switches are switched off"
offers "tractrix-render --no-coll" --no-collide --no-collide-mesh
offers "tractrix-bench --no-e" --no-error

claim "commands, with options of their own"
offers "tractrix-bench st" step stress
offers "tractrix-gen fu" fur
offers "tractrix-gen fur --comb" --comb --comb-reach
offers "tractrix-gen --comb"
offers "tractrix-gen fur assets/hea" head.obj

claim "programs that are scripts: their words, their options, and those of the program that they run"
offers "tractrix-farm pl" plain
offers "tractrix-farm --par" --part --parts
offers "tractrix-farm plain -o x assets/gust.json --alg" --algo
offers "tractrix-farm plain -o x assets/gust.json --algo rop" rope
offers "tractrix-turntable assets/gust.json sh" sheet
offers "tractrix-turntable assets/gus" gust.json
offers "tractrix-turntable --sec" --seconds
offers "tractrix-turntable assets/gust.json sheet --raster " auto blocks compute quads
offers "tractrix-compare-goldens tests/gold" golden goldens.txt
offers "tractrix-compare-goldens tests/goldens.txt tests/golden/ x/ --pix" --pixel-tolerance

claim "the files are sound, of every shell"
for name in render gen convert compare bench farm turntable compare-goldens; do
    holds bash -n "$shells/bash/tractrix-$name"
    ! command -v zsh >/dev/null || holds zsh -n "$shells/zsh/_tractrix-$name"
    ! command -v fish >/dev/null || holds fish --no-execute "$shells/fish/tractrix-$name.fish"
done

ask_all
finish
