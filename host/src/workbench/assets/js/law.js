// A law of one's own: read by the program while it is typed, and drawn over what the model misses.

import { ask } from "./ask.js";
import { button, el } from "./elements.js";
import { digits } from "./numbers.js";
import { signature } from "./signature.js";

const EXAMPLE = "drag: torque = -c*abs(w/v)^p*sgn(w); c = 0.1 in [0, 2] V; v = 10 rad/s; p = 0.5 in [0.2, 4]";
const WIDE = 286;
// Pause after the last key, ms.
const PAUSE = 250;

// What was typed stays from one drawing of the panel to the next.
let text = "";
let open = false;
let known = null;
let asked = 0;

/** The field; `does.fit` adds the law to the model's effects, `stroke` is the colour of the model to come. */
export function field(bench, chosen, stroke, does) {
  const drawn = el("div", { id: "law-drawn", "aria-live": "polite" });
  const add = button("Add the law", () => does.fit([...chosen.effects, text.trim()]), { id: "law-add", class: "btn pri", disabled: true });
  const area = el("textarea", {
    id: "law", class: "law", rows: 4, spellcheck: "false", "aria-label": "A law of your own", placeholder: EXAMPLE, "aria-describedby": "law-drawn",
    oninput: () => {
      text = area.value;
      known = null;
      add.disabled = true;
      later(() => read(drawn, add, bench, stroke));
    },
  });
  area.value = text;
  if (known) show(known, drawn, add, bench, stroke);
  else if (text) read(drawn, add, bench, stroke);
  return el("details", { class: "own-law", open, ontoggle: (event) => {
    open = event.target.open;
  } }, el("summary", {}, "A law of your own"), area, drawn, el("p", { class: "acts" }, add));
}

let waiting = 0;
function later(does) {
  clearTimeout(waiting);
  waiting = setTimeout(does, PAUSE);
}

async function read(drawn, add, bench, stroke) {
  const own = ++asked;
  if (!text.trim()) {
    drawn.replaceChildren();
    return;
  }
  try {
    const found = await ask("law", text);
    // A later key has asked again.
    if (own !== asked) return;
    known = found;
    show(found, drawn, add, bench, stroke);
  } catch (error) {
    if (own === asked) drawn.replaceChildren(el("p", { class: "fault" }, error.message));
  }
}

function show(found, drawn, add, bench, stroke) {
  drawn.replaceChildren();
  if (found.fault) {
    const { at, what } = found.fault;
    const own = text.trim();
    drawn.append(el("p", { class: "fault", id: "law-fault" }, `${what} (character ${at + 1})`),
      el("p", { class: "law-at" }, own.slice(Math.max(0, at - 16), at), el("mark", {}, own.slice(at, at + 1) || " "), own.slice(at + 1, at + 17)));
    return;
  }
  add.disabled = Boolean(bench.job);
  for (const curve of found.curves) {
    drawn.append(signature(curve, { width: WIDE, height: 110, stroke, labels: true }));
  }
  const numbers = found.parameters.map((one) => `${one.name} ${digits(one.low, 3)} … ${digits(one.high, 3)}${one.unit ? ` ${one.unit}` : ""}`);
  const drawing = found.curves.length ? "; the curve has the values from which the search starts" : "";
  drawn.append(el("p", { class: "quiet s12" }, `${found.name}: a ${found.place}; fitted: ${numbers.join(", ") || "nothing"}${drawing}`));
}
