"""Writes the Parquet fixtures with pyarrow, Parquet's reference library for Python.

    pip install pyarrow numpy && python make_parquet.py
"""

from datetime import date, timedelta
from decimal import Decimal
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

HERE = Path(__file__).parent / "fixtures" / "parquet"
FIRST = 1_700_000_000_123_456_789


def flat(rows: int) -> pa.Table:
    """One table: what each row holds follows from its number k, and the test knows how."""
    k = range(rows)
    fields = [
        pa.field("t", pa.float64(), metadata={"unit": "s"}),
        pa.field("count", pa.int32()),
        pa.field("big", pa.int64()),
        pa.field("small", pa.uint8()),
        pa.field("half", pa.float16()),
        pa.field("exact", pa.decimal128(9, 2)),
        pa.field("on", pa.bool_()),
        pa.field("when", pa.timestamp("ns", tz="UTC")),
        pa.field("day", pa.date32()),
        pa.field("took", pa.duration("us")),
        pa.field("label", pa.string()),
        pa.field("mode", pa.dictionary(pa.int8(), pa.int16())),
        pa.field("gap", pa.float64()),
        pa.field("state", pa.list_(pa.float32())),
        pa.field("pair", pa.list_(pa.float64(), 2)),
        pa.field("arm", pa.struct([("angle", pa.float64()), ("raw", pa.list_(pa.int16()))])),
        pa.field("image", pa.list_(pa.uint8())),
    ]
    columns = [
        [0.25 * i for i in k],
        [i - 7 for i in k],
        [1_000_000_007 * i for i in k],
        [i % 256 for i in k],
        np.array([0.5 * (i % 64) for i in k], dtype=np.float16),
        [Decimal(i) / 4 for i in k],
        [i % 3 == 0 for i in k],
        pa.array([FIRST + 1_000_001 * i for i in k], pa.timestamp("ns", tz="UTC")),
        [date(2024, 1, 31) + timedelta(days=i) for i in k],
        pa.array([1500 * i for i in k], pa.duration("us")),
        [f"row {i}" for i in k],
        pa.array([i % 2 for i in k], pa.int16()).dictionary_encode().cast(
            pa.dictionary(pa.int8(), pa.int16())
        ),
        [None if i % 5 == 2 else 0.125 * i for i in k],
        [[i + 0.25, i + 0.5, i + 0.75] for i in k],
        [[2.0 * i, 2.0 * i + 1.0] for i in k],
        [None if i == 4 else {"angle": -0.5 * i, "raw": [i, i + 1]} for i in k],
        [bytes([i % 256]) * 300 for i in k],
    ]
    columns[-1] = [list(image) for image in columns[-1]]
    arrays = [c if isinstance(c, pa.Array) else pa.array(c, f.type) for c, f in zip(columns, fields)]
    return pa.Table.from_arrays(arrays, schema=pa.schema(fields))


def main() -> None:
    HERE.mkdir(parents=True, exist_ok=True)
    pq.write_table(flat(100), HERE / "flat.parquet", row_group_size=32, compression="snappy")
    few = flat(40).drop_columns(["image"])
    for codec in ["none", "gzip", "zstd", "lz4"]:
        pq.write_table(few, HERE / f"codec_{codec}.parquet", compression=codec)
    numbers = pa.table(
        {
            "count": pa.array([k * k for k in range(200)], pa.int64()),
            "angle": pa.array([0.25 * k for k in range(200)], pa.float32()),
            "label": pa.array([f"{k % 4}" for k in range(200)]),
        }
    )
    pq.write_table(
        numbers,
        HERE / "encodings.parquet",
        use_dictionary=["label"],
        column_encoding={"count": "DELTA_BINARY_PACKED", "angle": "BYTE_STREAM_SPLIT"},
        data_page_version="2.0",
        data_page_size=256,
        write_page_checksum=True,
    )
    # As `servoid batch` takes them: a recording a row, with what is known of the motor beside it.
    lengths = [5, 8, 6]
    recordings = pa.table(
        {
            "unit": ["left", "right", None],
            "t_s": [[0.001 * k for k in range(n)] for n in lengths],
            "voltage_v": [[0.5 * k + n for k in range(n)] for n in lengths],
            "angle_counts": [[10 * k - n for k in range(n)] for n in lengths],
            "current_a": pa.array([[0.25 * k for k in range(5)], None, [1.0] * 6]),
            "enabled": [[k % 2 == 0 for k in range(n)] for n in lengths],
            "counts_per_rev": [4096.0, 2048.0, 1024.0],
        }
    )
    pq.write_table(recordings, HERE / "recordings.parquet", row_group_size=2)
    ragged = pa.table(
        {
            "t": [0.5 * k for k in range(20)],
            "hits": [[float(i) for i in range(k % 4)] for k in range(20)],
        }
    )
    pq.write_table(ragged, HERE / "ragged.parquet")
    pq.write_table(numbers.slice(0, 0), HERE / "empty.parquet")


main()
