// The result as a file.

import { at, el, save } from "./elements.js";

const SAID = {
  report: ["Report", "one page to read and to print"],
  session: ["Session", "all of this, to go on with"],
  fit: ["Fit", "parameters, errors and notes, as JSON"],
  diagnosis: ["Diagnosis", "what was found missing, as JSON"],
};

/** Lists what may be taken; `say` tells what went wrong. */
export function show(bench, say) {
  const names = [...Object.keys(SAID), ...bench.formats];
  at("export-list").replaceChildren(el("div", { class: "exports" }, ...names.map((name) => {
    const [title, what] = SAID[name] ?? [name, "the model in this form"];
    return el("button", { type: "button", "data-format": name, onclick: () => take(name).then(() => say(null), say).then(() => at("export-dialog").close()) },
      el("b", {}, title), el("span", { class: "quiet" }, what));
  })));
  if (!at("export-dialog").open) at("export-dialog").showModal();
}

async function take(format) {
  const answer = await fetch(`export?format=${format}`);
  if (!answer.ok) throw new Error((await answer.json()).error);
  const name = /filename="([^"]+)"/.exec(answer.headers.get("content-disposition"))[1];
  save(name, await answer.blob());
}

at("export-close").addEventListener("click", () => at("export-dialog").close());
