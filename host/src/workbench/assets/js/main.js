// The page of the workbench: shows what lies on the bench, and asks for work. The bench itself is kept by the program.

import { ask } from "./ask.js";
import { letter, spoken, step } from "./names.js";
import * as details from "./details.js";
import * as device from "./device.js";
import { at, el } from "./elements.js";
import * as error from "./error.js";
import * as exports from "./exports.js";
import * as gallery from "./gallery.js";
import * as keyboard from "./keyboard.js";
import * as ladder from "./ladder.js";
import * as lanes from "./lanes.js";
import * as live from "./live.js";
import * as mapping from "./mapping.js";
import { counts, digits, times } from "./numbers.js";
import * as parameters from "./parameters.js";
import * as proposals from "./proposals.js";
import * as recordings from "./recordings.js";
import { turn as turnTheme } from "./theme.js";
import * as tree from "./tree.js";

const SILENT = "The workbench does not answer";
// Effects that are tried and models that are fitted in a usual look for what is missing.
const USUALLY_TRIED = 32;

let bench = null;
let wrong = "";
// What this page looks at: recordings that are held out, two models side by side, the model before.
let heldOut = false;
let comparing = false;
let before = false;
let byHand = null;

// ---- asking

function say(fault) {
  wrong = fault ? String(fault.message || fault) : "";
  showFault();
}

function showFault() {
  const text = wrong || bench?.fault || "";
  at("fault").hidden = !text;
  at("fault").textContent = text;
}

const act = (path, body) => ask(path, body).then(() => say(null), say);
const work = (what) => act("work", what);
const model = (id) => bench?.models.find((one) => one.id === id);

function fit(effects, algorithm = "lm") {
  const same = bench.models.find((one) => one.algorithm === algorithm && [...one.effects].sort().join() === [...effects].sort().join());
  comparing = false;
  // It is on the bench already.
  if (same && same.id !== bench.chosen) return act("choose", { chosen: same.id, against: bench.chosen });
  return fitNow(effects, algorithm);
}

const fitNow = (effects, algorithm = "lm") => work({ what: "fit", effects, algorithm });

// Whether something else may take the place of what is on the bench. It is asked where models would go.
function putAway() {
  if (!bench?.models.length) return Promise.resolve(true);
  const count = bench.models.length === 1 ? "One model" : `${bench.models.length} models`;
  at("put-away-what").textContent = `${count} of ${bench.recording.name} will make room. Undo brings everything back while this workbench runs; `
    + "to keep it for longer, export it as a session first.";
  at("put-away").returnValue = "";
  at("put-away").showModal();
  return new Promise((answer) => {
    at("put-away").addEventListener("close", () => answer(at("put-away").returnValue === "yes"), { once: true });
  });
}

// A first recording is fitted; the next one judges, and any further one is fitted with the first.
function record(seconds) {
  const { recording } = bench;
  const judged = recording?.sources.some((one) => one.role === "held out");
  return work({ what: "record", seconds, role: recording === null ? "fitted" : judged ? "beside" : "held_out" });
}

// Other recordings, or other parts of them: the model that is looked at is fitted to these.
async function others(path, body) {
  if (!await putAway()) return;
  const effects = model(bench.chosen)?.effects ?? [];
  try {
    await ask(path, body);
    await fitNow(effects);
  } catch (fault) {
    say(fault);
  }
}

// ---- what buttons and keys do

const does = {
  fit,
  get comparing() {
    return comparing;
  },
  lock: (effect, locked) => act("lock", { effect, locked }),
  suggest: () => work({ what: "suggest", model: bench.chosen }),
  diagnose: () => work({ what: "diagnose" }),
  twins: (id) => work({ what: "twins", model: id }),
  arm: () => act("arm", {}),
  record,
  plan: (seconds) => work({ what: "plan", seconds }),
  play: () => work({ what: "play" }),
  commission: async (seconds) => {
    if (await putAway()) work({ what: "commission", seconds });
  },
  reveal: () => act("reveal", {}),
  race: (algorithms, effects, budget, seeds) => work({ what: "race", algorithms, effects, budget, seeds }),
  preview: () => {
    byHand = null;
    before = false;
    draw();
  },
  alone: () => {
    comparing = false;
    show();
  },
  swap: () => act("choose", { chosen: bench.against, against: bench.chosen }),
  choose: (id) => {
    comparing = false;
    return act("choose", { chosen: id, against: bench.chosen === id ? bench.against : bench.chosen });
  },
  compare: (id) => {
    if (id === bench.chosen) return null;
    comparing = true;
    return act("choose", { chosen: bench.chosen, against: id }).then(show);
  },
  remove: (id) => act("remove", { model: id }),
  exports: () => exports.show(bench, say),
  role: (k, role, of) => others("roles", { roles: of.recording.sources.map((one, place) => (place === k ? role : one.role)) }),
  span: (asked) => others("span", asked),
  view: (held) => {
    heldOut = held;
    show();
  },
  trial: async (body) => {
    byHand = await lanes.trial(body);
    draw();
    return Math.sqrt(byHand.reduce((sum, e) => sum + e * e, 0) / byHand.length);
  },
  putBack: () => {
    byHand = null;
    draw();
  },
  say,
};

// ---- showing

// What is foreseen of the proposal that is previewed.
function foreseen() {
  const effect = proposals.preview();
  if (!effect || comparing || before || !bench.proposed) return null;
  const found = bench.proposed.list.find((one) => one.effect === effect);
  return found && { effect: spoken(effect), id: effect, error: found.held_out_rms_counts ?? found.rms_counts };
}

function show() {
  const { recording, job } = bench;
  const chosen = model(bench.chosen);
  at("start").hidden = recording !== null;
  at("bench").hidden = recording === null;
  at("export").hidden = recording === null;
  at("undo").disabled = Boolean(job) || !bench.undo;
  at("redo").disabled = Boolean(job) || !bench.redo;
  at("demo").disabled = Boolean(job);
  at("blind").disabled = Boolean(job);
  if (wrong.startsWith(SILENT)) wrong = "";
  showFault();
  showWork();
  device.show(bench, does);
  live.show(bench);
  if (recording && !recording.sources.some((one) => one.role === "held out")) heldOut = false;
  recordings.show(bench, heldOut, does);
  if (!recording) {
    gallery.show().catch(say);
    return;
  }
  if (!model(bench.against)) comparing = false;
  proposals.show(bench, does);
  if (proposals.preview() === null) proposals.previewOpen();
  const parent = chosen && model(chosen.parent);
  parameters.show(bench, chosen, comparing ? model(bench.against) : parent);
  error.show(bench, chosen, comparing ? model(bench.against) : parent);
  at("residual-name").textContent = `Residual${recording.window_s ? ` in windows of ${digits(recording.window_s, 1)} s` : ""}, counts`;
  details.show(bench, does);
  draw();
}

// Lanes, ladder and tree, which follow what is previewed.
function draw() {
  if (!bench?.recording) return;
  const seen = foreseen();
  ladder.show(bench, seen);
  tree.show(bench, seen, does);
  const chosen = model(bench.chosen);
  const parent = chosen && model(chosen.parent);
  const beside = model(bench.against);
  const drawn = [];
  const of = (one) => ({ id: one.id, stamp: one.stamp, source: `series/model/${one.id}` });
  if (comparing && beside) drawn.push(of(beside));
  if (before && parent) drawn.push(of(parent));
  else if (chosen) drawn.push(of(chosen));
  if (byHand && chosen) drawn.push({ id: chosen.id, stamp: `hand${performance.now()}`, values: byHand, dashed: true });
  if (seen) drawn.push({ id: bench.next, stamp: `p${chosen.stamp}/${seen.id}`, source: `series/proposal/${chosen.id}/${seen.id}`, dashed: true });
  const roots = ladder.wayTo(bench.models, bench.chosen);
  lanes.compareScale(before || comparing ? null : roots[0]);
  lanes.legend(drawn, (one) => (one.values ? "moved by hand" : one.dashed ? `+ ${seen.effect}, foreseen` : nameOf(model(one.id))));
  at("open-key").hidden = true;
  const own = bench.revision;
  lanes.show(bench.recording, drawn, heldOut).then(drawnNow, (fault) => {
    // What was asked for may be gone by now: then the next state draws.
    setTimeout(() => bench.revision === own && say(fault), 300);
  });
  const choices = parent && !comparing ? [["Before", true], ["After", false]] : [];
  at("compare").replaceChildren(...choices.map(([text, value]) => el("button", {
    type: "button", "aria-pressed": String(before === value), title: "Before and after (Space)", onclick: () => {
      before = value;
      draw();
    },
  }, text)));
}

const nameOf = (one) => {
  const own = step(one, model(one.parent));
  return own === "linear" ? "linear motor" : own;
};

function drawnNow() {
  at("open-key").hidden = !lanes.hasOpen();
  const solid = lanes.drawn().filter((one) => !one.dashed).at(-1);
  at("worst").replaceChildren(...[solid && lanes.worstButton(solid)].filter(Boolean));
  document.body.dataset.drawn = String(bench.revision);
}

// ---- work that goes on

let began = 0;
let lastSaid = "";
let tried = null;

function showWork() {
  const { job } = bench;
  at("work").hidden = !job;
  if (!job) {
    tried = null;
    lastSaid = "";
    at("stop").disabled = false;
    return;
  }
  if (!began || at("work-what").dataset.job !== job) began = performance.now();
  at("work-what").dataset.job = job;
  const titles = { fit: "Fitting", suggest: "Testing what is missing", diagnose: "Finding everything that is missing", race: "Racing searches", twins: "Trying motors like yours", plan: "Looking for the experiment that decides", record: "Fitting what was recorded", experiment: "Fitting what was recorded", commission: "Fitting what was recorded" };
  at("work-what").textContent = job === "fit" && tried !== null ? titles.suggest : titles[job] ?? job;
  const bar = at("work-bar");
  if (job === "twins" && bench.twins) bar.value = bench.twins.tried / bench.twins.of;
  else if (tried !== null && ["fit", "suggest"].includes(job)) bar.value = Math.min(0.98, tried / USUALLY_TRIED);
  else bar.removeAttribute("value");
  const seconds = ((performance.now() - began) / 1000).toFixed(0);
  at("progress").textContent = `${lastSaid ? `${lastSaid} · ` : ""}${seconds} s`;
}
setInterval(() => bench?.job && showWork(), 500);

function progress(what) {
  if (what.tried !== undefined) {
    ({ tried } = what);
    lastSaid = ["diagnose", "twins", "plan"].includes(what.job) ? `${tried} models tried` : `${tried} of about ${Math.max(USUALLY_TRIED, tried)} models`;
  } else {
    tried = null;
    const name = what.algorithm ? `${what.algorithm}: ` : "";
    lastSaid = `${name}${what.evaluations} evaluations${what.rms_counts === null ? "" : `, ${counts(what.rms_counts)} counts`}`;
  }
  if (bench) showWork();
}

let refreshing = null;
async function refresh() {
  try {
    const old = bench;
    bench = await ask("state");
    if (old?.recording?.stamp !== bench.recording?.stamp) heldOut = false;
    if (old && old.chosen !== bench.chosen) {
      before = false;
      byHand = null;
      announce(old);
    }
    show();
  } catch (fault) {
    say(`${SILENT} (${fault.message}). If it was ended, start it again and open its new address.`);
  }
}

// For those who read with their ears.
function announce(old) {
  const [now, then] = [model(bench.chosen), old.models.find((one) => one.id === old.chosen)];
  if (!now) return;
  const fall = then ? error.judged(then) / error.judged(now) : 1;
  at("said").textContent = `${letter(now.id)}, ${now.name}. Held-out error ${counts(error.judged(now))} counts${fall > 1.05 ? `, ${times(fall)} times less` : ""}.${now.explained ? " Explained." : ""}`;
}

const events = new EventSource("events");
events.addEventListener("changed", () => {
  // One after the other: the last answer is the newest.
  refreshing = (refreshing ?? Promise.resolve()).then(refresh);
});
events.addEventListener("progress", (event) => progress(JSON.parse(event.data)));
events.addEventListener("error", () => refresh());

// ---- files

const doing = { bench: () => bench, say, putAway, fit: fitNow };
const take = (files) => mapping.take(Array.from(files), doing).catch(say);

at("file").addEventListener("change", (event) => {
  take(event.target.files).finally(() => {
    event.target.value = "";
  });
});
document.addEventListener("dragover", (event) => {
  event.preventDefault();
  at("drop").classList.add("over");
});
document.addEventListener("dragleave", () => at("drop").classList.remove("over"));
document.addEventListener("drop", (event) => {
  event.preventDefault();
  at("drop").classList.remove("over");
  if (event.dataTransfer.files.length) take(event.dataTransfer.files);
});

// ---- buttons and keys

async function demonstrate(blind) {
  if (!await putAway()) return;
  try {
    await ask("demo", { blind });
    await fitNow([]);
  } catch (fault) {
    say(fault);
  }
}
at("demo").addEventListener("click", () => demonstrate(false));
at("blind").addEventListener("click", () => demonstrate(true));
at("put-away-yes").addEventListener("click", () => at("put-away").close("yes"));
at("put-away-no").addEventListener("click", () => at("put-away").close(""));
at("undo").addEventListener("click", () => act("undo", {}));
at("redo").addEventListener("click", () => act("redo", {}));
at("export").addEventListener("click", does.exports);
at("theme").addEventListener("click", turnTheme);
at("stop").addEventListener("click", stop);
at("live-stop").addEventListener("click", stop);

function stop() {
  at("stop").disabled = true;
  lastSaid = "stopping";
  showWork();
  ask("stop", {}).catch(say);
}

keyboard.listen({
  proposal: (by) => bench && !comparing && proposals.turn(by, bench, does),
  add: () => {
    const effect = proposals.openEffect();
    if (effect && bench.proposed && !bench.job) fit([...model(bench.chosen).effects, effect]);
  },
  lock: () => {
    const effect = proposals.openEffect();
    if (effect) does.lock(effect, true);
  },
  before: () => {
    if (!model(model(bench?.chosen)?.parent)) return;
    before = !before;
    draw();
  },
  cursor: (by) => lanes.step(by),
  pan: (by) => bench?.recording && lanes.pan(by),
  window: (factor) => lanes.scale(factor),
  tab: (k) => bench?.recording && details.turnTo(k),
  undo: () => !at("undo").disabled && at("undo").click(),
  redo: () => !at("redo").disabled && at("redo").click(),
  theme: turnTheme,
  escape: () => {
    if (bench?.job) stop();
    else details.close();
  },
});
lanes.onWindow(() => {
  at("use-span").hidden = lanes.part() === null;
  at("use-span").disabled = Boolean(bench?.job);
});
at("use-span").addEventListener("click", () => does.span({ what: "samples", ...lanes.part() }));
details.begin();
// What was named on the command line, and not understood there.
mapping.waiting(doing).catch(say);
