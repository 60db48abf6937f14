# SPDX-License-Identifier: MIT
# shellcheck shell=sh
# Makes a minimal Debian in a folder, for scripts that test packages and archives on a fresh system. A script sources
# this file with `name` set. It gets $work, a folder that is removed at the end, and $root, where root_make puts the
# system.
fail() {
    echo "${name:?}: $*" >&2
    exit 1
}
command -v mmdebstrap >/dev/null || fail "no mmdebstrap here: scripts/setup deb installs it"
[ "$(id -u)" = 0 ] || fail "not root: expected root, which mmdebstrap needs"
work=$(mktemp -d)
root=$work/root
# Unmounts first: removing a folder with a mount in it would remove the mounted files.
root_tidy() {
    for folder in proc dev; do
        ! mountpoint -q "$root/$folder" || umount "$root/$folder"
    done
    rm -rf --one-file-system "$work"
}
trap root_tidy EXIT
trap 'exit 130' INT TERM HUP

# root_make SUITE PACKAGES: makes a system with these packages and their dependencies. Ubuntu's suites come from
# Ubuntu's archive.
root_make() {
    echo "$name: a root with $1"
    case $1 in
    jammy | noble) set -- "$@" "deb [trusted=yes] http://archive.ubuntu.com/ubuntu $1 main universe" ;;
    esac
    root_suite=$1 root_packages=$2
    shift 2
    logged "mmdebstrap $root_suite" mmdebstrap --quiet --variant=minbase --include=apt "$root_suite" "$root" "$@"
    cp /etc/resolv.conf "$root/etc/resolv.conf"
    for folder in proc dev; do mount --bind "/$folder" "$root/$folder"; done
    in_root apt-get -qq update
    logged "dependencies" in_root apt-get -qq satisfy -y --no-install-recommends "$root_packages"
    install -d -o 1000 -g 1000 "$root/tmp/user"
}
# in_root COMMAND...: runs as root. as_user COMMAND...: runs as an ordinary user with an empty environment.
in_root() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp LC_ALL=C DEBIAN_FRONTEND=noninteractive "$@"; }
as_user() { chroot --userspec=1000:1000 "$root" env -i PATH=/usr/bin:/bin HOME=/tmp/user TMPDIR=/tmp/user "$@"; }
# logged WHAT COMMAND...: if the command fails, fails with its output.
logged() {
    what=$1
    shift
    "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2 && fail "$what"; }
}
