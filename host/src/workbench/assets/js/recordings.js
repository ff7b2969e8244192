// The recordings on the bench, each with its role.

import { at, el } from "./elements.js";
import { digits } from "./numbers.js";

const ROLES = ["fitted", "held out", "ignored"];

/** A chip for each; `does.view` shows those of a role. */
export function show(bench, heldOut, does) {
  const { recording } = bench;
  at("more").hidden = !recording;
  if (!recording) {
    at("recordings").replaceChildren();
    at("about").textContent = "";
    return;
  }
  at("recordings").replaceChildren(...recording.sources.map((one, k) => {
    const held = one.role === "held out";
    const name = one.name.split(/[\\/]/).at(-1);
    return el("li", { class: `rec ${one.role}`, "data-shown": String(held === heldOut && one.role !== "ignored") },
      el("button", {
        type: "button", "aria-pressed": String(held === heldOut && one.role !== "ignored"), title: `Show ${one.name} along the models${turned(one)}`,
        disabled: one.role === "ignored", onclick: () => does.view(held),
      }, el("b", {}, name), el("span", { class: "quiet s12 len" }, one.span_s ? `${one.span_s.map((t) => digits(t, 3)).join("–")} s` : `${digits(one.seconds, 3)} s · ${rate(one)}`)),
      one.span_s ? el("button", { type: "button", class: "whole", title: "Use the whole recording again", "aria-label": `Use the whole of ${name}`, disabled: Boolean(bench.job),
        onclick: () => does.span({ what: "whole", recording: k }) }, "×") : null,
      el("select", { class: `role ${one.role.replace(" ", "_")}`, "aria-label": `Role of ${name}`, disabled: Boolean(bench.job), onchange: (event) => {
        does.role(k, event.target.value, bench).finally(() => {
          event.target.value = one.role;
        });
      } }, ...ROLES.map((role) => el("option", { value: role, selected: role === one.role }, role))));
  }));
  const end = recording.held_out_from_s === null || recording.held_out === null ? "" : ` · from ${digits(recording.held_out_from_s, 3)} s held out`;
  const motor = recording.motor ? `${recording.motor} · ` : "";
  at("about").textContent = `${motor}${digits(recording.supply_v, 3)} ${recording.drive_unit} · ${recording.counts_per_rev} counts/rev${end}`;
  at("drive-name").textContent = `Drive, ${recording.drive_unit}`;
}

function turned(one) {
  return one.turned_counts ? `; ${digits(one.turned_counts, 4)} counts are added to its readings: its encoder was zeroed at another angle of the shaft` : "";
}

function rate(one) {
  const hertz = (one.samples - 1) / one.seconds;
  return hertz >= 999.5 ? `${digits(hertz / 1000, 2)} kHz` : `${digits(hertz, 3)} Hz`;
}
