// Recordings and sessions of the workbench in a real browser.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { add, close, drag, drop, error, open, opened, settled, state, tab, test, workplace } from "./bench.mjs";

const at = workplace(
  "simulate --hide coulomb --out rec.csv --seed 1",
  "simulate --hide coulomb --out other.csv --seed 2",
);

test("a bad file shows the reader's message, a foreign one asks which column is what", async () => {
  const bench = await at.desk.bench("");
  const page = await open(at.chrome, bench.url);
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
  const foreign = readFileSync(at.desk.path("rec.csv"), "utf8").replace("t_s,voltage_v,angle_counts", "when,u,enc");
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
  const { sources } = (await state(page)).recording;
  assert.deepEqual(sources.map((one) => [one.name, one.samples]), [["foreign.csv", 20000]]);
  const says = (words) => page.waitForFunction((words) => document.getElementById("fault").textContent.includes(words), words);
  // What is no table is refused by what it is.
  await drop(page, [["picture.csv", "\u0089PNG\r\n"]]);
  await says("this is a PNG picture");
  await drop(page, [["nothing.csv", ""]]);
  await says("empty");
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
  await page.check("#role [value=held_out]");
  await page.waitForFunction(() => !document.getElementById("load").disabled);
  await page.click("#load");
  await page.waitForFunction(() => document.getElementById("column-fault").textContent.includes("no test"));
  await close(page, bench);
});

test("runs of one motor are fitted together, on the command line, by dropping, and in a session", async () => {
  at.desk.run("simulate --hide coulomb --out third.csv --seed 3");
  const text = (name) => readFileSync(at.desk.path(name), "utf8");
  const together = async (page) => {
    await settled(page, 1);
    const { sources, samples } = (await state(page)).recording;
    assert.deepEqual(sources.map((one) => [one.name, one.role]), [["rec.csv", "fitted"], ["other.csv", "fitted"], ["third.csv", "held out"]]);
    assert.equal(samples, 40000);
    return error(page);
  };
  // The last judges, as in a diagnosis; the error is over both that are fitted.
  const bench = await at.desk.bench("rec.csv other.csv third.csv --session several.json");
  const page = await open(at.chrome, bench.url);
  const shown = await together(page);
  await close(page, bench);
  const again = await at.desk.bench("several.json");
  const reopened = await open(at.chrome, again.url);
  assert.equal(await together(reopened), shown);
  await close(reopened, again);
  // The same by dropping all three, and by adding one after the other.
  const empty = await at.desk.bench("");
  const dropped = await open(at.chrome, empty.url);
  const motor = ["motor.toml", "counts_per_rev = 2000\n"];
  await drop(dropped, [motor, ...["rec.csv", "other.csv", "third.csv"].map((name) => [name, text(name)])]);
  assert.equal(await together(dropped), shown);
  assert.deepEqual(dropped.faults, []);
  const more = async (name, role) => {
    await drop(dropped, [[name, text(name)]]);
    await dropped.waitForSelector("#columns[open]");
    await dropped.fill("#map-counts_per_rev", "2000");
    await dropped.check(`#role [value=${role}]`);
    await dropped.waitForFunction(() => !document.getElementById("load").disabled);
    await dropped.click("#load");
  };
  for (const [name, role] of [["rec.csv", "fitted"], ["third.csv", "held_out"], ["other.csv", "beside"]]) {
    // Until the fit has begun the bench looks as before.
    const begun = dropped.waitForResponse((response) => new URL(response.url()).pathname.endsWith("/work"));
    await more(name, role);
    if (role === "fitted") await dropped.click("#put-away-yes");
    await begun;
    await settled(dropped, 1);
  }
  assert.equal(await together(dropped), shown);
  // One that judges is not fitted as well, nor the other way round.
  for (const [name, role, words] of [["third.csv", "beside", "no test"], ["rec.csv", "held_out", "no test"], ["rec.csv", "beside", "same samples"]]) {
    await more(name, role);
    await dropped.waitForFunction((words) => document.getElementById("column-fault").textContent.includes(words), words);
    await dropped.click("#columns button[value=cancel]");
  }
  await close(dropped, empty);
});

test("recordings change their roles, and undo and a session know of it", async () => {
  const [bench, page] = await opened(at, "rec.csv --validate other.csv --session roles.json");
  const roles = async (page) => (await state(page)).recording.sources.map((one) => [one.name, one.role].join(" "));
  const held = await error(page);
  const give = async (k, role) => {
    await page.selectOption(`.rec >> nth=${k} >> select`, role);
    await page.click("#put-away-yes");
    // The page shows what was chosen at once; the program has it once it says so.
    while ((await state(page)).recording.sources[k]?.role !== role) await page.waitForTimeout(20);
    await settled(page, 1);
  };
  // One that judges is shown along the models, too.
  await page.click(".rec >> nth=1 >> button");
  await page.waitForFunction(() => document.querySelectorAll(".rec")[1].dataset.shown === "true");
  await give(1, "ignored");
  assert.deepEqual(await roles(page), ["rec.csv fitted", "other.csv ignored"]);
  assert.notEqual((await state(page)).recording.held_out_from_s, null);
  // The only one that is fitted stays so.
  await page.selectOption(".rec >> nth=0 >> select", "ignored");
  await page.click("#put-away-yes");
  await page.waitForFunction(() => document.getElementById("fault").textContent.includes("one recording at least must be fitted"));
  await give(1, "held out");
  assert.deepEqual(await roles(page), ["rec.csv fitted", "other.csv held out"]);
  await close(page, bench);
  const [again, second] = await opened(at, "roles.json");
  assert.deepEqual(await roles(second), ["rec.csv fitted", "other.csv held out"]);
  assert.ok(Math.abs((await error(second)) / held - 1) < 0.01);
  await close(second, again);
});

test("a session that ended before its first fit did is fitted when it is opened again", async () => {
  const [bench, page] = await opened(at, "rec.csv --session early.json");
  await close(page, bench);
  const saved = JSON.parse(readFileSync(at.desk.path("early.json"), "utf8"));
  Object.assign(saved, { models: [], chosen: null, against: null });
  writeFileSync(at.desk.path("early.json"), JSON.stringify(saved));
  const [again, second] = await opened(at, "early.json");
  assert.equal((await state(second)).models.length, 1);
  await close(second, again);
});

test("a log of fifty megabytes is dropped, previewed and read", async () => {
  at.desk.run("simulate --hide coulomb --seconds 2000 --out huge.csv --seed 3 --no-motor");
  const text = readFileSync(at.desk.path("huge.csv"), "utf8");
  assert.ok(text.length > 50e6, `${text.length} bytes`);
  const bench = await at.desk.bench("");
  const page = await open(at.chrome, bench.url);
  await drop(page, [["huge.csv", text]]);
  await page.waitForSelector("#columns[open]", { timeout: 60_000 });
  await page.fill("#map-counts_per_rev", "2000");
  await page.fill("#map-supply_v", "12");
  await page.click("#load");
  await page.waitForSelector(".rec", { timeout: 120_000 });
  assert.equal((await state(page)).recording.samples, 2_000_000);
  // Nobody waits for the fit of half an hour: it stops, however busy the machine.
  await page.keyboard.press("Escape");
  await page.waitForSelector("#work", { state: "hidden", timeout: 60_000 });
  await close(page, bench);
});

test("a span of a recording is chosen by dragging, is kept in a session, and is taken back", async () => {
  const [bench, page] = await opened(at, "rec.csv --validate other.csv --session span.json");
  const spans = async () => (await state(page)).recording.sources.map((one) => one.span_s);
  assert.equal(await page.isVisible("#use-span"), false, "all of it is used");
  await drag(page, 0.25, 0.75);
  await page.click("#use-span");
  await page.click("#put-away-yes");
  await page.waitForSelector(".rec .whole");
  await settled(page, 1);
  const [[from, to], other] = await spans();
  const whole = 20;
  assert.ok(Math.abs(from - 0.25 * whole) < 0.3 && Math.abs(to - 0.75 * whole) < 0.3 && other === null, `${from} to ${to} s`);
  assert.ok(Math.abs((await state(page)).recording.seconds - (to - from)) < 0.01);
  await close(page, bench);
  const [again, second] = await opened(at, "span.json");
  assert.deepEqual((await state(second)).recording.sources[0].span_s, [from, to]);
  await second.click(".rec .whole");
  await second.click("#put-away-yes");
  await second.waitForFunction(() => !document.querySelector(".rec .whole"));
  await settled(second, 1);
  assert.equal((await state(second)).recording.sources[0].span_s, null);
  // The fit is undone first, then what it was fitted to.
  await second.click("#undo");
  await second.waitForFunction(() => document.querySelectorAll("#tree .node").length === 0);
  await second.click("#undo:enabled");
  await second.waitForSelector(".rec .whole");
  await close(second, again);
});

test("a second tab does not break the first, and a session is opened again as it was", async () => {
  const bench = await at.desk.bench("rec.csv --validate other.csv --session kept.json");
  const first = await open(at.chrome, bench.url);
  const second = await open(at.chrome, bench.url);
  await settled(first, 1);
  await settled(second, 1);
  await add(second, "coulomb");
  await settled(second, 2);
  await settled(first, 2);
  assert.equal(await error(first), await error(second));
  await second.context().close();
  await first.waitForSelector("#explained");
  const shown = await error(first);
  await close(first, bench);
  const [again, page] = await opened(at, "kept.json", 2);
  assert.equal(await error(page), shown);
  await close(page, again);
});

test("another recording asks first, undo brings the bench back, and two programs do not share a session", async () => {
  const [bench, page] = await opened(at, "rec.csv --session undone.json");
  const before = await error(page);
  const name = () => page.textContent("#recordings");
  const motor = readFileSync(at.desk.path("motor.toml"), "utf8");
  const other = [["other.csv", readFileSync(at.desk.path("other.csv"), "utf8")], ["motor.toml", motor]];
  await drop(page, other);
  await page.click("#put-away-no");
  assert.match(await name(), /rec\.csv/);
  await drop(page, other);
  await page.click("#put-away-yes");
  await page.waitForFunction(() => document.getElementById("recordings").textContent.includes("other.csv"));
  await settled(page, 1);
  // The fit, then the recording.
  await page.click("#undo");
  await settled(page, 0);
  await page.keyboard.press("Control+z");
  await page.waitForFunction(() => document.getElementById("recordings").textContent.includes("rec.csv"));
  await settled(page, 1);
  assert.equal(await error(page), before);
  await page.click("#redo");
  await page.waitForFunction(() => document.getElementById("recordings").textContent.includes("other.csv"));
  await page.click("#undo");
  await settled(page, 1);
  await assert.rejects(at.desk.bench("--session undone.json"), /ended with 2/);
  await close(page, bench);
  assert.match(readFileSync(at.desk.path("undone.json"), "utf8"), /rec\.csv/);
});

test("a model of chaotic runs is opened again as it was, and its notes and its method are told", async () => {
  const [bench, page] = await opened(at, "rec.csv --validate other.csv --session chaos.json");
  await tab(page, "searches");
  await page.selectOption("#algorithm", "pso");
  await page.click("#refit");
  await settled(page, 2);
  await add(page, "cogging");
  await settled(page, 3);
  const table = async (page) => (await state(page)).models.map((model) => [model.name, model.rms_counts, model.held_out_rms_counts, model.parent].join(" ")).join("\n");
  const [shown, models] = [await error(page), await table(page)];
  assert.match(models, /linear motor \(by pso\)/);
  await tab(page, "log");
  assert.ok((await page.locator("#notes li").count()) > 0);
  assert.doesNotMatch(await page.textContent("#notes"), / --/);
  await close(page, bench);
  const [again, second] = await opened(at, "--session chaos.json", 3);
  assert.equal(await error(second), shown);
  assert.equal(await table(second), models);
  await close(second, again);
});

test("what is wrong in a session that was edited is left out with a word", async () => {
  const [bench, page] = await opened(at, "rec.csv --session edited.json");
  await close(page, bench);
  const session = JSON.parse(readFileSync(at.desk.path("edited.json"), "utf8"));
  session.models.push({ ...session.models[0], algorithm: "magic" });
  writeFileSync(at.desk.path("edited.json"), JSON.stringify({
    ...session, chosen: 99, race: { schema: "x" }, diagnosis: session.models[0],
  }));
  const [again, second] = await opened(at, "edited.json");
  const said = await second.textContent("#fault");
  for (const words of ["chosen: there is no model 99", "no search method `magic`", "race: schema is `x`", "diagnosis: schema"]) {
    assert.ok(said.includes(words), `${words}: ${said}`);
  }
  assert.ok((await error(second)) > 0, "the model that is left is looked at");
  assert.equal(await second.locator("#verdict").count(), 0);
  await close(second, again);
});
