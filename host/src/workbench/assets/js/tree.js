// A tree of models: each a node, an edge for what was added or removed, with its held-out error.

import { colour, letter, step } from "./names.js";
import { at, svg } from "./elements.js";
import { judged } from "./error.js";
import { counts } from "./numbers.js";

const [ACROSS, DOWN] = [92, 50];

/** Draws the tree; `does` holds `choose`, `compare` and `remove`. */
export function show(bench, foreseen, does) {
  const place = at("tree");
  const focused = document.activeElement?.dataset?.model;
  const children = new Map();
  const ids = new Set(bench.models.map((model) => model.id));
  for (const model of bench.models) {
    const parent = ids.has(model.parent) ? model.parent : null;
    children.set(parent, [...(children.get(parent) ?? []), model]);
  }
  const places = new Map();
  let rows = 0;
  let deepest = 0;
  const lay = (model, depth, row) => {
    places.set(model.id, [depth, row]);
    deepest = Math.max(deepest, depth);
    (children.get(model.id) ?? []).forEach((child, k) => {
      if (k) rows += 1;
      lay(child, depth + 1, k ? rows : row);
    });
  };
  (children.get(null) ?? []).forEach((root, k) => {
    if (k) rows += 1;
    lay(root, 0, rows);
  });
  const at0 = ([depth, row]) => [20 + depth * ACROSS, 22 + row * DOWN];
  place.replaceChildren();
  for (const model of bench.models) {
    const parent = places.get(model.parent);
    if (!parent) continue;
    const [x0, y0] = at0(parent);
    const [x, y] = at0(places.get(model.id));
    place.append(edge(x0, y0, x, y, false), label(x0, x, y, step(model, bench.models.find((one) => one.id === model.parent))));
  }
  if (foreseen && places.has(bench.chosen)) {
    const [x0, y0] = at0(places.get(bench.chosen));
    const taken = (children.get(bench.chosen) ?? []).length > 0;
    if (taken) rows += 1;
    const [x, y] = [x0 + ACROSS, taken ? 22 + rows * DOWN : y0];
    deepest = Math.max(deepest, places.get(bench.chosen)[0] + 1);
    const stroke = colour(bench.next);
    place.append(edge(x0, y0, x, y, true), label(x0, x, y, `+ ${foreseen.effect}`),
      svg("circle", { cx: x, cy: y, r: 8, fill: "var(--surface)", stroke, "stroke-dasharray": "3 2", "stroke-width": 1.5 }),
      svg("text", { x, y: y + 4, "text-anchor": "middle", style: `fill:${stroke};font-weight:600` }, letter(bench.next)),
      svg("text", { x, y: y + 24, "text-anchor": "middle", style: `fill:${stroke}` }, counts(foreseen.error)));
  }
  for (const model of bench.models) place.append(node(model, at0(places.get(model.id)), bench, does));
  const [wide, high] = [44 + deepest * ACROSS, 56 + rows * DOWN];
  for (const [name, value] of [["width", wide], ["height", high], ["viewBox", `0 0 ${wide} ${high}`]]) place.setAttribute(name, value);
  at("tree-hint").textContent = bench.models.length > 1 ? "Shift+click compares" : "";
  if (focused) place.querySelector(`[data-model="${focused}"]`)?.focus();
}

const edge = (x0, y0, x, y, dashed) => svg("path", {
  class: dashed ? "edge dashed" : "edge", d: y0 === y ? `M${x0} ${y0}H${x}` : `M${x0} ${y0}C${x0 + 40} ${y0} ${x0 + 20} ${y} ${x} ${y}`,
});

function label(x0, x, y, text) {
  const said = text.length > 11 ? `${text.slice(0, 10)}…` : text;
  return svg("text", { x: (x0 + x) / 2, y: y - 6, "text-anchor": "middle" }, svg("title", {}, text), said);
}

function node(model, [x, y], bench, does) {
  const own = model.id === bench.chosen;
  const beside = model.id === bench.against && does.comparing;
  const made = svg("g", {
    class: "node", role: "button", tabindex: 0, "data-model": model.id, "aria-pressed": own ? "true" : "false",
  },
  svg("circle", { class: "ring", cx: x, cy: y, r: 12, fill: "none", stroke: own || beside ? colour(model.id) : "transparent", "stroke-width": 1.5,
    "stroke-dasharray": beside ? "3 2" : "" }),
  svg("circle", { cx: x, cy: y, r: 9, fill: colour(model.id) }),
  svg("text", { class: "l", x, y: y + 4, "text-anchor": "middle" }, letter(model.id)),
  svg("text", { class: "n", x, y: y + 26, "text-anchor": "middle" }, ` ${counts(judged(model))} `),
  svg("title", {}, `${model.name}: click shows it, Shift+click compares, Delete removes it`));
  made.addEventListener("click", (event) => (event.shiftKey ? does.compare(model.id) : does.choose(model.id)));
  made.addEventListener("keydown", (event) => {
    if (event.key === "Enter" || event.key === " ") {
      event.preventDefault();
      event.stopPropagation();
      if (event.shiftKey) does.compare(model.id);
      else does.choose(model.id);
    } else if (event.key === "Delete" || event.key === "Backspace") {
      event.preventDefault();
      does.remove(model.id);
    }
  });
  return made;
}
