// SPDX-License-Identifier: MIT
// Runs within a page that is tested, before the test's own script (browser.sh).
"use strict";

const claims = [];
const claim = (text, holds) => claims.push((holds ? "good: " : "FAILED: ") + text);
const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// The browser's clock is virtual and leaps over waiting, but images are decoded in real time: each turn takes some of that.
async function until(holds, what) {
    for (let i = 0; i < 2000 && !holds(); ++i) {
        await wait(10);
        for (let k = 0, x = 0; k < 2e6; ++k) x += Math.sqrt(k);
    }
    claim(what, Boolean(holds()));
}

// The promise's value. Work of the browser alone, as of createImageBitmap, does not hold back the virtual clock: while a
// script waits for nothing else, the clock leaps to its end, and so does the test.
async function value(promise, what) {
    let kept, settled = false;
    promise.then((result) => (kept = result)).finally(() => (settled = true));
    await until(() => settled, what);
    return kept;
}

function press(key, more = {}) {
    document.activeElement.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true, ...more }));
}

function point(target, kind, x, y) {
    target.dispatchEvent(new PointerEvent(kind, { clientX: x, clientY: y, pointerId: 1, button: 0, bubbles: true, cancelable: true }));
}

// A failure of the page itself counts.
addEventListener("error", (event) => claim("no error: " + event.message, false));
addEventListener("unhandledrejection", (event) => claim("no rejection: " + event.reason, false));
addEventListener("securitypolicyviolation", (event) => claim("nothing against the policy: " + event.violatedDirective + " " + event.blockedURI, false));

function finish() {
    claim("the script came to its end", true);
    const list = document.createElement("pre");
    list.id = "claims";
    list.textContent = "\n" + claims.join("\n") + "\n";
    document.documentElement.replaceChildren(list);
}
