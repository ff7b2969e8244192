"""Writes the data log with WPILib's own library.

    pip install robotpy-wpiutil && python make_wpilog.py
"""

import dataclasses
from pathlib import Path

import wpiutil.log as log
from wpiutil import DataLogWriter
from wpiutil.wpistruct import double, int16, make_wpistruct, pack, packArray

HERE = Path(__file__).parent / "fixtures" / "wpilog"
FIRST = 1_000_123
STEP = 5_001


@make_wpistruct(name="Rotation2d")
@dataclasses.dataclass
class Rotation2d:
    value: double


@make_wpistruct(name="Pose2d")
@dataclasses.dataclass
class Pose2d:
    x: double
    turns: int16
    rotation: Rotation2d
    on: bool


def main() -> None:
    HERE.mkdir(parents=True, exist_ok=True)
    path = HERE / "robot.wpilog"
    path.unlink(missing_ok=True)
    writer = DataLogWriter(str(path), "made for a test")
    voltage = log.DoubleLogEntry(writer, "/arm/voltage", '{"source":"test","unit":"V"}', FIRST)
    counts = log.IntegerLogEntry(writer, "/arm/counts", FIRST)
    current = log.FloatLogEntry(writer, "/arm/current", FIRST)
    enabled = log.BooleanLogEntry(writer, "/arm/enabled", FIRST)
    raw = log.DoubleArrayLogEntry(writer, "/arm/raw", FIRST)
    flags = log.BooleanArrayLogEntry(writer, "/arm/flags", FIRST)
    whole = log.IntegerArrayLogEntry(writer, "/arm/whole", FIRST)
    half = log.FloatArrayLogEntry(writer, "/arm/half", FIRST)
    state = log.StringLogEntry(writer, "sysid-test-state-arm", FIRST)
    words = log.StringArrayLogEntry(writer, "/arm/words", FIRST)
    opaque = log.RawLogEntry(writer, "/arm/opaque", "", "proto:Something", FIRST)
    # The library's own entries of structures do not open in 2026.2.2; it packs them all the same.
    writer.addStructSchema(Pose2d, FIRST)
    pose = writer.start("/arm/pose", "struct:Pose2d", "", FIRST)
    poses = writer.start("/arm/poses", "struct:Pose2d[]", "", FIRST)
    for k in range(30):
        at = FIRST + STEP * k
        voltage.append(0.25 * k, at)
        counts.append(-3 * k, at)
        current.append(0.5 * k, at + 1)
        enabled.append(k % 2 == 0, at)
        raw.append([1.0 * k, 2.0 * k] if k % 2 else [1.0 * k, 2.0 * k, 3.0 * k], at)
        flags.append([k % 2 == 0, True], at)
        whole.append([k, -k], at)
        half.append([0.5 * k], at)
        if k % 10 == 0:
            state.append(["quasistatic-forward", "none", "dynamic-forward"][k // 10], at)
            words.append(["a", "b"], at)
            opaque.append(bytes([k]), at)
        here = Pose2d(1.5 * k, -k, Rotation2d(0.125 * k), k % 3 == 0)
        writer.appendRaw(pose, pack(here), at)
        writer.appendRaw(poses, packArray([here, Pose2d(0.0, 1, Rotation2d(2.0), True)]), at)
    # An entry that ends, and its number with it.
    voltage.finish(FIRST + STEP * 30)
    again = log.DoubleLogEntry(writer, "/arm/voltage", FIRST + STEP * 31)
    again.append(99.0, FIRST + STEP * 31)
    writer.flush()
    writer.stop()
    del writer


main()
