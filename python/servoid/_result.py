"""What results have in common: their JSON, their page."""

import html
import json
import warnings
from os import PathLike
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar

from . import _servoid
from ._model import Model


class Compiled(Protocol):
    """What a result is made of."""

    @property
    def json(self) -> str: ...
    @property
    def interrupted(self) -> bool: ...
    @property
    def model(self) -> "_servoid.Model": ...
    def summary(self) -> str: ...
    def page(self) -> str: ...


Own = TypeVar("Own", bound=Compiled)


class Result(Generic[Own]):
    """A result: the JSON of the command line, and what is made of it."""

    __slots__ = ("_document", "_own")

    def __init__(self, own: Own) -> None:
        self._own = own
        self._document: dict[str, Any] = json.loads(own.json)
        if own.interrupted:
            warnings.warn("stopped by Ctrl-C: this is the best so far", RuntimeWarning, stacklevel=3)

    @property
    def json(self) -> str:
        """The result as JSON, as the command line writes it."""
        return self._own.json

    def to_dict(self) -> dict[str, Any]:
        """The same as a dictionary of its own."""
        document: dict[str, Any] = json.loads(self._own.json)
        return document

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C stopped it before its end."""
        return self._own.interrupted

    @property
    def model(self) -> Model:
        """The model that was found."""
        return Model(self._own.model)

    def summary(self) -> str:
        """The result as the command line prints it."""
        return self._own.summary()

    def to_html(self, path: str | PathLike[str] | None = None) -> str:
        """The page of the result, in one file without requests; written to `path` if one is given."""
        page = self._own.page()
        if path is not None:
            Path(path).write_text(page, encoding="utf-8")
        return page

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.summary())}</pre>"
