"""Writes a text, and the same with Python's gzip and with Zstandard's library.

    pip install zstandard && python make_compressed.py
"""

import gzip
from pathlib import Path

import zstandard

HERE = Path(__file__).parent / "fixtures" / "compressed"
HERE.mkdir(parents=True, exist_ok=True)
text = "".join(f"{k},{2 * k}\n" for k in range(300)).encode()
(HERE / "rows.csv").write_bytes(text)
(HERE / "rows.csv.gz").write_bytes(gzip.compress(text, mtime=0))
(HERE / "rows.csv.zst").write_bytes(zstandard.ZstdCompressor(write_checksum=True).compress(text))
# As `cat one.gz other.gz` makes it.
halves = gzip.compress(text[:1000], mtime=0) + gzip.compress(text[1000:], mtime=0)
(HERE / "members.csv.gz").write_bytes(halves)
