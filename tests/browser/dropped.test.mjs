// Logs as people have them: dropped together, packed, of other formats, or named on the command line.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import { close, error, open, opened, settled, state, test, workplace } from "./bench.mjs";

const at = workplace(
  "simulate --hide coulomb --out rec.csv --seed 1",
  "simulate --hide coulomb --out other.csv --seed 2",
);

const rows = (name) => readFileSync(at.desk.path(name), "utf8").split("\n").filter((line) => /^[0-9]/.test(line)).map((line) => line.split(",").map(Number));
const foreign = (name) => ["zeit,spannung,winkel", ...rows(name).map((cells) => cells.join(","))].join("\n");
// A sketch's prints: whole milliseconds and eight bits of the supply.
const sketch = (name) => ["Motor test rig v1.3", "Encoder OK", "millis\tpwm\tenc",
  ...rows(name).map(([t, volts, counts]) => [Math.round(t * 1000), Math.round((volts / 12) * 255), counts].join("\t"))].join("\r\n");

// Files of any bytes.
async function dropBytes(page, files) {
  const packed = files.map(([name, bytes]) => [name, Buffer.from(bytes).toString("base64")]);
  const data = await page.evaluateHandle((files) => {
    const data = new DataTransfer();
    for (const [name, text] of files) data.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
    return data;
  }, packed);
  await page.dispatchEvent("#drop", "drop", { dataTransfer: data });
}

async function load(page, more = async () => {}) {
  await page.waitForSelector("#columns[open]");
  await page.fill("#map-counts_per_rev", "2000");
  await more();
  await page.waitForFunction(() => !document.getElementById("load").disabled);
  await page.click("#load");
  await settled(page, 1);
}

// A log of which something is not known is answered with what is missing, which the browser counts as a failed request.
const faults = (page) => page.faults.filter((fault) => !fault.includes("422"));

const sources = async (page) => (await state(page)).recording.sources.map((one) => [one.name, one.role]);

test("two logs that are dropped together are both used, the second one held out", async () => {
  const [kept, reference] = await opened(at, "rec.csv --validate other.csv");
  const right = await error(reference);
  await close(reference, kept);
  const bench = await at.desk.bench("");
  const page = await open(at.chrome, bench.url);
  await dropBytes(page, [["first.csv", foreign("rec.csv")], ["second.csv", foreign("other.csv")]]);
  await load(page);
  assert.deepEqual(await sources(page), [["first.csv", "fitted"], ["second.csv", "held out"]]);
  assert.equal(await error(page), right);
  assert.deepEqual(faults(page), []);
  await close(page, bench);
});

test("packed logs and logs of other formats are read as on the command line", async () => {
  const columns = rows("rec.csv");
  const json = JSON.stringify({ t: columns.map((row) => row[0]), u: columns.map((row) => row[1]), theta_counts: columns.map((row) => row[2]) });
  for (const [name, bytes] of [["rec.csv.gz", gzipSync(readFileSync(at.desk.path("rec.csv")))], ["rec.json", json]]) {
    const bench = await at.desk.bench("");
    const page = await open(at.chrome, bench.url);
    await dropBytes(page, [[name, bytes]]);
    await load(page);
    const [[shown]] = await sources(page);
    assert.ok(shown.startsWith(name), shown);
    assert.equal((await state(page)).recording.samples, columns.length);
    assert.deepEqual(faults(page), []);
    await close(page, bench);
  }
});

test("a sketch's log on the command line opens the page with the dialog filled in", async () => {
  // A folder without a motor.toml.
  mkdirSync(at.desk.path("bare"));
  writeFileSync(at.desk.path("bare/sketch.txt"), sketch("rec.csv"));
  for (const line of ["bench bare/sketch.txt", "bare/sketch.txt"]) {
    const bench = await at.desk.served(line);
    const page = await open(at.chrome, bench.url);
    await load(page, async () => {
      assert.equal(await page.inputValue("#map-preset"), "arduino");
      assert.equal(await page.inputValue("#map-voltage"), "pwm");
      await page.fill("#map-supply_v", "12");
    });
    assert.deepEqual(await sources(page), [["sketch.txt", "fitted"]]);
    assert.deepEqual(faults(page), []);
    await close(page, bench);
  }
});

test("the demo motor is there in a moment, and says what is in it", async () => {
  const bench = await at.desk.bench("");
  const page = await open(at.chrome, bench.url);
  await page.click("#demo");
  await settled(page, 1);
  assert.deepEqual((await sources(page)).map(([, role]) => role), ["fitted", "held out"]);
  assert.deepEqual(faults(page), []);
  await close(page, bench);
});
