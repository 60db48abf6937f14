// SPDX-License-Identifier: MIT
// The page of tractrix-bench: plots of the rows, and the rows as a table. Nothing here knows a command: columns do.
"use strict";

// --- Rows. data.columns: [{name, number, shown}], data.rows: [[value, ...]] with null for none.

const columns = data.columns.map((column, at) => ({ ...column, at }));
const column = (name) => columns.find((one) => one.name === name);
const rows = data.rows.map((values, at) => ({ values, at }));
const value = (row, name) => row.values[column(name).at] ?? null;
const wordOf = (row, name) => {
    const got = value(row, name);
    return got === null || got === "" ? "–" : typeof got === "number" ? figure(got) : got;
};

// What tells machines and builds apart; it stands in the heading, and among the columns only if it differs.
const DEVICE = [["cpu", "CPU"], ["renderer", "Renderer"], ["gl_version", "OpenGL"], ["version", "Version"], ["commit", "Commit"]];
const different = (name, among = rows) => [...new Set(among.map((row) => wordOf(row, name)))];
const isDevice = (name) => DEVICE.some(([device]) => device === name);
const isVaried = (one) => different(one.name).length > 1;

// --- Views: what is worth plotting of rows that have these columns and values. The first that have rows are offered.
// `line` joins points that agree in these columns, in the order of `by`; `front` marks what nothing beats in x and y.

const VIEWS = [
    { name: "Error against time", when: { part: "work", what: "error" }, x: "ms_min", y: "value", series: "algo", panels: "set", line: ["algo", "variant", "settings"], by: "rate_hz", front: true },
    { name: "Error by rate", when: { part: "motions", what: "error" }, x: "rate_hz", y: "value", series: "algo", panels: "scenario", line: ["algo", "variant", "settings"], by: "rate_hz" },
    { name: "Results by rate", x: "rate_hz", y: "value", series: "algo", panels: "what", line: ["algo", "variant", "settings", "scenario", "part"], by: "rate_hz" },
    { name: "Error against time", x: "ms_min", y: "rms", series: "scheme", panels: "set", front: true },
    { name: "Deviation against time, still", x: "still_ms_min", y: "rel_g", series: "way", panels: "scene", front: true },
    { name: "Deviation against time, moving", x: "moving_ms_min", y: "rel_g", series: "way", panels: "scene", front: true },
    { name: "Rest against time", x: "ms_min", y: "rest", series: "algo", panels: "hair", line: ["algo", "variant", "settings"], by: "rate", front: true },
    { name: "Life against time", x: "ms_min", y: "life", series: "algo", panels: "hair", line: ["algo", "variant", "settings"], by: "rate" },
    { name: "Growth with strands", when: { part: "strands" }, x: "strands", y: "ms_min", series: "algo", line: ["algo", "variant", "settings"], by: "strands" },
    { name: "Growth with vertices", when: { part: "vertices" }, x: "vertices", y: "ms_min", series: "algo", line: ["algo", "variant", "settings"], by: "vertices" },
    { name: "Growth with threads", when: { part: "threads" }, x: "threads", y: "ms_min", series: "algo", panels: "hair", line: ["algo", "variant", "settings"], by: "threads" },
    { name: "Time by hair", when: { part: "sets" }, x: "ms_min", y: "hair", series: "algo" },
    { name: "Time by scene", x: "ms_min", y: "scene", series: "algo", panels: "set" },
    { name: "Worst by category", x: "worst", y: "category", series: "rule" },
];

const fits = (view, row) => Object.entries(view.when || {}).every(([name, word]) => value(row, name) === word) && ["x", "y"].every((axis) => value(row, view[axis]) !== null);
const hasColumns = (view) => [view.x, view.y, view.series, ...Object.keys(view.when || {})].every((name) => column(name));

// For rows of no known kind: the first numbers that vary against each other, or a number by words. One row is no plot.
function plainView() {
    if (rows.length < 2) return null;
    const varied = columns.filter((one) => !isDevice(one.name) && isVaried(one) && one.name !== "command");
    const numbers = varied.filter((one) => one.number), words = varied.filter((one) => !one.number);
    const y = numbers[0], x = numbers[1] || words[0];
    return x && y ? { name: "Plot", x: x.name, y: y.name, series: (words.find((one) => different(one.name).length <= 12) || words[0] || {}).name } : null;
}

const known = VIEWS.filter((view) => hasColumns(view) && rows.some((row) => fits(view, row)));
const views = known.length ? known : [plainView()].filter(Boolean);

const state = {
    view: null,
    x: "", y: "", series: "", panels: "", // names of columns; "": none
    log: { x: true, y: true },
    facets: {}, // column: the word that rows must have
    hidden: new Set(), // series
    filter: "",
    sort: null, // a column
    down: false,
    all: false, // columns
    here: null, // the row under the pointer
};

// --- Which rows.

const passes = (row) => Object.entries(state.facets).every(([name, word]) => !word || wordOf(row, name) === word);
const searched = (row) => state.filter.toLowerCase().split(/\s+/).every((word) => columns.some((one) => wordOf(row, one.name).toLowerCase().includes(word)));
const chosenRows = () => rows.filter((row) => passes(row) && searched(row));
const seriesOf = (row) => (state.series ? wordOf(row, state.series) : "all");
const plotted = (row) => value(row, state.x) !== null && value(row, state.y) !== null && !["x", "y"].some((axis) => state.log[axis] && typeof value(row, state[axis]) === "number" && !(value(row, state[axis]) > 0));

function chooseView(view) {
    Object.assign(state, { view, x: view.x, y: view.y, series: view.series || "", panels: view.panels && column(view.panels) ? view.panels : "", hidden: new Set(), facets: { ...view.when } });
    for (const axis of ["x", "y"]) state.log[axis] = isWide(state[axis]);
    draw();
}

// Whether the numbers of these rows are positive and spread by 4 or more; by 1000 if zeros must be left out for it.
function isWide(name) {
    const numbers = chosenRows().filter((row) => value(row, state.x) !== null && value(row, state.y) !== null).map((row) => value(row, name)).filter((one) => typeof one === "number");
    const above = numbers.filter((one) => one > 0), spread = Math.max(...above) / Math.min(...above);
    return above.length > 1 && numbers.every((one) => one >= 0) && spread >= (above.length < numbers.length ? 1000 : 4);
}

// --- Scales: numbers, linear or logarithmic, and words at even steps.

// `list` has the plot's rows, `whole` those whose range the axis has.
function scale(name, list, whole, from, to, log) {
    const values = whole.map((row) => value(row, name));
    if (!column(name).number) {
        const words = [...new Set(list.map((row) => wordOf(row, name)))];
        const step = (to - from) / words.length;
        return { ticks: words.map((word, i) => [from + (i + 0.5) * step, word, false]), at: (row) => from + (words.indexOf(wordOf(row, name)) + 0.5) * step, words };
    }
    const map = log ? Math.log10 : (x) => x;
    let low = map(Math.min(...values)), high = map(Math.max(...values));
    const room = (high - low) * 0.06 || Math.abs(high) * 0.1 || 1;
    low -= room;
    high += room;
    if (!log && low < 0 && Math.min(...values) >= 0) low = 0;
    const place = (x) => from + ((map(x) - low) / (high - low)) * (to - from);
    return { ticks: (log ? logTicks(low, high) : linearTicks(low, high)).map(([x, label, fine]) => [place(x), label, fine]), at: (row) => place(value(row, name)) };
}

function linearTicks(low, high) {
    const rough = (high - low) / 5, power = 10 ** Math.floor(Math.log10(rough)), step = power * [1, 2, 5, 10].find((times) => times * power >= rough);
    const ticks = [];
    for (let i = Math.ceil(low / step); i * step <= high; ++i) ticks.push([i * step, figure(i * step, 5), false]);
    return ticks;
}

function logTicks(low, high) {
    const ticks = [], labelled = high - low < 0.4 ? [1, 2, 3, 4, 5, 6, 7, 8, 9] : high - low < 0.8 ? [1, 2, 3, 4, 6, 8] : high - low < 1.4 ? [1, 2, 5] : high - low < 2.4 ? [1, 3] : [1], every = Math.ceil((high - low) / 7);
    for (let power = Math.floor(low); power <= high; ++power)
        for (let times = 1; times < 10; ++times) {
            const x = times * 10 ** power;
            if (Math.log10(x) < low || Math.log10(x) > high) continue;
            ticks.push([x, labelled.includes(times) && power % every === 0 ? figure(x, 3) : "", times > 1]);
        }
    return ticks;
}

// --- Marks: a colour and a shape for each series.

const COLORS = 8;
const SHAPES = [
    (r) => "M" + -r + ",0a" + r + "," + r + " 0 1,0 " + 2 * r + ",0a" + r + "," + r + " 0 1,0 " + -2 * r + ",0Z",
    (r) => "M" + -r + "," + -r + "h" + 2 * r + "v" + 2 * r + "h" + -2 * r + "Z",
    (r) => "M0," + -1.2 * r + "L" + 1.15 * r + "," + 0.85 * r + "H" + -1.15 * r + "Z",
    (r) => "M0," + -1.3 * r + "L" + 1.3 * r + ",0L0," + 1.3 * r + "L" + -1.3 * r + ",0Z",
];
const allSeries = () => (state.series ? different(state.series, rows.filter((row) => state.facets === null || passes(row))) : ["all"]);
// Colours go round first, then shapes: two neighbours differ in both.
const styleOf = (name, list) => [list.indexOf(name) % COLORS, (list.indexOf(name) + Math.floor(list.indexOf(name) / COLORS)) % SHAPES.length];

function mark(name, list, radius) {
    const [color, shape] = styleOf(name, list);
    return element("path", { class: "mark c" + color, d: SHAPES[shape](radius) });
}

// --- A plot.

// How wide each of so many plots is, px: as many beside each other as fit. Less than the style's columns only by rounding.
function widthOf(count) {
    const room = byId("plots").clientWidth || 640, beside = Math.max(Math.min(Math.floor((room + 20) / 420), count), 1);
    return (room - 20 * (beside - 1)) / beside;
}

// The rows that no other beats in both, by x; those of equal x by y.
function frontOf(list) {
    let least = Infinity;
    return [...list].sort((p, q) => value(p, state.x) - value(q, state.x) || value(p, state.y) - value(q, state.y)).filter((row) => {
        const better = value(row, state.y) < least;
        if (better) least = value(row, state.y);
        return better;
    });
}

function joints(list, x, y, names) {
    const { line, by } = state.view, groups = new Map();
    if (!line || state.x !== state.view.x || state.y !== state.view.y || !line.every(column)) return [];
    for (const row of list) {
        const key = line.map((name) => wordOf(row, name)).join("\n") + "\n" + wordOf(row, "commit");
        groups.set(key, [...(groups.get(key) || []), row]);
    }
    return [...groups.values()].filter((group) => group.length > 1).map((group) => {
        const sorted = [...group].sort((p, q) => value(p, by) - value(q, by)), name = seriesOf(group[0]);
        return element("polyline", { class: "joint c" + styleOf(name, names)[0], "data-series": name, points: sorted.map((row) => x.at(row).toFixed(1) + "," + y.at(row).toFixed(1)).join(" ") });
    });
}

function axisName(name, axis) {
    return name + (state.log[axis] && column(name).number ? " (log)" : "");
}

function plot(title, list, whole, names, width) {
    const across = column(state.x).number ? 0 : 84, wordy = !column(state.y).number;
    const count = wordy ? different(state.y, list).length : 0;
    const longest = wordy ? Math.max(...different(state.y, list).map((word) => word.length)) : 0;
    const box = { left: wordy ? Math.min(24 + 6.4 * longest, 230) : 66, right: width - 14, top: wordy ? 8 : 26, bottom: wordy ? 24 + Math.max(24 * count, 120) : Math.min(Math.max(0.62 * width, 260), 460) };
    const height = box.bottom + 46 + across;
    const svg = element("svg", { viewBox: "0 0 " + width + " " + height, height, role: "img", "aria-label": state.y + " against " + state.x + (title ? ", " + title : "") + ": " + list.length + " points" });
    const x = scale(state.x, list, whole, box.left, box.right, state.log.x), y = wordy ? scale(state.y, list, whole, box.top, box.bottom, false) : scale(state.y, list, whole, box.bottom, box.top, state.log.y);
    for (const [at, label, fine] of x.ticks) {
        svg.append(element("line", { class: fine ? "grid fine" : "grid", x1: at, x2: at, y1: box.top, y2: box.bottom }));
        if (label) svg.append(element("text", { x: at, y: box.bottom + 17, "text-anchor": x.words ? "end" : "middle", transform: x.words ? "rotate(-38 " + at + " " + (box.bottom + 17) + ")" : null, text: label }));
    }
    for (const [at, label, fine] of y.ticks) {
        svg.append(element("line", { class: fine ? "grid fine" : "grid", x1: box.left, x2: box.right, y1: at, y2: at }));
        if (label) svg.append(element("text", { x: box.left - 8, y: at + 4, "text-anchor": "end", text: label.length > 34 ? label.slice(0, 33) + "…" : label }));
    }
    svg.append(element("rect", { class: "frame", x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top }));
    svg.append(element("text", { class: "axis-name", x: box.right, y: height - 8, "text-anchor": "end", text: axisName(state.x, "x") + " →" }));
    svg.append(element("text", { class: "axis-name", x: box.left, y: 16, text: wordy ? "" : "↑ " + axisName(state.y, "y") }));
    svg.append(...joints(list, x, y, names));
    if (state.view.front && state.x === state.view.x && state.y === state.view.y) {
        const front = frontOf(list);
        const corner = (row, i) => (i ? x.at(row).toFixed(1) + "," + y.at(front[i - 1]).toFixed(1) + " " : "") + x.at(row).toFixed(1) + "," + y.at(row).toFixed(1);
        if (front.length > 1) svg.append(element("polyline", { class: "front", points: front.map(corner).join(" ") }));
    }
    for (const row of list) {
        const made = mark(seriesOf(row), names, 4.5);
        made.setAttribute("transform", "translate(" + x.at(row).toFixed(1) + "," + y.at(row).toFixed(1) + ")");
        made.dataset.row = row.at;
        made.dataset.series = seriesOf(row);
        svg.append(made);
    }
    const find = (event) => {
        const inside = svg.getBoundingClientRect(), k = width / inside.width;
        const [px, py] = [(event.clientX - inside.left) * k, (event.clientY - inside.top) * k];
        const apart = (row) => Math.hypot(x.at(row) - px, y.at(row) - py);
        const nearest = list.reduce((best, row) => (best === null || apart(row) < apart(best) ? row : best), null);
        return nearest && apart(nearest) < 36 ? nearest : null;
    };
    svg.addEventListener("pointermove", (event) => pointAt(find(event), event));
    svg.addEventListener("pointerleave", () => pointAt(null));
    svg.addEventListener("click", (event) => goTo(find(event)));
    return element("figure", {}, title ? element("figcaption", { text: title }) : null, svg);
}

// --- The point under the pointer, its series, and its row.

function pointAt(row, event) {
    const tip = byId("tip");
    if (row !== state.here) {
        state.here = row;
        const name = row && seriesOf(row);
        for (const part of document.querySelectorAll("#plots [data-series]")) {
            part.classList.toggle("faded", Boolean(row) && part.dataset.series !== name);
            part.classList.toggle("here", Boolean(row) && part.dataset.row === String(row.at));
        }
        for (const part of document.querySelectorAll("tbody tr")) part.classList.toggle("here", Boolean(row) && part.dataset.row === String(row.at));
        if (row) tip.replaceChildren(element("b", { text: state.series ? seriesOf(row) : wordOf(row, state.y) }), element("dl", {}, ...tipColumns(row).flatMap((one) => [element("dt", { text: one.name }), element("dd", { text: wordOf(row, one.name) })])));
    }
    tip.hidden = !row;
    if (!row) return;
    const left = event.clientX + 16 + tip.offsetWidth < innerWidth ? event.clientX + 16 : event.clientX - 16 - tip.offsetWidth;
    tip.style.left = Math.max(left, 4) + "px";
    tip.style.top = Math.min(event.clientY + 12, innerHeight - tip.offsetHeight - 6) + "px";
}

// The axes, then what else the screen's table shows, this row has, and no choice has fixed.
function tipColumns(row) {
    const first = [column(state.x), column(state.y)].filter((one, i, list) => list.indexOf(one) === i);
    const rest = columns.filter((one) => one.shown && !first.includes(one) && one.name !== state.series && one.name !== "command" && !state.facets[one.name] && !isDevice(one.name) && !["–", ""].includes(wordOf(row, one.name)));
    return [...first, ...rest].slice(0, 14);
}

function goTo(row) {
    const item = row && document.querySelector('tbody tr[data-row="' + row.at + '"]');
    if (!item) return;
    item.scrollIntoView({ block: "center", behavior: matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth" });
    for (const part of document.querySelectorAll("tbody tr")) part.classList.toggle("here", part === item);
}

// --- Controls.

function picker(label, names, chosen, act, none) {
    const select = element("select", { "aria-label": label });
    if (none) select.append(element("option", { value: "", text: none }));
    select.append(...names.map((name) => element("option", { value: name, text: name })));
    select.value = chosen;
    select.addEventListener("change", () => act(select.value));
    return element("label", {}, label, select);
}

function logButton(axis) {
    const button = element("button", { class: "log", "aria-pressed": String(state.log[axis]), text: "log", "aria-label": "Logarithmic " + axis, "data-axis": axis });
    button.addEventListener("click", () => setLog(axis, !state.log[axis]));
    return button;
}

function setLog(axis, log) {
    state.log[axis] = log;
    draw();
}

function setAxis(key, name) {
    state[key] = name;
    if (key === "x" || key === "y") state.log[key] = column(name).number && isWide(name);
    if (key === "series") state.hidden = new Set();
    draw();
}

const offered = () => columns.filter((one) => one.name !== "command" && (isVaried(one) || one.name === state.x || one.name === state.y) && (!isDevice(one.name) || isVaried(one)));

function drawControls() {
    const names = offered().map((one) => one.name), words = columns.filter((one) => (!one.number || different(one.name).length <= 12) && one.name !== "command" && isVaried(one)).map((one) => one.name);
    for (const name of [state.series, state.panels]) if (name && !words.includes(name)) words.push(name);
    byId("views").replaceChildren(...views.map((view) => {
        const button = element("button", { role: "radio", "aria-checked": String(view === state.view), text: view.name });
        button.addEventListener("click", () => chooseView(view));
        return button;
    }));
    byId("views").hidden = views.length < 2;
    byId("axes").replaceChildren(picker("Across", names, state.x, (name) => setAxis("x", name)), column(state.x).number ? logButton("x") : "", picker("Up", names, state.y, (name) => setAxis("y", name)), column(state.y).number ? logButton("y") : "",
        picker("Series", words, state.series, (name) => setAxis("series", name), "none"), picker("Panels", words, state.panels, (name) => setAxis("panels", name), "one"));
    // Words that part the rows which the other choices leave.
    const wordsOf = (one) => different(one.name, rows.filter((row) => Object.entries(state.facets).every(([name, word]) => !word || name === one.name || wordOf(row, name) === word)));
    const facets = columns.filter((one) => !one.number && ![state.series, state.x, state.y, "command"].includes(one.name) && (one.shown || isDevice(one.name)) && (state.facets[one.name] || wordsOf(one).length > 1) && wordsOf(one).length <= 24);
    byId("facets").replaceChildren(...facets.map((one) => picker(one.name, wordsOf(one), state.facets[one.name] || "", (word) => {
        state.facets[one.name] = word;
        draw();
    }, "all")));
}

function drawLegend(names) {
    byId("legend").hidden = names.length < 2 && !state.series;
    byId("legend").replaceChildren(...names.map((name) => {
        const shown = !state.hidden.has(name), sample = element("svg", { viewBox: "-7 -7 14 14", "aria-hidden": "true" }, mark(name, allSeries(), 4.5));
        const button = element("button", { "aria-pressed": String(shown), "data-series": name }, sample, name);
        button.addEventListener("click", (event) => toggleSeries(name, event.shiftKey));
        return element("li", {}, button);
    }));
}

function toggleSeries(name, alone) {
    const others = allSeries().filter((other) => other !== name);
    if (alone) state.hidden = new Set(others.every((other) => state.hidden.has(other)) ? [] : others);
    else if (!state.hidden.delete(name)) state.hidden.add(name);
    drawPlots();
    byId("legend").querySelector('[data-series="' + CSS.escape(name) + '"]').focus();
}

const MOST_PANELS = 12;

// Panels have one range, to be compared, unless they are of different quantities.
const rangeOf = (title, list) => (["what", "part"].includes(state.panels) ? list.filter((row) => wordOf(row, state.panels) === title) : list);

function drawPlots() {
    const names = allSeries(), all = chosenRows(), able = all.filter(plotted), list = able.filter((row) => !state.hidden.has(seriesOf(row)));
    drawLegend(names.filter((name) => able.some((row) => seriesOf(row) === name)));
    const titles = state.panels ? different(state.panels, list).sort((p, q) => (q === "mean") - (p === "mean")) : [""];
    const width = widthOf(Math.min(titles.length, MOST_PANELS));
    byId("plots").replaceChildren(...titles.slice(0, MOST_PANELS).map((title) => plot(title, state.panels ? list.filter((row) => wordOf(row, state.panels) === title) : list, rangeOf(title, list), names, width)).filter(() => list.length));
    const notes = [];
    if (able.length < all.length) notes.push(all.length - able.length + " of these " + all.length + " rows are not drawn: no value, or none above 0 on a logarithmic axis.");
    if (titles.length > MOST_PANELS) notes.push("The first " + MOST_PANELS + " of " + titles.length + " panels are shown: filter the rows.");
    if (state.view.front) notes.push("Dashed: points that no other beats on both axes.");
    byId("missing").textContent = notes.join(" ");
}

// --- The table.

function shownColumns() {
    const varied = (one) => !isDevice(one.name) || isVaried(one);
    return columns.filter((one) => one.name !== "command" && (state.all || ((one.shown || (isDevice(one.name) && isVaried(one))) && varied(one) && chosenRows().some((row) => wordOf(row, one.name) !== "–"))));
}

function compare(one, p, q) {
    const [a, b] = [value(p, one.name), value(q, one.name)], none = (x) => x === null || x === "";
    if (none(a) || none(b)) return none(a) - none(b); // last, whichever way
    return (one.number ? a - b : a.localeCompare(b, "en", { numeric: true })) * (state.down ? -1 : 1) || p.at - q.at;
}

function setSort(one) {
    state.down = state.sort === one ? !state.down : false;
    state.sort = one;
    drawTable();
    say("Sorted by " + one.name + (state.down ? ", largest first" : ""));
    document.querySelector('th[data-column="' + one.name + '"] button').focus();
}

function tableHead(list) {
    const head = element("tr", {}, ...list.map((one) => {
        const sorted = state.sort === one, button = element("button", { text: one.name + (sorted ? (state.down ? " ↓" : " ↑") : "") });
        button.addEventListener("click", () => setSort(one));
        return element("th", { scope: "col", class: one.number ? "number" : "", "data-column": one.name, "aria-sort": sorted ? (state.down ? "descending" : "ascending") : null }, button);
    }));
    if (column("command")) head.append(element("th", { scope: "col" }, element("span", { class: "hidden", text: "command" })));
    return head;
}

function tableRow(row, list) {
    const item = element("tr", { "data-row": String(row.at) }, ...list.map((one) => element("td", { class: (one.number ? "number" : "") + (value(row, one.name) === "broken" ? " broken" : ""), title: one.number ? String(value(row, one.name) ?? "") : wordOf(row, one.name), text: wordOf(row, one.name) })));
    if (!column("command")) return item;
    const text = value(row, "command"), button = element("button", { text: "Copy", title: text || "", "aria-label": "Copy the command that repeats this row" });
    button.addEventListener("click", () => copy(text, button));
    item.append(element("td", {}, text ? button : ""));
    return item;
}

function drawTable() {
    const list = shownColumns(), found = chosenRows();
    if (state.sort) found.sort((p, q) => compare(state.sort, p, q));
    document.querySelector("thead").replaceChildren(tableHead(list));
    document.querySelector("tbody").replaceChildren(...found.map((row) => tableRow(row, list)));
    byId("count").textContent = found.length === rows.length ? rows.length + (rows.length === 1 ? " row" : " rows") : found.length + " of " + rows.length + " rows";
    byId("all-columns").setAttribute("aria-pressed", String(state.all));
}

function draw() {
    pointAt(null);
    if (state.view) {
        drawControls();
        drawPlots();
    }
    drawTable();
}

// --- The beginning.

function drawHead() {
    document.title = byId("title").textContent = data.title;
    const verdicts = column("verdict") ? rows.map((row) => value(row, "verdict")) : [];
    const holds = verdicts.filter((word) => word === "holds").length, broken = verdicts.filter((word) => word === "broken").length;
    byId("summary").append(rows.length + (rows.length === 1 ? " row" : " rows"));
    if (holds + broken) byId("summary").append(" · ", element("span", { class: broken ? "broken" : "", text: broken ? broken + " of " + (holds + broken) + " bounds broken" : "all " + holds + " bounds hold" }));
    for (const [name, label] of DEVICE)
        if (column(name)) byId("device").append(element("div", {}, element("dt", { text: label }), element("dd", { text: different(name).slice(0, 4).join(" | ") })));
    byId("made").append(command(data.command), element("p", { class: "soft", text: data.program + ". Times are in milliseconds." }));
}

const viewBy = (by) => () => views.length && chooseView(views[(views.indexOf(state.view) + by + views.length) % views.length]);

listenToKeys([
    [["→", "n"], "next view", viewBy(1)],
    [["←", "p"], "view before", viewBy(-1)],
    [["x", "y"], "logarithmic or linear", (event) => state.view && column(state[event.key]).number && setLog(event.key, !state.log[event.key])],
    [["s"], "all series again", () => { state.hidden = new Set(); draw(); }],
    [["c"], "all columns, or those that matter", () => byId("all-columns").click()],
    [["/"], "filter rows by words", () => byId("filter").focus()],
    [["t"], "theme: the system's, light, dark", nextTheme],
    [["?"], "this list", showHelp],
]);
byId("filter").addEventListener("input", (event) => {
    state.filter = event.target.value;
    draw();
});
byId("all-columns").addEventListener("click", () => {
    state.all = !state.all;
    drawTable();
});

let redraw = 0;
let widthBefore = innerWidth;
addEventListener("resize", () => {
    if (innerWidth === widthBefore || !state.view) return;
    widthBefore = innerWidth;
    cancelAnimationFrame(redraw);
    redraw = requestAnimationFrame(drawPlots);
});

drawHead();
byId("figure").hidden = !views.length;
if (views.length) chooseView(views[0]);
else draw();
