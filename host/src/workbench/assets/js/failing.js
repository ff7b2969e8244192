// Where the models fail: cumulative squared error over time and speed, with the band that a right model keeps, and the orders of the angle.

import { ask } from "./ask.js";
import { colour, letter } from "./colours.js";
import { el, path, svg } from "./elements.js";
import { digits } from "./numbers.js";

const [WIDE, HIGH, LEFT, BOTTOM] = [290, 160, 30, 18];

/** Fills a place with them. */
export async function show(place) {
  const { models } = await ask("failing");
  const [best] = models;
  if (!best) {
    place.replaceChildren(el("p", { class: "quiet" }, "Nothing is fitted yet."));
    return;
  }
  place.replaceChildren(
    el("p", { class: "quiet s12" }, `Share of the squared error of ${models.map((one) => letter(one.id)).join(" and ")} as samples are counted in order. `
      + "The grey band is what a right model would leave: where a line leaves it, the model fails."),
    el("div", { class: "curves" },
      shares("Time", "s", models, "time"), shares("Speed", "rad/s, sorted", models, "speed"), cumulatedOrders(models), orders(models)),
    taken(best) ?? "");
}

function frame(title, unit, children) {
  return el("figure", {}, el("figcaption", {}, el("strong", {}, title), " ", el("span", { class: "quiet" }, unit)),
    svg("svg", { viewBox: `0 0 ${WIDE} ${HIGH}`, width: "100%", role: "img", "aria-label": `${title}, ${unit}` }, ...children));
}

const X = (part) => LEFT + part * (WIDE - LEFT - 6);
const Y = (share) => 6 + (1 - share) * (HIGH - BOTTOM - 10);

function grid() {
  return [0, 0.5, 1].flatMap((share) => [
    svg("path", { class: "grid", d: `M${LEFT} ${Y(share)}H${WIDE - 6}` }),
    svg("text", { x: LEFT - 6, y: Y(share) + 4, "text-anchor": "end" }, String(100 * share))]);
}

// The abscissa is the order of the samples, with the quantity written beneath.
function shares(title, unit, models, what) {
  const [best] = models;
  const n = best[what].share.length;
  const part = (k) => (k + 1) / n;
  const band = best[what].band;
  const parts = grid();
  if (band.length) {
    const there = band.map(([low], k) => [X(part(k)), Y(low)]);
    const back = band.map(([, high], k) => [X(part(k)), Y(high)]).reverse();
    parts.push(svg("path", { d: `${path([[X(0), Y(0)], ...there, ...back])}Z`, fill: "var(--band)" }));
  }
  for (const model of [...models].reverse()) {
    const points = [[X(0), Y(0)], ...model[what].share.map((share, k) => [X((k + 1) / model[what].share.length), Y(share)])];
    parts.push(svg("path", { d: path(points), fill: "none", stroke: colour(model.id), "stroke-width": 1.75 }));
  }
  for (const k of [0, n >> 1, n - 1]) {
    parts.push(svg("text", { x: X(k === 0 ? 0 : part(k)), y: HIGH - 4, "text-anchor": k === 0 ? "start" : k === n - 1 ? "end" : "middle" }, k === 0 && what === "time" ? "0" : digits(best[what].x[k], 2)));
  }
  return frame(title, unit, parts);
}

function cumulatedOrders(models) {
  const parts = grid();
  const n = models[0].orders_v.length;
  // Kolmogorov's bound of 95 % for powers that are as white noise would have them.
  const bound = (k) => 1.36 * Math.sqrt(((k / n) * (1 - k / n)) / n) * 2;
  const ks = Array.from({ length: n + 1 }, (_, k) => k);
  const limited = (share) => Math.max(0, Math.min(1, share));
  parts.push(svg("path", {
    d: `${path([...ks.map((k) => [X(k / n), Y(limited(k / n - bound(k)))]), ...ks.map((k) => [X(k / n), Y(limited(k / n + bound(k)))]).reverse()])}Z`, fill: "var(--band)",
  }));
  for (const model of [...models].reverse()) {
    const powers = model.orders_v.map((v) => v * v);
    const total = powers.reduce((a, b) => a + b, 0) || 1;
    let sum = 0;
    const points = [[X(0), Y(0)], ...powers.map((p, k) => {
      sum += p;
      return [X((k + 1) / n), Y(sum / total)];
    })];
    parts.push(svg("path", { d: path(points), fill: "none", stroke: colour(model.id), "stroke-width": 1.75 }));
  }
  for (const k of [1, n / 2, n]) parts.push(svg("text", { x: X(k / n), y: HIGH - 4, "text-anchor": k === n ? "end" : "middle" }, String(k)));
  return frame("Angle order", "cycles per revolution", parts);
}

function orders(models) {
  const n = models[0].orders_v.length;
  const most = Math.max(...models.flatMap((model) => model.orders_v)) || 1;
  const parts = [0.5, 1].flatMap((part) => [
    svg("path", { class: "grid", d: `M${LEFT} ${Y(part)}H${WIDE - 6}` }),
    svg("text", { x: LEFT - 4, y: Y(part) + 4, "text-anchor": "end" }, digits(part * most, 2))]);
  const wide = (WIDE - LEFT - 6) / n;
  models.forEach((model, m) => model.orders_v.forEach((v, k) => {
    const [x, bar] = [X(k / n) + (m * wide) / (models.length + 1), wide / (models.length + 1)];
    parts.push(svg("rect", { x, y: Y(v / most), width: bar, height: Math.max(0, Y(0) - Y(v / most)), fill: colour(model.id) }));
  }));
  for (const k of [1, n / 2, n]) parts.push(svg("text", { x: X((k - 0.5) / n), y: HIGH - 4, "text-anchor": "middle" }, String(k)));
  return frame("Orders", "missing drive, V", parts);
}

// What each effect of the model takes of the drive, stacked.
function taken(model) {
  if (!model.taken.length) return null;
  const [wide, high] = [1180, 120];
  const n = model.taken[0].parts_v.length;
  const sums = Array.from({ length: n }, (_, k) => model.taken.reduce((sum, one) => sum + one.parts_v[k], 0));
  const most = Math.max(...sums) || 1;
  const x = (k) => LEFT + (k / n) * (wide - LEFT - 6);
  const y = (v) => 6 + (1 - v / most) * (high - BOTTOM - 10);
  const parts = [0.5, 1].flatMap((part) => [svg("path", { class: "grid", d: `M${LEFT} ${y(part * most)}H${wide - 6}` }),
    svg("text", { x: LEFT - 4, y: y(part * most) + 4, "text-anchor": "end" }, digits(part * most, 2))]);
  const below = new Array(n).fill(0);
  model.taken.forEach((one, m) => {
    // Steps: each part of the time has its own height.
    const edge = (values) => values.flatMap((v, k) => [[x(k), y(v)], [x(k + 1), y(v)]]);
    const above = below.map((v, k) => v + one.parts_v[k]);
    parts.push(svg("path", { d: `${path([...edge(above), ...edge(below).reverse()])}Z`, fill: colour(model.id), opacity: 0.85 - 0.25 * (m % 3) }));
    above.forEach((v, k) => {
      below[k] = v;
    });
  });
  parts.push(svg("text", { x: LEFT, y: high - 4 }, "0"), svg("text", { x: wide - 6, y: high - 4, "text-anchor": "end" }, `${digits(model.taken[0].seconds, 3)} s`));
  const said = model.taken.map((one) => `${one.effect.replace(/_/g, " ")} ${digits(one.rms_v, 2)} V`).join(", ");
  return el("figure", { style: "margin-top:16px" }, el("figcaption", {}, el("strong", {}, "What each effect takes of the drive"), " ",
    el("span", { class: "quiet" }, `RMS over the recording, from below: ${said}`)),
  svg("svg", { viewBox: `0 0 ${wide} ${high}`, width: "100%", class: "taken", role: "img", "aria-label": `What each effect takes of the drive: ${said}` }, ...parts));
}
