"""A large lot of simulated motors with damaged recordings and odd units among them, through `servoid batch` and `servoid fleet`.

    python fleet_lot.py FOLDER [--motors 10000] [--damaged 200] [--odd 50] [--seed 1] [--do fit|diagnose]

The plant is numpy's alone: all motors side by side, steps of 20 us with the winding's exact response and each standstill at its
moment, counts floored once a millisecond.
SERVOID names the program. Prints what was found of what was hidden, times, and the largest memory of each step.
"""

import argparse
import json
import os
import resource
import subprocess
import time
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

PERIOD_S = 1e-3
SUBSTEPS = 50
SECONDS = 2.0
COUNTS_PER_REV = 2000
SUPPLY_V = 12.0
#: Median of each parameter, and standard deviation of its logarithm between motors.
MOTOR = {
    "resistance": (1.2, 0.05),
    "inductance": (0.3e-3, 0.05),
    "k": (0.0165, 0.03),
    "inertia": (6e-6, 0.04),
    "viscous": (8e-6, 0.10),
    "friction": (0.005, 0.10),
}
#: Friction and viscous friction go together: one grease.
CORRELATION = 0.6


def drawn(rng, motors):
    """Parameters of so many motors."""
    z = dict(zip(MOTOR, rng.standard_normal((len(MOTOR), motors)), strict=True))
    z["viscous"] = CORRELATION * z["friction"] + np.sqrt(1 - CORRELATION**2) * z["viscous"]
    return {name: centre * np.exp(spread * z[name]) for name, (centre, spread) in MOTOR.items()}


def odd(rng, motors, count, parameters):
    """Makes so many of them odd, in one of six ways; returns their numbers and how."""
    numbers = rng.choice(motors, count, replace=False)
    ways = rng.integers(0, 6, count)
    extra = np.zeros(motors)
    for number, way in zip(numbers, ways, strict=True):
        if way == 0:
            parameters["friction"][number] *= 2
        elif way == 1:
            parameters["k"][number] *= 0.8
        elif way == 2:
            parameters["inertia"][number] *= 1.3
        elif way == 3:
            parameters["resistance"][number] *= 1.4
        elif way == 4:
            extra[number] = 0.5 * parameters["friction"][number]
        else:
            parameters["viscous"][number] *= 8
    return numbers, ways, extra


def recorded(rng, parameters, cogging):
    """Voltage and counts of all motors: steps up and down, a coast, and a slow triangle."""
    steps = round(SECONDS / PERIOD_S)
    t = np.arange(steps) * PERIOD_S
    shape = np.where(t < 0.8, np.sign(np.sin(2 * np.pi * t / 0.4)) * 6, 0.0)
    triangle = 2 * np.abs((t / 0.6) % 1 - 0.5) * 2 - 1
    shape = np.where((t >= 0.9) & (t < 1.8), 9 * triangle, shape)
    motors = len(cogging)
    voltage = np.broadcast_to(shape, (motors, steps))
    current, speed, angle = np.zeros(motors), np.zeros(motors), rng.uniform(0, 1, motors)
    before = speed
    counts = np.empty((motors, steps), np.int32)
    p, step = parameters, PERIOD_S / SUBSTEPS
    fades = np.exp(-step * p["resistance"] / p["inductance"])
    brake = step * p["friction"] / p["inertia"]
    for k in range(steps):
        counts[:, k] = np.floor(angle * COUNTS_PER_REV / (2 * np.pi))
        for _ in range(SUBSTEPS):
            middle = 1.5 * speed - 0.5 * before
            steady = (shape[k] - p["k"] * middle) / p["resistance"]
            after = steady + (current - steady) * fades
            push = p["k"] * 0.5 * (current + after) - p["viscous"] * middle - cogging * np.cos(8 * angle)
            current = after
            free = step * push / p["inertia"]
            started = np.sign(free) * np.maximum(np.abs(free) - brake, 0)
            before, speed = speed, np.where(speed == 0, started, speed + free - np.sign(speed) * brake)
            # Friction turns with the motor, or holds it, from the moment at which it stands: half a step late would pass for a
            # longer time constant of the winding.
            turned = before * speed < 0
            left = np.where(turned, speed / np.where(turned, speed - before, 1.0), 0.5)
            speed = np.where(turned, left * started, speed)
            angle += 0.5 * step * np.where(turned, (1 - left) * before + left * speed, before + speed)
    return t, voltage, counts


def damage(rng, row, way):
    """Damages a recording."""
    t, u, n = row["t_s"].copy(), row["voltage_v"].copy(), row["angle_counts"].astype(float)
    if way == 0:
        n[rng.integers(0, len(n))] = np.nan
    elif way == 1:
        t[len(t) // 2] = t[len(t) // 2 - 1]
    elif way == 2:
        u = u[:-7]
    elif way == 3:
        n[:] = n[0]
    else:
        t, u, n = t[:5], u[:5], n[:5]
    row |= {"t_s": t, "voltage_v": u, "angle_counts": n}


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("--motors", type=int, default=10_000)
    arguments.add_argument("--damaged", type=int, default=200)
    arguments.add_argument("--odd", type=int, default=50)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--do", default="fit", choices=["fit", "diagnose"])
    asked = arguments.parse_args()
    asked.folder.mkdir(parents=True, exist_ok=True)
    lot, hidden = asked.folder / "lot.parquet", asked.folder / "hidden.json"
    if not lot.exists():
        rng = np.random.default_rng(asked.seed)
        parameters = drawn(rng, asked.motors)
        numbers, ways, cogging = odd(rng, asked.motors, asked.odd, parameters)
        t, voltage, counts = recorded(rng, parameters, cogging)
        usual = np.setdiff1d(np.arange(asked.motors), numbers)
        damaged = rng.choice(usual, asked.damaged, replace=False)
        wrong = dict(zip(damaged.tolist(), rng.integers(0, 5, asked.damaged), strict=True))
        schema, writer = None, None
        for first in range(0, asked.motors, 250):
            rows = []
            for k in range(first, min(first + 250, asked.motors)):
                row = {
                    "unit": f"{k:06}",
                    "t_s": t,
                    "voltage_v": voltage[k],
                    "angle_counts": counts[k].astype(float),
                    "counts_per_rev": float(COUNTS_PER_REV),
                    "supply_v": SUPPLY_V,
                    "lot": f"lot {k * 10 // asked.motors}",
                    "station": str(k % 3),
                }
                if k in wrong:
                    damage(rng, row, wrong[k])
                rows.append(row)
            table = pa.Table.from_pylist(rows)
            if writer is None:
                schema, writer = table.schema, pq.ParquetWriter(lot, table.schema, compression="zstd")
            writer.write_table(table.cast(schema))
        writer.close()
        truth = {name: values.tolist() for name, values in parameters.items()}
        truth |= {"odd": {int(k): int(way) for k, way in zip(numbers, ways, strict=True)}, "damaged": sorted(wrong)}
        hidden.write_text(json.dumps(truth))
    truth = json.loads(hidden.read_text())
    servoid = os.environ.get("SERVOID", "servoid")

    def run(*arguments):
        started = time.monotonic()
        subprocess.run([servoid, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)
        spent = time.monotonic() - started
        most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
        print(f"servoid {arguments[0]}: {spent:.1f} s, at most {most:.0f} MB so far", flush=True)

    results = asked.folder / f"results-{asked.do}"
    options = ["--with", "coulomb"] if asked.do == "fit" else []
    run("batch", lot, "--out", results, "--do", asked.do, *options, "--json", asked.folder / "batch.json")
    run("fleet", results, "--report", asked.folder / "fleet.html", "--json", asked.folder / "fleet.json")
    run("population", results, "--json", asked.folder / "population.json")
    batch = json.loads((asked.folder / "batch.json").read_text())
    fleet = json.loads((asked.folder / "fleet.json").read_text())
    flagged = {int(one["unit"]) for one in fleet["odd"]}
    really = {int(k) for k in truth["odd"]}
    refused = sum(cause["recordings"] for cause in fleet["refused"])
    print(f"{batch['rows']}")
    print(f"error rows: {refused} of {len(truth['damaged'])} damaged")
    print(f"odd units flagged: {len(flagged & really)} of {len(really)}; false flags: {len(flagged - really)}", end=" ")
    print(f"({100 * len(flagged - really) / asked.motors:.2f} % of the fleet)")
    missed = sorted(truth["odd"][str(k)] for k in really - flagged)
    print(f"ways of the missed: {missed}")


if __name__ == "__main__":
    main()
