// The Pico's application, as it is flashed, commissions a motor; and whatever breaks, the bridge opens. `scripts/pico test` builds
// the image and names it in PICO, and the host's program in SERVOID.
import assert from "node:assert/strict";
import { execFile, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { connect } from "node:net";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { createInterface } from "node:readline";
import { after, test } from "node:test";
import { promisify } from "node:util";
import { Motor, TEN_WATTS } from "./motor.mjs";

const { PICO, SERVOID } = process.env;
assert.ok(PICO && SERVOID, "PICO and SERVOID name the image and the program: run scripts/pico test");

const folder = mkdtempSync(join(tmpdir(), "servoid-pico-"));
after(() => rmSync(folder, { recursive: true }));
const COUNTS = "2000";
const BENCH = join(import.meta.dirname, "bench.mjs");

test("the watchdog opens the bridge of a program that does not come back, and the program knows it", async () => {
  // The program for a first power-up is beside the application: it tells on the line what made it start.
  const bringup = join(dirname(PICO), "bringup-rp2040");
  const bench = spawn("node", [BENCH, bringup, "--wedged-at", "0.4"], { stdio: ["ignore", "pipe", "inherit"] });
  try {
    const told = createInterface(bench.stdout)[Symbol.asyncIterator]();
    const port = Number((await told.next()).value.split(":").at(-1));
    const line = connect(port, "127.0.0.1");
    line.write("++++");
    const said = createInterface(line)[Symbol.asyncIterator]();
    let last = "";
    for (let next = ""; !next.startsWith("reset:"); next = (await said.next()).value) last = next;
    assert.match(last, /duty 2048 ok/);
    const [, at] = (await told.next()).value.match(/restarted at ([\d.]+) s/);
    assert.ok(at - 0.4 < 0.016, at);
    assert.match((await said.next()).value, /duty 0 ok/);
    line.destroy();
  } finally {
    bench.kill();
  }
});

// A bench, and what the host says to the device on it: its exit code, and the run that it kept.
async function commission(name, benchFlags, flags) {
  const bench = spawn("node", [BENCH, PICO, "--counts-per-rev", COUNTS, ...benchFlags], {
    stdio: ["ignore", "pipe", "inherit"],
  });
  try {
    const [first] = await new Promise((told) => createInterface(bench.stdout).once("line", (...line) => told(line)));
    const out = join(folder, name);
    const given = ["--port", `tcp:${first.replace("link: ", "")}`, "--supply-v", "12", "--counts-per-rev", COUNTS, "--out", out];
    const run = await servoid(["device", "commission", ...given, ...flags]);
    return { run, out, saved: JSON.parse(readFileSync(join(out, "device.json"), "utf8")) };
  } finally {
    bench.kill();
  }
}

const servoid = (flags) =>
  promisify(execFile)(SERVOID, ["-q", ...flags]).then(
    ({ stdout }) => ({ code: 0, text: stdout }),
    ({ code, stdout, stderr }) => ({ code, text: stdout + stderr }),
  );

test("it finds the motor in fixed point; the host finds the same bits, and no physics missing", async () => {
  // Fewer models than usual: while the chip computes, the emulator takes six seconds for one of its own.
  // And a second to verify, as long as what its log holds to fit: over two, what the gain is not known to would be a quarter of a
  // count, and the error between 0.31 and 0.38 by where the shaft happened to stand.
  const { run, out, saved } = await commission("whole", [], ["--budget", "400", "--verify", "1"]);
  assert.equal(run.code, 0, run.text);
  const value = (name) => saved.outcome.parameters.find((p) => p.name === name).value;
  const [gain, lag] = new Motor(TEN_WATTS).truth();
  const off = [value("gain") / gain - 1, value("a1") / lag - 1];
  console.log(`gain ${off[0]}, a1 ${off[1]} off, ${saved.outcome.rms_counts} counts, ${saved.verified_rms_counts} held out`);
  assert.ok(Math.abs(off[0]) < 1e-4 && Math.abs(off[1]) < 1e-3, `${off}`);
  assert.ok(saved.verified_rms_counts < 0.35);
  const told = JSON.parse((await servoid(["device", "verify", out, "--json", "-"])).text);
  console.log(told.diagnosis.summary);
  assert.ok(told.same_bits && told.stands, told.verdict);
  const { rms_counts, validate_rms_counts } = told.diagnosis.final;
  assert.ok(Math.max(rms_counts, validate_rms_counts) < 0.35, told.diagnosis.summary);
});

for (const [name, benchFlags, told] of [
  ["a reversed encoder", ["--encoder-reversed"], "Runaway"],
  ["a fault of the bridge", ["--bridge-fault-at", "4"], "Bridge"],
]) {
  test(`${name} opens the bridge and is named`, async () => {
    const { run, saved } = await commission(name.replaceAll(" ", "-"), benchFlags, ["--excite", "20"]);
    assert.equal(run.code, 1, run.text);
    assert.equal(saved.failure.fault, told, run.text);
  });
}
