// What servoid can recognise, for a bench on which nothing lies yet.

import { ask } from "./ask.js";
import { at, el } from "./elements.js";
import { signature } from "./signature.js";

let asked = false;

/** Fills the gallery, once. */
export async function show() {
  if (asked) return;
  asked = true;
  const effects = await ask("catalogue");
  at("gallery").replaceChildren(...effects.map((one) => el("li", { title: one.said },
    signature(one.signature && { ...one.signature, bins: [] }, { width: 90, height: 56, stroke: "var(--ink)" }),
    el("p", { class: "s12" }, one.effect.replace(/_/g, " ")),
    el("p", { class: "dim s11" }, one.signature ? `by ${one.signature.against}` : "over time"))));
  at("gallery-count").textContent = `Each leaves its own mark on the residual. ${effects.length} are built in.`;
}
