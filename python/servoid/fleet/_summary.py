"""What the results of a batch say of all motors together."""

import json
import os
from pathlib import Path
from typing import Any

from .. import _servoid


class Summary:
    """What `servoid fleet RESULTS` says: odd motors, lots and stations, drift, repeatability; made by `summary`."""

    __slots__ = ("_page", "json")

    def __init__(self, text: str, page: str) -> None:
        #: `servoid.fleet/1`, as `servoid fleet --json` writes it.
        self.json = text
        self._page = page

    def to_dict(self) -> dict[str, Any]:
        """The same as a dictionary of its own."""
        document: dict[str, Any] = json.loads(self.json)
        return document

    def to_html(self, path: str | os.PathLike[str] | None = None) -> str:
        """The page with the drawings, in one file without requests; written to `path` if one is given."""
        if path is not None:
            Path(path).write_text(self._page, encoding="utf-8")
        return self._page

    def __repr__(self) -> str:
        document = self.to_dict()
        return f"<servoid.fleet.Summary of {document['recordings']} recordings, {len(document['odd'])} of them odd>"


def summary(results: str | os.PathLike[str], *, labels: str | os.PathLike[str] | None = None) -> Summary:
    """What the results in a folder, the `out` of `run` or `batch`, say of all motors together.

    Parameters
    ----------
    labels : a CSV file with a column `unit` and any of `serial`, `lot`, `station`, `operator`, `time`.

    The dictionary has among its keys `odd`, the recordings that are not like the others, each with its reasons; `quantities`, what
    motors are compared by, each with its median and spread; `refused`, the causes for which recordings have no result, each with an
    example.
    """
    return Summary(*_servoid.fleet(os.fspath(results), None if labels is None else os.fspath(labels)))
