// The loop of the workbench in a real browser: measured against model, where it fails, what is missing, add, the error falls.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { add, close, drag, error, open, opened, outside, settled, state, tab, test, turnAndResize, workplace } from "./bench.mjs";

const at = workplace(
  "simulate --hide coulomb --out rec.csv --seed 1",
  "simulate --hide coulomb --out other.csv --seed 2",
  "simulate --hide coulomb --hide cogging --excite commissioning-coast --out two.csv --seed 1",
  "simulate --hide coulomb --hide cogging --excite commissioning-coast --out more.csv --seed 2",
);

// What the loop needs is in the window, whole.
async function inSight(page, ids) {
  const out = await page.evaluate((ids) => ids.filter((id) => {
    const box = document.querySelector(id)?.getBoundingClientRect();
    return !box || box.height === 0 || box.top < 0 || box.left < 0 || box.bottom > innerHeight || box.right > innerWidth;
  }), ids);
  assert.deepEqual(out, [], "in the window");
  assert.equal(await page.evaluate(() => document.scrollingElement.scrollHeight - innerHeight), 0, "nothing to scroll");
}

const ALWAYS = ["#error-now", "#ladder", "#lane-angle", "#lane-residual", "#lane-drive", "#strip", "#tree", "#parameters"];

test("a log of an encoder that was zeroed at another angle is turned to that of the first", async () => {
  const moved = readFileSync(at.desk.path("more.csv"), "utf8").split("\n").map((line) => {
    const [time, volts, counts, ...rest] = line.split(",");
    return /^[0-9]/.test(line) ? [time, volts, Number(counts) - 300, ...rest].join(",") : line;
  });
  writeFileSync(at.desk.path("moved.csv"), moved.join("\n"));
  const [bench, page] = await opened(at, "two.csv --validate moved.csv");
  const turned = (await state(page)).recording.sources.map((one) => one.turned_counts);
  // One of twelve waves looks like the next.
  const wave = 2000 / 12;
  const off = (((turned[1] - 300 + wave / 2) % wave) + wave) % wave - wave / 2;
  assert.ok(turned[0] === 0 && Math.abs(off) < 1, turned.join());
  assert.match(await page.getAttribute("#recordings li:nth-child(2) button", "title"), /counts are added to its readings/);
  await close(page, bench);
});

test("from the recording to `explained` without scrolling, and each added effect makes the error fall", async () => {
  const [bench, page] = await opened(at, "two.csv --validate more.csv", 1, { viewport: { width: 1280, height: 800 } });
  await inSight(page, [...ALWAYS, "#proposals .open", "#add"]);
  const errors = [await error(page)];
  let clicks = 0;
  while (!(await page.locator("#explained").count())) {
    // The signature has the user's own volts, and the equation through them.
    assert.ok((await page.locator("#proposals .open .sig .dot").count()) > 5);
    const foreseen = await page.innerText("#proposals .open .falls .to");
    await page.click("#add");
    clicks += 1;
    await settled(page, clicks + 1);
    errors.push(await error(page));
    await inSight(page, ALWAYS);
    assert.ok(errors.at(-1) < errors.at(-2) / 3, `from ${errors.at(-2)} to ${errors.at(-1)}, foreseen ${foreseen}`);
    assert.ok(clicks < 5, `${errors}`);
  }
  await inSight(page, [...ALWAYS, "#explained"]);
  assert.ok(errors.at(-1) < 0.31, `${errors}`);
  // The ladder has a step for each model, the tree a node, and the residual in the lane is as small as the number says.
  const { models, chosen } = await state(page);
  assert.deepEqual(models.map((model) => model.parent), [null, 1, 2]);
  assert.equal(await page.locator("#ladder rect").count(), models.length);
  assert.equal(await page.locator("#tree .node").count(), models.length);
  assert.match(await page.innerText("#said"), /Explained/);
  const spread = await page.evaluate(async (id) => {
    const e = new Float32Array(await (await fetch(`series/model/${id}`)).arrayBuffer());
    return Math.sqrt(e.reduce((sum, x) => sum + x * x, 0) / e.length);
  }, chosen);
  assert.ok(Math.abs(spread / models.at(-1).rms_counts - 1) < 1e-3, `${spread}`);
  // Nothing came from anywhere else, and nothing went wrong on the way.
  assert.deepEqual(outside(page, bench.url), []);
  assert.deepEqual(page.faults, []);
  await close(page, bench);
});

test("the keyboard alone does the whole loop", async () => {
  const bench = await at.desk.bench("two.csv --validate more.csv");
  const page = await open(at.chrome, bench.url, { viewport: { width: 1280, height: 800 } });
  const press = (key) => page.keyboard.press(key);
  const opened = () => page.getAttribute("#proposals .open", "data-effect");
  await settled(page, 1);
  const first = await opened();
  await press("ArrowDown");
  assert.notEqual(await opened(), first);
  await press("ArrowUp");
  assert.equal(await opened(), first);
  // Locked out, it is proposed no more, until it is let in again.
  await press("l");
  await page.waitForFunction((first) => document.querySelector("#proposals .open")?.dataset.effect !== first, first);
  assert.deepEqual((await state(page)).locked, [first]);
  await press("Control+z");
  await page.waitForFunction((first) => document.querySelector("#proposals .open")?.dataset.effect === first, first);
  const before = await error(page);
  await press("Enter");
  await settled(page, 2);
  assert.ok((await error(page)) < before / 10);
  // Before and after, and a cursor that moves by a five-hundredth of the window, ten with shift.
  await press(" ");
  await page.waitForFunction(() => document.body.dataset.lanes === "1");
  await press(" ");
  await page.waitForFunction(() => document.body.dataset.lanes.startsWith("2"));
  const time = async () => Number((await page.innerText("#read-angle")).match(/t ([\d.]+) s/)[1]);
  await press("ArrowRight");
  const here = await time();
  await press("Shift+ArrowRight");
  assert.ok(Math.abs((await time()) - here - 0.4) < 5e-3, `${here} to ${await time()}`);
  await press("1");
  await page.waitForSelector("#dock .curves");
  await press("Escape");
  assert.ok(await page.isHidden("#dock"));
  await press("Control+z");
  await settled(page, 1);
  await press("Control+Shift+Z");
  await settled(page, 2);
  // Undone and done again, all is as it was; the rest of the way.
  for (let k = 0; k < 3 && !(await page.locator("#explained").count()); k += 1) {
    if (!(await page.locator("#add").count())) {
      await page.focus("#suggest");
      await press("Enter");
      await settled(page, 2);
      await page.evaluate(() => document.activeElement.blur());
    }
    await press("Enter");
    await settled(page, 2);
  }
  assert.equal(await page.locator("#explained").count(), 1);
  // Nodes are buttons: the first model again, and compared with the last.
  await page.focus("#tree .node >> nth=0");
  await press("Shift+Enter");
  await page.waitForSelector("#compared");
  assert.deepEqual(page.faults, []);
  await close(page, bench);
});

test("what is pointed at is foreseen in lanes, ladder and tree before anything is fitted", async () => {
  const [bench, page] = await opened(at, "rec.csv --validate other.csv");
  const other = page.locator("#proposals .prop").first();
  const name = (await other.getAttribute("data-effect")).replace(/_/g, " ");
  await other.hover();
  await page.waitForFunction((name) => document.getElementById("legend").textContent.includes(`+ ${name}, foreseen`), name);
  await page.waitForFunction(() => document.body.dataset.lanes === "1 2p");
  assert.match(await page.textContent("#ladder"), new RegExp(`\\+ ${name.slice(0, 6)}`));
  assert.equal(await page.locator("#tree .edge.dashed").count(), 1);
  const { models, proposed } = await state(page);
  assert.equal(models.length, 1);
  // What is foreseen is what the proposal says of its error.
  const found = proposed.list.find((one) => one.effect.replace(/_/g, " ") === name);
  const rms = await page.evaluate(async (effect) => {
    const e = new Float32Array(await (await fetch(`series/proposal/1/${effect}`)).arrayBuffer());
    return Math.sqrt(e.reduce((sum, x) => sum + x * x, 0) / e.length);
  }, found.effect);
  assert.ok(Math.abs(rms / found.rms_counts - 1) < 1e-2, `${rms} of ${found.rms_counts}`);
  await close(page, bench);
});

test("a tree of models: away and back, compared, removed, undone; a slider moves the model", async () => {
  const [bench, page] = await opened(at, "rec.csv --validate other.csv");
  const first = await error(page);
  await add(page, "coulomb");
  await settled(page, 2);
  await page.click("#tree .node >> nth=0");
  await settled(page, 2);
  await add(page, "windage");
  await settled(page, 3);
  let bench1 = await state(page);
  assert.deepEqual(bench1.models.map((model) => [model.id, model.parent]), [[1, null], [2, 1], [3, 1]]);
  await page.click("#tree [data-model='2']", { modifiers: ["Shift"] });
  await page.waitForSelector("#compared");
  assert.match(await page.innerText("#compared"), /predicts [\d.\s]+ times better/);
  await page.waitForFunction(() => document.body.dataset.lanes === "2 3");
  // The model that is looked at goes, with its number and its line; undo brings it back.
  await page.focus("#tree [data-model='3']");
  await page.keyboard.press("Delete");
  await settled(page, 2);
  assert.equal((await state(page)).models.length, 2);
  await page.keyboard.press("Control+z");
  await settled(page, 3);
  bench1 = await state(page);
  assert.equal(bench1.models.length, 3);
  await page.click("#tree [data-model='1']");
  await settled(page, 3);
  assert.ok(Math.abs((await error(page)) / first - 1) < 0.01);
  // Adding what is there already looks at it.
  await add(page, "coulomb");
  await settled(page, 3);
  assert.equal((await state(page)).chosen, 2);
  await tab(page, "hand");
  await page.locator("#sliders input").first().fill("700");
  await page.waitForFunction(() => document.getElementById("by-hand").textContent.includes("Moved by hand"));
  await page.waitForFunction(() => document.body.dataset.lanes.includes("2p"));
  await page.click("#put-back");
  await page.waitForFunction(() => !document.body.dataset.lanes.includes("2p"));
  assert.deepEqual(page.faults, []);
  await close(page, bench);
});

test("from answer to remedy, and motors like this one", async () => {
  const [bench, page] = await opened(at, "rec.csv --validate other.csv");
  await page.click("#add");
  await settled(page, 2);
  assert.equal(await page.locator("#explained").count(), 1);
  // Friction that is known is compensated: the loop follows better.
  await tab(page, "remedy");
  await page.waitForSelector("#dock .remedy svg");
  const remedy = await page.evaluate(async () => (await fetch("remedy")).json());
  assert.ok(remedy.rms_before > 1.5 * remedy.rms_after, `${remedy.rms_before} to ${remedy.rms_after}`);
  assert.ok(Math.abs(remedy.k_s - 0.36) < 0.01 && remedy.k_s_from === "coulomb", JSON.stringify([remedy.k_s, remedy.k_s_from]));
  // Twins are diagnosed one after the other, and what was found stays when a hand stops it.
  await page.click("#twins");
  await page.waitForFunction(() => /In \d+ of [1-9]/.test(document.getElementById("twins-found")?.textContent ?? ""), null, { timeout: 120_000 });
  await page.keyboard.press("Escape");
  await settled(page, 2);
  const { twins } = await state(page);
  assert.ok(twins.tried >= 1 && twins.tried < twins.of && twins.same <= twins.tried, JSON.stringify(twins));
  assert.match(await page.textContent("#fault"), /twins: stopped/);
  assert.deepEqual(page.faults, []);
  await close(page, bench);
});

test("a blind demonstration: find what is missing, then reveal it", async () => {
  const bench = await at.desk.bench("");
  const page = await open(at.chrome, bench.url);
  // One motor in place of any: some take far longer to diagnose than others.
  await page.route("**/demo", (route) => route.continue({ postData: JSON.stringify({ seed: 11, blind: true }) }));
  // By the keyboard alone.
  await page.focus("#blind");
  await page.keyboard.press("Enter");
  await settled(page, 1);
  assert.equal(await page.textContent("#secret"), "");
  await page.click("#diagnose");
  await page.waitForFunction(() => document.getElementById("verdict")?.textContent, null, { timeout: 180_000 });
  await settled(page, 1);
  await page.click("#reveal");
  await page.waitForFunction(() => document.getElementById("secret").textContent.startsWith("Hidden was "));
  assert.deepEqual(page.faults, []);
  await close(page, bench);
});

test("a recording of twenty minutes is thinned for drawing, never for what is near", async () => {
  at.desk.run("simulate --hide coulomb --seconds 1200 --out long.csv --seed 3 --no-motor");
  const [bench, page] = await opened(at, "long.csv --counts-per-rev 2000 --supply-v 12");
  const lanes = () => page.evaluate(() => ({ ...document.getElementById("lanes").dataset }));
  const whole = await lanes();
  assert.ok(whole.to - whole.from >= 1_200_000 && whole.points < 4000, JSON.stringify(whole));
  for (let k = 0; k < 3; k += 1) await drag(page, 0.45, 0.52);
  const near = await lanes();
  assert.equal(Number(near.points), near.to - near.from, `every sample is drawn: ${JSON.stringify(near)}`);
  await page.locator("#lane-angle .u-over").dblclick();
  assert.deepEqual(await lanes(), whole);
  await close(page, bench);
});

test("light, dark and other widths leave every drawing in its place", async () => {
  const [bench, page] = await opened(at, "rec.csv --validate other.csv");
  await page.click("#add");
  await settled(page, 2);
  for (const name of ["failing", "response", "clock", "limits"]) {
    await tab(page, name);
    await page.waitForSelector("#dock svg");
    await turnAndResize(page);
  }
  await tab(page, "failing");
  await page.click("#dock .acts button");
  await page.waitForFunction(() => document.querySelectorAll("#dock .main-svg").length > 3);
  assert.deepEqual(page.faults, []);
  await close(page, bench);
});
