// The RP2040 of rp2040js with an image in its flash, and what that emulator leaves out: the serial port's queue, the
// end of a sleep by an interrupt that is masked, state machines in step with the core, the true periods of timer and carrier, the
// watchdog's reset, and USB buffers that stay the controller's until the host has filled them.
import { readFileSync } from "node:fs";
import { Rom } from "./rom.mjs";
import { RP2040, USBCDC } from "./node_modules/rp2040js/dist/esm/index.js";
import { SimulationClock } from "./node_modules/rp2040js/dist/esm/clock/simulation-clock.js";

const FLASH = 0x10000000;
// Behind the second stage of the boot loader.
const VECTORS = 0x100;
const CYCLE_NS = 8;
// Cycles in which the program of the encoder's state machine comes round, and pushes its count.
const ROUND = 16;
// A byte on the line at 921,600 baud, ns.
const BYTE_NS = 10_850;
// Registers of the serial port, bits of its flags, its interrupt for bytes sent, and its queue (data sheet, 4.2.8).
const [FLAGS, DMA_CONTROL] = [0x18, 0x48];
const [SEND_FULL, SEND_EMPTY] = [1 << 5, 1 << 7];
const SENT = 1 << 5;
const QUEUE = 32;
// The first of the USB port's buffer control registers for packets from the host, of a pair for each endpoint, and the bit that says that
// a buffer is the controller's (data sheet, 4.1.2.5).
const FROM_HOST = 0x84;
const AVAILABLE = 1 << 10;
const PACKET = 64;
// Where the emulator keeps the watchdog: its address without the last three digits.
const WATCHDOG = 0x40058;

// Puts what an ELF file loads into the flash.
function load(flash, path) {
  const file = readFileSync(path);
  if (file.readUInt32BE(0) !== 0x7f454c46) throw new Error(`${path} is no ELF file`);
  const [table, size, count] = [file.readUInt32LE(28), file.readUInt16LE(42), file.readUInt16LE(44)];
  for (let at = table; at < table + size * count; at += size) {
    const [kind, offset, , address, length] = [0, 4, 8, 12, 16].map((k) => file.readUInt32LE(at + k));
    if (kind === 1 && length > 0) flash.set(file.subarray(offset, offset + length), address - FLASH);
  }
}

export class Chip {
  // `usb`: what is sent and received goes through the USB port, not the serial one.
  constructor(image, usb = false) {
    this.image = image;
    this.overUsb = usb;
    this.sent = () => {};
    this.restarted = () => {};
    this.seen = () => {};
    // The core stands still until a reset, and all around it goes on: so looks a program that never comes back.
    this.wedged = false;
    this.boot(0, { reason: 0, scratchData: new Uint32Array(8) });
  }

  // A chip out of reset, at this time, with what its watchdog keeps. All else is as after power-up, the pins included.
  boot(nanos, { reason, scratchData }) {
    this.clock = new SimulationClock();
    this.clock.nanosCounter = nanos;
    this.mcu = new RP2040(this.clock);
    // Of registers that the emulator has not: the program reads noise and power there.
    this.mcu.logger = { debug() {}, warn() {}, error: console.error, info() {} };
    if (this.flash) this.mcu.flash.set(this.flash);
    else load(this.mcu.flash, this.image);
    this.flash = this.mcu.flash;
    this.rom = new Rom(this.mcu, this.clock);
    const watchdog = this.mcu.peripherals[WATCHDOG];
    Object.assign(watchdog, { reason, scratchData });
    this.resets = false;
    watchdog.onWatchdogTrigger = () => {
      this.resets = true;
      // Or the emulator calls for ever.
      watchdog.alarm.enable = false;
    };
    const start = new DataView(this.mcu.flash.buffer, this.mcu.flash.byteOffset + VECTORS);
    const core = this.mcu.core;
    core.SP = start.getUint32(0, true);
    core.PC = start.getUint32(4, true) & ~1;
    core.VTOR = FLASH + VECTORS;
    this.periods();
    this.line();
    this.buffers();
    if (this.overUsb) this.host();
    this.machines();
    this.carrier = this.mcu.pwm.channels[0];
    this.turns();
  }

  // The power goes and comes back: the flash is as it was.
  cutPower() {
    this.wedged = false;
    this.boot(this.clock.nanos, { reason: 0, scratchData: new Uint32Array(8) });
    this.restarted();
  }

  // A period of the core's timer is a cycle longer than its reload value; the emulator's is not, and slides along the carrier.
  periods() {
    const { systickAlarm, systickTimer } = this.mcu.ppb;
    const ended = systickAlarm.callback;
    systickAlarm.callback = () => {
      ended();
      systickTimer.set(this.mcu.ppb.systickReload + 1);
    };
  }

  // The serial port: bytes go to `sent`, and come from `receive`. The emulator sends at once and asks for more without end: here
  // a queue of 32 bytes goes out at the line's speed, and its interrupt comes when it has sunk to an eighth (data sheet, 4.2.6).
  line() {
    const uart = this.mcu.uart[0];
    uart.checkInterrupts = () => {
      this.mcu.setInterrupt(uart.irq, (uart.interruptStatus & uart.interruptMask) !== 0);
    };
    const queue = [];
    let dmaControl = 0;
    const [read, write] = [uart.readUint32.bind(uart), uart.writeUint32.bind(uart)];
    uart.readUint32 = (offset) => {
      if (offset === DMA_CONTROL) return dmaControl;
      if (offset !== FLAGS) return read(offset);
      return (read(offset) & ~SEND_EMPTY) | (queue.length === 0 ? SEND_EMPTY : 0) | (queue.length < QUEUE ? 0 : SEND_FULL);
    };
    uart.writeUint32 = (offset, value) => {
      if (offset === DMA_CONTROL) dmaControl = value;
      else if (offset !== 0) write(offset, value);
      else if (queue.length < QUEUE) queue.push(value & 0xff);
    };
    this.waiting = [];
    this.free = { send: 0, receive: 0 };
    this.carry = () => {
      const now = this.clock.nanos;
      if (this.waiting.length > 0 && now >= this.free.receive) {
        this.free.receive = now + BYTE_NS;
        uart.feedByte(this.waiting.shift());
      }
      if (queue.length > 0 && now >= this.free.send) {
        this.free.send = now + BYTE_NS;
        this.sent(queue.shift());
        if (queue.length === QUEUE / 8) {
          uart.interruptStatus |= SENT;
          uart.checkInterrupts();
        }
      }
    };
  }

  // The emulator gives a USB buffer back to the program before a host has filled it, even without one.
  buffers() {
    const { usbCtrl: port, usbDPRAMView: memory } = this.mcu;
    const [updated, finished] = [port.DPRAMUpdated.bind(port), port.finishRead.bind(port)];
    port.DPRAMUpdated = (offset, value) => {
      updated(offset, value);
      if (offset >= FROM_HOST && (offset & 4) !== 0 && value & AVAILABLE) memory.setUint32(offset, value, true);
    };
    port.finishRead = (endpoint, bytes) => {
      finished(endpoint, bytes);
      const control = FROM_HOST + 8 * endpoint;
      memory.setUint32(control, memory.getUint32(control, true) & ~AVAILABLE, true);
    };
  }

  // A host on the USB port, which takes and sends packets as soon as the chip lets it.
  host() {
    const { usbCtrl: port } = this.mcu;
    const host = new USBCDC(port);
    host.onSerialData = (bytes) => bytes.forEach((byte) => this.sent(byte));
    let ready = false;
    // The emulator's own would answer with nothing if there is nothing.
    port.onEndpointRead = (endpoint) => {
      ready ||= endpoint === host.outEndpoint;
    };
    this.waiting = [];
    this.carry = () => {
      if (!ready || this.waiting.length === 0) return;
      ready = false;
      port.endpointReadDone(host.outEndpoint, Uint8Array.from(this.waiting.splice(0, PACKET)));
    };
  }

  receive(bytes) {
    this.waiting.push(...bytes);
  }

  // The state machines stand still but where that shows: when a line has changed, and when the program reads what they tell.
  machines() {
    const pio = this.mcu.pio[0];
    pio.run = () => {};
    const read = pio.readUint32.bind(pio);
    this.settle = (cycles) => {
      for (let k = 0; k < cycles; k += 1) pio.step();
    };
    pio.readUint32 = (offset) => {
      this.settle(ROUND / 2);
      return read(offset);
    };
  }

  // The lines of the encoder.
  encoder([a, b]) {
    this.mcu.gpio[20].setInputValue(a);
    this.mcu.gpio[21].setInputValue(b);
    this.settle(4 * ROUND);
  }

  // The fault line of the bridge, active low.
  fault(is) {
    this.mcu.gpio[19].setInputValue(!is);
  }

  // The part of the supply across the winding, as the carrier has it now; null while the bridge is open.
  duty() {
    const enabled = this.mcu.gpio[18].value === 1;
    const { alarmA, alarmB, top } = this.carrier;
    return enabled ? (alarmA.target - alarmB.target) / (top + 1) : null;
  }

  // Calls `seen` whenever the carrier has come down to zero, just before it takes new duties over: every 2 (TOP + 1) cycles
  // (data sheet, 4.5.2.6). The emulator's own carrier is two cycles short, and turns at its peak as well.
  turns() {
    const { carrier } = this;
    for (const alarm of [carrier.alarmA, carrier.alarmB, carrier.alarmBottom]) alarm.enable = false;
    const turn = this.clock.createAlarm(() => {
      next(0);
      this.seen();
      carrier.wrap();
    });
    const next = (from) => turn.schedule((2 * (carrier.top + 1) - from) * CYCLE_NS);
    const enable = carrier.updateEnable.bind(carrier);
    carrier.updateEnable = () => {
      enable();
      turn.cancel();
      if (carrier.timer.enable) next(carrier.timer.counter);
    };
  }

  // Runs for so many ns.
  run(ns) {
    const end = this.clock.nanos + ns;
    while (this.clock.nanos < end) {
      this.runUntilReset(end);
      if (this.resets) {
        this.wedged = false;
        this.boot(this.clock.nanos, this.mcu.peripherals[WATCHDOG]);
        this.restarted();
      }
    }
  }

  runUntilReset(end) {
    const { clock, mcu } = this;
    const core = mcu.core;
    while (clock.nanos < end && !this.resets) {
      if (this.wedged) {
        clock.tick(BYTE_NS);
      } else if (core.waiting) {
        clock.tick(Math.max(CYCLE_NS, Math.min(clock.nanosToNextAlarm || BYTE_NS, BYTE_NS)));
        const pending = core.pendingInterrupts & core.enabledInterrupts;
        if (core.pendingSystick || pending) core.waiting = false;
      } else if (!this.rom.ran(core)) {
        clock.tick(core.executeInstruction() * CYCLE_NS);
      }
      this.carry();
    }
  }
}
