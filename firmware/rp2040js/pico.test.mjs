// The Picos' applications, as they are flashed, commission a motor; and whatever breaks, the bridge opens. `scripts/pico test` builds
// the images and names them in PICO and PICO2, the bench of the Pico 2 in PICO2_BENCH, and the host's program in SERVOID.
import assert from "node:assert/strict";
import { execFile, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { connect } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { after, test } from "node:test";
import { promisify } from "node:util";
import { Motor, TEN_WATTS } from "./motor.mjs";

const { PICO, PICO2, PICO2_BENCH, YOURS, SERVOID } = process.env;
assert.ok(PICO && PICO2 && PICO2_BENCH && YOURS && SERVOID, "PICO, PICO2, PICO2_BENCH, YOURS and SERVOID name images and programs: run scripts/pico test");

// Each with the bench that runs its image, and the ports that a host may be at. Both benches take the same flags.
const BOARDS = [
  { name: "Pico", image: PICO, bench: ["node", join(import.meta.dirname, "bench.mjs")], ports: { USB: ["--usb"], "serial port": [] } },
  { name: "Pico 2", image: PICO2, bench: [PICO2_BENCH], ports: { "serial port": [] } },
];
const folder = mkdtempSync(join(tmpdir(), "servoid-pico-"));
after(() => rmSync(folder, { recursive: true }));
const COUNTS = "2000";

// A bench with an image, and the lines that it prints after the one that names the address of the board's port.
async function start({ bench: [program, ...fixed] }, image, flags) {
  const bench = spawn(program, [...fixed, image, ...flags], { stdio: ["pipe", "pipe", "inherit"] });
  const lines = createInterface(bench.stdout)[Symbol.asyncIterator]();
  const address = (await lines.next()).value.replace("link: ", "");
  return { bench, lines, address };
}

// A bench, and what the host says to the device on it: its exit code, and the run that it kept. `then` has the device do more.
async function commission(board, name, benchFlags, flags, verb = "commission", then = async () => {}) {
  const { bench, address } = await start(board, board.image, ["--counts-per-rev", COUNTS, ...benchFlags]);
  const told = async (verb, name, flags) => {
    const out = join(folder, `${board.name} ${name}`.replaceAll(" ", "-"));
    const given = ["--port", `tcp:${address}`, "--supply-v", "12", "--counts-per-rev", COUNTS, "--out", out];
    const run = await servoid(["device", verb, ...given, ...flags]);
    return { run, out, saved: JSON.parse(readFileSync(join(out, "device.json"), "utf8")) };
  };
  try {
    const first = await told(verb, name, flags);
    if (first.run.code === 0) await then(told, () => bench.stdin.write("power cut\n"));
    return first;
  } finally {
    bench.kill();
  }
}

const servoid = (flags) =>
  promisify(execFile)(SERVOID, ["-q", ...flags]).then(
    ({ stdout }) => ({ code: 0, text: stdout }),
    ({ code, stdout, stderr }) => ({ code, text: stdout + stderr }),
  );

test("a board out of the template boots, says who it is, and records a motor", async () => {
  const board = { ...BOARDS[0], name: "yours", image: YOURS };
  const { run, saved } = await commission(board, "recorded", [], ["--seconds", "0.5"], "record");
  assert.equal(run.code, 0, run.text);
  assert.equal(saved.board, "your board");
});

for (const board of BOARDS) {
  test(`${board.name}: the watchdog opens the bridge of a program that does not come back, and the program knows it`, async () => {
    // The program for a first power-up is beside the application: it tells on the line what made it start.
    const bringup = board.image.replace("application", "bringup");
    const { bench, lines, address } = await start(board, bringup, ["--wedged-at", "0.4"]);
    try {
      const line = connect(Number(address.split(":").at(-1)), "127.0.0.1");
      line.write("++++");
      const said = createInterface(line)[Symbol.asyncIterator]();
      let last = "";
      // The first start may have been told before anybody listened.
      let next = "";
      while (next !== "reset: watchdog") {
        if (next.startsWith("count")) last = next;
        next = (await said.next()).value;
      }
      assert.match(last, /duty 2048 ok/);
      const [, at] = (await lines.next()).value.match(/restarted at ([\d.]+) s/);
      assert.ok(at - 0.4 < 0.016, at);
      assert.match((await said.next()).value, /duty 0 ok/);
      line.destroy();
    } finally {
      bench.kill();
    }
  });

  for (const [port, portFlags] of Object.entries(board.ports)) {
    test(`${board.name}, ${port}: it finds the motor and makes a servo of it; the host finds the same bits, and no physics missing`, async () => {
      // Fewer models than usual: while the Pico's chip computes, its emulator takes six seconds for one of its own.
      // And a second to verify, as long as what its log holds to fit: over two, what the gain is not known to would be a quarter of a
      // count, and the error between 0.31 and 0.38 by where the shaft happened to stand.
      const { run, out, saved } = await commission(board, `whole ${port}`, portFlags, ["--budget", "400", "--verify", "1"], "tune", async (told, cutPower) => {
        for (const when of ["followed", "followed after a power cut"]) {
          const { run, saved } = await told("follow", `${when} ${port}`, ["--angle", "12.5", "--for", "1"]);
          assert.equal(run.code, 0, run.text);
          assert.ok(Math.abs(saved.followed.reached - 12.5) < 0.02, run.text);
          console.log(`${when}: ${JSON.stringify(saved.predicted)}`);
          if (when === "followed") assert.equal(saved.predicted ?? null, null);
          else assert.ok(Math.abs(saved.predicted.gain_moved) < 0.02, run.text);
          cutPower();
        }
      });
      assert.equal(run.code, 0, run.text);
      const value = (name) => saved.outcome.parameters.find((p) => p.name === name).value;
      const [gain, lag] = new Motor(TEN_WATTS).truth();
      const off = [value("gain") / gain - 1, value("a1") / lag - 1];
      console.log(`gain ${off[0]}, a1 ${off[1]} off, ${saved.outcome.rms_counts} counts, ${saved.verified_rms_counts} held out`);
      assert.ok(Math.abs(off[0]) < 1e-4 && Math.abs(off[1]) < 1e-3, `${off}`);
      assert.ok(saved.verified_rms_counts < 0.35);
      const { predicted, measured } = saved.tuned;
      console.log(`a step of ${saved.tuned.step_counts} counts: predicted ${JSON.stringify(predicted)}, measured ${JSON.stringify(measured)}`);
      assert.ok(Math.abs(measured.settling_s / predicted.settling_s - 1) < 0.15);
      assert.ok(Math.abs(measured.overshoot - predicted.overshoot) < 0.15);
      const told = JSON.parse((await servoid(["device", "verify", out, "--json", "-"])).text);
      console.log(told.diagnosis.summary);
      assert.ok(told.same_bits && told.stands, told.verdict);
      const { rms_counts, validate_rms_counts } = told.diagnosis.final;
      assert.ok(Math.max(rms_counts, validate_rms_counts) < 0.35, told.diagnosis.summary);
    });
  }

  for (const [name, benchFlags, told] of [
    ["a reversed encoder", ["--encoder-reversed"], "Runaway"],
    ["a fault of the bridge", ["--bridge-fault-at", "4"], "Bridge"],
  ]) {
    test(`${board.name}: ${name} opens the bridge and is named`, async () => {
      const { run, saved } = await commission(board, name, benchFlags, ["--excite", "20"]);
      assert.equal(run.code, 1, run.text);
      assert.equal(saved.failure.fault, told, run.text);
    });
  }
}
