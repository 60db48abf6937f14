// SPDX-License-Identifier: MIT
// The page of tractrix-compare: a list of pairs, one of them in a viewer, its figures beside it.
"use strict";

const OUTCOMES = {
    // word: [severity, class, heading]
    failed: [6, "bad", "Failed"],
    unreadable: [5, "bad", "Unreadable"],
    unrendered: [4.5, "bad", "Not rendered"],
    different: [3.4, "bad", "Different"], // and the mean of FLIP, below 1
    "size mismatch": [3, "warn", "Size mismatch"],
    missing: [2, "warn", "Missing"],
    new: [1.5, "warn", "New"],
    updated: [1, "warn", "Updated"],
    "within limits": [0.5, "good", "Within limits"],
    same: [0, "good", "Same"],
};
const MODES = [
    ["side", "Side by side"],
    ["slider", "Slider"],
    ["blink", "Blink"],
    ["heat", "Heat map"],
    ["difference", "Difference"],
];
const BLINK_MS = 600;
const MOST_SCALE = 64;

const outcomeOf = (pair) => (pair.updated ? "updated" : pair.outcome);
const limitsOf = (pair) => (pair.level ? data.limits[pair.level] : data.limits); // of goldens by platform
const classOf = (pair) => OUTCOMES[outcomeOf(pair)][1];
const severity = (pair) => OUTCOMES[outcomeOf(pair)][0] + (pair.flip || 0);

const pairs = data.pairs.map((pair, at) => ({ ...pair, at_pixel: pair.at, at }));
pairs.sort((p, q) => severity(q) - severity(p) || p.at - q.at);

const state = {
    chosen: null, // a pair
    outcome: null, // only these; null: all
    filter: "",
    mode: "side",
    marked: new Set(),
    scale: 1,
    x: 0, // where the image's corner is in a pane, px
    y: 0,
    fits: true,
    spot: null, // a pixel that has a frame: x, y
    slider: 0.5, // of the pane
    shows: "b", // while blinking
    heat: 1, // opacity
    gain: 8, // of the difference
};

// --- Images. They lie behind the page's scripts, so a large page shows its list before they have come.

const loaded = new Promise((resolve) => {
    if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", resolve);
    else resolve();
});

async function blobOf(number) {
    if (!byId("image-" + number)) await loaded;
    const text = byId("image-" + number).textContent;
    const bytes = Uint8Array.fromBase64 ? Uint8Array.fromBase64(text) : Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new Blob([bytes], { type: typeOf(text) });
}

// Of base64: a JPEG file begins with the bytes FF D8 FF.
const typeOf = (text) => (text.startsWith("/9j/") ? "image/jpeg" : "image/png");

// What is decoded of the pair in the viewer: its own, so that a long list does not fill the memory.
class Pictures {
    constructor(pair) {
        this.pair = pair;
        this.urls = [];
        this.pixels = {};
    }
    number(which) {
        return which === "map" ? this.pair.map : this.pair[which].image;
    }
    async url(which) {
        const url = URL.createObjectURL(await blobOf(this.number(which)));
        this.urls.push(url);
        return url;
    }
    // ImageData of a or b, by a bitmap without conversions: the file's own levels.
    async levels(which) {
        if (this.number(which) === undefined) return null;
        if (!this.pixels[which]) {
            const bitmap = await createImageBitmap(await blobOf(this.number(which)), { premultiplyAlpha: "none", colorSpaceConversion: "none" });
            const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
            const context = canvas.getContext("2d", { willReadFrequently: true });
            context.drawImage(bitmap, 0, 0);
            this.pixels[which] = context.getImageData(0, 0, bitmap.width, bitmap.height);
        }
        return this.pixels[which];
    }
    release() {
        this.urls.forEach((url) => URL.revokeObjectURL(url));
    }
}
let pictures = null;

// --- The list.

const shown = () =>
    pairs.filter((pair) => (!state.outcome || outcomeOf(pair) === state.outcome) && pair.name.toLowerCase().includes(state.filter.toLowerCase()));

function remark(pair) {
    if (pair.rmse === undefined) return pair.updated ? "" : pair.outcome === "missing" ? "no new file" : pair.outcome === "new" ? "no reference" : "";
    return pair.equal ? "identical" : pair.flip === 0 ? "looks equal" : "FLIP " + figure(pair.flip, 3);
}

function row(pair) {
    const thumbnail = pair.thumbnail
        ? element("img", { class: "thumbnail", src: "data:" + typeOf(pair.thumbnail) + ";base64," + pair.thumbnail, alt: "", loading: "lazy", decoding: "async" })
        : element("span", { class: "thumbnail", text: "no image" });
    const what = element("div", { class: "what " + classOf(pair) }, element("span", { class: "dot" }), element("span", { class: "word", text: OUTCOMES[outcomeOf(pair)][2] }),
        element("span", { class: "number", text: remark(pair) }), element("span", { class: "marked", text: state.marked.has(pair) ? "✓" : "" }));
    const item = element("li", { id: "pair-" + pair.at, role: "option", title: pair.name, "aria-selected": String(pair === state.chosen) }, thumbnail, element("div", {}, element("div", { class: "name", text: pair.name }), what));
    item.addEventListener("click", () => choose(pair));
    return item;
}

function drawList() {
    const list = shown();
    byId("list").replaceChildren(...list.map(row));
    byId("nothing").hidden = list.length > 0;
    drawAccepting();
    return list;
}

function drawAccepting() {
    const list = accepting();
    byId("accepting").hidden = !list.length || !data.many;
    byId("accept-all").textContent = "Copy " + list.length + (list.length === 1 ? " accept command" : " accept commands");
}

// What the button at the list's end copies: the marked ones, or all that are shown.
const accepting = () => (state.marked.size ? pairs.filter((pair) => state.marked.has(pair)) : shown().filter((pair) => pair.accept));

function drawOutcomes() {
    const chip = (outcome, label, count) => {
        const button = element("button", { class: outcome ? OUTCOMES[outcome][1] : "", "aria-pressed": String(state.outcome === outcome), "data-outcome": outcome || "all" },
            outcome ? element("span", { class: "dot" }) : null, element("span", { text: label }), element("span", { class: "number", text: count }));
        button.addEventListener("click", () => setOutcome(state.outcome === outcome ? null : outcome));
        return button;
    };
    const chips = Object.entries(OUTCOMES).map(([word, [, , heading]]) => [word, heading, pairs.filter((pair) => outcomeOf(pair) === word).length]);
    byId("outcomes").replaceChildren(chip(null, "All", pairs.length), ...chips.filter(([, , count]) => count).map((words) => chip(...words)));
}

function setOutcome(outcome) {
    state.outcome = outcome;
    drawOutcomes();
    refresh();
}

// After a change of the filter: the chosen pair stays if it is still there.
function refresh() {
    const list = drawList();
    if (list.length && !list.includes(state.chosen)) choose(list[0]);
    say(list.length + " of " + pairs.length + " images");
}

function step(by) {
    const list = shown(), at = list.indexOf(state.chosen);
    if (list.length) choose(list[Math.min(Math.max(at + by, 0), list.length - 1)]);
}

function choose(pair) {
    const before = state.chosen && byId("pair-" + state.chosen.at);
    const same = state.chosen && sizeOf(state.chosen).join() === sizeOf(pair).join();
    if (before) before.setAttribute("aria-selected", "false");
    state.chosen = pair;
    const item = byId("pair-" + pair.at);
    if (item) {
        item.setAttribute("aria-selected", "true");
        item.scrollIntoView({ block: "nearest", inline: "nearest" });
        byId("list").setAttribute("aria-activedescendant", item.id);
    }
    writeAddress();
    if (!same) state.fits = true;
    state.spot = null;
    showPair();
    drawDetails();
    say(pair.name + ": " + OUTCOMES[outcomeOf(pair)][2]);
}

// --- The address: #NAME?view=MODE, so that a link leads to an image.

function writeAddress() {
    history.replaceState(null, "", "#" + encodeURIComponent(state.chosen.name) + (state.mode === "side" ? "" : "?view=" + state.mode));
}

function readAddress() {
    const [name, view] = location.hash.slice(1).split("?view=");
    if (MODES.some(([mode]) => mode === view)) state.mode = view;
    try {
        return pairs.find((pair) => pair.name === decodeURIComponent(name));
    } catch {
        return undefined; // no escapes that mean something
    }
}

// --- The viewer.

const panes = { a: byId("pane-a"), b: byId("pane-b") };
const stage = byId("stage");

// Of the larger image.
function sizeOf(pair) {
    return [Math.max(pair.a.width || 0, pair.b.width || 0) || 1, Math.max(pair.a.height || 0, pair.b.height || 0) || 1];
}

const isHere = (which) => pictures.number(which) !== undefined;

async function showPair() {
    const pair = state.chosen;
    if (pictures) pictures.release();
    pictures = new Pictures(pair);
    const mine = pictures;
    byId("name").textContent = pair.name;
    byId("outcome").className = classOf(pair);
    byId("outcome").replaceChildren(element("span", { class: "dot" }), element("span", { class: "word", text: OUTCOMES[outcomeOf(pair)][2] }), element("span", { text: sentence(pair) }));
    for (const pane of Object.values(panes)) pane.querySelector(".plane").replaceChildren();
    byId("readout").replaceChildren();
    drawMode();
    const add = async (pane, which) => {
        if (mine !== pictures || !isHere(which)) return;
        const image = element("img", { alt: which === "map" ? "Heat map" : (which === "a" ? "Reference " : "New ") + pair.name, class: which, draggable: "false" });
        image.src = await mine.url(which);
        if (mine === pictures) panes[pane].querySelector(".plane").append(image);
    };
    await add("b", "b");
    await add("a", "a");
    await add("b", "a");
    await add("b", "map");
    if (mine !== pictures) return;
    drawMode();
    stage.dataset.ready = pair.name;
}

// What is left to say behind the outcome.
function sentence(pair) {
    if (pair.rmse !== undefined && pair.equal) return "every pixel is equal";
    if (pair.outcome === "different" && pair.exact) return "the same driver and processor drew both, so they must be equal";
    if (pair.outcome === "different") return figure(100 * pair.failing_pixels / pair.compared_pixels, 3) + " % of the pixels fail";
    if (pair.rmse !== undefined) return pair.largest_difference === 0 ? "they look equal" : "at most " + figure(pair.largest_difference, 3) + " levels";
    return pair.text || "";
}

function setMode(mode) {
    state.mode = mode;
    drawMode();
    writeAddress();
}

// What a mode lacks, in words; empty: nothing.
function lack(mode) {
    const pair = state.chosen;
    const lost = ["a", "b"].find((which) => !isHere(which));
    if (mode === "side") return "";
    if (lost) return (lost === "a" ? "There is no reference" : "There is no new image") + " to compare with";
    if (mode === "heat" && !isHere("map")) return pair.rmse === undefined ? "No heat map: the sizes differ" : "No heat map: the images look equal";
    return "";
}

function emptyText(which) {
    const side = state.chosen[which];
    return isHere(which) ? "" : side.error || (which === "a" ? "No reference: " : "No new image: ") + side.path;
}

let blinking = null;

function drawMode() {
    const mode = state.mode, missing = lack(mode);
    stage.dataset.mode = mode;
    for (const button of byId("modes").children) {
        const chosen = button.dataset.mode === mode;
        button.setAttribute("aria-checked", String(chosen));
        button.tabIndex = chosen ? 0 : -1;
    }
    panes.a.querySelector(".empty").textContent = emptyText("a");
    panes.b.querySelector(".empty").textContent = mode === "side" ? emptyText("b") : missing;
    panes.b.querySelector(".plane").hidden = Boolean(missing);
    clearInterval(blinking);
    blinking = null;
    if (mode === "blink" && !missing && !matchMedia("(prefers-reduced-motion: reduce)").matches) blink();
    drawAmount();
    if (state.fits) fit();
    else place();
    if (mode === "difference" && !missing) drawDifference();
    drawLayers();
}

function blink() {
    blinking = setInterval(() => {
        state.shows = state.shows === "a" ? "b" : "a";
        drawLayers();
    }, BLINK_MS);
}

// Space: stops and starts; without blinking it shows the other image.
function toggleBlink() {
    if (state.mode !== "blink") return setMode("blink");
    if (blinking) {
        clearInterval(blinking);
        blinking = null;
    } else blink();
    drawAmount();
}

function showSide(which) {
    clearInterval(blinking);
    blinking = null;
    state.shows = which;
    drawAmount();
    drawLayers();
}

// Which images are seen in the second pane, and how much of them.
function drawLayers() {
    const plane = panes.b.querySelector(".plane"), mode = state.mode;
    for (const layer of plane.children) {
        const kind = layer.className;
        const seen = mode === "side" ? kind === "b" : mode === "slider" ? kind === "a" || kind === "b" : mode === "blink" ? kind === state.shows : mode === "heat" ? kind === "b" || kind === "map" : kind === "difference";
        layer.hidden = !seen;
        layer.style.zIndex = kind === "a" ? 0 : kind === "b" ? 1 : 2;
        layer.style.opacity = kind === "map" ? state.heat : 1;
        layer.style.clipPath = mode !== "slider" ? "" : clip(kind);
    }
    const left = panes.b.querySelector(".tag.left"), right = panes.b.querySelector(".tag.right");
    left.hidden = mode === "blink" && state.shows !== "a";
    right.hidden = mode === "blink" && state.shows !== "b";
    right.textContent = { heat: "FLIP error over B", difference: "Difference × " + state.gain }[mode] || "B new";
    const divider = byId("divider");
    divider.style.left = 100 * state.slider + "%";
    divider.setAttribute("aria-valuenow", Math.round(100 * state.slider));
    stage.dataset.shows = state.shows;
}

// In the image's pixels: A left of the divider, B right of it.
function clip(kind) {
    const cut = (state.slider * panes.b.clientWidth - state.x) / state.scale;
    return kind === "a" ? "inset(0 max(0px, calc(100% - " + cut + "px)) 0 0)" : "inset(0 0 0 " + Math.max(cut, 0) + "px)";
}

function setSlider(share) {
    state.slider = Math.min(Math.max(share, 0), 1);
    drawLayers();
}

// The knob of a mode: opacity of the heat map, gain of the difference, pace of blinking.
function drawAmount() {
    const label = byId("amount"), [word, knob, value] = label.children;
    label.hidden = !["heat", "difference"].includes(state.mode) || Boolean(lack(state.mode));
    byId("legend").hidden = state.mode !== "heat" || label.hidden;
    if (state.mode === "heat") {
        word.textContent = "Opacity";
        Object.assign(knob, { min: 0, max: 1, step: 0.05, value: state.heat });
        value.textContent = Math.round(100 * state.heat) + " %";
    } else if (state.mode === "difference") {
        word.textContent = "Gain";
        Object.assign(knob, { min: 0, max: 6, step: 1, value: Math.log2(state.gain) });
        value.textContent = "× " + state.gain;
    }
}

byId("amount").querySelector("input").addEventListener("input", (event) => {
    if (state.mode === "heat") state.heat = Number(event.target.value);
    else state.gain = 2 ** Number(event.target.value);
    drawAmount();
    if (state.mode === "difference") drawDifference();
    drawLayers();
});

// |A - B| of each channel, and alpha's difference in all three, times the gain.
async function drawDifference() {
    const mine = pictures, gain = state.gain;
    const [a, b] = [await mine.levels("a"), await mine.levels("b")];
    if (mine !== pictures || state.mode !== "difference" || !a || !b) return;
    const [width, height] = [Math.min(a.width, b.width), Math.min(a.height, b.height)];
    const made = new ImageData(width, height);
    for (let y = 0; y < height; ++y)
        for (let x = 0; x < width; ++x) {
            const i = 4 * (y * a.width + x), j = 4 * (y * b.width + x), to = 4 * (y * width + x);
            const alpha = Math.abs(a.data[i + 3] - b.data[j + 3]);
            for (let k = 0; k < 3; ++k) made.data[to + k] = gain * Math.max(Math.abs(a.data[i + k] - b.data[j + k]), alpha);
            made.data[to + 3] = 255;
        }
    const plane = panes.b.querySelector(".plane");
    plane.querySelector(".difference")?.remove();
    const canvas = element("canvas", { class: "difference", width, height });
    canvas.getContext("2d").putImageData(made, 0, 0);
    plane.append(canvas);
    drawLayers();
}

// --- Zoom and place.

// Both panes have one place and scale.
function place() {
    const ratio = window.devicePixelRatio || 1;
    for (const [which, pane] of Object.entries(panes)) {
        const plane = pane.querySelector(".plane"), ground = pane.querySelector(".ground");
        const side = state.chosen[which], shown = isHere(which) && !(which === "b" && lack(state.mode));
        plane.style.transform = "translate(" + state.x + "px, " + state.y + "px) scale(" + state.scale + ")";
        plane.classList.toggle("pixels", state.scale * ratio >= 1.5);
        const spot = pane.querySelector(".spot");
        spot.hidden = !state.spot || state.scale < 6;
        if (state.spot) Object.assign(spot.style, { left: state.x + state.spot[0] * state.scale + "px", top: state.y + state.spot[1] * state.scale + "px", width: state.scale + "px", height: state.scale + "px" });
        Object.assign(ground.style, { left: state.x + "px", top: state.y + "px", width: (shown ? side.width : 0) * state.scale + "px", height: (shown ? side.height : 0) * state.scale + "px" });
    }
    byId("zoom-fit").textContent = (state.fits ? "Fit " : "") + figure(100 * state.scale, 3) + " %";
    stage.dataset.scale = state.scale;
    drawLayers();
}

// The pane that is seen: in all modes but one the first is not.
const room = () => [panes.b.clientWidth, panes.b.clientHeight];

// Side by side or one above the other, whichever shows them larger.
function arrange() {
    const [width, height] = sizeOf(state.chosen), [across, down] = [stage.clientWidth, stage.clientHeight];
    const beside = Math.min(across / 2 / width, down / height), above = Math.min(across / width, down / 2 / height);
    stage.classList.toggle("column", state.mode === "side" && above > 1.1 * beside);
}

function fit() {
    arrange();
    const [width, height] = sizeOf(state.chosen), [across, down] = room();
    const most = Math.min(across / width, down / height);
    state.scale = most >= 2 ? Math.min(Math.floor(most), 8) : most || 1;
    state.x = (across - width * state.scale) / 2;
    state.y = (down - height * state.scale) / 2;
    state.fits = true;
    place();
}

// Keeps what is under (x, y) of the pane where it is.
function zoom(factor, x = room()[0] / 2, y = room()[1] / 2) {
    const scale = Math.min(Math.max(state.scale * factor, 0.05), MOST_SCALE);
    state.x = x - (x - state.x) * scale / state.scale;
    state.y = y - (y - state.y) * scale / state.scale;
    state.scale = scale;
    state.fits = false;
    place();
}

function zoomTo(scale) {
    zoom(scale / state.scale);
}

function pan(x, y) {
    state.x += x;
    state.y += y;
    state.fits = false;
    place();
}

// A pixel in the middle, large.
function goTo(x, y) {
    const [across, down] = room();
    state.scale = Math.max(state.scale, 16);
    state.x = across / 2 - (x + 0.5) * state.scale;
    state.y = down / 2 - (y + 0.5) * state.scale;
    state.fits = false;
    state.spot = [x, y];
    place();
    read(x, y);
}

// --- The pixel under the pointer.

function swatch([red, green, blue]) {
    const canvas = element("canvas", { width: 1, height: 1 });
    const context = canvas.getContext("2d");
    context.fillStyle = "rgb(" + [red, green, blue].join() + ")";
    context.fillRect(0, 0, 1, 1);
    return canvas;
}

const pixelOf = (image, x, y) => image && x < image.width && y < image.height ? [...image.data.slice(4 * (y * image.width + x), 4 * (y * image.width + x) + 4)] : null;

async function read(x, y) {
    const mine = pictures, [width, height] = sizeOf(state.chosen);
    if (x < 0 || y < 0 || x >= width || y >= height) return byId("readout").replaceChildren();
    const a = pixelOf(await mine.levels("a"), x, y), b = pixelOf(await mine.levels("b"), x, y);
    if (mine !== pictures) return;
    const alpha = state.chosen.a.alpha || state.chosen.b.alpha;
    const words = (pixel) => (alpha ? pixel : pixel.slice(0, 3)).join(" ");
    const parts = [element("span", { text: "x " + x + "  y " + y })];
    for (const [name, pixel] of [["A ", a], ["B ", b]])
        if (pixel) parts.push(element("span", {}, name, swatch(pixel), " ", element("b", { text: words(pixel) })));
    if (a && b) {
        const off = b.map((level, k) => level - a[k]).map((level) => (level > 0 ? "+" + level : level < 0 ? "−" + -level : "0"));
        parts.push(element("span", {}, "B − A ", element("b", { text: words(off) })));
    }
    if (state.chosen.a.lossy || state.chosen.b.lossy) parts.push(element("span", { text: "of JPEG pictures: the files differ by some levels" }));
    if ([state.chosen.a, state.chosen.b].some((side) => side.depth && side.depth !== "8 bits")) parts.push(element("span", { text: "of 8-bit pictures" }));
    byId("readout").replaceChildren(...parts);
}

function paneAt(event) {
    const pane = event.target.closest(".pane") || panes.b, box = pane.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
}

function readAt(event) {
    const [x, y] = paneAt(event);
    read(Math.floor((x - state.x) / state.scale), Math.floor((y - state.y) / state.scale));
}

// --- Pointers: one moves, two zoom, the divider slides.

const pointers = new Map();
let sliding = false;

stage.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015)), ...paneAt(event));
    readAt(event);
}, { passive: false });
stage.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    sliding = event.target === byId("divider");
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    stage.setPointerCapture(event.pointerId);
    stage.classList.add("dragging");
});
stage.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return readAt(event);
    const now = [event.clientX, event.clientY], box = panes.b.getBoundingClientRect();
    pointers.set(event.pointerId, now);
    if (sliding) return setSlider((now[0] - box.left) / box.width);
    if (pointers.size === 2) {
        const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
        const apart = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
        return zoom(apart(now) / apart(before), other[0] - box.left, other[1] - box.top);
    }
    pan(now[0] - before[0], now[1] - before[1]);
});
for (const kind of ["pointerup", "pointercancel"])
    stage.addEventListener(kind, (event) => {
        pointers.delete(event.pointerId);
        sliding = false;
        stage.classList.remove("dragging");
    });
stage.addEventListener("dblclick", (event) => (state.fits ? zoom(1 / state.scale, ...paneAt(event)) : fit()));
new ResizeObserver(() => state.chosen && (state.fits ? fit() : place())).observe(stage);

byId("zoom-in").addEventListener("click", () => zoom(2));
byId("zoom-out").addEventListener("click", () => zoom(0.5));
byId("zoom-fit").addEventListener("click", () => fit());

// --- Figures.

function metricRows(pair) {
    const limits = pair.exact ? { max_difference: 0 } : limitsOf(pair), pixels = pair.compared_pixels;
    const percent = limits.max_failing_percent !== undefined;
    const most = percent ? limits.max_failing_percent : limits.max_failing_pixels;
    const share = 100 * pair.failing_pixels / pixels;
    const where = element("button", { class: "link number", text: "at " + pair.at_pixel.join(", "), title: "Show this pixel" });
    where.addEventListener("click", () => goTo(...pair.at_pixel));
    const largest = element("span", {}, figure(pair.largest_difference));
    if (pair.largest_difference > 0) largest.append(" ", where);
    const row = (name, value, most, shown) => [name, shown || figure(value), most === undefined ? "" : figure(most), most !== undefined && value > most];
    const rows = [
        // name, value, limit, whether it is broken
        ["Failing pixels", pair.failing_pixels + (share ? "\u00a0(" + figure(share, 3) + "\u00a0%)" : ""), most === undefined ? "" : figure(most) + (percent ? "\u00a0%" : ""), most !== undefined && (percent ? share : pair.failing_pixels) > most],
        row("FLIP, mean", pair.flip, limits.max_flip),
        row("FLIP, largest", pair.flip_largest),
        row("Largest off by", pair.largest_difference, limits.max_difference, largest),
        row("Local difference", pair.local_difference, limits.max_local_difference),
        row("RMSE", pair.rmse),
        ["PSNR", pair.psnr_db === null ? "∞ dB" : figure(pair.psnr_db) + " dB", "", false],
    ];
    if (pair.ssim !== undefined) rows.push(["SSIM", figure(pair.ssim, 6), "", false]);
    return rows;
}

function metrics(pair) {
    if (pair.rmse === undefined) return null;
    const rows = metricRows(pair).map(([name, value, limit, broken]) =>
        element("tr", { class: broken ? "broken" : "" }, element("th", { text: name, scope: "row" }), element("td", { class: "number" }, value), element("td", { class: "number", text: limit && (broken ? "✕\u00a0≤\u00a0" : "✓\u00a0≤\u00a0") + limit })));
    const head = element("thead", {}, element("tr", {}, ...["Figure", "Value", "Limit"].map((text) => element("th", { text, scope: "col" }))));
    const masked = pair.width * pair.height - pair.compared_pixels;
    const of = limitsOf(pair);
    const levels = { platform: "the platform's own goldens.", class: "goldens of the class of devices.", common: "goldens of all platforms." };
    const limits = [
        pair.exact ? "The same renderer, driver and processor drew both images, so the limits of the level do not count." : pair.level ? "The limits are those of " + levels[pair.level] : "",
        masked ? "A mask leaves out " + figure(100 * masked / (masked + pair.compared_pixels), 3) + " % of the pixels: " + pair.mask + "." : "",
        of.pixel_tolerance === undefined ? "" : of.pixel_tolerance === 0 ? "A pixel fails if any channel differs."
            : "A pixel fails if a channel is off by more than " + figure(of.pixel_tolerance) + " of 255 levels.",
        "FLIP for " + figure(of.pixels_per_degree) + " pixels a degree.",
    ];
    return element("section", {}, element("h3", { text: "Figures" }), element("table", { class: "metrics" }, head, element("tbody", {}, ...rows)), element("p", { class: "soft", text: limits.filter(Boolean).join(" ") }));
}

function bytes(size) {
    return size < 1e3 ? size + " B" : size < 1e6 ? figure(size / 1e3, 3) + " kB" : figure(size / 1e6, 3) + " MB";
}

// What both files say of themselves: size, depth, and their texts such as device and driver.
function sides(pair) {
    const facts = (side) => {
        const list = new Map([["File", side.path]]);
        if (side.width) list.set("Image", side.width + " × " + side.height + ", " + side.depth + (side.alpha ? ", alpha" : "")).set("Size", bytes(side.bytes));
        if (side.lossy) list.set("Shown as", "JPEG, since the page would be large; figures are the file's");
        if (side.error) list.set("Error", side.error);
        for (const [key, text] of side.texts || []) list.set(key, list.has(key) ? list.get(key) + "\n" + text : text);
        return list;
    };
    const [a, b] = [facts(pair.a), facts(pair.b)];
    const rows = [...new Set([...a.keys(), ...b.keys()])].map((key) => {
        const differ = !["File", "Size"].includes(key) && a.has(key) && b.has(key) && a.get(key) !== b.get(key);
        if (a.get(key) === b.get(key)) return element("tr", {}, element("th", { text: key, scope: "row" }), element("td", { text: a.get(key), colspan: 2 }));
        return element("tr", { class: differ ? "differ" : "" }, element("th", { text: key, scope: "row" }), element("td", { text: a.get(key) || "–" }), element("td", { text: b.get(key) || "–" }));
    });
    const head = element("thead", {}, element("tr", {}, ...["", "A reference", "B new"].map((text) => element("th", { text, scope: "col" }))));
    return element("section", {}, element("h3", { text: "Files" }), element("table", { class: "sides" }, head, element("tbody", {}, ...rows)));
}

function acceptance(pair) {
    if (!pair.accept) return null;
    const mark = element("button", { id: "mark", "aria-pressed": String(state.marked.has(pair)), text: state.marked.has(pair) ? "Marked for acceptance" : "Mark for acceptance (a)" });
    mark.addEventListener("click", () => toggleMark());
    return element("section", {}, element("h3", { text: pair.b.image === undefined ? "Accept that it is gone" : "Accept B as the reference" }), command(pair.accept), data.many ? element("div", {}, mark) : null);
}

function drawDetails() {
    const pair = state.chosen;
    const made = element("section", {}, element("h3", { text: "Made by" }), command(pair.command || data.command), element("p", { class: "soft", text: data.program + ". Commands run in the folder where this one ran." }), pair.command ? element("details", {}, element("summary", { text: "Compared by" }), command(data.command)) : null);
    byId("details").replaceChildren(...[metrics(pair), acceptance(pair), sides(pair), made].filter(Boolean));
}

function toggleMark() {
    const pair = state.chosen;
    if (!pair.accept) return;
    if (!state.marked.delete(pair)) state.marked.add(pair);
    byId("pair-" + pair.at)?.replaceWith(row(pair));
    drawAccepting();
    drawDetails();
}

// --- The beginning.

function drawVerdict() {
    const bad = pairs.filter((pair) => !["same", "within limits", "updated"].includes(outcomeOf(pair))).length;
    const count = data.images, all = count === 1 ? "The image is" : count === 2 ? "Both images are" : "All " + count + " images are";
    const words = bad === 0 ? all + (pairs.some((pair) => pair.outcome === "within limits") || pairs.length < count ? " within the limits" : " the same") : count === 1 ? "The image needs a look" : bad + " of " + count + " images need a look".replace("need", bad === 1 ? "needs" : "need");
    byId("verdict").textContent = words;
    byId("verdict").className = bad ? "bad" : "good";
    document.title = (bad ? bad + " bad: " : "good: ") + "tractrix-compare";
}

// Left and right mean what the mode has: the divider, the image while blinking, the knob.
function sideways(by, event) {
    if (event.shiftKey) return pan(-60 * by, 0);
    if (state.mode === "slider") return setSlider(state.slider + 0.02 * by);
    if (state.mode === "blink") return showSide(by < 0 ? "a" : "b");
    const knob = byId("amount").querySelector("input");
    if (byId("amount").hidden) return pan(-60 * by, 0);
    if (by < 0) knob.stepDown();
    else knob.stepUp();
    knob.dispatchEvent(new Event("input"));
}

const withPair = (act) => (event) => state.chosen && act(event);
const upOrDown = (by) => (event) => (event.shiftKey ? pan(0, -60 * by) : step(by));

const KEYS = [
    [["j", "↓"], "next image", upOrDown(1)],
    [["k", "↑"], "image before", upOrDown(-1)],
    ...MODES.map(([mode, label], i) => [[String(i + 1)], label.toLowerCase(), () => setMode(mode)]),
    [["←", "→"], "move the slider; show A or B; turn the knob", (event) => sideways(event.key === "ArrowLeft" ? -1 : 1, event)],
    [["Space"], "blink; stop and go on", toggleBlink],
    [["+", "-"], "zoom in, out", (event) => zoom(event.key === "-" ? 0.5 : 2)],
    [["="], null, () => zoom(2)],
    [["0"], "fit", fit],
    [["z"], "a pixel of the image for one of the screen", () => zoomTo(1 / (window.devicePixelRatio || 1))],
    [["Shift"], "with arrows: move the image", null],
    [["w"], "the pixel with the largest difference", () => state.chosen.at_pixel && state.chosen.largest_difference > 0 && goTo(...state.chosen.at_pixel)],
    [["a"], "mark for acceptance", toggleMark],
    [["c"], "copy the command that accepts", () => state.chosen.accept && copy(state.chosen.accept)],
    [["/"], "filter names", () => byId("filter").focus()],
];
listenToKeys([...KEYS.map(([names, help, act]) => [names, help, act && withPair(act)]), [["t"], "theme: the system's, light, dark", nextTheme], [["?"], "this list", showHelp]]);

byId("modes").append(...MODES.map(([mode, label], i) => {
    const button = element("button", { role: "radio", "data-mode": mode, text: label, title: label + " (" + (i + 1) + ")", "aria-checked": "false" });
    button.addEventListener("click", () => setMode(mode));
    return button;
}));
byId("filter").addEventListener("input", (event) => {
    state.filter = event.target.value;
    refresh();
});
byId("accept-all").addEventListener("click", () => copy(accepting().map((pair) => pair.accept).join("\n") + "\n", byId("accept-all")));

document.body.classList.toggle("single", !data.many);
// The heat map's colours, as the program has them, from 0 to 1.
function drawLegend() {
    const canvas = byId("legend").querySelector("canvas"), context = canvas.getContext("2d");
    canvas.width = data.colors.length;
    data.colors.forEach((color, i) => {
        context.fillStyle = "rgb(" + color.join() + ")";
        context.fillRect(i, 0, 1, canvas.height);
    });
}

drawLegend();
drawVerdict();
drawOutcomes();
drawList();
if (pairs.length) choose(readAddress() || pairs[0]);
else document.querySelector("main").replaceChildren(element("p", { class: "note", text: "Only images that fail are listed, and there is none." }));
addEventListener("hashchange", () => {
    const asked = readAddress();
    if (asked) choose(asked);
});
