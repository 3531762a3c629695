"""The role of an input-output model: what a bridge shows its learner, and what it makes of the answer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np

from gapless.bridges.epochs import Epoch
from gapless.inertial.belief import Belief
from gapless.trip.recording import Array

Predict = Callable[[Array], Array]
"""A trained learner: rows in, rows out."""


class Part(NamedTuple):
    """One observation without its noise.

    Parameters
    ----------
    name : str
        "position", "velocity" or "attitude": whose noise it has.
    z : ndarray, shape (m,)
    H : ndarray, shape (m, n)
    """

    name: str
    z: Array
    H: Array


class Model(Protocol):
    """Turns epochs into rows for a learner, and its answers into observations.

    What changes during an outage is a `course`, a value that is replaced and never changed.
    """

    @property
    def outputs(self) -> int:
        """Numbers that a learner answers with."""
        ...

    def pairs(self, epochs: Sequence[Epoch]) -> tuple[Array, Array]:
        """Rows to learn from.

        Parameters
        ----------
        epochs : sequence of Epoch

        Returns
        -------
        X : ndarray, shape (n, p)
        Y : ndarray, shape (n, k)
        """
        ...

    def begin(self, epochs: Sequence[Epoch], fix: Array) -> Any:
        """The course at the beginning of an outage.

        Parameters
        ----------
        epochs : sequence of Epoch
            Those that the shadow comes from, the last first to be gone on from; none where it starts anew.
        fix : ndarray, shape (3,)
            The last fix.

        Returns
        -------
        object
        """
        ...

    def row(self, course: Any, epoch: Epoch) -> Array:
        """What the learner is asked.

        Parameters
        ----------
        course : object
        epoch : Epoch

        Returns
        -------
        ndarray, shape (p,)
        """
        ...

    def carry(self, course: Any, epoch: Epoch, y: Array) -> Any:
        """The course after an answer.

        Parameters
        ----------
        course : object
        epoch : Epoch
        y : ndarray, shape (k,)

        Returns
        -------
        object
        """
        ...

    def wrong(self, course: Any, epoch: Epoch) -> dict[str, Array]:
        """How far off the course is at an epoch at which GNSS spoke.

        Parameters
        ----------
        course : object
        epoch : Epoch

        Returns
        -------
        dict of str to ndarray
            By part.
        """
        ...

    def say(self, course: Any, belief: Belief, epoch: Epoch) -> list[Part]:
        """Observations that follow from the course.

        Parameters
        ----------
        course : object
        belief : Belief
        epoch : Epoch

        Returns
        -------
        list of Part
        """
        ...


def go_on(model: Model, predict: Predict, course: Any, epoch: Epoch) -> Any:
    """Ask the learner, and follow its answer.

    Parameters
    ----------
    model : Model
    predict : callable
    course : object
    epoch : Epoch

    Returns
    -------
    object or None
        The course after the answer; None where a recursion ran away and there is nothing left to ask.
    """
    row = model.row(course, epoch)
    if not np.isfinite(row).all():
        return None
    return model.carry(course, epoch, np.asarray(predict(row[None, :]), float).reshape(-1))
