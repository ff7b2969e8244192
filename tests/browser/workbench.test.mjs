// The workbench in a real browser.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { after, before } from "node:test";
import { Desk, browser, drop, error, open, outside, settled, test, turnAndResize } from "./bench.mjs";

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
  // However often the drawing was replaced, a key acts once: an arrow moves a cursor by a five-hundredth.
  const cursor = async () => Number((await page.locator("#bench-timeline ~ .cursors tr").nth(1).innerText()).split("\t")[1]);
  await page.focus("#bench-timeline");
  await page.keyboard.press("a");
  const before = await cursor();
  await page.keyboard.press("ArrowRight");
  const moved = await cursor() - before;
  assert.ok(Math.abs(moved - 20 / 500) < 2e-3, `moved by ${moved} s`);
  await page.keyboard.press("Escape");
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
  for (const counts of ["-2000", "0"]) {
    await page.fill("#map-counts_per_rev", counts);
    await page.locator("#map-counts_per_rev").blur();
    await page.waitForFunction(() => document.getElementById("column-fault").textContent.includes("greater than zero"));
  }
  assert.ok(await page.isDisabled("#load"));
  await page.click("#columns button[value=cancel]");
  // The same recording under names of somebody else.
  const foreign = readFileSync(desk.path("rec.csv"), "utf8").replace("t_s,voltage_v,angle_counts", "when,u,enc");
  await drop(page, [["foreign.csv", foreign]]);
  await page.waitForSelector("#columns[open]");
  const columns = (words) => page.waitForFunction((words) => document.getElementById("column-fault").textContent.includes(words), words);
  await page.fill("#map-counts_per_rev", "");
  await page.selectOption("#map-time", "");
  await columns("choose which column is which");
  await page.selectOption("#map-time", "when");
  await columns("fill them in");
  await page.fill("#map-counts_per_rev", "2000");
  await page.locator("#map-counts_per_rev").blur();
  await page.waitForFunction(() => !document.getElementById("load").disabled);
  await page.click("#load");
  await settled(page, 1);
  assert.match(await page.textContent("#about"), /foreign\.csv: 20000 samples/);
  const says = (words) => page.waitForFunction((words) => document.getElementById("fault").textContent.includes(words), words);
  // A session that is none.
  await drop(page, [["other.json", "{\"schema\": \"x\"}"]]);
  await says("schema is `x`");
  await drop(page, [["newer.json", "{\"schema\": \"servoid.session/9\", \"fitted\": 1}"]]);
  await says("servoid.session/9");
  await drop(page, [["list.json", "[1, 2]"]]);
  await says("a session is what the workbench saved");
  // The same recording once more tests nothing.
  await drop(page, [["foreign.csv", foreign]]);
  await page.waitForSelector("#columns[open]");
  await page.selectOption("#map-time", "when");
  await page.fill("#map-counts_per_rev", "2000");
  await page.selectOption("#role", "held_out");
  await page.waitForFunction(() => !document.getElementById("load").disabled);
  await page.click("#load");
  await page.waitForFunction(() => document.getElementById("column-fault").textContent.includes("no test"));
  await page.context().close();
  await bench.end();
});

test("runs of one motor are fitted together, on the command line, by dropping, and in a session", async () => {
  desk.run("simulate --hide coulomb --out third.csv --seed 3");
  const text = (name) => readFileSync(desk.path(name), "utf8");
  const together = async (page) => {
    await settled(page, 1);
    assert.match(await page.textContent("#about"), /rec\.csv \+ other\.csv: 40000 samples.*never fitted: third\.csv/);
    return error(page);
  };
  // The last judges, as in a diagnosis; the error is over both that are fitted.
  const bench = await desk.bench("rec.csv other.csv third.csv --session several.json");
  const page = await open(chrome, bench.url);
  const shown = await together(page);
  await page.context().close();
  await bench.end();
  const again = await desk.bench("several.json");
  const reopened = await open(chrome, again.url);
  assert.equal(await together(reopened), shown);
  await reopened.context().close();
  await again.end();
  // The same by dropping all three, and by adding one after the other.
  const empty = await desk.bench("");
  const dropped = await open(chrome, empty.url);
  const motor = ["motor.toml", "counts_per_rev = 2000\n"];
  await drop(dropped, [motor, ...["rec.csv", "other.csv", "third.csv"].map((name) => [name, text(name)])]);
  assert.equal(await together(dropped), shown);
  assert.deepEqual(dropped.faults, []);
  const add = async (name, role) => {
    await drop(dropped, [[name, text(name)]]);
    await dropped.waitForSelector("#columns[open]");
    await dropped.fill("#map-counts_per_rev", "2000");
    await dropped.selectOption("#role", role);
    await dropped.waitForFunction(() => !document.getElementById("load").disabled);
    await dropped.click("#load");
  };
  await add("rec.csv", "fitted");
  await dropped.click("#put-away-yes");
  await settled(dropped, 1);
  for (const [name, role] of [["third.csv", "held_out"], ["other.csv", "beside"]]) {
    await add(name, role);
    await dropped.waitForFunction((name) => document.getElementById("about").textContent.includes(name), name);
    await settled(dropped, 1);
  }
  assert.equal(await together(dropped), shown);
  // One that judges is not fitted as well, nor the other way round.
  for (const [name, role, words] of [["third.csv", "beside", "no test"], ["rec.csv", "held_out", "no test"], ["rec.csv", "beside", "same samples"]]) {
    await add(name, role);
    await dropped.waitForFunction((words) => document.getElementById("column-fault").textContent.includes(words), words);
    await dropped.click("#columns button[value=cancel]");
  }
  await dropped.context().close();
  await empty.end();
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

test("another recording asks first, undo brings the bench back, and two programs do not share a session", async () => {
  const bench = await desk.bench("rec.csv --session undone.json");
  const page = await open(chrome, bench.url);
  await settled(page, 1);
  const before = await error(page);
  const name = () => page.textContent("#about");
  const motor = readFileSync(desk.path("motor.toml"), "utf8");
  const other = [["other.csv", readFileSync(desk.path("other.csv"), "utf8")], ["motor.toml", motor]];
  await drop(page, other);
  await page.click("#put-away-no");
  assert.match(await name(), /rec\.csv/);
  await drop(page, other);
  await page.click("#put-away-yes");
  await page.waitForFunction(() => document.getElementById("about").textContent.includes("other.csv"));
  await settled(page, 1);
  // The fit, then the recording.
  await page.click("#undo");
  await settled(page, 0);
  await page.keyboard.press("Control+z");
  await page.waitForFunction(() => document.getElementById("about").textContent.includes("rec.csv"));
  await settled(page, 1);
  assert.equal(await error(page), before);
  await page.click("#redo");
  await page.waitForFunction(() => document.getElementById("about").textContent.includes("other.csv"));
  await page.click("#undo");
  await settled(page, 1);
  await assert.rejects(desk.bench("--session undone.json"), /ended with 2/);
  await page.context().close();
  await bench.end();
  assert.match(readFileSync(desk.path("undone.json"), "utf8"), /rec\.csv/);
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
  await page.waitForFunction(() => document.getElementById("fault").textContent.includes("resistance_ohm"));
  assert.doesNotMatch(await page.textContent("#fault"), /--/);
  // What goes right afterwards takes the message away.
  await page.selectOption("#format", "toml");
  await Promise.all([page.waitForEvent("download"), page.click("#take")]);
  await page.waitForFunction(() => document.getElementById("fault").hidden);
  await page.context().close();
  await bench.end();
});

test("light, dark and other widths leave every drawing in its place", async () => {
  const bench = await desk.bench("rec.csv --validate other.csv");
  const page = await open(chrome, bench.url);
  await settled(page, 1);
  await page.click("#suggest");
  await page.click("#suggestions button:text('Add coulomb')");
  await settled(page, 2);
  await turnAndResize(page);
  assert.deepEqual(page.faults, []);
  await page.context().close();
  await bench.end();
});

test("a model of chaotic runs is opened again as it was, and its notes and its method are told", async () => {
  const bench = await desk.bench("rec.csv --validate other.csv --session chaos.json");
  const page = await open(chrome, bench.url);
  await settled(page, 1);
  await page.selectOption("#algorithm", "pso");
  await page.click("#refit");
  await settled(page, 2);
  const names = await page.evaluate(() => document.getElementById("bench-timeline").data.map((line) => line.name));
  assert.ok(names.includes("linear motor") && names.includes("linear motor (by pso)"), String(names));
  await page.selectOption("#algorithm", "lm");
  await page.selectOption("#effect", "cogging");
  await page.click("#add");
  await settled(page, 3);
  const table = (page) => page.innerText("#models");
  const [shown, models] = [await error(page), await table(page)];
  assert.match(models, /linear motor \(by pso\)/);
  assert.ok((await page.locator("#notes li").count()) > 0);
  assert.doesNotMatch(await page.textContent("#notes"), / --/);
  await page.context().close();
  await bench.end();
  const again = await desk.bench("--session chaos.json");
  const second = await open(chrome, again.url);
  await settled(second, 3);
  assert.equal(await error(second), shown);
  assert.equal(await table(second), models);
  await second.context().close();
  await again.end();
});

test("what is wrong in a session that was edited is left out with a word", async () => {
  const bench = await desk.bench("rec.csv --session edited.json");
  const page = await open(chrome, bench.url);
  await settled(page, 1);
  await page.context().close();
  await bench.end();
  const session = JSON.parse(readFileSync(desk.path("edited.json"), "utf8"));
  session.models.push({ ...session.models[0], algorithm: "magic" });
  writeFileSync(desk.path("edited.json"), JSON.stringify({
    ...session, chosen: 99, race: { schema: "x" }, diagnosis: session.models[0],
  }));
  const again = await desk.bench("edited.json");
  const second = await open(chrome, again.url);
  await settled(second, 1);
  const said = await second.textContent("#fault");
  for (const words of ["chosen: there is no model 99", "no search method `magic`", "race: schema is `x`", "diagnosis: schema"]) {
    assert.ok(said.includes(words), `${words}: ${said}`);
  }
  assert.ok((await error(second)) > 0, "the model that is left is looked at");
  assert.equal(await second.textContent("#verdict"), "");
  await second.context().close();
  await again.end();
});

test("while work goes on the bench stays true, and what is stopped says so", async () => {
  const bench = await desk.bench("rec.csv --validate other.csv");
  let page = await open(chrome, bench.url);
  await settled(page, 1);
  const first = await error(page);
  await page.selectOption("#effect", "coulomb");
  await page.click("#add");
  await settled(page, 2);
  const says = (words) => page.waitForFunction((words) => document.getElementById("fault").textContent.includes(words), words,
    { timeout: 60_000 });
  const stopped = () => page.waitForFunction(() => document.getElementById("stop").hidden, null, { timeout: 60_000 });
  await page.click("text=Let searches race");
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
  await drop(page, [["other.csv", readFileSync(desk.path("other.csv"), "utf8")]]);
  await says("busy (race)");
  // The model that is looked at goes, with its number and its line.
  await page.click("button[aria-label='remove motor with coulomb']");
  await page.waitForFunction((first) => Number(document.getElementById("error-now").textContent) === first, first);
  await page.waitForFunction(() => !document.getElementById("bench-timeline").data.some((line) => line.name.includes("coulomb")));
  assert.ok(await page.isVisible("#stop"));
  await page.click("#stop");
  await stopped();
  await says("race: stopped");
  // A refusal is no fault of the page.
  assert.deepEqual(page.faults.filter((text) => !text.includes("status of 422")), []);
  await page.context().close();
  await bench.end();

  // Two minutes with cogging are looked at for many seconds: long enough for a hand to stop it.
  desk.run("simulate --hide cogging --seconds 120 --out long.csv --seed 1");
  const slow = await desk.bench("long.csv");
  page = await open(chrome, slow.url);
  await settled(page, 1);
  await page.click("#diagnose");
  await page.click("#stop");
  await stopped();
  await says("diagnose: stopped");
  assert.doesNotMatch(await page.textContent("#fault"), /lm/);
  assert.deepEqual(page.faults, []);
  await page.context().close();
  await slow.end();
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
