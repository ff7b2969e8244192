// Starts the program and a browser, as a user would; ends both.
import { spawn, execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test as plain } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

export const SERVOID = process.env.SERVOID;
// The firmware as a program of this machine.
export const EMULATED = process.env.EMULATED ?? fileURLToPath(new URL("../../target/firmware/emulated", import.meta.url));
const BROWSER = process.env.CHROMIUM ?? ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);

// A test that fails if it waits for what never comes; the slowest takes half a minute.
export function test(name, body) {
  return plain(name, { timeout: 300_000 }, body);
}

// A folder of its own, in which servoid is run as at a shell.
export class Desk {
  constructor() {
    this.programs = [];
    this.folder = mkdtempSync(join(tmpdir(), "servoid-browser-"));
  }

  path(name) {
    return join(this.folder, name);
  }

  run(line) {
    return execFileSync(SERVOID, [...line.split(" "), "--quiet"], { cwd: this.folder, encoding: "utf8" });
  }

  // `servoid bench`, and the address that it prints.
  bench(line) {
    return this.served(`bench ${line}`);
  }

  // `servoid device bench` with an emulated device, likewise.
  device(line) {
    return this.served(`device bench --emulate --image ${EMULATED} ${line}`);
  }

  async served(line) {
    const args = [...line.split(" ").filter(Boolean), "--no-open", "--json", "-", "--quiet"];
    const program = spawn(SERVOID, args, { cwd: this.folder, stdio: ["ignore", "pipe", "inherit"] });
    this.programs.push(program);
    let text = "";
    const url = await new Promise((resolve, reject) => {
      program.stdout.on("data", (part) => {
        text += part;
        if (text.trimEnd().endsWith("}")) resolve(JSON.parse(text).url);
      });
      program.on("exit", (code) => reject(new Error(`servoid ${line} ended with ${code}`)));
    });
    const ended = new Promise((done) => program.on("exit", done));
    return { url, program, end: () => (program.kill("SIGINT"), ended) };
  }

  // Also of what a failed test has left running, which would keep this one alive.
  clear() {
    for (const program of this.programs) program.kill("SIGKILL");
    rmSync(this.folder, { recursive: true });
  }
}

export function browser() {
  const args = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync"];
  return chromium.launch({ executablePath: BROWSER, args });
}

// A browser and a desk for the tests of a file, on which `lines` have been run: `at.chrome`, `at.desk`.
export function workplace(...lines) {
  const place = {};
  before(async () => {
    place.chrome = await browser();
    place.desk = new Desk();
    for (const line of lines) place.desk.run(line);
  });
  after(async () => {
    await place.chrome?.close();
    place.desk?.clear();
  });
  return place;
}

// `servoid bench`, opened in the browser and at rest with so many models.
export async function opened(place, line, models = 1, options = {}) {
  const bench = await place.desk.bench(line);
  const page = await open(place.chrome, bench.url, options);
  await settled(page, models);
  return [bench, page];
}

// Ends a page and its program.
export async function close(page, bench) {
  await page.context().close();
  await bench.end();
}

// A page that keeps a list of everything it asked for, and of what went wrong on it.
export async function open(browser, url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options });
  const page = await context.newPage();
  page.asked = [];
  page.faults = [];
  page.on("request", (request) => page.asked.push(request.url()));
  page.on("pageerror", (error) => page.faults.push(String(error)));
  page.on("console", (message) => {
    if (message.type() === "error") page.faults.push(message.text());
  });
  await page.goto(url);
  return page;
}

// What the page asked for beyond `own`.
export function outside(page, own) {
  return page.asked.filter((url) => !url.startsWith(own) && !url.startsWith("data:") && !url.startsWith("blob:"));
}

// Nothing is being done, and what is shown has been drawn.
export async function settled(page, models) {
  await page.waitForFunction(
    (models) => document.getElementById("work").hidden && !document.getElementById("bench").hidden
      && document.querySelectorAll("#tree .node").length >= models,
    models, { timeout: 120_000 });
  const begun = Date.now();
  // Counted again: recordings that were exchanged have no model until the fit that follows begins.
  const rests = () => page.evaluate(async (models) => {
    const state = await (await fetch("state")).json();
    return !state.job && document.body.dataset.drawn === String(state.revision) && document.querySelectorAll("#tree .node").length >= models;
  }, models);
  while (!(await rests())) {
    if (Date.now() - begun > 120_000) throw new Error(`the page does not settle: ${await page.textContent("#fault")}`);
    await page.waitForTimeout(50);
  }
}

// Arms the device, and clicks what starts its motor; then the run is on the screen.
export async function start(page, id) {
  await page.click("#arm");
  await page.click(`#${id}:enabled`);
  await page.waitForSelector("#live:not([hidden])");
}

// Drags across the lanes, from one part of their width to another.
export async function drag(page, from, to) {
  const box = await page.locator("#lane-angle .u-over").boundingBox();
  await page.mouse.move(box.x + from * box.width, box.y + 20);
  await page.mouse.down();
  await page.mouse.move(box.x + to * box.width, box.y + 20, { steps: 5 });
  await page.mouse.up();
}

// What the program says of the bench.
export const state = (page) => page.evaluate(async () => (await fetch("state")).json());

// Every drawing stands in a place of its own height, fills it, and covers no other.
export async function drawnApart(page) {
  const wrong = await page.evaluate(() => {
    const found = [];
    const places = Array.from(document.querySelectorAll(".plot")).filter((div) => div.querySelector(".main-svg") && div.clientWidth > 0);
    const boxes = places.map((div) => div.getBoundingClientRect());
    places.forEach((div, k) => {
      const [box, svg] = [boxes[k], div.querySelector(".main-svg").getBoundingClientRect()];
      if (box.height < 150) found.push(`${div.id} is ${box.height} high`);
      if (Math.abs(svg.height - box.height) > 2 || Math.abs(svg.width - box.width) > 2) {
        found.push(`${div.id}: ${svg.width} x ${svg.height} in ${box.width} x ${box.height}`);
      }
      if (box.right > document.documentElement.clientWidth + 1) found.push(`${div.id} ends at ${box.right}`);
      boxes.slice(k + 1).forEach((other, j) => {
        const apart = box.bottom <= other.top + 1 || other.bottom <= box.top + 1 || box.right <= other.left + 1 || other.right <= box.left + 1;
        if (!apart) found.push(`${div.id} covers ${places[k + 1 + j].id}`);
      });
      // Titles of axes stand beside each other, and the legend above what is drawn.
      const titles = Array.from(div.querySelectorAll(".xtitle, .x2title"), (text) => text.getBoundingClientRect());
      titles.forEach((a, m) => titles.slice(m + 1).forEach((b) => {
        if (a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom) found.push(`${div.id}: titles of axes cover each other`);
      }));
      const legend = div.querySelector(".legend .bg")?.getBoundingClientRect();
      const frame = div.querySelector(".nsewdrag")?.getBoundingClientRect();
      if (legend && frame && legend.height > 0 && legend.bottom > frame.top + 2) found.push(`${div.id}: the legend lies on the drawing`);
    });
    return found;
  });
  if (wrong.length) throw new Error(wrong.join("\n"));
}

// Through light and dark, and windows of several widths.
export async function turnAndResize(page) {
  for (const width of [1280, 1100, 390, 1280]) {
    await page.click("[data-switch-theme], #theme");
    await page.setViewportSize({ width, height: 900 });
    await page.waitForTimeout(700);
    await drawnApart(page);
  }
}

// Files dropped on the page.
export async function drop(page, files) {
  const data = await page.evaluateHandle((files) => {
    const data = new DataTransfer();
    // Characters below 256 that are no text stand for bytes.
    const bytes = (text) => (/^[\u0080-\u00ff]/.test(text) ? Uint8Array.from(text, (c) => c.charCodeAt(0)) : text);
    for (const [name, text] of files) data.items.add(new File([bytes(text)], name));
    return data;
  }, files);
  await page.dispatchEvent("#drop", "drop", { dataTransfer: data });
}

// The error that is shown, once it no longer counts.
export async function error(page) {
  let before = null;
  for (;;) {
    const text = await page.textContent("#error-now");
    if (text === before) return Number(text.replace(/[\s\u202f]/g, "").replace("\u2212", "-"));
    before = text;
    await page.waitForTimeout(120);
  }
}

// Opens a tab beneath the lanes.
export async function tab(page, name) {
  if ((await page.getAttribute(`#tab-${name}`, "aria-selected")) !== "true") await page.click(`#tab-${name}`);
}

// Adds an effect by its name, whatever is proposed.
export async function add(page, effect) {
  await page.selectOption("#effect", effect);
  await page.click("#add-any");
}
