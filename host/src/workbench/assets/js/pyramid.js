// A long series with its least and greatest values over blocks, so that any part of it is thinned at once for what is seen.

const STEP = 4;

/** Extremes of a series over blocks of 4, 16, 64 … samples. */
export class Pyramid {
  constructor(values) {
    this.values = values;
    this.levels = [];
    let below = { size: 1, min: values, max: values, sum: values };
    while (below.min.length > 64) {
      const length = Math.ceil(below.min.length / STEP);
      const level = {
        size: below.size * STEP,
        min: new Float32Array(length),
        max: new Float32Array(length),
        sum: new Float64Array(length),
      };
      for (let k = 0; k < length; k += 1) {
        const end = Math.min(below.min.length, (k + 1) * STEP);
        let [min, max, sum] = [Infinity, -Infinity, 0];
        for (let j = k * STEP; j < end; j += 1) {
          if (below.min[j] < min) min = below.min[j];
          if (below.max[j] > max) max = below.max[j];
          sum += below.sum[j];
        }
        level.min[k] = min;
        level.max[k] = max;
        level.sum[k] = sum;
      }
      this.levels.push(level);
      below = level;
    }
  }

  /** Least, greatest and mean value from sample `from` up to `to`, which is not among them. */
  over(from, to) {
    const width = to - from;
    let level = { size: 1, min: this.values, max: this.values, sum: this.values };
    for (const coarser of this.levels) {
      if (coarser.size * STEP > width) break;
      level = coarser;
    }
    const first = Math.floor(from / level.size);
    const last = Math.min(level.min.length, Math.ceil(to / level.size));
    let [min, max, sum] = [Infinity, -Infinity, 0];
    for (let k = first; k < last; k += 1) {
      if (level.min[k] < min) min = level.min[k];
      if (level.max[k] > max) max = level.max[k];
      sum += level.sum[k];
    }
    const samples = Math.min(this.values.length, last * level.size) - first * level.size;
    return [min, max, sum / samples];
  }

  /** The largest size from sample `from` up to `to`. */
  largest(from, to) {
    const [min, max] = this.over(from, Math.max(to, from + 1));
    return Math.max(Math.abs(min), Math.abs(max));
  }
}

/** Edges of at most `most` parts of the samples from `from` up to `to`. */
export function parts(from, to, most) {
  const count = Math.max(1, Math.min(most, to - from));
  return Array.from({ length: count + 1 }, (_, k) => from + Math.round(((to - from) * k) / count));
}
