// What is missing: the proposals beside the model that is looked at, the explained model, or two models compared.

import { colour, letter, spoken } from "./names.js";
import { at, button, el, row } from "./elements.js";
import { field } from "./law.js";
import { counts, digits, estimate, usual } from "./numbers.js";
import { repeatability } from "./floor.js";
import { shownOf } from "./parameters.js";
import { signature } from "./signature.js";

// Widths of the drawings, px.
const WIDE = 286;

let open = 0;
let listed = null;
let previewed = null;

/** The effect that is previewed; nothing for none. */
export const preview = () => previewed;

/**
 * Shows what there is to say beside the model that is looked at. `does` holds what buttons do: `fit`, `lock`, `suggest`, `diagnose`,
 * `reveal`, `preview`, `alone`.
 */
export function show(bench, does) {
  const chosen = bench.models.find((one) => one.id === bench.chosen);
  const beside = bench.models.find((one) => one.id === bench.against);
  const place = at("finding");
  const key = `${bench.chosen}:${chosen?.stamp}:${bench.recording?.stamp}`;
  if (key !== listed) {
    listed = key;
    open = 0;
    previewed = null;
  }
  place.replaceChildren();
  if (!chosen) return;
  if (does.comparing && beside) place.append(compared(bench, chosen, beside, does));
  else if (chosen.explained) place.append(explained(bench, chosen, does));
  else place.append(missing(bench, chosen, does));
  place.append(foot(bench, chosen, does));
}

function missing(bench, chosen, does) {
  const { proposed } = bench;
  if (!proposed) {
    if (bench.job) return el("div");
    return el("div", { class: "sec" }, el("h2", {}, "What is missing?"),
      el("p", { class: "acts" }, button("Look for it", does.suggest, { class: "btn pri", id: "suggest" })));
  }
  const rows = rowsOf(proposed);
  const rest = [...proposed.list.filter((one) => !one.locked && !rows.includes(one)), ...proposed.list.filter((one) => one.locked)];
  open = Math.min(open, Math.max(0, rows.length - 1));
  const head = el("div", { class: "sec head" }, el("h2", {}, "What is missing?"), el("span", { class: "space" }),
    el("span", { class: "dim s12" }, `${proposed.tried} tested, ${proposed.seconds.toFixed(1)} s`));
  if (!rows.length) {
    const said = repeatability(bench) ? explained(bench, chosen, does) : el("div", { class: "sec" }, el("p", {}, chosen.at_floor
      ? "The error is the encoder's own, yet it is not noise: a longer recording would tell more."
      : "Nothing in the catalogue explains more. Something else is missing."));
    return el("div", {}, head, said, little(rest, bench, does));
  }
  const list = el("div", { id: "proposals" });
  rows.forEach((one, k) => list.append(k === open ? opened(one, rows, chosen, bench, does) : closed(one, k, bench, does)));
  if (rows.length > 1) list.insertBefore(thead(), list.children[open === 0 ? 1 : 0]);
  return el("div", {}, head, list, little(rest, bench, does));
}

// Those that are shown with their signatures: others than the first where they explain much. By a score, which knows the motor's own noise, only
// what is believed.
function rowsOf(proposed) {
  const first = proposed.floor ? -1 : 0;
  return proposed.list.filter((one) => !one.locked).filter((one, k) => k === first || !one.little);
}

const thead = () => el("div", { class: "thead", "aria-hidden": "true" }, el("span", {}, "Effect"), el("span", {}, "foreseen"), el("span", {}, "held out"));

const title = (one) => {
  const short = one.title.replace(/ \(.*\)$/, "");
  return short[0].toUpperCase() + short.slice(1);
};
const parameters = (one) => (one.parameters === 1 ? "1 parameter" : `${one.parameters} parameters`);

function opened(one, rows, chosen, bench, does) {
  const stroke = colour(bench.next);
  const fewest = rows.every((other) => other.parameters >= one.parameters);
  const worse = one.rms_counts < chosen.rms_counts && one.worse;
  const alike = rows.filter((other) => one.looks_like.includes(other.effect)).map((other) => spoken(other.effect));
  const others = one.looks_like.filter((name) => !alike.includes(spoken(name))).map(spoken);
  const facts = [
    ["Evidence", one.evidence],
    ["Foreseen", one.foreseen_rms_counts === null ? null : `${counts(one.foreseen_rms_counts)} before the refit`],
    ["Look-alikes", [...alike.map((name) => `${name} (tested below)`), ...others].join(", ") || "none"],
  ];
  if (!one.believed) facts.unshift(["Doubt", "removes too little of the held-out error to be believed"]);
  const made = el("article", { class: "open", style: `--pc:${stroke}`, "data-effect": one.effect, tabindex: "-1" },
    el("h3", { class: "ttl" }, title(one), el("small", {}, parameters(one) + (fewest && rows.length > 1 ? " · simplest" : ""))),
    about(bench.effects.find((own) => own.name === one.effect)),
    el("p", { class: "falls" }, el("span", { class: "quiet" }, counts(chosen.held_out_rms_counts)), "→",
      el("span", { class: "to", style: `color:${stroke}` }, counts(one.held_out_rms_counts)),
      el("span", { class: worse ? "warned s12" : "quiet s12" }, worse ? "held out: fits better, predicts worse" : "counts held out, verified")),
    signature(one.signature, { width: WIDE, height: 130, stroke, labels: true }),
    el("dl", { class: "kv" }, ...facts.filter(([, text]) => text).flatMap(([name, text]) => [el("dt", {}, name), el("dd", {}, text)])),
    el("p", { class: "acts" },
      el("button", { type: "button", class: "btn pri", id: "add", disabled: Boolean(bench.job), onclick: () => does.fit([...chosen.effects, one.effect]) },
        `Add ${spoken(one.effect)}`, el("span", { class: "kbd" }, "Enter")),
      button("Lock out", () => does.lock(one.effect, true), { id: "lock", title: "Propose this effect no more (L)" })));
  made.addEventListener("pointerenter", () => hover(one, does));
  return made;
}

// What the catalogue says of an effect; it stays open from one to the next.
let reading = false;
function about(effect) {
  const lines = [["Equation", effect.equation], ["Sign", effect.sign], ["Exposed by", effect.exposed_by], ["Source", effect.source]];
  return el("details", { class: "told", open: reading, ontoggle: (event) => {
    reading = event.target.open;
  } }, el("summary", { title: "The effect's equation, and what exposes it", "aria-label": `About ${spoken(effect.name)}` }, "?"),
  el("dl", { class: "kv" }, ...lines.flatMap(([name, text]) => [el("dt", {}, name), el("dd", {}, text)])));
}

function closed(one, k, bench, does) {
  const made = el("button", { type: "button", class: "prop", "data-effect": one.effect, onclick: () => choose(k, bench, does) },
    signature(one.signature, { width: 56, height: 40, stroke: colour(bench.next) }),
    el("span", { class: "nm" }, title(one)),
    el("span", { class: "num quiet" }, counts(one.foreseen_rms_counts)),
    el("span", { class: "num v" }, counts(one.held_out_rms_counts)),
    el("span", { class: "sub" }, [parameters(one), one.worse ? "predicts worse" : one.believed ? "" : "doubtful",
      one.looks_like.length ? `look-alike of ${spoken(one.looks_like[0])}` : ""].filter(Boolean).join(" · ")));
  made.addEventListener("pointerenter", () => hover(one, does));
  return made;
}

function little(rest, bench, does) {
  if (!rest.length) return null;
  return el("div", { class: "little" }, el("p", {}, el("span", { class: "strong" }, rest.length === 1 ? "1 explains little" : `${rest.length} explain little`), ", held out"),
    el("ul", {}, ...rest.map((one) => el("li", {}, el("button", {
      type: "button", title: one.locked ? "Locked out; propose it again" : title(one),
      onclick: () => (one.locked ? does.lock(one.effect, false) : does.fit([...bench.models.find((m) => m.id === bench.chosen).effects, one.effect])),
    }, el("span", {}, `${one.locked ? "🔒 " : ""}${spoken(one.effect)}`), el("span", { class: "n" }, counts(one.held_out_rms_counts)))))));
}

function hover(one, does) {
  if (previewed === one.effect) return;
  previewed = one.effect;
  does.preview();
}

function choose(k, bench, does) {
  open = k;
  previewed = rowsOf(bench.proposed)[open]?.effect ?? null;
  show(bench, does);
  document.querySelector("#proposals .open")?.scrollIntoView({ block: "nearest" });
  does.preview();
}

/** Opens the next proposal, or the one before. */
export function turn(by, bench, does) {
  if (!document.getElementById("proposals")) return;
  const rows = document.querySelectorAll("#proposals [data-effect]").length;
  choose(Math.max(0, Math.min(rows - 1, open + by)), bench, does);
}

/** The proposal that is open. */
export const openEffect = () => document.querySelector("#proposals .open")?.dataset.effect ?? null;

/** Previews the open proposal, if there is any. */
export function previewOpen() {
  previewed = openEffect();
}

// ---- the end of the way

function explained(bench, chosen, does) {
  const tint = colour(chosen.id);
  const names = chosen.effects.map(spoken);
  const said = names.length ? `${listed_of(names)} explain${names.length === 1 ? "s" : ""} this motor.` : "A linear motor explains this recording.";
  const motor = repeatability(bench);
  const readings = `${bench.recording.window_s ? "readings'" : "encoder's"} own error`;
  const left = motor ? `the motor's own repeatability is left: about ${counts(motor)} counts after ${digits(bench.recording.window_s, 2)} s` : `the ${readings} is left`;
  const own = el("div", { class: "sec" }, el("h2", {}, "The model"), ...chosen.effects.map((effect) => owned(bench, chosen, effect, does)));
  return el("div", {},
    el("div", { class: "sec done explained", id: "explained", style: `--tint:${tint}` }, el("span", { class: "check", "aria-hidden": "true" }, "✓"), el("h2", {}, "Explained"),
      el("p", { class: "quiet" }, `${said[0].toUpperCase()}${said.slice(1)} ${bench.recording.held_out ? "On the held-out recording" : "Also in what was not fitted"} only ${left}.`)),
    chosen.effects.length ? own : null,
    el("div", { class: "sec" }, el("h2", {}, "Is anything left?"), el("table", { class: "facts" },
      row("Fitted, counts", counts(chosen.rms_counts)), row("Held out, counts", counts(chosen.held_out_rms_counts)),
      motor ? row("The motor's repeatability, counts", counts(motor)) : null,
      row(bench.recording.window_s ? "The readings' own, counts" : "The encoder's own, counts", counts(bench.floor_counts)),
      bench.recording.window_s ? null : row("Residual is noise", chosen.white === null ? "too little motion to tell" : chosen.white ? "yes" : "no")),
    el("p", { class: "acts" }, button("Export the model", does.exports, { class: "btn pri" }))));
}

const listed_of = (names) => (names.length < 2 ? names.join("") : `${names.slice(0, -1).join(", ")} and ${names.at(-1)}`);

function owned(bench, chosen, effect, does) {
  const found = (chosen.signatures ?? {})[effect];
  const own = shownOf(chosen).filter((one) => one.name.startsWith(`${effect}.`));
  const values = own.map((one) => {
    const { value, factor, unit } = usual(one.value, one.unit);
    const [text, half] = estimate(value, one.std === null ? NaN : 1.96 * one.std * factor);
    return `${spoken(one.name.split(".")[1])} ${text}${half ? ` ± ${half}` : ""} ${unit}`;
  });
  // Some effects are told by no single quantity, and have no drawing.
  return el("div", { class: "owned" }, found?.curve.length ? signature(found, { width: 96, height: 64, stroke: colour(chosen.id) }) : null,
    el("div", {}, el("h3", { class: "strong" }, spoken(effect)), ...values.slice(0, 3).map((text) => el("p", { class: "quiet" }, text)),
      button(`Remove ${spoken(effect)}`, () => does.fit(chosen.effects.filter((other) => other !== effect)), { class: "btn link", disabled: Boolean(bench.job) })));
}

function compared(bench, chosen, beside, does) {
  const tag = (model) => el("span", { class: "tag", style: `background:${colour(model.id)}` }, letter(model.id));
  const [first, second] = [beside, chosen];
  const better = first.held_out_rms_counts / second.held_out_rms_counts;
  return el("div", { class: "sec", id: "compared" }, el("h2", {}, "Compared"),
    el("table", { class: "facts" },
      el("tr", {}, el("th", {}), el("th", {}, tag(first)), el("th", {}, tag(second))),
      row("Held out, counts", counts(first.held_out_rms_counts), counts(second.held_out_rms_counts)),
      row("Fitted, counts", counts(first.rms_counts), counts(second.rms_counts)),
      row("Effects", String(first.effects.length), String(second.effects.length)),
      row("Residual is noise", noise(first), noise(second))),
    el("p", { class: "quiet", style: "margin-top:8px" }, better > 1.05
      ? `${letter(second.id)} predicts ${digits(better, 2)} times better than ${letter(first.id)}.`
      : better < 0.95 ? `${letter(first.id)} predicts ${digits(1 / better, 2)} times better than ${letter(second.id)}.` : "Both predict about equally."),
    el("p", { class: "acts" }, button(`Show ${letter(second.id)} alone`, does.alone), button("Swap", does.swap)));
}

const noise = (model) => (model.white === null ? "?" : model.white ? "yes" : "no");

// ---- what is always there

function foot(bench, chosen, does) {
  const rest = bench.effects.filter((one) => !chosen.effects.includes(one.name));
  const select = el("select", { id: "effect", "aria-label": "Any effect" }, ...rest.map((one) => el("option", { value: one.name }, spoken(one.name))));
  const parts = [];
  if (bench.diagnosis) parts.push(el("p", { id: "verdict", class: "quiet" }, bench.diagnosis.summary));
  parts.push(el("p", { class: "row" }, select, button("Add", () => does.fit([...chosen.effects, select.value]), { id: "add-any", disabled: Boolean(bench.job) })));
  if (chosen.effects.length && !chosen.explained) {
    parts.push(el("p", { class: "row", style: "flex-wrap:wrap" }, ...chosen.effects.map((effect) => button(`Remove ${spoken(effect)}`,
      () => does.fit(chosen.effects.filter((other) => other !== effect)), { class: "btn link", disabled: Boolean(bench.job) }))));
  }
  parts.push(field(bench, chosen, colour(bench.next), does));
  parts.push(el("p", { class: "row" }, button("Find everything that is missing", does.diagnose, { id: "diagnose", disabled: Boolean(bench.job) })));
  if (chosen.effects.length) parts.push(twins(bench, chosen, does));
  if (bench.secret) {
    parts.push(bench.secret.told === null ? el("p", {}, button("Reveal what is hidden", does.reveal, { id: "reveal" })) : null,
      el("p", { id: "secret", role: "status" }, bench.secret.told === null ? "" : `Hidden was ${bench.secret.told}`));
  }
  return el("div", { class: "foot" }, ...parts);
}

// How far the name can be trusted: what is named in motors like this one.
function twins(bench, chosen, does) {
  const found = bench.twins;
  const goes = bench.job === "twins";
  if (!found && !goes) {
    return el("p", { class: "row" }, button("Try it on motors like yours", () => does.twins(chosen.id), {
      id: "twins", disabled: Boolean(bench.job), title: "20 motors of the virtual bench with these constants and effects, driven and read as yours was",
    }));
  }
  const { tried, same, of, others } = found ?? { tried: 0, same: 0, of: 20, others: {} };
  const rest = Object.entries(others).sort((a, b) => b[1] - a[1]).map(([names, count]) => `${count} × ${spoken(names)}`);
  return el("div", { id: "twins-found" },
    tried === 0 ? el("p", { class: "quiet" }, "Diagnosing motors like yours …") : el("p", {}, el("span", { class: "strong" }, `In ${same} of ${tried}`), ` motors like yours ${chosen.effects.length === 1 ? "this effect alone is" : "just these effects are"} named.`,
      tried < of && goes ? el("span", { class: "quiet" }, ` ${of - tried} to go.`) : null),
    rest.length ? el("p", { class: "quiet s12" }, `Named in the others: ${rest.join(", ")}.`) : null);
}
