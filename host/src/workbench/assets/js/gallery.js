// What servoid can recognise, for a bench on which nothing lies yet.

import { ask } from "./ask.js";
import { at, el } from "./elements.js";
import { spoken } from "./names.js";
import { signature } from "./signature.js";

let asked = false;

/** Fills the gallery, once. */
export async function show() {
  if (asked) return;
  asked = true;
  const effects = await ask("catalogue");
  const drawn = effects.filter((one) => one.signature);
  at("gallery").replaceChildren(...drawn.map((one) => el("li", { title: one.said },
    signature({ ...one.signature, bins: [] }, { width: 90, height: 56, stroke: "var(--ink)" }),
    el("p", { class: "s12" }, spoken(one.effect)), el("p", { class: "dim s11" }, `by ${one.signature.against}`))));
  const others = effects.filter((one) => !one.signature).map((one) => spoken(one.effect));
  at("gallery-others").textContent = `And what no single quantity shows: ${others.join(", ")}.`;
  at("gallery-count").textContent = `Each leaves its own mark on the residual. ${effects.length} are built in.`;
}
