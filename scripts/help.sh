# SPDX-License-Identifier: MIT
# shellcheck shell=sh
# Sourced by the developers' scripts: --help prints the comment at the start of the script, and the script ends.
case ${1-} in
-h | --help)
    sed -n '3,/^[^#]/{/^# shellcheck /d;s/^# \{0,1\}//p;}' "$0"
    exit
    ;;
esac
