// The report in a real browser, from a double click.
import assert from "node:assert/strict";
import { open, outside, test, turnAndResize, workplace } from "./bench.mjs";

const at = workplace(
  "demo --out demo.html",
);

// Scrolls through the page until every picture is drawn. A picture that is drawn above can push the awaited one out of view, so
// that every look at it scrolls again.
async function drawn(page) {
  const places = await page.locator(".plot").count();
  for (let k = 0; k < places; k += 1) {
    await page.waitForFunction((k) => {
      const plot = document.querySelectorAll(".plot")[k];
      plot.scrollIntoView({ block: "nearest" });
      return plot.querySelector(".main-svg");
    }, k, { polling: 100 });
  }
  return places;
}

test("it draws everything, offline, and nothing is asked for", async () => {
  const url = `file://${at.desk.path("demo.html")}`;
  const page = await open(at.chrome, url);
  await page.context().setOffline(true);
  assert.ok((await drawn(page)) >= 8);
  assert.deepEqual(outside(page, url), []);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("light, dark and other widths leave every drawing in its place", async () => {
  const page = await open(at.chrome, `file://${at.desk.path("demo.html")}`);
  await drawn(page);
  await turnAndResize(page);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("cursors show values and their difference, and time axes go together", async () => {
  const page = await open(at.chrome, `file://${at.desk.path("demo.html")}`);
  await drawn(page);
  const first = page.locator("#timeline");
  await first.focus();
  await page.keyboard.press("a");
  await page.keyboard.press("b");
  for (let k = 0; k < 5; k += 1) await page.keyboard.press("ArrowRight");
  const row = await page.locator("#figure-timeline .cursors tr").nth(1).innerText();
  const [a, b, difference] = row.split("\t").slice(1).map(Number);
  assert.ok(difference > 0 && Math.abs(b - a - difference) < 2e-4, row);
  await page.evaluate(() => Plotly.relayout("timeline", { "xaxis.range": [2, 4] }));
  await page.waitForFunction(() => {
    const range = document.getElementById("timeline-held-out").layout.xaxis.range;
    return range && Math.abs(range[0] - 2) < 1e-6 && Math.abs(range[1] - 4) < 1e-6;
  });
  await page.context().close();
});

test("a click sets cursor A, with shift cursor B, and the table tells what lies between", async () => {
  const page = await open(at.chrome, `file://${at.desk.path("demo.html")}`);
  await drawn(page);
  const plot = page.locator("#timeline .xy .nsewdrag, #timeline .nsewdrag").first();
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  await page.evaluate(() => {
    const timeline = document.getElementById("timeline");
    timeline.on("plotly_hover", (event) => (timeline.hovered = event.points[0].x));
  });
  // Plotly looks for the nearest sample while the mouse moves, and takes that one on a click: the one under the mouse before is
  // no longer to be taken.
  const click = async (part) => {
    await page.mouse.move(box.x + part * box.width - 4, box.y + box.height / 2);
    await page.mouse.move(box.x + part * box.width, box.y + box.height / 2);
    await page.waitForFunction((part) => {
      const timeline = document.getElementById("timeline");
      const [from, to] = timeline._fullLayout.xaxis.range;
      return Math.abs((timeline.hovered - from) / (to - from) - part) < 0.01;
    }, part);
    await page.mouse.down();
    await page.mouse.up();
  };
  const times = async () => {
    const row = await page.locator("#figure-timeline .cursors tr").nth(1).innerText();
    return row.split("\t").slice(1).map((cell) => (cell.trim() === "" ? null : Number(cell)));
  };
  await click(0.25);
  await page.waitForFunction(() => document.querySelectorAll("#figure-timeline .cursors tr").length > 1);
  const [first, none] = await times();
  assert.equal(none, null);
  await page.keyboard.down("Shift");
  await click(0.75);
  await page.keyboard.up("Shift");
  await page.waitForFunction(() => document.querySelectorAll("#figure-timeline .cursors tr:nth-child(2) td")[1].textContent !== "");
  const [a, b, between] = await times();
  assert.equal(a, first);
  // Half of the width is half of the time that is shown.
  const [from, to] = await page.evaluate(() => document.getElementById("timeline")._fullLayout.xaxis.range);
  assert.ok(Math.abs(between / (to - from) - 0.5) < 0.02, `${a} ${b} ${between} of ${from}..${to}`);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});
