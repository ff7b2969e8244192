"""What is known of a motor, as the text of a `motor.toml`."""

import json
from collections.abc import Mapping
from typing import Any

#: A value, a value with its relative tolerance, or whether something holds.
Fact = float | tuple[float, float] | bool
Facts = Mapping[str, Fact]


def known_toml(known: Facts | None) -> str | None:
    """The facts as a `[known]` section; nothing of nothing."""
    if known is None:
        return None
    lines = ["[known]"]
    for name, fact in known.items():
        if isinstance(fact, tuple):
            value, tolerance = fact
            lines.append(f"{_key(name)} = {{ value = {_number(value)}, tolerance = {_number(tolerance)} }}")
        elif isinstance(fact, bool):
            lines.append(f"{_key(name)} = {str(fact).lower()}")
        else:
            lines.append(f"{_key(name)} = {_number(fact)}")
    return "\n".join(lines) + "\n"


def motor_toml(
    *,
    name: str | None,
    counts_per_rev: float | None,
    supply_v: float | None,
    units: Mapping[str, str],
    drive: str,
    known: Facts | None,
) -> str:
    """A whole motor file."""
    lines = []
    if name is not None:
        lines.append(f"name = {json.dumps(name)}")
    for key, value in (("counts_per_rev", counts_per_rev), ("supply_v", supply_v)):
        if value is not None:
            lines.append(f"{key} = {_number(value)}")
    if units:
        lines.append("[units]")
        lines.extend(f"{key} = {json.dumps(unit)}" for key, unit in units.items())
    if drive != "voltage":
        lines.append("[drive]")
        lines.append(f"kind = {json.dumps(drive)}")
    return "\n".join([*lines, known_toml(known) or ""])


def _key(name: str) -> str:
    return json.dumps(str(name))


def _number(value: Any) -> str:
    # TOML spells what is no number as Python does.
    return repr(float(value))
