"""How much an input holds, and how many tasks that makes."""

import importlib
import os

#: Tasks for each CPU if their number is not given: a lost task costs little, and the last ones end at about the same time.
PER_CPU = 4


def census(input: str) -> tuple[int | None, int | None]:
    """Recordings of an input, and row groups of a Parquet file; None for what is not known here."""
    if os.path.isdir(input):
        return sum(name.lower().endswith(".csv") for _, _, names in os.walk(input) for name in names), None
    try:
        metadata = importlib.import_module("pyarrow.parquet").read_metadata(input)
    except Exception:
        # There is no pyarrow, or the file is damaged; the batch says more about a damaged file.
        return None, None
    return metadata.num_rows, metadata.num_row_groups


def usual_tasks(cpus: int, recordings: int | None, groups: int | None) -> int:
    """Tasks if their number is not given: whole row groups where there are enough for every CPU, so that each is decoded once."""
    most = groups if groups is not None and groups >= 2 * cpus else recordings
    return max(1, min(PER_CPU * cpus, most if most is not None else PER_CPU * cpus))
