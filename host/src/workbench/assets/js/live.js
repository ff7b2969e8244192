// A run of the motor that is under way: what is measured, models that run along, and what they foresee.

import { ask } from "./ask.js";
import { at, el, row } from "./elements.js";
import { colour, letter, spoken, value, variable } from "./names.js";
import { counts, digits } from "./numbers.js";

const STAGES = { idle: "Waiting", probe: "Probing: small steps until the shaft moves", excite: "Exciting", record: "Recording what the device fits", fit: "The device is fitting; the bridge is open", verify: "Verifying", report: "Done" };
const EVERY_MS = 100;
// Seconds before and after now.
const [BEFORE, AFTER] = [8, 1.6];
const LANES = [["live-angle", 0.5], ["live-residual", 0.28], ["live-drive", 0.22]];

let watching = false;
let plots = [];
let built = "";

/** Shows the run of a device while there is one. */
export function show(bench) {
  const runs = Boolean(bench.device?.running);
  document.querySelector("main").classList.toggle("running", runs);
  at("live").hidden = !runs;
  if (runs && !watching) watch(bench);
  watching = runs;
}

async function watch(bench) {
  watching = true;
  while (watching) {
    try {
      const run = await ask("live");
      if (run && watching) draw(bench, run);
    } catch {
      // The next state says what went wrong.
    }
    await new Promise((done) => setTimeout(done, EVERY_MS));
  }
  for (const plot of plots) plot.destroy();
  [plots, built] = [[], ""];
}

// The number of the model by which a curve has its colour and letter.
const numberOf = (bench, run, k) => (run.ahead ? bench.next + k : bench.chosen);

function draw(bench, run) {
  const ahead = run.ahead ?? { time: [], drive: [], angles: [] };
  const x = [...run.time, ...ahead.time];
  const now = run.seconds;
  const empty = (of) => of.map(() => null);
  const then = (past) => [...past, ...empty(ahead.time)];
  const later = (next) => [...empty(run.time), ...next];
  const models = run.models.map((one, k) => ({ ...one, id: numberOf(bench, run, k) }));
  const data = [
    [x, then(run.angle), ...models.map((one) => then(one.angle)), ...ahead.angles.map(later)],
    [x, ...models.flatMap((one) => [then(one.residual), then(one.innovation)])],
    [x, then(run.drive), later(ahead.drive)],
  ];
  const key = `${models.map((one) => one.id)}:${ahead.angles.length}`;
  if (key !== built) {
    built = key;
    for (const plot of plots) plot.destroy();
    plots = build(models, ahead.angles.length, bench);
  }
  plots.forEach((plot, lane) => {
    plot.setData(data[lane], false);
    plot.setScale("x", { min: Math.max(0, now - BEFORE), max: Math.max(0, now - BEFORE) + BEFORE + AFTER });
  });
  numbers(run, models);
}

function build(models, aheads, bench) {
  const line = (id, extra = {}) => ({ stroke: () => value(variable(id)), width: 1.5, points: { show: false }, ...extra });
  const measured = { stroke: () => value("--measured-band"), width: 5, points: { show: false } };
  const quiet = { stroke: () => value("--ink-2"), width: 1, points: { show: false }, paths: uPlot.paths.stepped({ align: 1 }) };
  const series = [
    [{}, measured, ...models.map((one) => line(one.id)), ...Array.from({ length: aheads }, (_, k) => line(bench.next + k, { dash: [5, 3] }))],
    [{}, ...models.flatMap((one) => [line(one.id), line(one.id, { width: 1, alpha: 0.4 })])],
    [{}, quiet, { ...quiet, dash: [3, 3] }],
  ];
  // Less titles and padding.
  const room = at("live-lanes").clientHeight - LANES.length * 24 - 40;
  return LANES.map(([id, share], lane) => new uPlot({
    width: at("live-lanes").clientWidth - 32, height: Math.max(80, room * share), legend: { show: false }, cursor: { show: false }, series: series[lane],
    padding: [8, 0, lane === LANES.length - 1 ? 0 : 8, 0],
    scales: { x: { time: false } },
    axes: [
      { show: lane === LANES.length - 1, size: 22, stroke: () => value("--ink-3"), grid: { show: false }, ticks: { show: false }, values: (_, ticks) => ticks.map((t) => `${digits(t, 3)} s`) },
      { stroke: () => value("--ink-3"), size: 56, grid: { stroke: () => value("--line"), width: 1 }, ticks: { show: false } },
    ],
    hooks: { draw: [nowLine] },
  }, series[lane].map(() => []), at(id)));
}

// The present: left of it is what was measured, right of it what is foreseen.
function nowLine(plot) {
  const measured = plot.data[0];
  const last = plot.data[1] ? plot.data[1].findLastIndex((y) => y !== null) : -1;
  if (last < 0) return;
  const x = plot.valToPos(measured[last], "x", true);
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.strokeStyle = value("--ink");
  ctx.setLineDash([]);
  ctx.lineWidth = devicePixelRatio;
  ctx.beginPath();
  ctx.moveTo(x, bbox.top);
  ctx.lineTo(x, bbox.top + bbox.height);
  ctx.stroke();
  ctx.restore();
}

function numbers(run, models) {
  const of = run.of_seconds === null ? "" : ` of ${digits(run.of_seconds, 3)}`;
  at("live-stage").textContent = STAGES[run.stage] ?? run.stage;
  at("live-time").textContent = run.models_run && run.stage === "fit" ? `${run.models_run[0]} of about ${run.models_run[1]} models` : `${run.seconds.toFixed(1)}${of} s`;
  const bar = at("live-bar");
  const part = run.stage === "fit" && run.models_run ? run.models_run[0] / run.models_run[1] : run.of_seconds ? run.seconds / run.of_seconds : null;
  if (part === null) bar.removeAttribute("value");
  else bar.value = Math.min(1, part);
  const rms = (values) => Math.sqrt(values.reduce((sum, e) => sum + e * e, 0) / Math.max(1, values.length));
  at("live-models").replaceChildren(...models.map((one) => el("div", { class: "live-model" },
    el("span", { class: "tag", style: `background:${colour(one.id)}` }, letter(one.id)), el("span", {}, spoken(one.name)),
    el("span", { class: "err" }, el("span", { class: "big", style: `color:${colour(one.id)}` }, counts(one.rms_counts)), el("span", { class: "quiet s12" }, "counts RMS")),
    el("span", { class: "quiet s12" }, `innovations ${counts(rms(one.innovation))}`))));
  if (!models.length) at("live-models").replaceChildren(el("p", { class: "quiet" }, "No model runs along yet: the first one is fitted to this recording."));
  const facts = [["Speed", run.speed_rad_s === null ? "–" : `${digits(run.speed_rad_s, 3)} rad/s`], ["Drive", run.drive.length ? `${digits(run.drive.at(-1), 3)} V` : "–"]];
  if (run.current_a !== null) facts.push(["Current", `${digits(run.current_a, 3)} A`]);
  facts.push(["Periods lost", String(run.missing)]);
  at("live-facts").replaceChildren(...facts.map((fact) => row(...fact)));
}
