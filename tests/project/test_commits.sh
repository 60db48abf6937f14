#!/bin/sh
# SPDX-License-Identifier: MIT
# scripts/check-commits finds each kind of fault in a commit message, and none in good messages.
. tests/support/claims.sh
program=$work/here/scripts/check-commits
mkdir -p "$work/here/src" "$work/here/scripts" && cp scripts/check-commits scripts/help.sh "$work/here/scripts/"
cd "$work/here" || exit 1

claim 'without a history it says so'
run 77
says 'no git history'

git init -q . && git config user.name Somebody && git config user.email somebody@localhost

# commits LINES MESSAGE: makes a commit that changes this many lines of src.
commits() {
    seq "$1" >src/a.c
    git add . && git commit -q --allow-empty -m "$2"
    git rm -q --cached src/a.c
}

# finds MESSAGE FAULT [LINES]
finds() {
    claim "'$1'"
    commits "${3:-1}" "$1"
    run 1 -1
    says "$2"
    [ "$(wc -l <"$work/out")" = 1 ] || bad 'not one line'
}

for message in 'Keep a strand that lies still' "$(printf 'Process rows\n\nThey were forgotten.')" 'Bring back the tip' "Focus the eye on a$(printf '%053d' 0)"; do
    claim "'$message' is good"
    commits 1 "$message"
    run 0 HEAD~..HEAD
    silent out
done
finds "Keep $(printf '%068d' 0)" '73 characters: expected at most 72'
finds 'Keeps a strand' "begins with 'Keeps'"
finds 'Kept: a strand' "begins with 'Kept:'"
finds 'Keeping a strand' "begins with 'Keeping'"
finds 'Added a strand' "begins with 'Added'"
finds 'keep a strand' "begins with 'keep'"
finds 'Keep a strand.' 'full stop'
finds 'Move all strands' 'without a body' 100
claim 'a reason makes it good'
commits 100 "$(printf 'Move all strands\n\nThe solver reads them in this order.')"
run 0 HEAD~..HEAD
claim 'the last ones are looked at where nothing is asked for'
run 1
says 'Move all strands'
finish
