// A law of one's own on the workbench, in a real browser.
import assert from "node:assert/strict";
import { close, error, opened, settled, test, workplace } from "./bench.mjs";

const LAW = "drag: torque = -c*w/(ws + abs(w)); c = 0.3 in [0, 5] V; ws = 40 in [1, 1000] rad/s";
const HIDDEN = "hidden: torque = -c*w/(ws + abs(w)); c = 0.5 in [0, 5] V; ws = 60 in [1, 1000] rad/s";

const at = workplace();

test("a law is drawn while it is typed, added, and taken away", async () => {
  for (const [name, seed] of [["rec.csv", 1], ["other.csv", 2]]) {
    at.desk.run(`simulate --effect ${HIDDEN.replaceAll(" ", "")} --seconds 8 --seed ${seed} --out ${name}`);
  }
  const [bench, page] = await opened(at, "rec.csv --validate other.csv");
  const before = await error(page);
  await page.click(".own-law summary");
  // What is wrong is said with its place.
  await page.fill("#law", LAW.replace("c*w", "c*w*w"));
  await page.waitForSelector("#law-fault");
  assert.match(await page.textContent("#law-fault"), /expected V.*\(character \d+\)/s);
  assert.ok(await page.isDisabled("#law-add"));
  // What is right is drawn over what the model misses.
  await page.fill("#law", LAW);
  await page.waitForSelector("#law-drawn svg circle.dot");
  assert.ok((await page.locator("#law-drawn svg circle.dot").count()) > 5);
  assert.match(await page.textContent("#law-drawn"), /drag: a torque; fitted: c 0 … 5/);
  await page.click("#law-add");
  await settled(page, 2);
  const after = await error(page);
  assert.ok(after < 0.4 && before > 100 * after, `${before} to ${after}`);
  await close(page, bench);
});
