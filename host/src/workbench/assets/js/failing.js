// Where the models fail: cumulative squared error over time and speed, with the band that a right model keeps, and the orders of the angle.

import { ask } from "./ask.js";
import { colour, letter, spoken } from "./names.js";
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
      + (best.time.band.length ? "The grey band is what a right model would leave: where a line leaves it, the model fails."
        : "Models run in windows, or readings are no counts: there no band is known that a right one would keep.")),
    el("div", { class: "curves" },
      samples("Time", "s", models, "time"), samples("Speed", "rad/s, sorted", models, "speed"), cumulatedOrders(models), orders(models)),
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

// Cumulative shares, evenly along the abscissa, over the band `[low, high]` of a right model; ticks are `[part, text]`.
function cumulated(title, unit, curves, band, ticks) {
  const along = (shares) => shares.map((share, k) => [X((k + 1) / shares.length), Y(share)]);
  const parts = grid();
  if (band.length) {
    const [there, back] = [0, 1].map((side) => along(band.map((edges) => edges[side])));
    parts.push(svg("path", { d: `${path([[X(0), Y(0)], ...there, ...back.reverse()])}Z`, fill: "var(--band)" }));
  }
  for (const { id, shares } of [...curves].reverse()) {
    parts.push(svg("path", { d: path([[X(0), Y(0)], ...along(shares)]), fill: "none", stroke: colour(id), "stroke-width": 1.75 }));
  }
  for (const [part, text] of ticks) {
    parts.push(svg("text", { x: X(part), y: HIGH - 4, "text-anchor": part === 0 ? "start" : part === 1 ? "end" : "middle" }, text));
  }
  return frame(title, unit, parts);
}

// Samples in their order, with the quantity written beneath.
function samples(title, unit, models, what) {
  const { x, band } = models[0][what];
  const middle = x.length >> 1;
  const ticks = [[0, what === "time" ? "0" : digits(x[0], 2)], [(middle + 1) / x.length, digits(x[middle], 2)], [1, digits(x.at(-1), 2)]];
  return cumulated(title, unit, models.map((model) => ({ id: model.id, shares: model[what].share })), band, ticks);
}

// Orders of the angle, with Kolmogorov's bound of 95 % for powers that are as white noise would have them.
function cumulatedOrders(models) {
  const n = models[0].orders_v.length;
  const limited = (share) => Math.max(0, Math.min(1, share));
  const band = Array.from({ length: n }, (_, k) => {
    const part = (k + 1) / n;
    const bound = 1.36 * Math.sqrt((part * (1 - part)) / n) * 2;
    return [limited(part - bound), limited(part + bound)];
  });
  const curves = models.map((model) => {
    const powers = model.orders_v.map((v) => v * v);
    const total = powers.reduce((a, b) => a + b, 0) || 1;
    let sum = 0;
    const shares = powers.map((p) => {
      sum += p;
      return sum / total;
    });
    return { id: model.id, shares };
  });
  return cumulated("Angle order", "cycles per revolution", curves, band, [[1 / n, "1"], [0.5, String(n / 2)], [1, String(n)]]);
}

function orders(models) {
  const n = models[0].orders_v.length;
  const most = Math.max(...models.flatMap((model) => model.orders_v)) || 1;
  // Few digits, that they fit beside the axis.
  const [unit, scale] = most < 0.1 ? ["mV", 1e3] : ["V", 1];
  const parts = [0.5, 1].flatMap((part) => [
    svg("path", { class: "grid", d: `M${LEFT} ${Y(part)}H${WIDE - 6}` }),
    svg("text", { x: LEFT - 4, y: Y(part) + 4, "text-anchor": "end" }, digits(part * most * scale, 2))]);
  const wide = (WIDE - LEFT - 6) / n;
  models.forEach((model, m) => model.orders_v.forEach((v, k) => {
    const [x, bar] = [X(k / n) + (m * wide) / (models.length + 1), wide / (models.length + 1)];
    parts.push(svg("rect", { x, y: Y(v / most), width: bar, height: Math.max(0, Y(0) - Y(v / most)), fill: colour(model.id) }));
  }));
  for (const k of [1, n / 2, n]) parts.push(svg("text", { x: X((k - 0.5) / n), y: HIGH - 4, "text-anchor": "middle" }, String(k)));
  return frame("Orders", `missing drive, ${unit}`, parts);
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
  const said = model.taken.map((one) => `${spoken(one.effect)} ${digits(one.rms_v, 2)} V`).join(", ");
  return el("figure", { style: "margin-top:16px" }, el("figcaption", {}, el("strong", {}, "What each effect takes of the drive"), " ",
    el("span", { class: "quiet" }, `RMS over the recording, from below: ${said}`)),
  svg("svg", { viewBox: `0 0 ${wide} ${high}`, width: "100%", class: "taken", role: "img", "aria-label": `What each effect takes of the drive: ${said}` }, ...parts));
}
