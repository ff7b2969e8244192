// Makes elements of the page.

export const at = (id) => document.getElementById(id);

function filled(made, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, "");
    else made.setAttribute(name, value);
  }
  made.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return made;
}

/** An element of HTML with attributes, listeners (`onclick`) and children. */
export function el(tag, attributes = {}, ...children) {
  return filled(document.createElement(tag), attributes, children);
}

/** The same of SVG. */
export function svg(tag, attributes = {}, ...children) {
  return filled(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
}

/** A button; `does` is its listener. */
export function button(text, does, attributes = {}) {
  return el("button", { type: "button", class: "btn", onclick: does, ...attributes }, text);
}

/** A row of a table of facts: its name, and what there is to say. */
export const row = (...cells) => el("tr", {}, ...cells.map((text, k) => el(k ? "td" : "th", {}, text)));

/** Gives a file to the user. */
export function save(name, blob) {
  const link = el("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** A path along points `[x, y]`; `null` begins a new part. */
export function path(points) {
  let down = false;
  let text = "";
  for (const point of points) {
    if (!point) {
      down = false;
      continue;
    }
    text += `${down ? "L" : "M"}${point[0].toFixed(1)} ${point[1].toFixed(1)}`;
    down = true;
  }
  return text;
}
