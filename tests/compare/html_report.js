// SPDX-License-Identifier: MIT
// Drives the page of tests/compare/test_html_report.sh.
const names = () => [...document.querySelectorAll("#list .name")].map((name) => name.textContent);
const chosen = () => document.querySelector('#list [aria-selected="true"] .name').textContent;
const layer = (which) => document.querySelector("#pane-b .plane ." + which);
const cells = (table) => [...document.querySelectorAll("#details " + table + " tr")].map((row) => [...row.children].map((cell) => cell.textContent).join("|"));
const near = (a, b) => Math.abs(a - b) < 1e-3;

async function goTo(name) {
    for (let i = 0; i < 20; ++i) press("k");
    for (let i = 0; i < 20 && chosen() !== name; ++i) press("j");
    await until(() => stage.dataset.ready === name, "shows " + name);
}

async function driveList() {
    claim("failures come first", names().join() === "cut.png,differ.png,size.png,gone.png,new.png,float.pfm,<b>&amp; it's.png,same.png");
    claim("the heading counts", byId("verdict").textContent === "5 of 8 images need a look");
    claim("each image has a thumbnail", document.querySelectorAll("#list img.thumbnail").length === 8);
    claim("the first is chosen", chosen() === "cut.png");
    press("j");
    claim("j chooses the next", chosen() === "differ.png");
    press("ArrowUp");
    claim("arrow up chooses the one before", chosen() === "cut.png");
    press("/");
    claim("/ goes to the filter", document.activeElement === byId("filter"));
    byId("filter").value = "E.P";
    byId("filter").dispatchEvent(new Event("input"));
    claim("the filter filters, in any case", names().join() === "size.png,gone.png,same.png");
    press("j");
    claim("letters typed into the filter choose nothing", chosen() === "size.png");
    press("Escape");
    byId("filter").value = "";
    byId("filter").dispatchEvent(new Event("input"));
    document.querySelector('[data-outcome="missing"]').click();
    claim("an outcome filters", names().join() === "gone.png");
    document.querySelector('[data-outcome="missing"]').click();
    claim("and no longer", names().length === 8);
    claim("the address leads to the image", location.hash === "#" + encodeURIComponent(chosen()));
}

async function driveModes() {
    await goTo("differ.png");
    await until(() => layer("a").naturalWidth === 160 && layer("b").naturalHeight === 120, "both images are there at their size");
    claim("side by side: each in its pane", !document.querySelector("#pane-a .a").hidden && layer("a").hidden && !layer("b").hidden);
    press("2");
    const divider = byId("divider"), box = byId("pane-b").getBoundingClientRect();
    claim("2 is the slider", stage.dataset.mode === "slider" && getComputedStyle(divider).display === "block");
    claim("it begins in the middle", divider.getAttribute("aria-valuenow") === "50");
    const left = box.left + box.width / 2, top = box.top + box.height / 2;
    point(divider, "pointerdown", left, top);
    point(stage, "pointermove", box.left + 0.75 * box.width, top);
    point(stage, "pointerup", box.left + 0.75 * box.width, top);
    claim("the slider moves with the pointer", divider.getAttribute("aria-valuenow") === "75" && near(parseFloat(divider.style.left), 75));
    claim("and B begins there", near(parseFloat(layer("b").style.clipPath.split(" ")[3]), (0.75 * box.width - state.x) / state.scale));
    press("ArrowLeft");
    claim("and with an arrow", divider.getAttribute("aria-valuenow") === "73");
    press("3");
    const first = stage.dataset.shows;
    await until(() => stage.dataset.shows !== first, "3 blinks");
    press("ArrowLeft");
    claim("an arrow shows A alone", stage.dataset.shows === "a" && layer("b").hidden && !layer("a").hidden);
    await wait(1500);
    claim("and stops the blinking", stage.dataset.shows === "a");
    press("4");
    claim("4 shows the heat map", stage.dataset.mode === "heat" && !layer("map").hidden);
    press("ArrowLeft");
    claim("an arrow turns its opacity", near(parseFloat(layer("map").style.opacity), 0.95));
    press("5");
    await until(() => layer("difference"), "5 draws the difference");
    press("1");
}

async function driveZoom() {
    const plane = document.querySelector("#pane-b .plane"), before = state.scale;
    const box = byId("pane-b").getBoundingClientRect(), at = [Math.ceil(box.left) + 30, Math.ceil(box.top) + 40];
    const under = () => [(at[0] - box.left - state.x) / state.scale, (at[1] - box.top - state.y) / state.scale];
    const place = under();
    byId("pane-b").dispatchEvent(new WheelEvent("wheel", { deltaY: -400, clientX: at[0], clientY: at[1], bubbles: true, cancelable: true }));
    claim("the wheel zooms", state.scale > 1.5 * before);
    claim("about the pointer", near(under()[0], place[0]) && near(under()[1], place[1]));
    claim("to pixels", getComputedStyle(layer("b")).imageRendering === "pixelated" && plane.classList.contains("pixels"));
    const x = state.x;
    point(stage, "pointerdown", 400, 400);
    point(stage, "pointermove", 425, 400);
    point(stage, "pointerup", 425, 400);
    claim("a drag moves", near(state.x, x + 25));
    press("0");
    claim("0 fits again", near(state.scale, before));
    press("w");
    await until(() => byId("readout").textContent.includes("B − A"), "the pixel under the pointer is read");
    const [a, b] = await value(Promise.all([pictures.levels("a"), pictures.levels("b")]), "both images are decoded");
    const [px, py] = state.chosen.at_pixel, i = 4 * (py * 160 + px);
    const most = Math.max(...[0, 1, 2].map((k) => Math.abs(a.data[i + k] - b.data[i + k])));
    claim("w goes to the largest difference, whose levels differ by it", most === state.chosen.largest_difference && byId("readout").textContent.startsWith("x " + px + "  y " + py));
    const spot = document.querySelector("#pane-a .spot"), plane_a = document.querySelector("#pane-a .a").getBoundingClientRect(), frame = spot.getBoundingClientRect();
    claim("and frames it", !spot.hidden && near((frame.left - plane_a.left) / state.scale, px) && near((frame.top - plane_a.top) / state.scale, py) && near(frame.width, state.scale));
    press("0");
}

async function driveFigures() {
    const figures = cells(".metrics").join("\n");
    claim("figures stand beside limits", /Failing pixels\|\d+.\([\d.]+.%\)\|✕.≤.2.%/.test(figures) && figures.includes("Local difference|"));
    const marked = [...document.querySelectorAll(".sides .differ")].map((row) => row.children[0].textContent);
    claim("the files' texts are there, where they differ marked", cells(".sides").includes("Comment|Old <card>|New <\/script>") && marked.includes("Comment") && !marked.includes("Driver") && !marked.includes("File"));
    claim("and what is the same stands once", cells(".sides").some((row) => row === "Image|160 × 120, 8 bits"));
    press("a");
    claim("a marks the image", byId("mark").getAttribute("aria-pressed") === "true" && byId("accept-all").textContent === "Copy 1 accept command");
    press("a");
    claim("all that can be accepted are counted", byId("accept-all").textContent === "Copy 4 accept commands");
    await goTo("float.pfm");
    await until(() => layer("b").naturalWidth === 4, "floats have a picture of 8 bits");
    const level = (await value(pictures.levels("b"), "it is decoded")).data.slice(0, 3).join();
    claim("through the curve of sRGB, clamped", level === "188,255,0");
    await goTo("same.png");
    press("4");
    claim("without a heat map a line says why", document.querySelector("#pane-b .empty").textContent === "No heat map: the images look equal");
    await goTo("gone.png");
    press("1");
    claim("a missing image has a line, too", document.querySelector("#pane-b .empty").textContent.startsWith("No new image: "));
    await goTo("cut.png");
    claim("as has a damaged one", document.querySelector("#pane-b .empty").textContent.includes("cut.png"));
    claim("which cannot be accepted", !byId("mark"));
}

async function driveRest() {
    const ground = () => getComputedStyle(document.body).backgroundColor;
    const light = ground();
    press("t");
    press("t");
    claim("t switches to dark", document.documentElement.dataset.theme === "dark" && ground() !== light);
    press("t");
    press("?");
    claim("? lists the keys", byId("help").open && byId("keys").children.length > 20);
    byId("help").close();
    claim("names are text", !document.querySelector("#list b, #details b") && names().includes("<b>&amp; it's.png"));
    const unnamed = [...document.querySelectorAll("button, input")].filter((part) => !part.closest("[hidden]") && !(part.textContent.trim() || part.ariaLabel || part.labels?.[0]?.textContent.trim()));
    claim("every control has a name", unnamed.length === 0);
    claim("nothing is wider than the window", document.documentElement.scrollWidth <= innerWidth);
    claim("nothing was loaded", performance.getEntriesByType("resource").every((entry) => /^(blob|data):/.test(entry.name)));
}

(async () => {
    await driveList();
    await driveModes();
    await driveZoom();
    await driveFigures();
    await driveRest();
    finish();
})().catch((error) => {
    claim("no exception: " + error.stack, false);
    finish();
});
