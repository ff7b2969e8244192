// The number that counts: the held-out error of the model that is looked at.

import { colour } from "./names.js";
import { at } from "./elements.js";
import { counts, digits, times } from "./numbers.js";

const STEP_MS = 480;
const still = matchMedia("(prefers-reduced-motion: reduce)");

let shown = null;
let counting = 0;

/** The error by which a model is judged: held out, or fitted where nothing is held out. */
export const judged = (model) => model.held_out_rms_counts ?? model.rms_counts;

/** Shows a model's error; it counts down from the one before. */
export function show(bench, model, beside) {
  const held = model?.held_out_rms_counts !== null && model !== undefined;
  at("error-title").textContent = held ? "Held-out error" : "Fitted error";
  at("error-panel").classList.toggle("done", Boolean(model?.explained));
  at("error-panel").style.setProperty("--tint", model ? colour(model.id) : "");
  at("error-now").style.color = model ? colour(model.id) : "";
  if (!model) {
    at("error-now").textContent = "–";
    at("error-more").textContent = "Nothing is fitted yet.";
    shown = null;
    return;
  }
  const { window_s: windows, window_reason: reason } = bench.recording;
  const parts = [`fitted ${counts(model.rms_counts)}`, `floor ${counts(bench.floor_counts)}`];
  if (windows) parts.unshift(`windows of ${digits(windows, 1)}\u00a0s`);
  if (beside) {
    const fall = judged(beside) / judged(model);
    if (fall > 1.05) parts.push(`÷\u00a0${times(fall)}`);
  }
  at("error-more").textContent = parts.join("\u2003");
  at("error-more").title = windows ? `Each window starts from the measured state: ${reason}. Over the whole run: ${counts(model.whole_rms_counts)} counts.` : "";
  countTo(judged(model));
}

function countTo(end) {
  const from = shown;
  shown = end;
  counting += 1;
  const own = counting;
  const place = at("error-now");
  if (from === null || from === end || still.matches || !(from > 0 && end > 0)) {
    place.textContent = counts(end);
    return;
  }
  const began = performance.now();
  const next = (now) => {
    if (own !== counting) return;
    const part = Math.min(1, (now - began) / STEP_MS);
    const eased = 1 - (1 - part) ** 3;
    // Evenly on the scale of the ladder.
    place.textContent = counts(part === 1 ? end : from * (end / from) ** eased);
    if (part < 1) requestAnimationFrame(next);
  };
  requestAnimationFrame(next);
}
