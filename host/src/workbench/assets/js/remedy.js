// From answer to remedy: the speed loop of the fitted motor, before and after what is known of its effects.

import { ask } from "./ask.js";
import { colour, spoken } from "./names.js";
import { button, el, path, svg } from "./elements.js";
import { digits, times } from "./numbers.js";

const [WIDE, HIGH, LEFT, BOTTOM] = [760, 190, 44, 20];

/** Fills a place with it. */
export async function show(place, bench, does) {
  const found = await ask("remedy");
  const fall = found.rms_before / found.rms_after;
  const row = (name, value, unit, from) => el("tr", {}, el("th", {}, name, from ? el("span", { class: "dim" }, ` ${spoken(from)}`) : null),
    el("td", {}, digits(value, 4)), el("td", { class: "dim" }, unit));
  const rows = [row("kp", found.kp, "V·s/rad"), row("ki", found.ki, "V/rad"), row("kV", found.k_v, "V·s/rad"), row("kA", found.k_a, "V·s²/rad")];
  if (found.k_s !== null) rows.push(row("kS", found.k_s, "V", found.k_s_from));
  if (found.k_g !== null) rows.push(row("kG", found.k_g, "V", found.k_g_from));
  const knows = spoken([found.k_s_from, found.k_g_from, ...found.by_angle.map((name) => `${name} by a table of the angle`), found.crossing && "backlash"].filter(Boolean).join(", "));
  place.replaceChildren(el("div", { class: "remedy" },
    el("div", {}, el("h2", {}, `Speed error ${found.crossing ? "of the load " : ""}in closed loop, on the fitted motor`),
      el("p", { class: "falls" }, el("span", { class: "quiet" }, `${digits(found.rms_before, 3)}`), "→",
        el("span", { class: "to", style: `color:${colour(bench.chosen)}` }, digits(found.rms_after, 3)), el("span", { class: "quiet s12" }, `rad/s RMS${fall > 1.05 ? `, ÷ ${times(fall)}` : ""}`)),
      el("p", { class: "quiet s12" }, knows ? `A PI controller with the feed-forward of a linear motor; then ${knows} as well.` : "This model has nothing that a feed-forward could compensate beyond a linear motor's."),
      found.crossing ? crossed(found.crossing) : null,
      el("table", { class: "facts" }, ...rows),
      el("p", { class: "acts" }, button("Export the gains", does.exports, { class: "btn sm" }))),
    drawn(found, bench)));
}

// The encoder sits before the gap: what is won is the load's angle.
function crossed({ gap_rad, time_s, rms_before, rms_after }) {
  const [gap, time] = [`${digits(gap_rad * 1e3, 3)} mrad`, `${digits(time_s * 1e3, 2)} ms`];
  return el("p", { class: "quiet s12" }, "Where the wanted acceleration reverses, the motor crosses the gap of ", gap, ` within ${time} ahead of its load. `,
    "Load's angle error ", el("strong", {}, `${digits(rms_before * 1e3, 3)} → ${digits(rms_after * 1e3, 3)} mrad`), " RMS.");
}

function drawn(found, bench) {
  const time = found.time_s;
  const errors = { before: found.before.map((w, k) => w - found.wanted[k]), after: found.after.map((w, k) => w - found.wanted[k]) };
  const most = 1.1 * Math.max(...errors.before.map(Math.abs), ...errors.after.map(Math.abs));
  const X = (t) => LEFT + (t / time.at(-1)) * (WIDE - LEFT - 8);
  const Y = (w) => 8 + (1 - (w / most + 1) / 2) * (HIGH - BOTTOM - 8);
  const line = (values) => path(values.map((w, k) => [X(time[k]), Y(w)]));
  const text = (x, y, said, anchor) => svg("text", { x, y, "text-anchor": anchor }, said);
  const round = Number(most.toPrecision(1)) / 2;
  const widest = Math.max(...found.wanted);
  // Where the wanted speed reverses, friction does, too.
  const turns = time.filter((t, k) => k && found.wanted[k - 1] * found.wanted[k] < 0);
  return el("figure", {},
    el("figcaption", { class: "legend" },
      el("span", { class: "key" }, el("span", { class: "swatch", style: "color:var(--ink-3)" }), "linear feed-forward"),
      el("span", { class: "key" }, el("span", { class: "swatch", style: `color:${colour(bench.chosen)}` }), "effects compensated"),
      el("span", { class: "quiet s12" }, `speed less wanted, rad/s, as ±${digits(widest, 3)} rad/s are wanted`)),
    svg("svg", { viewBox: `0 0 ${WIDE} ${HIGH}`, width: "100%", role: "img", "aria-label": "Error of the speed over time" },
      ...turns.map((t) => svg("path", { class: "grid", d: `M${X(t)} 8V${HIGH - BOTTOM}` })),
      ...[-round, 0, round].flatMap((w) => [svg("path", { class: "grid", d: `M${LEFT} ${Y(w)}H${WIDE - 8}` }), text(LEFT - 6, Y(w) + 4, digits(w, 2), "end")]),
      svg("path", { d: line(errors.before), fill: "none", stroke: "var(--ink-3)", "stroke-width": 1.25 }),
      svg("path", { d: line(errors.after), fill: "none", stroke: colour(bench.chosen), "stroke-width": 1.25 }),
      text(LEFT, HIGH - 4, "0", "start"), text(WIDE - 8, HIGH - 4, `${digits(time.at(-1), 3)} s`, "end")));
}
