// The device that is connected: what it is, arming, and what its motor may be driven for.

import { at, button, el, path, row, svg } from "./elements.js";
import { colour, letter, spoken } from "./names.js";
import { counts, digits } from "./numbers.js";

const RECORD_S = 20;
const PLAN_S = 20;

let left = 0;
let since = 0;
let shown = null;

/** Shows the device, if there is one. `does` holds `arm`, `record`, `plan`, `play` and `commission`. */
export function show(bench, does) {
  const { device } = bench;
  at("device").hidden = !device;
  if (!device) return;
  [left, since, shown] = [device.armed_s, performance.now(), [bench, does]];
  at("device-name").textContent = device.board;
  at("device-about").textContent = [`${digits(1e-3 / device.period_s, 3)} kHz`, `${digits(device.supply_v, 3)} V`, ...limits(device)].join(" · ");
  at("device-about").title = `${device.firmware} at ${device.port}${device.runs ? `; runs are kept in ${device.runs}` : ""}`;
  buttons();
  experiment(bench, device, does);
  found(device);
}

function limits({ limits: most, senses_current: senses }) {
  const parts = [[most.voltage_v, "V"], [most.current_a, "A"], [most.travel_rev, "rev"], [most.speed_rad_s, "rad/s"]]
    .filter(([value]) => value !== null).map(([value, unit]) => `${digits(value, 3)} ${unit}`);
  return [`at most ${parts.join(", ")}`, ...(senses ? [] : ["no current sensor"])];
}

const armedFor = () => Math.max(0, left - (performance.now() - since) / 1000);

// What turns the motor waits until it is armed.
function buttons() {
  const [bench, does] = shown;
  const busy = Boolean(bench.job);
  const armed = armedFor() > 0 && !busy;
  at("arm").disabled = busy;
  at("arm").textContent = armed ? `Armed, ${Math.ceil(armedFor())} s` : "Arm";
  at("arm").classList.toggle("on", armed);
  at("arm").onclick = does.arm;
  for (const [id, act] of [["record", () => does.record(RECORD_S)], ["commission", () => does.commission(RECORD_S)], ["play", does.play]]) {
    const one = at(id);
    if (!one) continue;
    one.disabled = !armed;
    one.onclick = act;
  }
}
setInterval(() => shown && !at("device").hidden && buttons(), 250);

// ---- the experiment that decides

function experiment(bench, device, does) {
  const place = at("experiment");
  const { planned } = device;
  const rivals = bench.proposed?.rivals ?? [];
  if (planned) {
    place.replaceChildren(el("div", { class: "sec" }, el("h2", {}, "The experiment that decides"),
      el("p", { class: "quiet", style: "margin-top:4px" }, `${planned.excitation[0].toUpperCase()}${planned.excitation.slice(1)}: ${planned.reason}.`),
      drawing(bench, planned),
      el("p", { class: "row spread s12" }, ...planned.rivals.map((one, k) => el("span", {},
        el("span", { class: "tag", style: `background:${colour(bench.next + k)}` }, letter(bench.next + k)), ` if ${spoken(one.effect)}`))),
      el("table", { class: "facts" },
        row("The wrong model misses by at least", `${counts(planned.missed_counts)} counts`), row("Travel", `${digits(planned.travel_rev, 3)} rev`),
        row("Top speed", `${digits(planned.speed_rad_s, 3)} rad/s`), row("Peak drive", `${digits(planned.voltage_v, 3)} V`),
        row("Peak current", `${digits(100 * planned.current_of_stall, 2)} % of stall`)),
      el("p", { class: "acts" }, el("button", { type: "button", class: "btn pri", id: "play" }, "Record the experiment that decides")),
      el("p", { class: "quiet s12" }, `The motor will turn for ${digits(planned.seconds, 2)} s. Arm it first; Esc opens the bridge at any time.`)));
    buttons();
    return;
  }
  place.replaceChildren(...(rivals.length > 1 && !bench.job ? [el("div", { class: "sec" }, el("h2", {}, "These recordings cannot tell"),
    el("p", { class: "quiet", style: "margin-top:4px" }, `${rivals.map(spoken).join(", ")} explain them about equally.`),
    el("p", { class: "acts" }, button("Plan the experiment that decides", () => does.plan(PLAN_S), { id: "plan" })))] : []));
}

// What each rival foresees, over what is driven.
function drawing(bench, planned) {
  const [width, height] = [286, 120];
  const all = planned.rivals.flatMap((one) => one.angle);
  const [low, high] = [Math.min(...all), Math.max(...all)];
  const most = Math.max(...planned.drive.map(Math.abs), 1e-9);
  const x = (k) => (k / (planned.time.length - 1)) * width;
  const curve = (values, y) => path(values.map((value, k) => [x(k), y(value)]));
  return svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "foresees", role: "img", "aria-label": "What each effect foresees of the experiment" },
    svg("path", { d: curve(planned.drive, (v) => height - 18 - (v / most) * 14), fill: "none", stroke: "var(--ink-3)" }),
    ...planned.rivals.map((one, k) => svg("path", {
      d: curve(one.angle, (turns) => 6 + (height - 48) * (1 - (turns - low) / (high - low || 1))), fill: "none", stroke: colour(bench.next + k), "stroke-width": 1.75,
      "stroke-dasharray": k ? "5 3" : "none",
    })));
}

// ---- what the device found itself

function found(device) {
  const own = device.found;
  at("found").hidden = !own;
  if (!own) return;
  const verified = own.verified_rms_counts === null ? "" : `, ${counts(own.verified_rms_counts)} counts on what it had not seen`;
  const text = own.parameters ? own.parameters.map((one) => `${spoken(one.name)} ${digits(one.value, 4)} ${one.unit}`).join(" · ") : "";
  at("found").textContent = own.failure
    ? `The device says: ${own.failure}. ${text}` : `The device found ${text}: ${counts(own.rms_counts)} counts${verified}${good(own)}.`;
}

/** What the device says that its numbers are good for. */
function good(own) {
  if (!own.grade) return "";
  const grade = { floor: "good for all", control: "good for gains", no: "good for nothing" }[own.grade];
  return own.reason ? `; ${grade}: ${own.reason}` : `; ${grade}`;
}
