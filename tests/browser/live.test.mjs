// A device on the workbench, in a real browser: the motor is armed, recorded, watched, stopped and commissioned from the page.
import assert from "node:assert/strict";
import { existsSync, readdirSync } from "node:fs";
import { close, open, settled, start, state, test, workplace } from "./bench.mjs";

const at = workplace();

const over = (page) => page.waitForSelector("#live", { state: "hidden", timeout: 60_000 });

test("armed, the motor is recorded; a model runs along the next run; Esc stops it, and what was recorded is kept", async () => {
  const bench = await at.desk.device("--hide coulomb --runs kept");
  const page = await open(at.chrome, bench.url, { viewport: { width: 1280, height: 800 } });
  await page.waitForSelector("#device:not([hidden])");
  for (const id of ["record", "commission"]) assert.equal(await page.isEnabled(`#${id}`), false, "nothing turns the motor before it is armed");
  // Nor does a request that leaves the page aside.
  const refused = await page.evaluate(async () => (await fetch("work", {
    method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify({ what: "record", seconds: 5 }),
  })).json());
  assert.match(refused.error, /arm the device first/);
  page.faults.length = 0;

  await start(page, "record");
  await page.waitForFunction(() => Number.parseFloat(document.getElementById("live-time").textContent) > 2);
  await over(page);
  await settled(page, 1);
  assert.deepEqual((await state(page)).recording.sources.map((one) => one.role), ["fitted"]);

  await start(page, "record");
  await page.waitForSelector("#live-models .tag");
  await page.waitForFunction(() => Number.parseFloat(document.getElementById("live-time").textContent) > 5);
  assert.equal(await page.evaluate(() => document.documentElement.scrollHeight <= innerHeight), true, "the run needs no scrolling");
  const begun = Date.now();
  await page.keyboard.press("Escape");
  await over(page);
  assert.ok(Date.now() - begun < 2000, "a stop takes no time");
  await settled(page, 1);
  const [first, second] = (await state(page)).recording.sources;
  assert.deepEqual([first.role, second.role], ["fitted", "held out"]);
  assert.ok(second.seconds > 4 && second.seconds < first.seconds - 1, `${second.seconds} of ${first.seconds} s`);
  assert.deepEqual(readdirSync(at.desk.path("kept")), ["001-record", "002-record"]);
  assert.ok(existsSync(at.desk.path("kept/002-record/recording.csv")));
  assert.deepEqual(page.faults, []);
  await close(page, bench);
});

test("the experiment that decides is planned, recorded with both models running along, and decides", async () => {
  // A third of the supply, an encoder of 32 counts and no coasting: a drop at the brushes does what friction does. 64 counts tell them apart.
  const bench = await at.desk.device("--hide coulomb --no-coast --counts-per-rev 32 --amplitude 0.3");
  const page = await open(at.chrome, bench.url, { viewport: { width: 1280, height: 800 } });
  await start(page, "record");
  await over(page);
  await settled(page, 1);
  await page.click("#plan");
  await page.waitForSelector("#play", { timeout: 120_000 });
  const { planned } = (await state(page)).device;
  assert.ok(planned.missed_counts > 1 && planned.voltage_v <= 0.3 * 12 + 1e-9, JSON.stringify([planned.missed_counts, planned.voltage_v]));
  const rivals = planned.rivals.map((one) => one.effect);
  assert.ok(rivals.includes("coulomb") && rivals.length > 1, rivals.join());
  await start(page, "play");
  await page.waitForFunction((count) => document.querySelectorAll("#live-models .tag").length === count, rivals.length);
  await over(page);
  await settled(page, rivals.length);
  const after = await state(page);
  assert.deepEqual(after.models.find((model) => model.id === after.chosen).effects, ["coulomb"], "the experiment decides for what is there");
  assert.equal(after.recording.sources.length, 2);
  await close(page, bench);
});

test("a motor is commissioned from the page, and the host fits what it recorded", async () => {
  const bench = await at.desk.device("");
  const page = await open(at.chrome, bench.url);
  await page.evaluate(() => {
    const stage = document.getElementById("live-stage");
    window.stages = new Set();
    new MutationObserver(() => window.stages.add(stage.textContent)).observe(stage, { childList: true });
  });
  await start(page, "commission");
  await page.waitForSelector("#live:not([hidden])");
  await page.waitForSelector("#live", { state: "hidden", timeout: 180_000 });
  // The bench runs faster than life: a short stage may pass between two looks of the page, all of them may not.
  const stages = (await page.evaluate(() => [...window.stages])).filter((said) => /^(Probing|Exciting|Recording|The device is fitting|Verifying)/.test(said));
  assert.ok(stages.length >= 1, stages.join("; "));
  await settled(page, 1);
  assert.match(await page.textContent("#found"), /The device found .*counts/);
  const after = await state(page);
  assert.deepEqual(after.recording.sources.map((one) => one.role), ["fitted", "held out"]);
  assert.equal(after.models[0].explained, true, "a linear motor, and nothing else");
  await close(page, bench);
});
