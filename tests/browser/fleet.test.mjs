// The page of a fleet in a real browser.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { open, outside, test, workplace } from "./bench.mjs";

const at = workplace();
const MOTORS = 30;
const ODD = "17.csv";

test("an odd motor unfolds what was found of it, from the list and from a drawing", async () => {
  mkdirSync(at.desk.path("logs"));
  for (let motor = 0; motor < MOTORS; motor += 1) {
    const name = `${String(motor).padStart(2, "0")}.csv`;
    const torque = name === ODD ? 0.009 : 0.003 * (1 + 0.2 * (((motor * 7) % MOTORS) / MOTORS - 0.5));
    at.desk.run(`simulate --seconds 3 --hide coulomb:torque=${torque} --seed ${motor} --out logs/${name}`);
  }
  at.desk.run("batch logs --out results --do fit --with coulomb");
  at.desk.run("fleet results --report fleet.html");
  const url = `file://${at.desk.path("fleet.html")}`;
  const page = await open(at.chrome, url);
  const own = page.locator(`details.unfold[data-name="${ODD}"]`);
  await own.locator("summary").click();
  assert.match(await own.innerText(), /coulomb\.torque/);
  await own.locator("summary").click();
  assert.ok(!(await own.evaluate((one) => one.open)));
  // The diamond in the drawing of the friction.
  const place = await page.evaluate(() => {
    const figures = Array.from(document.querySelectorAll("figure"));
    const plot = figures.find((one) => one.querySelector("h3").textContent === "coulomb.torque").querySelector(".plot");
    plot.scrollIntoView({ block: "center" });
    return plot.id;
  });
  const diamond = page.locator(`#${place} .scatterlayer .point`).last();
  await diamond.waitFor({ state: "attached" });
  const box = await diamond.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.up();
  await page.waitForFunction((name) => document.querySelector(`details.unfold[data-name="${name}"]`).open, ODD);
  assert.deepEqual(outside(page, url), []);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});
