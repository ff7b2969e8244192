// What people see: on a desk and on a phone, by day and by night, and by those who read with their ears.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { close, open, settled, tab, test, workplace } from "./bench.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const SHOTS = process.env.SHOTS;
const at = workplace(
  "simulate --hide cogging --out rec.csv --seed 1",
  "simulate --hide cogging --out other.csv --seed 2",
  "demo --out demo.html",
);

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
      const empty = await at.desk.bench("");
      const start = await open(at.chrome, empty.url, options);
      await start.waitForSelector("#demo:visible");
      await looked(start, `start-${width}-${colorScheme}`);
      await close(start, empty);

      const bench = await at.desk.bench("rec.csv --validate other.csv");
      const page = await open(at.chrome, bench.url, options);
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
      await close(page, bench);

      const report = await open(at.chrome, `file://${at.desk.path("demo.html")}`, options);
      await report.locator("#timeline").scrollIntoViewIfNeeded();
      await report.waitForSelector("#timeline .main-svg");
      await looked(report, `report-${width}-${colorScheme}`);
      await report.context().close();
    });
  }
}
