// Measured and models over time: angle, residual and drive share one time axis and one cursor. Every view is thinned from whole series.

import { keptNumbers, numbers } from "./ask.js";
import { colour, letter, value, variable } from "./names.js";
import { at, button, el, path, svg } from "./elements.js";
import { counts, digits } from "./numbers.js";
import { Pyramid, parts } from "./pyramid.js";
import { onTheme } from "./theme.js";

const LEFT = 56;
// Below this the residual is drawn as its range and mean: lines would only be the encoder's steps.
const RANGE_COUNTS = 5;
// A second with less of the squared error is none to look at.
const WORST = 0.15;
const FLOOR = Math.sqrt(1 / 12);
const SHARES = { angle: 0.46, residual: 0.34, drive: 0.2 };
const TITLES = 22;
// Padding, legend, strip and the axis of time.
const AROUND = 12 + 24 + 40 + 22;

let recording = null;
let shown = [];
let span = null;
let cursor = null;
let held = false;
let windowed = null;
const plots = {};

// ---- what is shown

/** Shows a recording and models along it: `{ id, stamp, source, dashed }`, the one that is looked at last. */
export async function show(about, models, heldOut) {
  const query = heldOut ? "?held_out=true" : "";
  const key = `${about.stamp}${query}`;
  if (recording?.key !== key) {
    const of = (what, Kind) => keptNumbers(`${key}/${what}`, `series/${what}${query}`, Kind);
    const [time, angle, drive, open] = await Promise.all([
      of("time", Float64Array), of("angle", Float32Array), of("drive", Float32Array), of("open", Uint8Array),
    ]);
    const perRev = about.counts_per_rev;
    const turns = Float32Array.from(angle, (x) => x / perRev);
    recording = {
      key, time, angle, turns: new Pyramid(turns), drive: new Pyramid(drive), open: spans(time, open), perRev, about,
    };
    span = [0, time.length];
    cursor = null;
  }
  held = heldOut;
  const loaded = await Promise.all(models.map(async (model) => {
    const residual = model.values ?? await keptNumbers(`${key}/${model.stamp}`, `${model.source}${query}`, Float32Array);
    return { ...model, ...along(recording, model.stamp, residual) };
  }));
  shown = loaded;
  draw();
}

/** The residual of a model whose constants were moved by hand, counts. */
export const trial = (body) => numbers("trial", Float32Array, body);

const pyramids = new WeakMap();

// What is drawn of a residual; made once.
function along(of, stamp, residual) {
  if (!pyramids.has(residual)) {
    const turns = residual.map((e, k) => (of.angle[k] + e) / of.perRev);
    pyramids.set(residual, { residual: new Pyramid(residual), turns: new Pyramid(turns) });
  }
  return pyramids.get(residual);
}

// Times in which the bridge is open.
function spans(time, open) {
  const found = [];
  for (let k = 0; k < open.length; k += 1) {
    if (!open[k]) continue;
    const from = k;
    while (k < open.length && open[k]) k += 1;
    found.push([time[from], time[Math.min(k, open.length - 1)]]);
  }
  return found;
}

// ---- drawing

const width = () => Math.max(200, at("lanes").clientWidth - 32);

function thinned() {
  const edges = parts(span[0], span[1], Math.max(100, width() - LEFT));
  const raw = edges.length - 1 === span[1] - span[0];
  // Each part stands for its first sample, or for its extremes one after the other.
  const x = [];
  for (let k = 0; k + 1 < edges.length; k += 1) {
    const [from, to] = [edges[k], edges[k + 1]];
    if (raw) x.push(recording.time[from]);
    else x.push(recording.time[from], recording.time[(from + to) >> 1]);
  }
  const line = (pyramid) => {
    const y = [];
    for (let k = 0; k + 1 < edges.length; k += 1) {
      if (raw) {
        y.push(pyramid.values[edges[k]]);
        continue;
      }
      const [from, to] = [edges[k], edges[k + 1]];
      const [min, max] = pyramid.over(from, to);
      const rises = pyramid.values[from] <= pyramid.values[to - 1];
      y.push(rises ? min : max, rises ? max : min);
    }
    return y;
  };
  const range = (pyramid) => {
    const [low, high, mean] = [[], [], []];
    const wide = Math.max(1, Math.round((edges.length - 1) / 160));
    for (let k = 0; k + 1 < edges.length; k += 1) {
      const first = Math.max(0, k - wide);
      const last = Math.min(edges.length - 1, k + wide + 1);
      const [min, max] = pyramid.over(edges[k], edges[k + 1]);
      const [, , smooth] = pyramid.over(edges[first], edges[last]);
      for (let copy = 0; copy < (raw ? 1 : 2); copy += 1) {
        low.push(min);
        high.push(max);
        mean.push(smooth);
      }
    }
    return [low, high, mean];
  };
  return { x, line, range };
}

function lineOf(model, width = 1.5) {
  return {
    stroke: () => value(variable(model.id)), width, dash: model.dashed ? [5, 3] : undefined, points: { show: false },
  };
}

function build() {
  const { x, line, range } = thinned();
  const largest = Math.max(0, ...shown.map((model) => model.residual.largest(...span)));
  const asRange = shown.length > 0 && largest < RANGE_COUNTS && span[1] - span[0] > 400;
  const measured = {
    stroke: () => value("--measured-band"), width: 6, cap: "round", points: { show: false },
  };
  const angle = { data: [x, line(recording.turns), ...shown.map((model) => line(model.turns))],
    series: [measured, ...shown.map((model) => lineOf(model))] };
  const residual = { data: [x], series: [], bands: [] };
  for (const model of shown) {
    if (!asRange) {
      residual.data.push(line(model.residual));
      residual.series.push(lineOf(model));
      continue;
    }
    const [low, high, mean] = range(model.residual);
    const none = { stroke: "transparent", width: 0, points: { show: false } };
    residual.data.push(low, high, mean);
    residual.series.push(none, none, lineOf(model));
    const k = residual.series.length;
    residual.bands.push({ series: [k - 1, k - 2], fill: () => faded(value(variable(model.id))) });
  }
  if (!shown.length) {
    residual.data.push(x.map(() => null));
    residual.series.push({ points: { show: false } });
  }
  const drive = { data: [x, line(recording.drive)],
    series: [{ stroke: () => value("--ink-2"), width: 1, points: { show: false } }] };
  return { angle, residual, drive, asRange };
}

const faded = (hex) => `${hex}40`;

let shape = "";

function draw() {
  if (!recording) return;
  const made = build();
  const own = JSON.stringify([shown.map((model) => [model.id, model.dashed]), made.asRange, held]);
  const heights = heightsNow();
  for (const name of Object.keys(SHARES)) {
    const size = { width: width(), height: heights[name] };
    if (own !== shape || !plots[name]) {
      plots[name]?.destroy();
      plots[name] = new uPlot(options(name, made[name], size, made.asRange), made[name].data, at(`lane-${name}`));
    } else {
      plots[name].setSize(size);
      plots[name].setData(made[name].data, false);
      plots[name].setScale("x", between());
    }
  }
  shape = own;
  strip();
  inset();
  readout();
  windowed?.();
  Object.assign(at("lanes").dataset, { from: span[0], to: span[1], points: made.angle.data[0].length });
  document.body.dataset.lanes = shown.map((model) => `${model.id}${model.dashed ? "p" : ""}`).join(" ");
}

function heightsNow() {
  const left = Math.max(240, at("lanes").clientHeight - AROUND - 3 * TITLES);
  const found = {};
  for (const [name, share] of Object.entries(SHARES)) found[name] = Math.round(left * share) + (name === "drive" ? 22 : 0);
  return found;
}

const between = () => ({ min: recording.time[span[0]], max: recording.time[span[1] - 1] });

function options(name, { series, bands = [] }, size, asRange) {
  const axis = {
    stroke: () => value("--ink-3"), font: "11px Inter, system-ui, sans-serif", ticks: { show: false },
    grid: { stroke: () => value("--grid"), width: 1 },
  };
  const last = name === "drive";
  const symmetric = (u, low, high) => {
    const most = Math.max(Math.abs(low ?? 0), Math.abs(high ?? 0), asRange ? 1 : 1e-9) * 1.08;
    return [-most, most];
  };
  return {
    ...size,
    padding: [8, 0, last ? 0 : 8, 0],
    legend: { show: false },
    cursor: {
      sync: { key: "lanes", setSeries: false }, y: false, points: { show: false },
      drag: { x: true, y: false, setScale: false }, bind: { dblclick: () => () => whole() },
    },
    scales: { x: { time: false, range: () => [between().min, between().max] },
      y: name === "angle" ? {} : { range: symmetric } },
    axes: [
      { ...axis, show: last, size: 22, gap: 4, values: (u, ticks) => ticks.map((t) => digits(t, 6).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "")) },
      { ...axis, size: LEFT, gap: 8, space: name === "drive" ? 18 : 36, values: (u, ticks) => ticks.map((y) => short(y)) },
    ],
    series: [{}, ...series],
    bands,
    hooks: {
      drawClear: [shade],
      draw: name === "residual" && asRange ? [floor] : [],
      setCursor: [(u) => moved(u)],
      setSelect: [(u) => selected(u)],
    },
  };
}

function short(y) {
  const text = Math.abs(y) >= 1 ? digits(Number(y.toPrecision(6)), Math.max(1, Math.ceil(Math.log10(Math.abs(y) + 1)))) : digits(y, 2);
  return text.replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");
}

// Where the bridge is open.
function shade(u) {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.fillStyle = value("--shade");
  for (const [from, to] of recording.open) {
    const left = Math.max(bbox.left, u.valToPos(from, "x", true));
    const right = Math.min(bbox.left + bbox.width, u.valToPos(to, "x", true));
    if (right > left) ctx.fillRect(left, bbox.top, right - left, bbox.height);
  }
  ctx.restore();
}

// The encoder's own error, either way.
function floor(u) {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.strokeStyle = value("--floor");
  ctx.setLineDash([4 * devicePixelRatio, 3 * devicePixelRatio]);
  ctx.lineWidth = devicePixelRatio;
  ctx.beginPath();
  for (const y of [-FLOOR, FLOOR]) {
    const top = u.valToPos(y, "y", true);
    ctx.moveTo(bbox.left, top);
    ctx.lineTo(bbox.left + bbox.width, top);
  }
  ctx.stroke();
  ctx.restore();
}

// ---- window

/** Shows the samples from time `from` to `to`, s. */
export function zoom(from, to) {
  const { time } = recording;
  const first = Math.max(0, sampleAt(from));
  const last = Math.min(time.length, sampleAt(to) + 1);
  if (last - first < 4) return;
  span = [first, last];
  draw();
}

/** Shows everything. */
export function whole() {
  span = [0, recording.time.length];
  draw();
}

function selected(u) {
  const { left, width } = u.select;
  if (width < 4) return;
  const [from, to] = [u.posToVal(left, "x"), u.posToVal(left + width, "x")];
  u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
  zoom(from, to);
}

function sampleAt(t) {
  const { time } = recording;
  let [low, high] = [0, time.length - 1];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (time[middle] < t) low = middle + 1;
    else high = middle;
  }
  return low;
}

// ---- cursor

function moved(u) {
  if (u.cursor.left === null || u.cursor.left < 0) return;
  cursor = sampleAt(u.posToVal(u.cursor.left, "x"));
  readout();
}

/** Moves the cursor by a part of the window. */
export function step(by) {
  if (!recording) return;
  const here = cursor ?? (span[0] + span[1]) >> 1;
  const wide = Math.max(1, Math.round((span[1] - span[0]) / 500));
  cursor = Math.max(span[0], Math.min(span[1] - 1, here + by * wide));
  const left = plots.angle.valToPos(recording.time[cursor], "x");
  plots.angle.setCursor({ left, top: 1 });
  readout();
}

function readout() {
  const k = cursor;
  const none = k === null || k >= recording.time.length;
  const of = (model, text) => el("span", { class: "strong", style: `color:${colour(model.id)}` }, `${letter(model.id)} ${text}`);
  at("read-angle").replaceChildren(...(none ? [] : [
    el("span", { class: "quiet" }, `t ${digits(recording.time[k], 5)} s`),
    el("span", { class: "strong" }, `measured ${digits(recording.turns.values[k], 4)}`),
    ...shown.map((model) => of(model, digits(model.turns.values[k], 4))),
  ]));
  at("read-residual").replaceChildren(...shown.map((model) => of(model, none ? `≤ ${counts(model.residual.largest(...span))}` : counts(model.residual.values[k]))));
  at("read-drive").replaceChildren(none ? "" : el("span", { class: "strong" }, digits(recording.drive.values[k], 4)));
}

/** The second in which a model's squared error is largest: its begin, its end, and its share. */
export function worstSecond(model) {
  const { time } = recording;
  const e = model.residual.values;
  let total = 0;
  for (let k = 0; k < e.length; k += 1) total += e[k] * e[k];
  let [sum, from, best] = [0, 0, { share: 0, from: 0, to: 0 }];
  for (let k = 0; k < e.length; k += 1) {
    sum += e[k] * e[k];
    while (time[k] - time[from] > 1) {
      sum -= e[from] * e[from];
      from += 1;
    }
    if (sum > best.share * total) best = { share: sum / total, from: time[from], to: time[k] };
  }
  return best;
}

/** The models that are drawn. */
export const drawn = () => shown;

// ---- the strip that moves the window

function strip() {
  const place = at("strip");
  const [wide, high] = [width() - LEFT, 28];
  const edges = parts(0, recording.time.length, 300);
  const [low, top] = recording.turns.over(0, recording.time.length);
  const y = (v) => 3 + (high - 6) * (1 - (v - low) / (top - low || 1));
  const points = [];
  for (let k = 0; k + 1 < edges.length; k += 1) {
    const [min, max] = recording.turns.over(edges[k], edges[k + 1]);
    const x = (wide * k) / (edges.length - 2 || 1);
    points.push([x, y(min)], [x, y(max)]);
  }
  const at0 = (k) => (wide * k) / recording.time.length;
  place.setAttribute("viewBox", `0 0 ${wide} ${high}`);
  place.setAttribute("width", wide);
  place.replaceChildren(
    svg("rect", { x: 0.5, y: 0.5, width: wide - 1, height: high - 1, rx: 3, class: "strip-all" }),
    svg("path", { d: path(points), class: "strip-line" }),
    svg("rect", { x: at0(span[0]), y: 0.5, width: Math.max(4, at0(span[1]) - at0(span[0])), height: high - 1, rx: 3, class: "strip-window" }),
  );
}

at("strip").addEventListener("pointerdown", (event) => {
  const place = at("strip").getBoundingClientRect();
  const sample = (x) => Math.round(((x - place.left) / place.width) * recording.time.length);
  const here = sample(event.clientX);
  const length = span[1] - span[0];
  const inside = here >= span[0] && here < span[1];
  const grip = inside ? here - span[0] : length >> 1;
  const move = (x) => {
    const from = Math.max(0, Math.min(recording.time.length - length, sample(x) - grip));
    span = [from, from + length];
    requestAnimationFrame(draw);
  };
  const follow = (moved) => move(moved.clientX);
  move(event.clientX);
  addEventListener("pointermove", follow);
  addEventListener("pointerup", () => removeEventListener("pointermove", follow), { once: true });
});

/** Moves the window by a part of itself. */
export function pan(by) {
  const length = span[1] - span[0];
  const from = Math.max(0, Math.min(recording.time.length - length, span[0] + Math.round(by * length)));
  span = [from, from + length];
  draw();
}

/** Makes the window wider or narrower by a factor, about the cursor. */
export function scale(factor) {
  if (!recording) return;
  const length = Math.max(8, Math.min(recording.time.length, Math.round((span[1] - span[0]) * factor)));
  const middle = cursor ?? (span[0] + span[1]) >> 1;
  const from = Math.max(0, Math.min(recording.time.length - length, middle - (length >> 1)));
  span = [from, from + length];
  draw();
}

/** The window as samples, where it is a part of what is drawn; else nothing. */
export const part = () => (recording && span[1] - span[0] < recording.time.length ? { from: span[0], to: span[1], held_out: held } : null);

/** Calls `does` whenever the window has changed. */
export const onWindow = (does) => {
  windowed = does;
};

/** Whether the bridge is ever open. */
export const hasOpen = () => Boolean(recording?.open.length);

// ---- the residual on the scale of the first model

let scaleOf = null;

/** The model whose scale the inset has; nothing for none. */
export function compareScale(model) {
  scaleOf = model;
}

async function inset() {
  const place = at("inset");
  const model = shown.filter((one) => !one.dashed).at(-1);
  place.replaceChildren();
  at("inset-said").textContent = "";
  if (!scaleOf || !model || scaleOf.id === model.id || !recording) return;
  const query = held ? "?held_out=true" : "";
  const key = recording.key;
  const first = await keptNumbers(`${key}/${scaleOf.stamp}`, `series/model/${scaleOf.id}${query}`, Float32Array);
  if (recording.key !== key || !shown.includes(model)) return;
  const base = along(recording, scaleOf.stamp, first).residual;
  const most = base.largest(0, first.length) || 1;
  const edges = parts(0, first.length, 160);
  const lineOf = (pyramid) => {
    const points = [];
    for (let k = 0; k + 1 < edges.length; k += 1) {
      const [min, max] = pyramid.over(edges[k], edges[k + 1]);
      points.push([k, 8 - (7 * min) / most], [k, 8 - (7 * max) / most]);
    }
    return path(points);
  };
  place.replaceChildren(
    svg("path", { d: lineOf(base), stroke: colour(scaleOf.id), fill: "none" }),
    svg("path", { d: lineOf(model.residual), stroke: colour(model.id), fill: "none", "stroke-width": 1.5 }));
  at("inset-said").textContent = `${letter(model.id)} on the scale of ${letter(scaleOf.id)}`;
}

/** The legend above the lanes. */
export function legend(models, name) {
  at("legend").replaceChildren(
    el("span", { class: "key" }, el("span", { class: "swatch measured" }), "measured"),
    ...models.map((model) => el("span", { class: "key" },
      model.dashed
        ? el("span", { class: "swatch dashed", style: `color:${colour(model.id)}` })
        : el("span", { class: "tag", style: `background:${colour(model.id)}` }, letter(model.id)),
      name(model))));
}

/** A button that shows a model's worst second. */
export function worstButton(model, does) {
  const worst = worstSecond(model);
  if (worst.share < WORST) return null;
  return button(`${Math.round(100 * worst.share)} % of it in one second`, () => {
    zoom(worst.from - 0.25, worst.to + 0.25);
    does?.();
  }, { class: "btn link", title: "Of the squared error: show this second" });
}

new ResizeObserver(() => recording && draw()).observe(at("lanes"));
onTheme(() => {
  if (recording) draw();
  for (const plot of Object.values(plots)) plot.redraw(false, true);
});
