"""How far the work is: a line on a terminal that is drawn anew, elsewhere one line at the end."""

import math
import sys
import time


class Progress:
    """The line."""

    def __init__(self, shown: bool, total: int | None, shards: int | None, things: str = "recordings") -> None:
        self._shown, self._things = shown, things
        self._drawn = shown and sys.stderr.isatty()
        self._total, self._shards = total, shards
        self._started = time.monotonic()
        self._recordings = self._ended = 0

    def over(self, shards: int) -> "Progress":
        """The same, of so many shards."""
        self._shards = shards
        return self

    def __enter__(self) -> "Progress":
        self._draw()
        return self

    def __exit__(self, *_: object) -> None:
        if self._drawn:
            sys.stderr.write("\r\x1b[K")
        if self._shown:
            took = time.monotonic() - self._started
            print(f"fleet: {self._so_far()}, {took:.1f} s, {self._recordings / max(took, 1e-9):.3g}/s", file=sys.stderr, flush=True)

    def at(self, recordings: int, ended: int = 0) -> None:
        """So many recordings have a result, and so many shards have ended."""
        self._recordings, self._ended = recordings, ended
        self._draw()

    def _so_far(self) -> str:
        total = "" if self._total is None else f" of {self._total}"
        shards = "" if self._shards is None else f" in {self._ended} of {self._shards} shards"
        return f"{self._recordings}{total} {self._things}{shards}"

    def _draw(self) -> None:
        if not self._drawn:
            return
        took = time.monotonic() - self._started
        part, whole = (self._recordings, self._total) if self._total else (self._ended, self._shards)
        bar = left = ""
        if whole:
            filled = min(30, 30 * part // whole)
            bar = f"{'#' * filled}{'.' * (30 - filled)} "
            left = f"  {_clock(took * (whole - part) / part)} left" if 0 < part <= whole else ""
        rate = f"  {self._recordings / took:.3g}/s" if self._recordings and took > 0.0 else ""
        sys.stderr.write(f"\r\x1b[Kfleet {bar}{self._so_far()}{rate}{left}")
        sys.stderr.flush()


def _clock(seconds: float) -> str:
    minutes, seconds = divmod(math.ceil(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{seconds:02}" if hours else f"{minutes}:{seconds:02}"
