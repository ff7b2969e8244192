// What people see: on a desk and on a phone, by day and by night, and by those who read with their ears.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { after, before } from "node:test";
import { Desk, browser, open, settled, tab, test } from "./bench.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const SHOTS = process.env.SHOTS;
let chrome;
let desk;
before(async () => {
  chrome = await browser();
  desk = new Desk();
  desk.run("simulate --hide cogging --out rec.csv --seed 1");
  desk.run("simulate --hide cogging --out other.csv --seed 2");
  desk.run("demo --out demo.html");
});
after(async () => {
  await chrome?.close();
  desk?.clear();
});

// axe runs in the page's own world past its policy, as an extension would.
async function faults(page) {
  const session = await page.context().newCDPSession(page);
  await session.send("Runtime.evaluate", { expression: axe });
  const answer = await session.send("Runtime.evaluate", {
    expression: "axe.run().then((found) => JSON.stringify(found.violations))", awaitPromise: true, returnByValue: true,
  });
  const violations = JSON.parse(answer.result.value);
  return violations.filter((fault) => ["serious", "critical"].includes(fault.impact))
    .map((fault) => `${fault.id}: ${fault.nodes.map((node) => node.target.join(" ")).join(", ")}`);
}

async function looked(page, name) {
  const wide = await page.evaluate(() => document.scrollingElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `${name} is ${wide} pixels wider than the window`);
  if (SHOTS) {
    mkdirSync(SHOTS, { recursive: true });
    await page.screenshot({ path: `${SHOTS}/${name}.png`, fullPage: true });
  }
  assert.deepEqual(await faults(page), [], name);
}

for (const [width, height] of [[1280, 900], [390, 844]]) {
  for (const colorScheme of ["light", "dark"]) {
    test(`workbench and report at ${width} pixels, ${colorScheme}`, async () => {
      const options = { viewport: { width, height }, colorScheme };
      const empty = await desk.bench("");
      const start = await open(chrome, empty.url, options);
      await start.waitForSelector("#demo:visible");
      await looked(start, `start-${width}-${colorScheme}`);
      await start.context().close();
      await empty.end();

      const bench = await desk.bench("rec.csv --validate other.csv");
      const page = await open(chrome, bench.url, options);
      await settled(page, 1);
      await page.waitForSelector("#proposals article");
      await looked(page, `proposed-${width}-${colorScheme}`);
      await page.click("#add");
      await settled(page, 2);
      await looked(page, `added-${width}-${colorScheme}`);
      for (const name of ["failing", "response", "clock", "limits", "remedy", "hand", "searches", "log"]) {
        await tab(page, name);
        await settled(page, 2);
        await page.waitForTimeout(300);
        await looked(page, `tab-${name}-${width}-${colorScheme}`);
      }
      await page.context().close();
      await bench.end();

      const report = await open(chrome, `file://${desk.path("demo.html")}`, options);
      await report.locator("#timeline").scrollIntoViewIfNeeded();
      await report.waitForSelector("#timeline .main-svg");
      await looked(report, `report-${width}-${colorScheme}`);
      await report.context().close();
    });
  }
}
