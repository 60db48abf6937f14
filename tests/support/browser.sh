#!/bin/sh
# SPDX-License-Identifier: MIT
# For tests of pages; source it after claims.sh. Runs scripts within a page in a headless Chromium.
work=${work:?claims.sh makes it}
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || browser=

# drive PAGE SCRIPT...: opens a copy of the page in which the scripts (files) run at the end; the page's policy would
# forbid that. They call `claim(text, holds)` and finally `finish()`; each claim counts in the test.
drive() {
    page=$1
    shift
    { sed "s/script-src [^;]*;/script-src 'unsafe-inline';/" "$page" && echo '<script>(() => {' && cat tests/support/browser.js "$@" && echo '})();</script>'; } >"$work/driven.html"
    dump "$work/driven.html" "${size:-1280,800}"
    # shellcheck disable=SC2016 # sed's words
    sed -n 's/.*<pre id="claims">//; s/&lt;/</g; s/&gt;/>/g; s/&amp;/\&/g; s/^\(good\|FAILED\): /&/p' "$work/dump" >"$work/claims"
    passed=$((passed + $(grep -c '^good: ' "$work/claims")))
    if grep -q '^FAILED: ' "$work/claims"; then
        failed=$((failed + $(grep -c '^FAILED: ' "$work/claims")))
        grep '^FAILED: ' "$work/claims"
    fi
    if grep -q '^good: the script came to its end' "$work/claims"; then good; else bad "the driving script did not finish: $(grep CONSOLE "$work/browser.log")"; fi
}

# dump PAGE [WIDTH,HEIGHT]: writes the page's elements, after its scripts have run, to $work/dump.
dump() {
    HOME=$work timeout 300 "$browser" --headless --enable-logging=stderr --no-sandbox --disable-gpu --hide-scrollbars --window-size="${2:-1280,800}" \
        --user-data-dir="$work/profile" --virtual-time-budget=600000 --dump-dom "file://$1" >"$work/dump" 2>"$work/browser.log" </dev/null
}
