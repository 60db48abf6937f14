#!/bin/sh
# SPDX-License-Identifier: MIT
# The Python module from its wheel, in a separate virtual environment and without network: pytest runs tests/python/.
. tests/support/claims.sh
python=/usr/bin/python3
[ -x $python ] || python=python3
programs=$(realpath "$bin")

claim "what the tests need is there: scripts/setup python installs it"
# All are found by one process; those that are there and broken fail below.
holds $python -c 'import importlib.util, sys
sys.exit(", ".join(f"no {name}" for name in sys.argv[1:] if not importlib.util.find_spec(name)) or 0)' numpy pytest build setuptools wheel venv
holds patchelf --version
[ "$failed" = 0 ] || finish

claim "the wheel is for every Python 3 of this kind of machine"
holds scripts/make-wheel "$programs" "$work/wheel" 0.0.1
set -- "$work"/wheel/*
if [ $# = 1 ]; then good; else bad "$# files"; fi
case ${1##*/} in tractrix-0.0.1-py3-none-manylinux_2_[0-9]*_*.whl) good ;; *) bad "named ${1##*/}" ;; esac

claim "it is installed without a network"
offline=$(unshare --net --map-root-user true 2>/dev/null && echo "unshare --net --map-root-user")
# The wheel of pip installs without being installed itself, which takes 2 s. It lies in Debian's folder or in Python's own.
pip=$(find /usr/share/python-wheels "$($python -c 'import ensurepip; print(ensurepip.__path__[0])')/_bundled" -name 'pip-*.whl' 2>/dev/null | head -n 1)
if [ -n "$pip" ]; then pip=$pip/pip without=--without-pip; else pip=$work/venv/bin/pip without=; fi
# shellcheck disable=SC2086 # words
holds $python -m venv --system-site-packages $without "$work/venv"
# shellcheck disable=SC2086 # words
holds $offline "$work/venv/bin/python" "$pip" --quiet --disable-pip-version-check install --no-index "$1"

claim "its tests hold"
export PYTHONDONTWRITEBYTECODE=1 TRACTRIX_BIN="$programs"
unset TRACTRIX_LIBRARY PYTHONPATH
# shellcheck disable=SC2086
if $offline "$work/venv/bin/python" -m pytest -q -p no:cacheprovider --rootdir=. tests/python >"$work/out" 2>"$work/err" </dev/null; then good; else bad "see above"; fi
tests=$(sed -nE 's/^(.*, )?([0-9]+) passed.*/\2/p' "$work/out")
passed=$((passed + ${tests:-0}))
if [ "${tests:-0}" -gt 80 ]; then good; else bad "${tests:-no} tests passed"; fi
if grep -q ' skipped' "$work/out"; then skip "$(tail -n 1 "$work/out")"; fi
finish
