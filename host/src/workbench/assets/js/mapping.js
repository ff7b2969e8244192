// A file that was dropped: what it is, which column is what, and what that means.

import { ask } from "./ask.js";
import { at, el, path, save, svg } from "./elements.js";
import { digits } from "./numbers.js";

const QUANTITIES = [
  ["time", "Time", ["s", "ms", "us"], ""],
  ["voltage", "Command", ["V", "duty"], ""],
  ["angle", "Angle", ["counts", "deg", "rad", "rev"], ""],
  ["current", "Current", null, "Optional, in A. Separates resistance from the torque constant."],
  ["temperature", "Temperature", null, "Optional, in °C. A law of your own may go with it."],
  ["enabled", "Bridge enabled", null, "Optional. Coasting separates friction from back-EMF."],
];
const ROLES = [
  ["fitted", "Fitted", "a new bench: models learn from it"], ["held_out", "Held out", "judges the models, is never fitted"],
  ["beside", "Fitted with the others", "another run of the same motor"],
];
const NUMBERS = ["counts_per_rev", "supply_v", "resistance_ohm"];
// What files begin with that are no tables.
const OTHERS = [
  ["\x89PNG", "a PNG picture"], ["\xff\xd8\xff", "a JPEG picture"], ["GIF8", "a GIF picture"], ["%PDF", "a PDF document"], ["\x1f\x8b", "a gzip archive"],
  ["PK\x03\x04", "a ZIP archive or a spreadsheet; save it as CSV"], ["\x89HDF", "an HDF5 file; export it as CSV"], ["PAR1", "a Parquet file; export it as CSV"],
  ["MATLAB 5.0", "a MATLAB file; export it with writetable"], ["\x7fELF", "a program"], ["SQLite format", "a database"],
];

let dropped = null;
let does = null;
let preview = null;
let checks = 0;

/** Takes files; `with_` holds `bench`, `say`, `putAway`, `fit` and `act`. */
export async function take(files, with_) {
  does = with_;
  does.say(null);
  if (does.bench()?.job) throw new Error(`The bench is busy (${does.bench().job}): wait for it, or stop it first.`);
  const texts = [];
  for (const file of files) {
    const head = String.fromCharCode(...new Uint8Array(await file.slice(0, 16).arrayBuffer()));
    const other = OTHERS.find(([begins]) => head.startsWith(begins));
    if (other) throw new Error(`${file.name}: this is ${other[1]}. A recording is a table as text: CSV with time, voltage and angle.`);
    if (!file.size) throw new Error(`${file.name}: this file is empty.`);
    texts.push({ name: file.name, text: await file.text() });
  }
  const session = texts.find((file) => /^[\s\uFEFF]*\{/.test(file.text) || file.name.toLowerCase().endsWith(".json"));
  if (session) {
    const text = session.text.replace(/^\uFEFF/, "");
    await ask("session?check=true", text);
    if (await does.putAway()) await ask("session", text);
    return;
  }
  const motor = texts.find((file) => file.name.toLowerCase().endsWith(".toml"));
  const tables = texts.filter((file) => file !== motor);
  if (!tables.length) throw new Error("There is no recording among these files: drop a CSV with time, voltage and angle.");
  dropped = { name: tables[0].name, csv: tables[0].text };
  if (motor) {
    try {
      await send({ motor: motor.text, check: true });
    } catch (error) {
      does.say(error);
      await open();
      return;
    }
    if (!await does.putAway()) return;
    // As on the command line: of several the last judges, and the others are fitted together.
    for (const [place, file] of tables.entries()) {
      dropped = { name: file.name, csv: file.text };
      const last = place > 0 && place === tables.length - 1;
      await send({ motor: motor.text, role: place === 0 ? "fitted" : last ? "held_out" : "beside" });
    }
    await does.fit([]);
    return;
  }
  await open();
}

const send = (more) => ask("recording", { ...dropped, ...more });

async function open() {
  preview = await ask("preview", dropped.csv.slice(0, 262144));
  at("file-name").textContent = dropped.name;
  const columns = `${preview.header.length} column${preview.header.length === 1 ? "" : "s"}`;
  at("file-about").textContent = `${columns}, separated by ${{ ",": "commas", ";": "semicolons", "\t": "tabs" }[preview.divider] ?? "commas"}`;
  const heads = ["Quantity", "Column", "Unit", "First rows", "Guessed from"];
  at("mapping").replaceChildren(el("thead", {}, el("tr", {}, ...heads.map((text, k) => el("th", { class: k === 3 ? "view" : k === 4 ? "why" : "" }, text)))),
    el("tbody", {}, ...QUANTITIES.map(row)));
  at("first-rows").replaceChildren(el("thead", {}, el("tr", {}, ...preview.header.map((text) => el("th", {}, text)))),
    el("tbody", {}, ...preview.rows.map((cells) => el("tr", {}, ...cells.map((text) => el("td", {}, text))))));
  const standing = Boolean(does.bench()?.recording);
  at("role").replaceChildren(el("legend", {}, "Use it as"), ...ROLES.filter(([name]) => standing || name === "fitted").map(([name, title, what], k) =>
    el("label", {}, el("input", { type: "radio", name: "role", value: name, checked: k === 0 }), el("strong", {}, title), el("span", { class: "quiet" }, what))));
  // Nothing is known of this file yet; what was said of the one before is not of this one.
  show("");
  at("load").disabled = true;
  if (!at("columns").open) at("columns").showModal();
  await check();
}

function row([what, title, units, hint]) {
  const guessed = preview.guess[what];
  const select = el("select", { id: `map-${what}`, "aria-label": `Column of ${title.toLowerCase()}`, onchange: () => redraw() },
    el("option", { value: "" }, "not recorded"), ...preview.header.map((name) => el("option", { value: name, selected: name === guessed }, name)));
  const unit = units && el("select", { id: `map-${what}_unit`, "aria-label": `Unit of ${title.toLowerCase()}` },
    ...units.map((name) => el("option", { value: name, selected: name === preview.guess[`${what}_unit`] }, name === "us" ? "µs" : name)));
  const view = el("td", { class: "view" });
  const why = el("td", { class: "why" });
  const redraw = () => {
    const column = preview.header.indexOf(select.value);
    view.replaceChildren(column < 0 ? "" : spark(preview.values[column] ?? []));
    const own = select.value === guessed && guessed;
    why.textContent = select.value === "" ? hint || "Needed: choose its column." : own ? `its name${range(preview.values[column])}` : `chosen by you${range(preview.values[column])}`;
    select.classList.toggle("doubt", select.value === "" && !hint);
  };
  redraw();
  return el("tr", {}, el("td", {}, title), el("td", {}, select), el("td", {}, unit ?? ""), view, why);
}

function range(values) {
  const found = (values ?? []).filter((x) => x !== null);
  return found.length ? `; from ${digits(Math.min(...found), 4)} to ${digits(Math.max(...found), 4)}` : "; no numbers";
}

function spark(values) {
  const found = values.filter((x) => x !== null);
  const [low, high] = [Math.min(...found), Math.max(...found)];
  const points = values.map((y, k) => (y === null ? null : [4 + (128 * k) / Math.max(1, values.length - 1), 4 + 24 * (1 - (y - low) / (high - low || 1))]));
  return svg("svg", { width: 136, height: 32, "aria-hidden": "true" }, svg("path", { d: path(points), fill: "none", stroke: "var(--ink-2)" }));
}

function mapping() {
  const chosen = {};
  for (const [what, , units] of QUANTITIES) {
    chosen[what] = at(`map-${what}`).value;
    if (units) chosen[`${what}_unit`] = at(`map-${what}_unit`).value;
  }
  for (const key of NUMBERS) {
    const field = at(`map-${key}`);
    chosen[key] = field.value === "" ? null : Number(field.value);
    // What is no number has no value, and must not pass for a field that was left empty.
    if (field.validity.badInput) throw new Error(`${field.closest("label").firstChild.textContent.trim()}: this is not a number`);
  }
  return chosen;
}

async function check() {
  checks += 1;
  const own = checks;
  let fault = "";
  let means = null;
  try {
    means = await send({ mapping: mapping(), check: true });
  } catch (error) {
    // Fields have no lines.
    fault = error.message.replace(/^motor\.toml:\d+:\d+: /, "");
  }
  // An answer to what is no longer chosen says nothing.
  if (own !== checks) return;
  show(fault);
  at("load").disabled = Boolean(fault) || Boolean(does.bench()?.job);
  at("save-motor").disabled = Boolean(fault);
  const rows = means ? [
    ["Drive", `±${digits(means.drive, 3)} ${means.drive_unit}`], ["Top speed", `${digits(means.rpm, 4)} rpm`], ["Travel", `${digits(means.turns, 4)} rev`],
    ["Positive drive turns", means.forward ? "positive" : "negative"], ["Samples", `${means.samples}, ${digits(means.interval_s * 1e3, 4)} ms apart`],
  ] : [];
  at("means").replaceChildren(...rows.flatMap(([name, text]) => [el("dt", {}, name), el("dd", {}, text)]),
    ...(means ? [el("dd", { class: "hint", style: "grid-column:1/3" }, `Does ${digits(means.rpm, 3)} rpm look right? If not, the counts per revolution or a unit is wrong.`)] : []));
}

function show(fault) {
  at("column-fault").hidden = !fault;
  at("column-fault").textContent = fault;
}

// As it is typed: nobody has to leave a field first.
let typed = null;
at("columns").addEventListener("input", () => {
  clearTimeout(typed);
  typed = setTimeout(check, 120);
});
at("columns").addEventListener("change", check);
at("load").addEventListener("click", async () => {
  try {
    const role = at("role").querySelector("input:checked")?.value ?? "fitted";
    if (role === "fitted" && !await does.putAway()) return;
    await send({ mapping: mapping(), role });
    at("columns").close();
    await does.fit([]);
  } catch (error) {
    // What is still being checked must not take this away.
    clearTimeout(typed);
    checks += 1;
    show(error.message);
  }
});
at("save-motor").addEventListener("click", async () => {
  try {
    const { text } = await ask("motor", mapping());
    save("motor.toml", new Blob([text]));
  } catch (error) {
    show(error.message);
  }
});
