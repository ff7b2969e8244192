// What stands below a model's error.

/** What the motor does not repeat, counts, as the last look beside the chosen model found it; 0 where it did not. */
export function repeatability(bench) {
  const found = bench.proposed?.floor;
  return found?.kind === "repeatability" ? found.counts : 0;
}

/** The error of a right model, counts. */
export const floorCounts = (bench) => Math.max(repeatability(bench), bench.floor_counts);
