// Numbers as people read them: three digits that tell, a narrow space between thousands, a true minus.

const NARROW = "\u202f";

/** A number with so many digits that tell. */
export function digits(x, count = 3) {
  if (x === null || x === undefined || !Number.isFinite(x)) return "–";
  if (x === 0) return "0";
  const size = Math.floor(Math.log10(Math.abs(Number(x.toPrecision(count)))));
  if (size >= 7 || size < -4) {
    const [mantissa, power] = x.toExponential(count - 1).split("e");
    return signed(`${mantissa}e${Number(power)}`);
  }
  const text = Math.abs(x).toFixed(Math.max(0, Math.min(6, count - 1 - size)));
  return (x < 0 ? "−" : "") + grouped(text);
}

const signed = (text) => text.replace(/-/g, "−");

/** Thousands apart. */
function grouped(text) {
  const [whole, part] = text.split(".");
  const apart = whole.length > 3 ? whole.replace(/\B(?=(\d{3})+$)/g, NARROW) : whole;
  return part === undefined ? apart : `${apart}.${part}`;
}

/** An error in counts. */
export function counts(x) {
  if (x === null || x === undefined || !Number.isFinite(x)) return "–";
  if (x < 10) return digits(x, 3);
  return x < 1e6 ? grouped(x.toFixed(x < 100 ? 1 : 0)) : digits(x, 3);
}

/** A factor. */
export const times = (x) => (x < 9.95 ? x.toFixed(1) : grouped(x.toFixed(0)));

/** A text of ours as a number again. */
export const read = (text) => Number(text.replace(/[\s\u202f]/g, "").replace("−", "-"));

// The units in which an engineer has such numbers.
const USUAL = [
  ["rad/(s*V)", 30 / Math.PI, "rpm/V"], ["N*m/A", 1e3, "mN·m/A"], ["N*m*s/rad", 1e6, "µN·m·s"], ["N*m", 1e3, "mN·m"], ["kg*m^2", 1e7, "g·cm²"], ["H", 1e3, "mH"],
  ["V*s/rad", 1e3, "mV·s"], ["V*s^2/rad", 1e6, "µV·s²"], ["s", 1e3, "ms"], ["s^2", 1e6, "ms²"], ["ohm", 1, "Ω"],
];

/** A value in such a unit: `{ value, factor, unit }`. */
export function usual(value, unit, name) {
  const found = name === "viscous_part" ? ["1", 100, "%"] : USUAL.find(([si]) => si === unit);
  const [, factor, own] = found ?? [unit, 1, spelled(unit)];
  return { value: value * factor, factor, unit: own };
}

const spelled = (unit) => (unit === "1" ? "" : unit.replace(/\*/g, "·").replace(/\^2/g, "²").replace("ohm", "Ω"));

// More digits than this of a value say nothing more.
const MOST_DIGITS = 5;
// A half width below this part of the value stands as a percentage, below the other one as a bound.
const [SMALL, LEAST] = [2e-3, 1e-4];

/** A value with its half width: as many digits as that allows; a very small half width as a part of the value, at most. */
export function estimate(value, half) {
  if (!Number.isFinite(half) || half <= 0) return [Number.isInteger(value) ? String(value) : digits(value, 4), null];
  const size = value === 0 ? 0 : Math.floor(Math.log10(Math.abs(value)));
  if (size >= 7 || size < -4) return [digits(value, 3), digits(half, 2)];
  const needed = 1 - Math.floor(Math.log10(half));
  const places = Math.max(0, Math.min(needed, MOST_DIGITS - 1 - size));
  const fixed = (x) => (x < 0 ? "−" : "") + grouped(Math.abs(x).toFixed(places));
  const part = half / Math.abs(value);
  if (part < LEAST) return [fixed(value), "0.01 %"];
  return [fixed(value), part < SMALL ? `${digits(100 * part, 1)} %` : fixed(half)];
}
