// The parameters of the model that is looked at, with intervals and units.

import { colour, letter, spoken } from "./names.js";
import { at, el, svg } from "./elements.js";
import { digits, estimate, times, usual } from "./numbers.js";
import { judged } from "./error.js";
import { floorCounts, repeatability } from "./floor.js";

// Half of the width of the whisker's scale, as a part of the value.
const SCALE = 0.25;
const SURE = 1.96;

const NAMES = {
  gain: "Gain", a1: "Time constant", a2: "Second coefficient", kb: "Kb", kt: "Kt", resistance: "R", inductance: "L", inertia: "J",
  viscous: "b", electrical_time_constant: "Electrical lag", mechanical_time_constant: "Mechanical lag", viscous_part: "Viscous part",
};

// An effect with one parameter has its name.
function name(one, all) {
  if (NAMES[one.name]) return NAMES[one.name];
  const [effect, own] = one.name.split(".");
  const alone = all.filter((other) => other.name.startsWith(`${effect}.`)).length === 1;
  return spoken(own && !alone ? `${effect} ${own}` : effect);
}

/** The parameters that are shown: a wave by amplitude and phase, not by cosine and sine as well. */
export function shownOf(model) {
  const has = (text) => model.parameters.some((one) => one.name === text);
  return model.parameters.filter((one) => {
    const [effect, own] = one.name.split(".");
    return !(own && /^(co)?sine/.test(own) && has(`${effect}.amplitude`));
  });
}

/** Shows them; rings are where the parent's values were. */
export function show(bench, model, parent) {
  at("parameters-tag").replaceChildren(...(model ? [el("span", { class: "tag", style: `background:${colour(model.id)}` }, letter(model.id))] : []));
  at("parameters").replaceChildren(...(model ? shownOf(model).map((one, k, all) => row(one, parent, model.id, all)) : []));
  at("parameters-key").textContent = parent ? "± 95 %, ○ before" : "± 95 %";
  const over = model ? judged(model) / floorCounts(bench) : 1;
  at("trust").hidden = over < 1.5;
  at("trust").textContent = `Not to be trusted yet: the error is ${times(over)} times the ${repeatability(bench) ? "motor's repeatability" : bench.recording.window_s ? "readings' own" : "encoder's own"}.`;
}

function row(one, parent, id, all) {
  const { value, factor, unit } = usual(one.value, one.unit, one.name);
  const half = one.std === null ? NaN : SURE * one.std * factor;
  const cells = [el("td", { title: one.name }, name(one, all))];
  if (one.at_bound) {
    cells.push(el("td", { class: "v" }, digits(value, 4)), el("td", { class: "pm" }, "at bound"), el("td", { class: "u" }, unit), el("td", { class: "w" }));
  } else if (one.std === null && one.identifiable) {
    cells.push(el("td", { class: "v" }, estimate(value, NaN)[0]), el("td", { class: "pm" }), el("td", { class: "u" }, unit), el("td", { class: "w" }));
  } else if (!one.identifiable || !Number.isFinite(half) || half >= Math.abs(value)) {
    const most = Number.isFinite(half) ? Math.abs(value) + half : NaN;
    const said = Number.isFinite(most) ? `below ${digits(most, 3)}` : "not determined";
    cells.push(el("td", { class: "whole", colspan: 2 }, said), el("td", { class: "u" }, unit), el("td", { class: "w" }));
  } else {
    const [text, wide] = estimate(value, half);
    cells.push(el("td", { class: "v" }, text), el("td", { class: "pm" }, wide ? `± ${wide}` : ""), el("td", { class: "u" }, unit),
      el("td", { class: "w" }, whisker(value, half, before(one, parent, factor), id)));
  }
  return el("tr", {}, ...cells);
}

function before(one, parent, factor) {
  const found = parent?.parameters.find((other) => other.name === one.name);
  return found ? found.value * factor : null;
}

function whisker(value, half, old, id) {
  const X = (x) => 16 + Math.max(-15, Math.min(15, ((x - value) / (Math.abs(value) * SCALE)) * 16));
  return svg("svg", { width: 32, height: 14, "aria-hidden": "true" },
    svg("path", { d: "M0 7H32", stroke: "var(--grid)" }),
    old === null ? null : svg("circle", { cx: X(old), cy: 7, r: 3, fill: "none", stroke: "var(--ink-3)" }),
    svg("path", { d: `M${X(value - half)} 7H${X(value + half)}`, stroke: colour(id), "stroke-width": 3 }),
    svg("path", { d: "M16 3V11", stroke: "var(--ink)" }));
}
