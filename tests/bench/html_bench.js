// SPDX-License-Identifier: MIT
// Drives the page of tests/bench/test_bench_html.sh.
const marks = () => [...document.querySelectorAll("#plots .mark")];
const firstColumn = (name) => [...document.querySelectorAll("tbody tr")].map((row) => row.children[[...document.querySelectorAll("thead th")].findIndex((head) => head.dataset.column === name)].textContent);
const head = (name) => document.querySelector('th[data-column="' + name + '"]');
const type = (text) => {
    byId("filter").value = text;
    byId("filter").dispatchEvent(new Event("input"));
};

claim("rows of both files are there", byId("count").textContent === "8 rows");
claim("the heading names the files and counts broken bounds", byId("title").textContent.endsWith("one.csv, " + byId("title").textContent.split(", ")[1]) && byId("summary").textContent === "8 rows · 2 of 6 bounds broken");
claim("both machines are named", byId("device").textContent.includes("A | B") && byId("device").textContent.includes("1e52405"));
claim("time is across and error up, both logarithmic", state.x === "ms_min" && state.y === "value" && state.log.x && state.log.y);
claim("each set has a panel", [...document.querySelectorAll("figcaption")].map((one) => one.textContent).join() === "1k16,10k32");
claim("a point for each row with both values", marks().length === 6);
claim("what is left out is said", byId("missing").textContent.startsWith("2 of these 8 rows are not drawn"));
claim("points of a solver are joined, and its front is drawn", document.querySelectorAll("#plots .joint").length === 2 && document.querySelectorAll("#plots .front").length === 2);

const [x0, x1] = [marks()[0], marks()[1]].map((mark) => Number(mark.getAttribute("transform").match(/[\d.]+/)[0]));
claim("a longer time is further right", x1 > x0);
document.querySelector('[data-axis="x"]').click();
claim("a click makes an axis linear", !state.log.x && document.querySelector(".axis-name").textContent === "ms_min →");
press("x");
claim("x makes it logarithmic", state.log.x);

const box = marks()[2].getBoundingClientRect();
marks()[2].ownerSVGElement.dispatchEvent(new PointerEvent("pointermove", { clientX: box.left + box.width / 2, clientY: box.top + box.height / 2, bubbles: true }));
claim("a point under the pointer shows its row", !byId("tip").hidden && byId("tip").textContent.includes("0.2") && byId("tip").textContent.includes("<\/script><b>"));
claim("and marks it in the table", document.querySelector("tbody tr.here").dataset.row === marks()[2].dataset.row);
marks()[2].ownerSVGElement.dispatchEvent(new PointerEvent("pointerleave"));
claim("until it leaves", byId("tip").hidden && !document.querySelector(".here"));

document.querySelector('#legend [data-series="rope"]').click();
claim("the legend hides a series", marks().length === 4 && document.querySelector('#legend [data-series="rope"]').getAttribute("aria-pressed") === "false");
claim("and keeps the focus", document.activeElement.dataset.series === "rope");
press("s");
claim("s shows all", marks().length === 6);

head("value").querySelector("button").click();
claim("a heading sorts, missing values last", firstColumn("value").join() === "0.01,0.01,0.02,0.02,0.2,0.2,–,–" && head("value").getAttribute("aria-sort") === "ascending");
head("value").querySelector("button").click();
claim("and again the other way, missing values last", firstColumn("value").join() === "0.2,0.2,0.02,0.02,0.01,0.01,–,–" && head("value").getAttribute("aria-sort") === "descending");
head("set").querySelector("button").click();
claim("words sort by the numbers in them", firstColumn("set")[0] === "1k16" && firstColumn("set")[7] === "10k32");
claim("broken bounds stand out", document.querySelectorAll("td.broken").length === 2);

press("/");
claim("/ goes to the filter", document.activeElement === byId("filter"));
type("rope 10K32");
claim("words filter rows and points", byId("count").textContent === "2 of 8 rows" && marks().length === 1);
type("nothing like it");
claim("nothing found is no error", byId("count").textContent === "0 of 8 rows" && marks().length === 0);
type("");
press("Escape");
const facet = byId("facets").querySelector('[aria-label="verdict"]');
facet.value = "broken";
facet.dispatchEvent(new Event("change"));
claim("a choice filters", byId("count").textContent === "2 of 8 rows");
press("?");
claim("? lists the keys", byId("help").open);
byId("help").close();
claim("texts are texts", !document.querySelector("td b, #tip dd b"));
claim("nothing is wider than the window", document.documentElement.scrollWidth <= innerWidth);
finish();
