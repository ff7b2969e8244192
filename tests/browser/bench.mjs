// Starts the program and a browser, as a user would; ends both.
import { spawn, execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

export const SERVOID = process.env.SERVOID;
const BROWSER = process.env.CHROMIUM ?? ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);

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
  async bench(line) {
    const args = ["bench", ...line.split(" ").filter(Boolean), "--no-open", "--json", "-", "--quiet"];
    const program = spawn(SERVOID, args, { cwd: this.folder, stdio: ["ignore", "pipe", "inherit"] });
    this.programs.push(program);
    let text = "";
    const url = await new Promise((resolve, reject) => {
      program.stdout.on("data", (part) => {
        text += part;
        if (text.trimEnd().endsWith("}")) resolve(JSON.parse(text).url);
      });
      program.on("exit", (code) => reject(new Error(`servoid bench ended with ${code}`)));
    });
    return { url, program, end: () => new Promise((done) => { program.on("exit", done); program.kill("SIGINT"); }) };
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
    (models) => document.getElementById("stop").hidden && !document.getElementById("bench").hidden
      && document.querySelectorAll("#models tbody tr").length >= models,
    models, { timeout: 120_000 });
  const begun = Date.now();
  const rests = () => page.evaluate(async () => {
    const state = await (await fetch("state")).json();
    return !state.job && document.body.dataset.drawn === String(state.revision);
  });
  while (!(await rests())) {
    if (Date.now() - begun > 120_000) throw new Error(`the page does not settle: ${await page.textContent("#fault")}`);
    await page.waitForTimeout(50);
  }
}

// Files dropped on the page.
export async function drop(page, files) {
  const data = await page.evaluateHandle((files) => {
    const data = new DataTransfer();
    for (const [name, text] of files) data.items.add(new File([text], name));
    return data;
  }, files);
  await page.dispatchEvent("#drop", "drop", { dataTransfer: data });
}

export const error = async (page) => Number(await page.textContent("#error-now"));
