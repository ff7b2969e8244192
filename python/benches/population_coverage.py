"""How often the 95 % intervals of a population hold the truth: many simulated fleets through `servoid.batch` and `servoid.population`.

    python population_coverage.py FOLDER [--fleets 200] [--motors 40] [--seed 1]

The plant is numpy's (fleet_lot.py). The truth is the mean and covariance of a million drawn motors.
"""

import argparse
import json
import shutil
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import servoid as sv
from fleet_lot import COUNTS_PER_REV, SUPPLY_V, drawn, recorded

#: Odd units are left out of a population; of usual fleets nearly none.
NAMES = ["gain", "a1", "electrical_time_constant", "coulomb.torque"]


def told(p):
    """What voltage and angle tell of motors, in the order of NAMES."""
    total = p["k"] + p["viscous"] * p["resistance"] / p["k"]
    inertia = p["inertia"] * p["resistance"] / p["k"]
    electrical = p["inductance"] / p["resistance"]
    damping = total - p["k"]
    return np.array(
        [1 / total, (inertia + electrical * damping) / total, electrical, p["friction"] * p["resistance"] / p["k"]]
    )


def every(held):
    """All of a kind, whatever the parameter."""
    return [one for own in held.values() for one in own]


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("--fleets", type=int, default=200)
    arguments.add_argument("--motors", type=int, default=40)
    arguments.add_argument("--seed", type=int, default=1)
    asked = arguments.parse_args()
    rng = np.random.default_rng(asked.seed)
    truth = told(drawn(np.random.default_rng(0), 1_000_000))
    mean, covariance = truth.mean(axis=1), np.cov(truth)
    held = {kind: {} for kind in ("mean", "variance", "covariance")}
    errors = {name: ([], []) for name in NAMES}
    missing = 0

    def note(kind, name, bounds, true):
        held[kind].setdefault(name, []).append(bounds["low"] <= true <= bounds["high"])

    for fleet in range(asked.fleets):
        shutil.rmtree(asked.folder, ignore_errors=True)
        asked.folder.mkdir(parents=True)
        parameters = drawn(rng, asked.motors)
        t, voltage, counts = recorded(rng, parameters, np.zeros(asked.motors))
        rows = {
            "unit": [str(k) for k in range(asked.motors)],
            "t_s": [t] * asked.motors,
            "voltage_v": list(voltage),
            "angle_counts": list(counts.astype(float)),
            "counts_per_rev": [float(COUNTS_PER_REV)] * asked.motors,
            "supply_v": [SUPPLY_V] * asked.motors,
        }
        pq.write_table(pa.table(rows), asked.folder / "lot.parquet")
        table = asked.folder / "table.parquet"
        sv.batch(asked.folder / "lot.parquet", asked.folder / "out", do="fit", effects=["coulomb"], table=table)
        own = dict(zip(NAMES, told(parameters), strict=True))
        for row in pq.read_table(table, columns=["unit", "parameters"]).to_pylist():
            for one in row["parameters"] or []:
                if one["name"] in errors and one["std"] is not None:
                    true = own[one["name"]][int(row["unit"])]
                    errors[one["name"]][0].append(one["value"] / true - 1)
                    errors[one["name"]][1].append(one["std"] / true)
        found = json.loads(sv.population(asked.folder / "out").json)
        place = {member["name"]: k for k, member in enumerate(found["parameters"])}
        for j, name in enumerate(NAMES):
            if name not in place:
                missing += 1
                continue
            note("mean", name, found["parameters"][place[name]]["mean"], mean[j])
            for k, other in enumerate(NAMES[: j + 1]):
                if other in place:
                    pair = name if j == k else f"{other}, {name}"
                    bounds = found["covariance"][place[name]][place[other]]
                    note("variance" if j == k else "covariance", pair, bounds, covariance[j, k])
        if (fleet + 1) % 20 == 0:
            print(f"{fleet + 1} fleets:", {kind: f"{100 * np.mean(every(own)):.1f} %" for kind, own in held.items()}, flush=True)
    for kind, own in held.items():
        found = every(own)
        print(f"{kind}: the truth is within {100 * np.mean(found):.1f} % of {len(found)} intervals of 95 %")
        for name, one in own.items():
            print(f"  {name}: {100 * np.mean(one):.1f} % of {len(one)}")
    print("errors of one motor's fit, in percent: mean, standard deviation, and what fits state")
    for name, (found, stated) in errors.items():
        told_std = np.sqrt(np.mean(np.square(stated)))
        print(f"  {name}: {100 * np.mean(found):.4f}, {100 * np.std(found):.4f}, {100 * told_std:.4f} ({len(found)} motors)")
    if missing:
        print(f"{missing} parameters were not in their population, and are not counted")


if __name__ == "__main__":
    main()
