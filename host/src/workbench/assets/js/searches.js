// Search methods side by side, and a fit by another one.

import { button, el } from "./elements.js";

const USUAL = ["ga", "pso", "firefly"];
const settings = { racers: USUAL, budget: "1000", seeds: "5", algorithm: "lm" };

/** Fills a place; gives the place of the race's curves. */
export function show(place, bench, does) {
  const busy = Boolean(bench.job);
  const chosen = bench.models.find((one) => one.id === bench.chosen);
  const boxes = bench.algorithms.map((name) => el("label", {}, el("input", {
    type: "checkbox", value: name, checked: settings.racers.includes(name), onchange: () => {
      settings.racers = Array.from(place.querySelectorAll("#racers input:checked"), (box) => box.value);
    },
  }), ` ${name}`));
  const number = (id) => el("input", { type: "number", id, value: settings[id], oninput: (event) => {
    settings[id] = event.target.value;
  } });
  const select = el("select", { id: "algorithm", onchange: (event) => {
    settings.algorithm = event.target.value;
  } }, ...bench.algorithms.map((name) => el("option", { value: name, selected: name === settings.algorithm }, name)));
  const curves = el("div");
  place.replaceChildren(
    el("h2", {}, "Let searches race for the unknowns of the model that is looked at"),
    el("div", { class: "racers", id: "racers", role: "group", "aria-label": "Search methods" }, ...boxes),
    el("p", { class: "row" }, el("label", {}, "Evaluations ", number("budget")), el("label", {}, "Seeds ", number("seeds")),
      button("Race", () => does.race(settings.racers, chosen?.effects ?? [], Number(settings.budget), Number(settings.seeds)), { id: "race", disabled: busy }),
      el("span", { class: "quiet" }, "or"), el("label", {}, "search with ", select),
      button("Fit again", () => does.fit(chosen?.effects ?? [], settings.algorithm), { id: "refit", disabled: busy || !chosen })),
    curves);
  return curves;
}
