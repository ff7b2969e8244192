// Boots an unmodified image of the Pico and closes the loop around it: its PWM drives a motor, the motor's encoder turns the lines
// that its state machine watches, its serial port, or with --usb its USB port, is a TCP socket. A line on the standard input cuts the power.
import net from "node:net";
import { parseArgs } from "node:util";
import { Chip } from "./chip.mjs";
import { Motor, TEN_WATTS } from "./motor.mjs";

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    port: { type: "string", default: "0" },
    "counts-per-rev": { type: "string", default: "2000" },
    "encoder-reversed": { type: "boolean", default: false },
    "bridge-fault-at": { type: "string", default: "Infinity" },
    "wedged-at": { type: "string", default: "Infinity" },
    usb: { type: "boolean", default: false },
  },
});
if (positionals.length !== 1) {
  console.error("usage: node bench.mjs IMAGE [flags]; scripts/pico --help lists them");
  process.exit(2);
}
const countsPerRev = Number(values["counts-per-rev"]);
const faultAt = Number(values["bridge-fault-at"]);
const wedgedAt = Number(values["wedged-at"]);

const LINES = [[false, false], [true, false], [true, true], [false, true]];
// Virtual time between two looks at the clock on the wall, ns.
const SLICE = 2e6;

const chip = new Chip(positionals[0], values.usb);
const motor = new Motor(TEN_WATTS);
let shown = 0;
let last = 0;

function lines() {
  const lines = LINES[((shown % 4) + 4) % 4];
  return values["encoder-reversed"] ? lines.toReversed() : lines;
}

function show(count) {
  while (shown !== count) {
    shown += Math.sign(count - shown);
    chip.encoder(lines());
  }
}

function advance() {
  const now = chip.clock.nanos * 1e-9;
  motor.advance(chip.duty(), now - last);
  if (last <= wedgedAt && now > wedgedAt) chip.wedged = true;
  last = now;
  show(Math.floor((motor.angle / 2 / Math.PI) * countsPerRev));
  chip.fault(now > faultAt);
}

chip.encoder(lines());
chip.fault(false);
chip.seen = advance;
chip.restarted = () => {
  // The emulator has forgotten what its pins show; the bench has not.
  advance();
  chip.encoder(lines());
  console.log(`restarted at ${last.toFixed(4)} s`);
};

net
  .createServer((socket) => {
    socket.setNoDelay(true);
    socket.on("data", (bytes) => chip.receive(bytes));
    socket.on("error", () => {});
    chip.sent = (byte) => socket.write(Uint8Array.of(byte));
  })
  .listen(Number(values.port), "127.0.0.1", function () {
    console.log(`link: 127.0.0.1:${this.address().port}`);
  });

// A line cuts the power for a moment.
process.stdin.on("data", () => chip.cutPower());

// No faster than the clock on the wall: a host waits in real time.
const started = performance.now();
function go() {
  chip.run(SLICE);
  const ahead = chip.clock.nanos / 1e6 - (performance.now() - started);
  setTimeout(go, Math.max(0, ahead));
}
go();
