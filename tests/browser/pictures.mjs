// Takes the pictures of the workbench that README and book show: SERVOID=target/release/servoid node tests/browser/pictures.mjs
import { mkdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { Desk, browser, error, open, settled, start, tab } from "./bench.mjs";

const docs = join(dirname(fileURLToPath(import.meta.url)), "../../docs");
const images = join(docs, "book/src/images");
mkdirSync(images, { recursive: true });
const desk = new Desk();
const chrome = await browser();
try {
  for (const [name, seed] of [["rec.csv", 1], ["other.csv", 2]]) {
    desk.run(`simulate --hide coulomb --hide cogging --excite commissioning-coast --out ${name} --seed ${seed}`);
  }
  const bench = await desk.bench("rec.csv --validate other.csv");
  const page = await open(chrome, bench.url, { viewport: { width: 1280, height: 800 }, colorScheme: "light" });
  const take = async (path) => {
    await error(page);
    await page.mouse.move(640, 20);
    await page.waitForTimeout(600);
    await page.screenshot({ path });
  };
  await settled(page, 1);
  await take(join(images, "bench-first.png"));
  await page.click("#add");
  await settled(page, 2);
  await take(join(docs, "workbench.png"));
  await page.click("#add");
  await settled(page, 3);
  await take(join(images, "bench-explained.png"));
  await tab(page, "failing");
  await page.waitForSelector("#dock .curves");
  await take(join(images, "bench-fails.png"));
  await bench.end();
  // A motor under way: an experiment that decides, with both models running along.
  const device = await desk.device("--hide coulomb --no-coast --counts-per-rev 64 --amplitude 0.3 --pace 1");
  const live = await open(chrome, device.url, { viewport: { width: 1280, height: 800 }, colorScheme: "light" });
  await start(live, "record");
  await live.waitForSelector("#live", { state: "hidden", timeout: 60_000 });
  await settled(live, 1);
  await live.click("#plan");
  await live.waitForSelector("#play", { timeout: 120_000 });
  await live.screenshot({ path: join(images, "bench-plan.png") });
  await start(live, "play");
  await live.waitForFunction(() => Number.parseFloat(document.getElementById("live-time").textContent) > 10);
  await live.screenshot({ path: join(images, "bench-live.png") });
  await device.end();
} finally {
  await chrome.close();
  desk.clear();
}
