// SPDX-License-Identifier: MIT
// What all pages share: the data, elements, numbers, copying, the theme and the list of keys.
"use strict";

const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);

// An element with properties (class, text, attributes, functions for events) and children.
function element(tag, properties = {}, ...children) {
    const svg = ["svg", "g", "path", "line", "circle", "rect", "text", "title", "polyline"].includes(tag);
    const made = svg ? document.createElementNS("http" + "://www.w3.org/2000/svg", tag) : document.createElement(tag);
    for (const [key, value] of Object.entries(properties)) {
        if (value === undefined || value === null || value === false) continue;
        if (key === "class") made.setAttribute("class", value);
        else if (key === "text") made.textContent = value;
        else if (typeof value === "function") made.addEventListener(key, value);
        else made.setAttribute(key, value === true ? "" : value);
    }
    made.append(...children.filter((child) => child !== null && child !== undefined));
    return made;
}

// Four digits that count, as the programs print them.
function figure(value, digits = 4) {
    if (typeof value !== "number") return "–";
    if (value === 0) return "0";
    const size = Math.abs(value);
    if (size >= 1e6 || size < 1e-4) return value.toExponential(digits - 1).replace(/\.?0+e/, "e");
    const text = value.toPrecision(digits);
    return text.includes("e") ? String(Math.round(value)) : text.includes(".") ? text.replace(/\.?0+$/, "") : text;
}

// --- What a screen reader says; a copy; a short answer on the button.

function say(text) {
    byId("said").textContent = text;
}

async function copy(text, button) {
    try {
        await navigator.clipboard.writeText(text);
    } catch {
        const field = element("textarea", { class: "hidden" });
        field.value = text;
        document.body.append(field);
        field.select();
        document.execCommand("copy");
        field.remove();
    }
    say("Copied");
    if (!button) return;
    const before = button.textContent;
    button.textContent = "Copied";
    setTimeout(() => (button.textContent = before), 1200);
}

// A command and the button that copies it.
function command(text) {
    const button = element("button", { text: "Copy", "aria-label": "Copy the command" });
    button.addEventListener("click", () => copy(text, button));
    return element("div", { class: "command" }, element("code", { text }), button);
}

// --- Theme: the system's, light or dark. Some browsers keep nothing for files.

const THEMES = ["auto", "light", "dark"];

function storedTheme() {
    try {
        return localStorage.getItem("tractrix-theme");
    } catch {
        return null;
    }
}

function setTheme(theme) {
    if (theme === "auto") delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = theme;
    byId("theme").textContent = "Theme: " + theme;
    try {
        localStorage.setItem("tractrix-theme", theme);
    } catch {
        return;
    }
}

function nextTheme() {
    const now = document.documentElement.dataset.theme || "auto";
    setTheme(THEMES[(THEMES.indexOf(now) + 1) % THEMES.length]);
}

// --- Keys. `keys`: [[key, ...], what it does, function or null]; a null is for the list alone.

function listenToKeys(keys) {
    const list = byId("keys");
    for (const [names, help] of keys)
        if (help) list.append(element("dt", {}, ...names.filter((name) => name.length < 12).map((name) => element("kbd", { text: name }))), element("dd", { text: help }));
    const typing = (target) => target instanceof HTMLElement && target.matches("input:not([type=range]), textarea, select");
    document.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.altKey || event.metaKey || byId("help").open) return;
        if (event.key === "Escape" && typing(event.target)) return event.target.blur();
        if (typing(event.target)) return;
        // Buttons and sliders keep the keys that they know.
        if ([" ", "Enter"].includes(event.key) && event.target.closest("button, summary, a")) return;
        if (event.key.startsWith("Arrow") && event.target.matches("input[type=range]")) return;
        for (const [names, , act] of keys)
            if (act && names.some((name) => KEY_NAMES[name] === event.key || name === event.key)) {
                event.preventDefault();
                act(event);
                return;
            }
    });
}

const KEY_NAMES = { "↑": "ArrowUp", "↓": "ArrowDown", "←": "ArrowLeft", "→": "ArrowRight", Space: " " };

const showHelp = () => byId("help").showModal();

setTheme(THEMES.includes(storedTheme()) ? storedTheme() : "auto");
byId("theme").addEventListener("click", nextTheme);
byId("keys-button").addEventListener("click", showHelp);
