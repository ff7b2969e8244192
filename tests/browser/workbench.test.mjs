// The workbench in a real browser.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { Desk, browser, drop, error, open, outside, settled } from "./bench.mjs";

let chrome;
let desk;
before(async () => {
  chrome = await browser();
  desk = new Desk();
  desk.run("simulate --hide coulomb --out rec.csv --seed 1");
  desk.run("simulate --hide coulomb --out other.csv --seed 2");
});
after(async () => {
  await chrome?.close();
  desk?.clear();
});

test("open, fit, add the suggested effect, and the error falls at least fifty-fold", async () => {
  const bench = await desk.bench("rec.csv --validate other.csv");
  const page = await open(chrome, bench.url);
  await settled(page, 1);
  const first = await error(page);
  await page.click("#suggest");
  await page.click("#suggestions button:text('Add coulomb')");
  await settled(page, 2);
  const second = await error(page);
  assert.ok(first / second >= 50, `from ${first} to ${second}`);
  // The ladder has grown a step, and the residual in the drawing has shrunk as the number says.
  const rungs = await page.evaluate(() => document.getElementById("bench-error-ladder").data[0].x.length);
  assert.equal(rungs, 2);
  const spread = await page.evaluate(() => {
    const lines = document.getElementById("bench-timeline").data.filter((line) => line.yaxis === "y2");
    return lines.map((line) => Math.max(...line.y.map(Math.abs)));
  });
  assert.equal(spread.length, 2);
  assert.ok(spread[0] / spread[1] > 20, `residuals of ${spread}`);
  // Nothing came from anywhere else, and nothing went wrong on the way.
  assert.deepEqual(outside(page, bench.url), []);
  assert.deepEqual(page.faults, []);
  // A slider moves the model at once, and putting it back puts it back.
  await page.click("text=Move its constants by hand");
  await page.locator("#sliders input").first().fill("700");
  await page.waitForFunction(() => document.getElementById("by-hand").textContent.includes("moved by hand"));
  await page.click("#put-back");
  await page.waitForFunction(() => document.getElementById("by-hand").textContent === "");
  // Without the effect again: that model is on the bench already, and is looked at.
  await page.click("#effects button");
  await settled(page, 2);
  assert.ok(Math.abs((await error(page)) / first - 1) < 0.01);
  await page.context().close();
  await bench.end();
});

test("a blind demonstration: name what is missing, then reveal it", async () => {
  const bench = await desk.bench("");
  const page = await open(chrome, bench.url);
  // By the keyboard alone.
  await page.focus("#demo");
  await page.keyboard.press("Enter");
  await settled(page, 1);
  assert.equal(await page.textContent("#secret"), "");
  await page.click("#diagnose");
  await page.waitForFunction(() => document.getElementById("verdict").textContent !== "", null, { timeout: 180_000 });
  await settled(page, 1);
  await page.click("#reveal");
  await page.waitForFunction(() => document.getElementById("secret").textContent.startsWith("Hidden was "));
  assert.deepEqual(page.faults, []);
  await page.context().close();
  await bench.end();
});

test("a bad file shows the reader's message, a foreign one asks which column is what", async () => {
  const bench = await desk.bench("");
  const page = await open(chrome, bench.url);
  await drop(page, [["garbage.csv", "t_s,voltage_v,angle_counts\n0,1,0\n0.001,x,3\n"]]);
  await page.waitForSelector("#columns[open]");
  await page.fill("#map-counts_per_rev", "2000");
  await page.locator("#map-counts_per_rev").blur();
  await page.waitForFunction(() => document.getElementById("column-fault").textContent.includes("garbage.csv:3:"));
  assert.ok(await page.isDisabled("#load"));
  await page.click("#columns button[value=cancel]");
  // The same recording under names of somebody else.
  const foreign = readFileSync(desk.path("rec.csv"), "utf8").replace("t_s,voltage_v,angle_counts", "when,u,enc");
  await drop(page, [["foreign.csv", foreign]]);
  await page.waitForSelector("#columns[open]");
  await page.selectOption("#map-time", "when");
  await page.fill("#map-counts_per_rev", "2000");
  await page.locator("#map-counts_per_rev").blur();
  await page.waitForFunction(() => !document.getElementById("load").disabled);
  await page.click("#load");
  await settled(page, 1);
  assert.match(await page.textContent("#about"), /foreign\.csv: 20000 samples/);
  // A session that is none.
  await drop(page, [["other.json", "{\"schema\": \"x\"}"]]);
  await page.waitForFunction(() => document.getElementById("fault").textContent.includes("schema is `x`"));
  await page.context().close();
  await bench.end();
});

test("a second tab does not break the first, and a session is opened again as it was", async () => {
  const bench = await desk.bench("rec.csv --validate other.csv --session kept.json");
  const first = await open(chrome, bench.url);
  const second = await open(chrome, bench.url);
  await settled(first, 1);
  await settled(second, 1);
  await second.selectOption("#effect", "coulomb");
  await second.click("#add");
  await settled(second, 2);
  await settled(first, 2);
  assert.equal(await error(first), await error(second));
  await second.context().close();
  await first.click("#suggest");
  await first.waitForFunction(() => document.getElementById("suggestions").textContent.includes("Nothing"));
  const shown = await error(first);
  await first.context().close();
  await bench.end();
  const again = await desk.bench("kept.json");
  const page = await open(chrome, again.url);
  await settled(page, 2);
  assert.equal(await error(page), shown);
  await page.context().close();
  await again.end();
});

test("killing the browser stops the work", async () => {
  const bench = await desk.bench("rec.csv");
  const alone = await browser();
  const page = await open(alone, bench.url);
  await settled(page, 1);
  const asked = { what: "race", algorithms: ["ga", "pso"], effects: ["cogging"], budget: 20000, seeds: 100 };
  await page.evaluate((asked) => fetch("work", {
    method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(asked),
  }), asked);
  const job = async () => (await (await fetch(`${bench.url}state`)).json()).job;
  assert.equal(await job(), "race");
  await alone.close();
  // Two seconds of patience, and the time that a model evaluation takes.
  const begun = Date.now();
  while ((await job()) !== null) {
    assert.ok(Date.now() - begun < 60_000, "the race goes on with nobody watching");
    await new Promise((done) => setTimeout(done, 200));
  }
  await bench.end();
});

test("a recording of twenty minutes is thinned for drawing, never for what is near", async () => {
  desk.run("simulate --hide coulomb --seconds 1200 --out long.csv --seed 3 --no-motor");
  const bench = await desk.bench("long.csv --counts-per-rev 2000 --supply-v 12");
  const page = await open(chrome, bench.url);
  await settled(page, 1);
  const drawn = () => page.evaluate(() => {
    const { data, layout } = document.getElementById("bench-timeline");
    return { points: data.map((line) => line.x.length), step: data[0].x[2] - data[0].x[1], range: layout.xaxis.range };
  });
  assert.ok(Math.max(...(await drawn()).points) < 8000);
  await page.evaluate(() => Plotly.relayout("bench-timeline", { "xaxis.range": [600, 600.5] }));
  await page.waitForFunction(() => document.getElementById("bench-timeline").data[0].x.length < 600);
  const near = await drawn();
  assert.ok(Math.abs(near.step - 0.001) < 1e-6, `every sample of half a second is drawn, ${near.step} s apart`);
  await page.context().close();
  await bench.end();
});

test("searches race, and what was found is taken away", async () => {
  const bench = await desk.bench("rec.csv");
  const page = await open(chrome, bench.url);
  await settled(page, 1);
  await page.click("text=Let searches race");
  await page.fill("#budget", "200");
  await page.fill("#seeds", "3");
  await page.click("#race");
  await page.waitForSelector("#bench-curves .main-svg", { timeout: 120_000 });
  const raced = await page.evaluate(() => document.getElementById("bench-curves").data.map((line) => line.name).filter(Boolean));
  assert.deepEqual(raced, ["ga", "pso", "firefly"]);
  await settled(page, 1);
  for (const [format, holds] of [["report", "<!doctype html>"], ["session", "servoid.session/1"], ["fit", "servoid.fit/1"],
    ["csv", "gain"], ["c", "#ifndef"]]) {
    await page.selectOption("#format", format);
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("#take")]);
    assert.ok(readFileSync(await download.path(), "utf8").includes(holds), format);
  }
  // What needs more than the recording tells says so.
  await page.selectOption("#format", "urdf");
  await page.click("#take");
  await page.waitForFunction(() => document.getElementById("fault").textContent.includes("--known"));
  await page.context().close();
  await bench.end();
});

test("whoever has no secret finds nothing", async () => {
  const bench = await desk.bench("");
  const { origin, host } = new URL(bench.url);
  for (const path of ["/", "/state", "/0123/", "/bench.js"]) {
    assert.equal((await fetch(origin + path)).status, 404, path);
  }
  const foreign = await fetch(`${bench.url}state`, { headers: { origin: "http://evil.example" } });
  assert.equal(foreign.status, 403);
  assert.match(host, /^127\.0\.0\.1:\d+$/);
  const page = await fetch(bench.url);
  assert.match(page.headers.get("content-security-policy"), /default-src 'none'/);
  await bench.end();
});
