// The tabs beneath the lanes.

import { ask } from "./ask.js";
import { value, variable } from "./names.js";
import { at, button, el } from "./elements.js";
import * as failing from "./failing.js";
import * as remedy from "./remedy.js";
import * as searches from "./searches.js";
import * as sliders from "./sliders.js";

const TABS = [
  ["failing", "Where it fails", fails], ["response", "Response", drawn], ["clock", "Clock", drawn],
  ["limits", "Not determined", drawn], ["remedy", "Remedy", remedied], ["hand", "By hand", byHand], ["searches", "Searches", searched], ["log", "Log", log],
];

let open = null;
let filled = null;
let now = null;
let asked = 0;

/** Makes the tabs. */
export function begin() {
  at("tabs").replaceChildren(...TABS.map(([name, title], k) => el("button", {
    type: "button", role: "tab", id: `tab-${name}`, "aria-selected": "false", "aria-controls": "dock", title: `${title} (${k + 1})`, onclick: () => turn(name),
  }, title)));
}

/** Opens a tab, or closes the one that is open. */
export function turn(name) {
  open = open === name ? null : name;
  filled = null;
  for (const [other] of TABS) at(`tab-${other}`).setAttribute("aria-selected", String(other === open));
  at("dock").hidden = open === null;
  if (open) at("dock").setAttribute("aria-labelledby", `tab-${open}`);
  fill().catch(now?.does.say);
}

/** Opens the tab of that number. */
export const turnTo = (k) => TABS[k] && turn(TABS[k][0]);

/** Closes the tab; says whether one was open. */
export function close() {
  if (!open) return false;
  turn(open);
  return true;
}

/** The bench has changed. */
export function show(bench, does) {
  now = { bench, does };
  fill().catch(does.say);
}

async function fill() {
  if (!open || !now) return;
  const [name, , fills] = TABS.find(([tab]) => tab === open);
  const key = fills === log || fills === searched ? `${name} ${now.bench.revision}` : name + stampOf(now.bench);
  if (key === filled) return;
  filled = key;
  asked += 1;
  const own = asked;
  await fills(name, now.bench, now.does, () => own === asked);
}

// What a tab's drawings are of.
function stampOf(bench) {
  const stamp = (id) => bench.models.find((model) => model.id === id)?.stamp;
  return ` ${bench.recording?.stamp} ${stamp(bench.chosen)} ${stamp(bench.against)}`;
}

async function fails(name, bench, does, current) {
  const place = el("div");
  at("dock").replaceChildren(place);
  await failing.show(place);
  if (!current()) return;
  const maps = el("div");
  place.append(el("p", { class: "acts" }, button("Missing drive against speed, voltage, current and time", async (event) => {
    event.target.remove();
    await plotted("maps", maps, bench).catch(does.say);
  }, { class: "btn sm" })), maps);
}

async function drawn(name, bench, does, current) {
  const place = el("div");
  await plotted(name, place, bench, current);
}

// Plotly and what draws with it, when they are first needed.
let loading = null;
function plotly() {
  loading ??= ["plotly.js", "plots.js"].reduce((before, source) => before.then(() => new Promise((done, failed) => {
    document.head.append(el("script", { src: source, onload: done, onerror: () => failed(new Error(`${source} does not load`)) }));
  })), Promise.resolve());
  const theme = document.documentElement.dataset.theme;
  return loading.then(() => servoid.theme(theme));
}

async function plotted(tab, place, bench, current = () => true) {
  const [answer] = await Promise.all([ask(`details/${tab}`), plotly()]);
  if (!current()) return;
  if (place.parentElement === null) at("dock").replaceChildren(place);
  for (const old of place.querySelectorAll(".plot")) servoid.forget(old);
  place.innerHTML = answer.html || "<p class=\"quiet\">The recording shows nothing here.</p>";
  for (const [id, drawing] of Object.entries(answer.drawings)) await servoid.draw(at(id), coloured(drawing, bench));
  document.body.dataset.tab = tab;
}

// The models of a drawing in the colours that they have on the page.
function coloured(drawing, bench) {
  const pairs = [["#d55e00", bench.against], ["#0072b2", bench.chosen]].filter(([, id]) => id !== null);
  let text = JSON.stringify(drawing);
  for (const [old, id] of pairs) text = text.replaceAll(new RegExp(`"${old}"`, "gi"), `"@${id}"`);
  for (const [, id] of pairs) text = text.replaceAll(`"@${id}"`, `"${value(variable(id))}"`);
  return JSON.parse(text);
}

async function remedied(name, bench, does, current) {
  const place = el("div");
  at("dock").replaceChildren(place);
  await remedy.show(place, bench, does).catch((error) => current() && place.replaceChildren(el("p", { class: "quiet" }, error.message)));
}

async function byHand(name, bench, does) {
  sliders.show(at("dock"), bench, does);
}

async function searched(name, bench, does, current) {
  const curves = searches.show(at("dock"), bench, does);
  if (bench.race) await plotted("race", curves, bench, current);
}

async function log(name, bench) {
  const model = bench.models.find((one) => one.id === bench.chosen);
  const lines = [...(bench.diagnosis ? [bench.diagnosis.summary, ...(bench.diagnosis.advice ?? [])] : []), ...(model?.notes ?? [])];
  at("dock").replaceChildren(el("h2", {}, "What there is to know of this fit"),
    el("ul", { class: "log", id: "notes" }, ...(lines.length ? lines : ["Nothing special."]).map((line) => el("li", {}, line))));
}
