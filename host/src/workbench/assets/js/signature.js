// An effect's signature: the volts that the motor asked for without it as dots, and the effect's own equation over the same motion.

import { path, svg } from "./elements.js";
import { digits } from "./numbers.js";

/** Draws one; `labels` names the axes. Without a quantity that tells the effect there is nothing to draw. */
export function signature(found, { width, height, stroke, labels = false }) {
  const box = svg("svg", { class: "sig sigbox", width, height, viewBox: `0 0 ${width} ${height}`, "aria-hidden": "true" });
  if (!found || !found.curve.length) {
    if (labels) box.append(svg("text", { x: 8, y: 18 }, "No single quantity tells this effect."));
    return box;
  }
  const bins = found.bins.filter(([, y]) => Number.isFinite(y));
  const xs = [...found.curve.map((p) => p[0]), ...bins.map((b) => b[0])];
  const [low, high] = [Math.min(...xs), Math.max(...xs)];
  const most = Math.max(...found.curve.map((p) => Math.abs(p[1])), ...bins.map((b) => Math.abs(b[1]))) || 1;
  const pad = labels ? { left: 34, right: 8, top: 24, bottom: 20 } : { left: 4, right: 4, top: 5, bottom: 5 };
  const X = (x) => pad.left + ((x - low) / (high - low || 1)) * (width - pad.left - pad.right);
  const Y = (y) => pad.top + (1 - (y / most + 1.1) / 2.2) * (height - pad.top - pad.bottom);
  box.append(svg("path", { class: "ax", d: path([[pad.left, Y(0)], [width - pad.right, Y(0)]]) }));
  if (low < 0 && high > 0) box.append(svg("path", { class: "ax", d: path([[X(0), pad.top], [X(0), height - pad.bottom]]) }));
  box.append(svg("path", {
    d: path(found.curve.map(([x, y]) => [X(x), Y(y)])), fill: "none", stroke, "stroke-width": labels ? 2 : 1.75, "stroke-linejoin": "round",
  }));
  for (const [x, y, error] of bins) {
    if (labels && error) box.append(svg("path", { class: "err", d: path([[X(x), Y(y - 2 * error)], [X(x), Y(y + 2 * error)]]) }));
    box.append(svg("circle", { class: "dot", cx: X(x), cy: Y(y), r: labels ? 2.5 : 1.5 }));
  }
  if (labels) {
    const text = (x, y, said, anchor = "start") => svg("text", { x, y, "text-anchor": anchor }, said);
    box.append(
      text(8, 15, "missing drive, V"), text(width - 66, 15, "yours", "end"), text(width - 8, 15, "physics", "end"),
      svg("circle", { class: "dot", cx: width - 100, cy: 11, r: 2.5 }),
      svg("path", { d: `M${width - 60} 11h10`, stroke, "stroke-width": 2 }),
      text(30, Y(most) + 4, digits(most, 2), "end"), text(30, Y(-most) + 4, digits(-most, 2), "end"),
      text(pad.left, height - 5, digits(low, 2)), text(width - 8, height - 5, `${found.against}, ${found.unit} ${digits(high, 2)}`, "end"));
  }
  return box;
}
