// Files that were dropped: the program says what is in them and what their columns may be; the user corrects it, and sees what it means.

import { ask, send } from "./ask.js";
import { at, el, path, save, svg } from "./elements.js";
import { digits } from "./numbers.js";

const ROLES = [
  ["fitted", "Fitted", "a new bench: models learn from it"], ["held_out", "Held out", "judges the models, is never fitted"],
  ["beside", "Fitted with the others", "another run of the same motor"],
];
const NUMBERS = ["counts_per_rev", "supply_v", "resistance_ohm"];
// What files begin with that hold no log at all.
const OTHERS = [
  ["\x89PNG", "a PNG picture"], ["\xff\xd8\xff", "a JPEG picture"], ["GIF8", "a GIF picture"], ["%PDF", "a PDF document"], ["\x7fELF", "a program"],
  ["SQLite format", "a database"],
];
// Nobody waits longer for a sign of life.
const PATIENCE_MS = 300;

// The logs of which it is asked what they are, the first one's tables, and what was said of it.
let logs = [];
let does = null;
let shown = null;
let checks = 0;

/** Takes files; `with_` holds `bench`, `say`, `putAway`, `fit` and `act`. */
export async function take(files, with_) {
  does = with_;
  does.say(null);
  if (does.bench()?.job) throw new Error(`The bench is busy (${does.bench().job}): wait for it, or stop it first.`);
  const told = [];
  for (const file of files) {
    const head = String.fromCharCode(...new Uint8Array(await file.slice(0, 16).arrayBuffer()));
    const other = OTHERS.find(([begins]) => head.startsWith(begins));
    if (other) throw new Error(`${file.name}: this is ${other[1]}. A recording is a log with time, voltage and angle.`);
    if (!file.size) throw new Error(`${file.name}: this file is empty.`);
    told.push(await patiently(`Reading ${file.name}`, send(`dropped?name=${encodeURIComponent(file.name)}`, file)));
  }
  await taken(told);
}

/** Asks for what was named on the command line, if there is any of which it must be said what it is. */
export async function waiting(with_) {
  does = with_;
  const told = await patiently("Reading", ask("dropped"));
  if (told.length) await taken(told);
}

async function taken(told) {
  const session = told.find((one) => one.kind === "session");
  if (session) {
    await ask("dropped/session", { id: session.id, check: true });
    if (await does.putAway()) await ask("dropped/session", { id: session.id });
    return;
  }
  const motor = told.find((one) => one.kind === "motor");
  logs = told.filter((one) => one.kind === "log");
  if (!logs.length) throw new Error("There is no recording among these files: drop a log with time, voltage and angle.");
  // As on the command line: the first is fitted, of several the last judges.
  logs.forEach((log, k) => {
    const last = k > 0 && k === logs.length - 1;
    log.role = log.role && log.role !== "fitted" ? log.role : k === 0 ? "fitted" : last ? "held_out" : "beside";
  });
  if (motor) {
    try {
      await read({ motor: motor.text, check: true });
    } catch (error) {
      does.say(error);
      await open();
      return;
    }
    if (!await does.putAway()) return;
    await patiently("Reading", read({ motor: motor.text }));
    await does.fit([]);
    return;
  }
  await open();
}

// Says what is being done, once it takes longer than a moment.
async function patiently(what, work) {
  const sign = setTimeout(() => {
    at("reading-what").textContent = what;
    at("reading").hidden = false;
  }, PATIENCE_MS);
  try {
    return await work;
  } finally {
    clearTimeout(sign);
    at("reading").hidden = true;
  }
}

const read = (more) => ask("dropped/read", { files: logs.filter((log) => log.role !== "unused").map(({ id, role }) => ({ id, role })), ...more });

async function open() {
  const [first] = logs;
  at("file-name").textContent = logs.length === 1 ? first.name : `${logs.length} logs`;
  at("file-about").textContent = [first.format, ...first.notes].join("; ");
  const standing = Boolean(does.bench()?.recording);
  const alone = logs.length === 1;
  at("role").hidden = !alone;
  at("files").hidden = alone;
  at("role").replaceChildren(el("legend", {}, "Use it as"), ...ROLES.filter(([name]) => standing || name === "fitted").map(([name, title, what], k) =>
    el("label", {}, el("input", { type: "radio", name: "role", value: name, checked: k === 0, onchange: () => { first.role = name; } }), el("strong", {}, title),
      el("span", { class: "quiet" }, what))));
  if (alone) first.role = "fitted";
  at("files").replaceChildren(el("h3", {}, "Use them as"), ...logs.map((log) => el("label", { class: "file-role" }, el("span", {}, log.name),
    el("select", { "aria-label": `Role of ${log.name}`, onchange: (event) => { log.role = event.target.value; } },
      ...[...ROLES, ["unused", "Not used", ""]].map(([name, title]) => el("option", { value: name, selected: name === log.role }, title))))));
  fill(first);
  // Nothing is known of this file yet; what was said of the one before is not of this one.
  show("");
  at("load").disabled = true;
  if (!at("columns").open) at("columns").showModal();
  await check();
}

// Fills the dialog with what the program proposes for a log.
function fill(log) {
  shown = log;
  const { proposal } = log;
  const tables = log.tables.filter((table) => table.columns.length);
  const best = proposal.table ?? tables.reduce((most, table) => (guessed(table, proposal) > guessed(most, proposal) ? table : most), tables[0] ?? { columns: [] }).name;
  const joined = Object.values(proposal.columns).some(({ column }) => !tables.some((table) => table.columns.some((one) => one.name === column)));
  shown.columns = joined
    ? tables.flatMap((table) => table.columns.map((one) => ({ ...one, name: `${table.name}:${one.name}` })))
    : tables.find((table) => table.name === best)?.columns ?? [];
  at("presets").replaceChildren(
    choice("map-drive", "Drive", log.drives.map(({ name, title }) => [name, title]), proposal.drive),
    choice("map-preset", "Written by", [["", "an unknown program"], ...log.presets.map(({ name }) => [name, name])], proposal.preset ?? ""),
    ...(tables.length > 1 && !joined ? [choice("map-table", "Tables", [["", "all that have these columns"], ...tables.map(({ name }) => [name, name])], "")] : []),
  );
  const heads = ["Quantity", "Column", "Unit", "First rows", "Guessed from"];
  at("mapping").replaceChildren(el("thead", {}, el("tr", {}, ...heads.map((text, k) => el("th", { class: k === 3 ? "view" : k === 4 ? "why" : "" }, text)))),
    el("tbody", {}, ...log.channels.map(row)));
  const rows = log.first_rows;
  at("first-rows").replaceChildren(el("thead", {}, el("tr", {}, ...rows.names.map((text) => el("th", {}, text)))),
    el("tbody", {}, ...rows.rows.map((cells) => el("tr", {}, ...cells.map((text) => el("td", {}, text ?? ""))))));
  for (const key of ["counts_per_rev", "supply_v"]) {
    const field = at(`map-${key}`);
    if (proposal[key]) field.value = proposal[key];
  }
  at("doubts").replaceChildren(...[...proposal.doubts].map((text) => el("li", {}, text)));
  at("doubts").hidden = !proposal.doubts.length;
}

const guessed = (table, proposal) => {
  const names = new Set(table.columns.map((one) => one.name));
  return Object.values(proposal.columns).filter(({ column }) => names.has(column)).length;
};

function choice(id, title, options, chosen) {
  return el("label", {}, title, el("select", { id, onchange: again }, ...options.map(([value, text]) => el("option", { value, selected: value === chosen }, text))));
}

// Another drive or preset has other columns: the program proposes them.
async function again(event) {
  if (event.target.id === "map-table") return;
  try {
    const preset = at("map-preset").value;
    const drive = event.target.id === "map-drive" ? at("map-drive").value : "";
    const told = await ask("dropped/proposal", { id: shown.id, preset, drive });
    fill({ ...shown, ...told });
    await check();
  } catch (error) {
    show(error.message);
  }
}

function row({ key, title, units, good_for: hint }) {
  const proposed = shown.proposal.columns[key];
  const guess = proposed?.column;
  const named = shown.columns.some((one) => one.name === guess);
  const options = shown.columns.filter((one) => one.is_number || one.is_time || one.name === guess || key === "direction" || key === "time");
  const select = el("select", { id: `map-${key}`, "aria-label": `Column of ${title.toLowerCase()}`, onchange: () => redraw() },
    el("option", { value: "" }, "not recorded"), ...options.map((one) => el("option", { value: one.name, selected: named && one.name === guess }, one.name)));
  const unit = units.length ? el("select", { id: `map-${key}_unit`, "aria-label": `Unit of ${title.toLowerCase()}` },
    el("option", { value: "" }, "as usual"), ...units.map((name) => el("option", { value: name, selected: name === proposed?.unit }, spelt(name)))) : null;
  const view = el("td", { class: "view" });
  const why = el("td", { class: "why" });
  const redraw = () => {
    const column = shown.columns.find((one) => one.name === select.value);
    view.replaceChildren(column?.drawn ? spark(column.drawn) : "");
    const own = select.value === guess && guess;
    why.textContent = select.value === "" ? (hint ? `Optional. ${hint}` : "Needed: choose its column.") : `${own ? proposed.why : "chosen by you"}${range(column)}`;
    select.classList.toggle("doubt", select.value === "" && !hint);
  };
  redraw();
  return el("tr", {}, el("td", {}, title), el("td", {}, select), el("td", {}, unit ?? ""), view, why);
}

// Units as people write them.
const spelt = (unit) => ({ us: "µs", percent: "%", pwm8: "PWM, 8 bits (±255)", pwm10: "PWM, 10 bits (±1023)", pwm885: "PWM of Dynamixel (±885)", int8: "a byte (±127)",
  duty: "duty (±1)", deg: "°", "N*m": "N·m", C: "°C", F: "°F" }[unit] ?? unit);

function range(column) {
  if (!column?.range) return "; no numbers";
  return `; from ${digits(column.range[0], 4)} to ${digits(column.range[1], 4)}`;
}

function spark(values) {
  const found = values.filter((x) => x !== null);
  const [low, high] = [Math.min(...found), Math.max(...found)];
  const points = values.map((y, k) => (y === null ? null : [4 + (128 * k) / Math.max(1, values.length - 1), 4 + 24 * (1 - (y - low) / (high - low || 1))]));
  return svg("svg", { width: 136, height: 32, "aria-hidden": "true" }, svg("path", { d: path(points), fill: "none", stroke: "var(--ink-2)" }));
}

// What is said in the dialog, by the keys of a motor file.
function said() {
  const asked = { columns: {}, units: {}, drive: at("map-drive").value, preset: at("map-preset").value, table: at("map-table")?.value ?? "" };
  if (shown.proposal.select) asked.select = shown.proposal.select;
  for (const { key } of shown.channels) {
    asked.columns[key] = at(`map-${key}`).value;
    const unit = at(`map-${key}_unit`);
    if (unit && asked.columns[key]) asked.units[key] = unit.value;
  }
  for (const key of NUMBERS) {
    const field = at(`map-${key}`);
    asked[key] = field.value === "" ? null : Number(field.value);
    // What is no number has no value, and must not pass for a field that was left empty.
    if (field.validity.badInput) throw new Error(`${field.closest("label").firstChild.textContent.trim()}: this is not a number`);
  }
  return asked;
}

async function check() {
  checks += 1;
  const own = checks;
  let fault = "";
  let means = null;
  const sign = setTimeout(() => own === checks && at("means").replaceChildren(el("dd", { class: "hint", style: "grid-column:1/3" }, "Reading …")), PATIENCE_MS);
  try {
    means = await read({ ...said(), check: true });
  } catch (error) {
    // Fields have no lines.
    fault = error.message.replace(/^motor\.toml:\d+:\d+: /, "");
  }
  clearTimeout(sign);
  // An answer to what is no longer chosen says nothing.
  if (own !== checks) return;
  show(fault);
  at("load").disabled = Boolean(fault) || Boolean(does.bench()?.job);
  at("save-motor").disabled = Boolean(fault);
  const rows = means ? [
    ["Drive", `±${digits(means.drive, 3)} ${means.drive_unit}`], ["Top speed", `${digits(means.rpm, 4)} rpm`], ["Travel", `${digits(means.turns, 4)} rev`],
    ["Positive drive turns", means.forward ? "positive" : "negative"], ["Samples", `${means.samples}, ${digits(means.interval_s * 1e3, 4)} ms apart`],
  ] : [];
  const wide = { class: "hint", style: "grid-column:1/3" };
  at("means").replaceChildren(...rows.flatMap(([name, text]) => [el("dt", {}, name), el("dd", {}, text)]), ...(means?.notes ?? []).map((note) => el("dd", wide, note)),
    ...(means ? [el("dd", wide, `Does ${digits(means.rpm, 3)} rpm look right? If not, the counts per revolution or a unit is wrong.`)] : []));
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
    if (logs.some((log) => log.role === "fitted") && !await does.putAway()) return;
    await patiently("Reading", read(said()));
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
    const { text } = await ask("motor", said());
    save("motor.toml", new Blob([text]));
  } catch (error) {
    show(error.message);
  }
});
