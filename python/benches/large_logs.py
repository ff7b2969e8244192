"""Logs of one gigabyte, as CSV and as Parquet, through `servoid open`, `check` and `fit`: times and the largest memory.

    python large_logs.py FOLDER [--gigabytes 1] [--keep]

SERVOID names the program; GNU time is needed. The logs are of one motor that turns to and fro, sampled at 1 kHz, with the columns that a logger writes beside
those that are fitted. They are written a part at a time, and removed afterwards.
"""

import argparse
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pc
import pyarrow.parquet as pq

PERIOD_S = 1e-3
COUNTS_PER_REV = 2048
SUPPLY_V = 24.0
#: First-order motor: speed for a volt, and its time constant.
GAIN_RAD_S_V = 20.0
TIME_CONSTANT_S = 0.05
#: Rows that are made and written at a time.
PART = 250_000
FLAGS = ["--counts-per-rev", str(COUNTS_PER_REV), "--supply-v", str(SUPPLY_V)]


def parts(rng):
    """Tables of rows, without end. Each part's motion begins where the one before it ended."""
    row, angle, speed = 0, 0.0, 0.0
    decay = np.exp(-PERIOD_S / TIME_CONSTANT_S)
    while True:
        steps = rng.uniform(-SUPPLY_V, SUPPLY_V, PART // 500)
        volts = np.repeat(np.round(steps, 3), 500)
        speeds = np.empty(PART)
        for k, target in enumerate(GAIN_RAD_S_V * volts[::500]):
            stretch = target + (speed - target) * decay ** np.arange(1, 501)
            speeds[500 * k : 500 * (k + 1)] = stretch
            speed = stretch[-1]
        angles = angle + PERIOD_S * np.cumsum(speeds)
        angle = angles[-1]
        times = PERIOD_S * np.arange(row, row + PART)
        row += PART
        noise = rng.standard_normal((5, PART))
        yield pa.table(
            {
                "t_s": np.round(times, 3),
                "voltage_v": volts,
                "angle_counts": np.floor(angles / (2 * np.pi) * COUNTS_PER_REV),
                "speed_rad_s": speeds + 0.1 * noise[0],
                "phase_current": volts - speeds / GAIN_RAD_S_V + 0.01 * noise[1],
                "supply_meas": SUPPLY_V + 0.1 * noise[2],
                "temperature": 30 + 0.01 * noise[3],
                "accelerometer": noise[4],
            }
        )


def made(path, size, seed=1):
    """Writes a log of about so many bytes; returns its rows."""
    rows, writer = 0, None
    for table in parts(np.random.default_rng(seed)):
        if writer is None:
            kind = pq.ParquetWriter if path.suffix == ".parquet" else pc.CSVWriter
            writer = kind(path, table.schema)
        writer.write_table(table)
        rows += table.num_rows
        if path.stat().st_size >= size:
            break
    writer.close()
    return rows


def measured(command):
    """Runs a command; returns seconds, the largest memory in MB, and the exit code.

    By time(1), which is small: the kernel counts what a process was before it became the command, and this one holds pyarrow.
    """
    with tempfile.NamedTemporaryFile("r") as said:
        timed = ["/usr/bin/time", "--quiet", "-f", "%e %M", "-o", said.name, *command]
        code = subprocess.call(timed, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        seconds, kilobytes = map(float, said.read().split())
    return seconds, kilobytes * 1024 / 1e6, code


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--gigabytes", type=float, default=1.0)
    parser.add_argument("--keep", action="store_true", help="leave the logs there")
    args = parser.parse_args()
    program = os.environ.get("SERVOID", "servoid")
    args.folder.mkdir(parents=True, exist_ok=True)
    print("log          command                                    s     MB  code")
    for name in ["large.csv", "large.parquet"]:
        log = args.folder / name
        rows = made(log, args.gigabytes * 1e9)
        print(f"{name}: {log.stat().st_size / 1e9:.2f} GB, {rows} rows", flush=True)
        verbs = {
            "open --plot": ["open", log, "--plot", args.folder / "large.svg"],
            "check": ["check", log, *FLAGS],
            "check --to 60": ["check", log, *FLAGS, "--to", "60"],
            "fit --from 100 --to 110": ["fit", log, *FLAGS, "--from", "100", "--to", "110"],
        }
        for said, verb in verbs.items():
            seconds, memory, code = measured([program, *map(str, verb)])
            print(f"             {said:36} {seconds:8.1f} {memory:6.0f} {code:5}", flush=True)
        if not args.keep:
            log.unlink()


if __name__ == "__main__":
    main()
