// Work on the workbench that goes on, is stopped, and is taken away, in a real browser.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { add, browser, close, drop, error, open, opened, settled, tab, test, workplace } from "./bench.mjs";

const at = workplace(
  "simulate --hide coulomb --out rec.csv --seed 1",
  "simulate --hide coulomb --out other.csv --seed 2",
);

test("killing the browser stops the work", async () => {
  const bench = await at.desk.bench("rec.csv");
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

test("searches race, and what was found is taken away", async () => {
  const [bench, page] = await opened(at, "rec.csv");
  await tab(page, "searches");
  await page.fill("#budget", "200");
  await page.fill("#seeds", "3");
  await page.click("#race");
  await page.waitForSelector("#bench-curves .main-svg", { timeout: 120_000 });
  const raced = await page.evaluate(() => document.getElementById("bench-curves").data.map((line) => line.name).filter(Boolean));
  assert.deepEqual(raced, ["ga", "pso", "firefly"]);
  await settled(page, 1);
  for (const [format, holds] of [["report", "<!doctype html>"], ["session", "servoid.session/1"], ["fit", "servoid.fit/1"],
    ["csv", "gain"], ["c", "#ifndef"]]) {
    await page.click("#export");
    const [download] = await Promise.all([page.waitForEvent("download"), page.click(`[data-format=${format}]`)]);
    assert.ok(readFileSync(await download.path(), "utf8").includes(holds), format);
  }
  // What needs more than the recording tells says so.
  await page.click("#export");
  await page.click("[data-format=urdf]");
  await page.waitForFunction(() => document.getElementById("fault").textContent.includes("resistance_ohm"));
  assert.doesNotMatch(await page.textContent("#fault"), /--/);
  // What goes right afterwards takes the message away.
  await page.click("#export");
  await Promise.all([page.waitForEvent("download"), page.click("[data-format=toml]")]);
  await page.waitForFunction(() => document.getElementById("fault").hidden);
  await close(page, bench);
});

test("while work goes on the bench stays true, and what is stopped says so", async () => {
  const bench = await at.desk.bench("rec.csv --validate other.csv");
  let page = await open(at.chrome, bench.url);
  await settled(page, 1);
  const first = await error(page);
  await add(page, "coulomb");
  await settled(page, 2);
  const says = (words) => page.waitForFunction((words) => document.getElementById("fault").textContent.includes(words), words,
    { timeout: 60_000 });
  const stopped = () => page.waitForFunction(() => document.getElementById("work").hidden, null, { timeout: 60_000 });
  await tab(page, "searches");
  for (const [field, value, words] of [["#budget", "1.5", "1.5 does not do"], ["#seeds", "-5", "-5 does not do"]]) {
    const before = await page.inputValue(field);
    await page.fill(field, value);
    await page.click("#race");
    await says(words);
    await page.fill(field, before);
  }
  await page.fill("#budget", "20000");
  await page.fill("#seeds", "100");
  await page.click("#race");
  await page.waitForSelector("#stop:visible");
  await drop(page, [["other.csv", readFileSync(at.desk.path("other.csv"), "utf8")]]);
  await says("busy (race)");
  // The model that is looked at goes, with its number and its line.
  await page.focus("#tree [data-model='2']");
  await page.keyboard.press("Delete");
  await page.waitForFunction(() => document.querySelectorAll("#tree .node").length === 1);
  assert.equal(await error(page), first);
  await page.waitForFunction(() => document.body.dataset.lanes.startsWith("1"));
  assert.ok(await page.isVisible("#stop"));
  await page.click("#stop");
  await stopped();
  await says("race: stopped");
  // A refusal is no fault of the page.
  assert.deepEqual(page.faults.filter((text) => !text.includes("status of 422")), []);
  await close(page, bench);

  // Two minutes with cogging are looked at for many seconds: long enough for a hand to stop it.
  at.desk.run("simulate --hide cogging --seconds 120 --out long.csv --seed 1");
  const slow = await at.desk.bench("long.csv");
  page = await open(at.chrome, slow.url);
  await settled(page, 1);
  await page.click("#diagnose");
  await page.click("#stop");
  await stopped();
  await says("diagnose: stopped");
  assert.doesNotMatch(await page.textContent("#fault"), /lm/);
  assert.deepEqual(page.faults, []);
  await close(page, slow);
});

test("whoever has no secret finds nothing", async () => {
  const bench = await at.desk.bench("");
  const { origin, host } = new URL(bench.url);
  for (const path of ["/", "/state", "/0123/", "/js/main.js"]) {
    assert.equal((await fetch(origin + path)).status, 404, path);
  }
  const foreign = await fetch(`${bench.url}state`, { headers: { origin: "http://evil.example" } });
  assert.equal(foreign.status, 403);
  assert.match(host, /^127\.0\.0\.1:\d+$/);
  const page = await fetch(bench.url);
  assert.match(page.headers.get("content-security-policy"), /default-src 'none'/);
  await bench.end();
});
