// The recordings on the bench, each with its role.

import { at, el } from "./elements.js";
import { digits } from "./numbers.js";

/** A chip for each; `does.view` shows those of a role. */
export function show(bench, heldOut, does) {
  const { recording } = bench;
  at("more").hidden = !recording;
  if (!recording) {
    at("recordings").replaceChildren();
    at("about").textContent = "";
    return;
  }
  at("recordings").replaceChildren(...recording.sources.map((one) => {
    const held = one.role === "held out";
    return el("li", {}, el("button", {
      type: "button", class: "rec", "aria-pressed": String(held === heldOut), title: `Show ${one.name} along the models`, onclick: () => does.view(held),
    }, el("b", {}, one.name), el("span", { class: "quiet s12 len" }, `${digits(one.seconds, 3)} s · ${rate(one)}`),
    el("span", { class: `role ${one.role}` }, one.role)));
  }));
  const end = recording.held_out_from_s === null || recording.held_out === null ? "" : ` · from ${digits(recording.held_out_from_s, 3)} s held out`;
  at("about").textContent = `${digits(recording.supply_v, 3)} ${recording.drive_unit} · ${recording.counts_per_rev} counts/rev${end}`;
  at("drive-name").textContent = `Drive, ${recording.drive_unit}`;
}

function rate(one) {
  const hertz = (one.samples - 1) / one.seconds;
  return hertz >= 999.5 ? `${digits(hertz / 1000, 2)} kHz` : `${digits(hertz, 3)} Hz`;
}
