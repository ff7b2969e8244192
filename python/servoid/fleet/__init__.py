"""A batch on the processes of one machine or of many: `python -m servoid.fleet run INPUT OUT --engine ray`.

An engine (Ray, Dask) runs tasks. Each task is one shard of `servoid.batch`, in a process of its own. The engine decides where a
task runs, and starts it again when a process or a machine is lost. The folder of results says what is done: a run that was killed
goes on with the same command. Input and results must be on storage that every machine reaches under the same path.

`run` does the batch, and `summary` says what its results tell of all motors together. `prove` proves on random motors, and `compare`
compares search methods over many seeds.
"""

from .._batch import Done
from ._comparison import compare
from ._parts import Joint
from ._proof import prove
from ._run import run
from ._summary import Summary, summary

__all__ = ["Done", "Joint", "Summary", "compare", "prove", "run", "summary"]
