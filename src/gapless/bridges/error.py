"""The error of an uncorrected INS as what is learned: O_INS-dP and its kin.

One model with five parts to choose gives six of the papers' and their comparators': what of the INS is shown
(features, now and some epochs back), how many past errors are shown beside it, against what the error is
taken, which of its components are learned, and how many epochs are predicted at a time. Wang et al. 2018
(O_INS-dP: INS against GNSS), Xu, Li & Rizos 2010 (O_INS-X_k: against the filter's estimate), Semeniuk &
Noureldin 2006 (past errors alone, by segments: ASFP), Georges et al. 2015 (with a sliding window of past
errors, each prediction feeding the next), Aslinezhad et al. 2020 (past errors alone: NAR; five past INS
samples alone: feed-forward).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from gapless.bridges.epochs import Epoch, features, follows
from gapless.bridges.model import Part
from gapless.bridges.shadow import difference
from gapless.inertial.belief import Belief
from gapless.inertial.coast import STATE
from gapless.trip.recording import Array

PLACES: Final = {"position": 0, "velocity": 3, "attitude": 6}
"""Where a component starts in an error, and in the error state of a filter."""


class Course(NamedTuple):
    """How far the model has come in an outage.

    Parameters
    ----------
    recent : tuple of Epoch
        The last epochs, oldest first; as many as a row shows beside its own.
    past : tuple of ndarray
        The last errors, oldest first: true ones at first, then predicted ones; as many as a row shows.
    error : ndarray, shape (k,)
        The last one predicted.
    ahead : tuple of ndarray
        Those of the same segment that are still to come.
    """

    recent: tuple[Epoch, ...]
    past: tuple[Array, ...]
    error: Array
    ahead: tuple[Array, ...] = ()


@dataclass(frozen=True)
class ErrorModel:
    """INS (now, and before) and its past errors -> its error.

    Parameters
    ----------
    features : tuple of str
        What of the shadow INS is shown, from `FEATURES`; may be empty where `window` is not 0.
    lags : int
        Epochs shown of it, this one included.
    window : int
        Past errors shown.
    reference : str
        "gnss", or "filter" for its estimate after the fix.
    learns : tuple of str
        Components: "position", "velocity", and with the filter as reference "attitude".
    axes : int
        2 for north and east, 3 for down too.
    segment : int
        Epochs that are predicted at a time.
    """

    features: tuple[str, ...]
    lags: int
    window: int
    reference: str
    learns: tuple[str, ...]
    axes: int
    segment: int = 1

    @property
    def outputs(self) -> int:
        """See `Model`."""
        return self.segment * sum(self._size(name) for name in self.learns)

    def pairs(self, epochs: Sequence[Epoch]) -> tuple[Array, Array]:
        """See `Model`: before its start the shadow had no error."""
        rows, targets, run, whole = [], [], 0, False
        need = max(self.lags - 1, self.window)
        known = [self._error(e) for e in epochs]
        for i, epoch in enumerate(epochs):
            if not (i and follows(epoch, epochs[i - 1])):
                run, whole = 0, bool(i) and epoch.segment != epochs[i - 1].segment
            else:
                run += 1
            ahead = epochs[i : i + self.segment]
            joined = len(ahead) == self.segment and all(follows(b, a) for a, b in pairwise(ahead))
            if joined and (whole or run >= need):
                course = self._course(epochs[i - min(run, need) : i], known[i - min(run, need) : i])
                rows.append(self.row(course, epoch))
                targets.append(np.concatenate(known[i : i + self.segment]))
        if not rows:
            return np.zeros((0, 1)), np.zeros((0, 1))
        x, y = np.array(rows).reshape(len(rows), -1), np.array(targets).reshape(len(rows), -1)
        good = np.isfinite(x).all(axis=1) & np.isfinite(y).all(axis=1)
        return x[good], y[good]

    def begin(self, epochs: Sequence[Epoch], fix: Array) -> Course:
        """See `Model`: from a new start there are no errors, and else those of this segment."""
        tail = list(epochs[-1:])
        for later, earlier in pairwise(reversed(epochs)):
            if not follows(later, earlier):
                break
            tail.insert(0, earlier)
        return self._course(tail, [np.nan_to_num(self._error(e)) for e in tail])

    def _course(self, epochs: Sequence[Epoch], errors: Sequence[Array]) -> Course:
        """A course after some epochs in a row, the errors that are missing being none."""
        none = np.zeros(sum(self._size(name) for name in self.learns))
        past = errors[len(errors) - min(len(errors), self.window) :]
        recent = epochs[len(epochs) - min(len(epochs), self.lags - 1) :]
        return Course(tuple(recent), (none,) * (self.window - len(past)) + tuple(past), none)

    def row(self, course: Course, epoch: Epoch) -> Array:
        """See `Model`."""
        shown = (*course.recent, epoch)
        shown = (shown[0],) * (self.lags - len(shown)) + shown
        return np.concatenate([features(self.features, e) for e in shown[-self.lags :]] + list(course.past))

    def carry(self, course: Course, epoch: Epoch, y: Array) -> Course:
        """See `Model`: each prediction feeds the next, and a segment is gone through to its end."""
        error, *ahead = course.ahead or y.reshape(self.segment, -1)
        recent = (*course.recent, epoch)[-(self.lags - 1) :] if self.lags > 1 else ()
        past = (*course.past, error)[-self.window :] if self.window else ()
        return Course(recent, past, error, tuple(ahead))

    def wrong(self, course: Course, epoch: Epoch) -> dict[str, Array]:
        """See `Model`."""
        missed = course.error - self._error(epoch)
        return {name: missed[part] for name, part in self._parts().items()}

    def say(self, course: Course, belief: Belief, epoch: Epoch) -> list[Part]:
        """See `Model`: the truth is the shadow less its error."""
        seen = difference(epoch.shadow, belief.estimate()[:STATE])
        said = []
        for name, part in self._parts().items():
            columns = PLACES[name] + np.arange(part.stop - part.start)
            h = np.zeros((len(columns), belief.layout.n))
            h[np.arange(len(columns)), columns] = 1.0
            said.append(Part(name, seen[columns] - course.error[part], h))
        return said

    def _error(self, epoch: Epoch) -> Array:
        error = epoch.gnss_error if self.reference == "gnss" else epoch.filter_error
        return np.concatenate([error[PLACES[name] : PLACES[name] + self._size(name)] for name in self.learns])

    def _size(self, name: str) -> int:
        return 3 if name == "attitude" else self.axes

    def _parts(self) -> dict[str, slice]:
        ends = np.cumsum([self._size(name) for name in self.learns]).tolist()
        return {name: slice(end - self._size(name), end) for name, end in zip(self.learns, ends, strict=True)}
