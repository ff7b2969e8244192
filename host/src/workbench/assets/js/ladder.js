// The error ladder: one step down for each effect on the way to the model that is looked at.

import { colour, letter, step } from "./names.js";
import { at, svg } from "./elements.js";
import { judged } from "./error.js";
import { repeatability } from "./floor.js";
import { counts, times } from "./numbers.js";

const [WIDE, HIGH] = [288, 200];
const [LEFT, TOP, BOTTOM] = [30, 20, 32];
// Room between the encoder's own error and the bottom, px.
const UNDER = 18;
const MOST = 5;

let known = new Set();

/** The models from the first to this one. */
export function wayTo(models, id) {
  const way = [];
  let model = models.find((one) => one.id === id);
  while (model && !way.includes(model)) {
    way.unshift(model);
    model = models.find((one) => one.id === model.parent);
  }
  return way;
}

/** Draws the ladder; `foreseen` is the held-out error of what is previewed, with its name. */
export function show(bench, foreseen) {
  const place = at("ladder");
  const narrow = place.clientHeight < 100;
  const high = narrow ? 64 : HIGH;
  place.setAttribute("viewBox", `0 0 ${WIDE} ${high}`);
  const way = wayTo(bench.models, bench.chosen);
  const cut = way.slice(-MOST);
  const steps = cut.map((model, k) => ({
    error: judged(model), id: model.id, name: step(model, k || cut.length < way.length ? bench.models.find((one) => one.id === model.parent) : null),
  }));
  if (foreseen) steps.push({ error: foreseen.error, id: bench.next, name: `+ ${foreseen.effect}`, dashed: true });
  place.replaceChildren();
  place.setAttribute("aria-label", steps.map((one) => `${one.name}: ${counts(one.error)} counts`).join(", "));
  if (!steps.length) return;
  const most = Math.max(...steps.map((one) => one.error), 10);
  const least = Math.min(bench.floor_counts, ...steps.map((one) => one.error));
  const [left, top, bottom, under] = narrow ? [0, 4, 2, 6] : [LEFT, TOP, BOTTOM, UNDER];
  const Y = (e) => top + (1 - Math.log(e / least) / Math.log(most / least)) * (high - top - bottom - under);
  const slots = Math.max(3, steps.length);
  const X = (k) => left + ((WIDE - left) * k) / slots;
  const full = (made) => {
    made.classList.add("full");
    return made;
  };
  for (let power = Math.ceil(Math.log10(least)); 10 ** power <= most; power += 1) {
    const y = Y(10 ** power);
    place.append(full(svg("path", { class: "grid", d: `M${left} ${y}H${WIDE}` })),
      full(svg("text", { x: left - 6, y: y + 4, "text-anchor": "end" }, power < 3 ? String(10 ** power) : `10${"⁰¹²³⁴⁵⁶⁷⁸⁹"[power]}`)));
  }
  const floor = Y(bench.floor_counts);
  const own = repeatability(bench);
  if (own > bench.floor_counts) {
    const y = Y(Math.min(own, most));
    place.append(svg("rect", { class: "repeats", x: left, y, width: WIDE - left, height: Math.max(0, floor - y) }));
    place.append(full(svg("text", { x: WIDE - 4, y: floor - 5, "text-anchor": "end" }, `the motor's repeatability ${counts(own)}`)));
  }
  place.append(svg("path", { class: "floor", d: `M${left} ${floor}H${WIDE}` }));
  steps.forEach((one, k) => {
    const [x, right, y] = [X(k), X(k + 1), Y(one.error)];
    const stroke = colour(one.id);
    const group = svg("g", { class: known.has(one.id) || one.dashed || !known.size ? "" : "drops" });
    group.append(svg("rect", { x, y, width: right - x, height: Math.max(0, high - bottom - y), fill: stroke, opacity: one.dashed ? 0.05 : 0.14 }));
    if (k) {
      const before = Y(steps[k - 1].error);
      group.append(svg("path", { d: `M${x} ${before}V${y}`, stroke, "stroke-width": 2, class: one.dashed ? "dashed" : "" }));
      const fall = steps[k - 1].error / one.error;
      if (fall >= 1.05 && y - before > 16) group.append(full(svg("text", { x: x + 6, y: (before + y) / 2 + 4, style: `fill:${stroke}` }, `÷ ${times(fall)}`)));
    }
    group.append(svg("path", { d: `M${x} ${y}H${right}`, stroke, "stroke-width": 3, class: one.dashed ? "dashed" : "" }));
    group.append(full(svg("text", { class: "v", x: right - 4, y: y - 6, "text-anchor": "end", style: `fill:${stroke}` }, counts(one.error))));
    const middle = (x + right) / 2;
    group.append(full(svg("text", { class: "v", x: middle, y: high - 17, "text-anchor": "middle", style: `fill:${stroke}` }, letter(one.id))));
    group.append(full(svg("text", { x: middle, y: high - 4, "text-anchor": "middle" }, fitted(one.name, right - x))));
    place.append(group);
  });
  place.append(full(svg("text", { x: left + 4, y: floor + 13 }, `${bench.recording.window_s ? "readings'" : "encoder"} floor ${counts(bench.floor_counts)}`)));
  known = new Set(bench.models.map((model) => model.id));
}

// A name in as much room as there is.
function fitted(name, room) {
  const most = Math.max(4, Math.floor(room / 6));
  return name.length > most ? `${name.slice(0, most - 1)}…` : name;
}
