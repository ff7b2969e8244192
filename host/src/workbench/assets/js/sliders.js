// Constants of the model moved by hand: its run follows in the lanes.

import { button, el } from "./elements.js";
import { counts, digits, usual } from "./numbers.js";

const moved = {};
let waiting = null;

/** Fills a place with a slider for each constant. */
export function show(place, bench, does) {
  for (const name of Object.keys(moved)) delete moved[name];
  const chosen = bench.models.find((one) => one.id === bench.chosen);
  const said = el("p", { class: "quiet", id: "by-hand", role: "status" });
  const rows = (chosen?.sliders ?? []).map((one, k) => slider(one, k, (name, x) => {
    moved[name] = x;
    clearTimeout(waiting);
    waiting = setTimeout(() => does.trial({ model: chosen.id, values: moved }).then((rms) => {
      said.textContent = `Moved by hand: ${counts(rms)} counts RMS; fitted: ${counts(chosen.rms_counts)}.`;
    }, does.say), 40);
  }));
  place.replaceChildren(el("div", { class: "head" }, el("h2", {}, "Constants by hand"), el("span", { class: "space" }), said,
    button("Put back", () => {
      show(place, bench, does);
      does.putBack();
    }, { class: "btn sm", id: "put-back" })), el("div", { class: "sliders", id: "sliders" }, ...rows));
}

// A slider moves by equal parts of the value; zero has none to move by.
function slider(one, k, does) {
  const [low, high] = [Math.abs(one.value) / 3, Math.abs(one.value) * 3];
  const turn = Math.sign(one.value) || 1;
  const valueAt = (place) => (low === 0 ? 0 : turn * low * (high / low) ** (place / 1000));
  const said = (x) => {
    const { value, unit } = usual(x, one.unit);
    return `${digits(value, 4)} ${unit}`;
  };
  const output = el("output", {}, said(one.value));
  return el("div", { class: "slider" }, el("label", { for: `slider-${k}` }, one.name.replace(/[._]/g, " ")), output, el("input", {
    type: "range", id: `slider-${k}`, min: 0, max: 1000, value: 500,
    oninput: (event) => {
      const x = valueAt(Number(event.target.value));
      output.textContent = said(x);
      does(one.name, x);
    },
  }));
}
