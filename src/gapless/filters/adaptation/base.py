"""What every rule that bends a filter shares: an innovation in, a verdict out.

A rule works in observation space. From the innovation z, its predicted covariance S = H P H' + R and
R itself follow the residual after the update, e = R S^-1 z, and what the update leaves of
H P H': A - A S^-1 A with A = S - R. So a rule needs neither state nor covariance, and any rule works
with any way to pass moments through a function.
"""

from __future__ import annotations

from typing import Any, ClassVar, Literal, NamedTuple, Protocol, Self

import numpy as np

from gapless.trip.recording import Array

Role = Literal["noise", "process", "recovery", "test", "weight"]


class Innovation(NamedTuple):
    """An observation before its update.

    Parameters
    ----------
    channel : str
        "position", "velocity", "odometer", "bridge...", or the name of a constraint.
    time : float
        [s]
    z : ndarray, shape (m,)
        Observed minus predicted.
    s : ndarray, shape (m, m)
        H P H' + R.
    r : ndarray, shape (m, m)
        As stated, or as an earlier rule left it.
    nis : float
        z' S^-1 z.
    denied : bool
        Whether another sensor, believed a moment ago, says that it is not the filter that is wrong.
    """

    channel: str
    time: float
    z: Array
    s: Array
    r: Array
    nis: float
    denied: bool = False

    @property
    def hph(self) -> Array:
        """H P H', shape (m, m)."""
        return self.s - self.r

    def bent(self, r: Array) -> Innovation:
        """The same with another R.

        Parameters
        ----------
        r : ndarray, shape (m, m)

        Returns
        -------
        Innovation
        """
        s = self.s + (r - self.r)
        return self._replace(s=s, r=r, nis=float(self.z @ np.linalg.solve(s, self.z)))


class Verdict(NamedTuple):
    """What to do with an observation, and with the filter.

    Parameters
    ----------
    r : ndarray, shape (m, m), or None
        The covariance that counts; None where the observation is rejected.
    gain : float
        Factor on the optimal gain.
    widen : bool
        Add z z' to P first: the filter is wrong, not the observation.
    noise : float, optional
        Factor on the process noise from now on; None leaves it as it is.
    fade : float
        Factor on P once the epoch is over.
    """

    r: Array | None
    gain: float = 1.0
    widen: bool = False
    noise: float | None = None
    fade: float = 1.0


class Adaptation(Protocol):
    """Decides how an innovation counts; remembers, per channel, what it needs of the past."""

    def judge(self, innovation: Innovation) -> Verdict:
        """Verdict on an innovation, and the memory of it.

        Parameters
        ----------
        innovation : Innovation

        Returns
        -------
        Verdict
        """
        ...

    def copy(self) -> Self:
        """An independent rule with the same memory.

        Returns
        -------
        Adaptation
        """
        ...


class Rule(Adaptation, Protocol):
    """An adaptation that a recipe can name; it is built from its `Table`.

    Attributes
    ----------
    Table : type of msgspec.Struct
        Its parameters, with defaults and bounds.
    role : str
        "noise": estimates R. "process": forgets. "recovery": doubts the filter. "test": doubts by
        z' S^-1 z. "weight": doubts by the residual. A chain holds one of each at most.
    bends_gain : bool
        Whether it takes another gain than the optimal one.
    reckons_optimal : bool
        Whether its formula is that of the optimal gain.
    """

    Table: ClassVar[type[Any]]
    role: ClassVar[Role]
    bends_gain: ClassVar[bool]
    reckons_optimal: ClassVar[bool]

    def __init__(self, table: Any = ...) -> None: ...


def whitened(innovation: Innovation, limit: float) -> tuple[Array, Array, Array]:
    """An innovation in units of what is stated, so that an estimate of R outlives a change of that.

    Parameters
    ----------
    innovation : Innovation
    limit : float
        A larger innovation than so many of its predicted standard deviations counts as that many:
        one absurd reading would blind an estimator for as long as it remembers.

    Returns
    -------
    low : ndarray, shape (m, m)
        L of R = L L'.
    z : ndarray, shape (m,)
        L^-1 z.
    hph : ndarray, shape (m, m)
        L^-1 H P H' L^-T.
    """
    low = np.asarray(np.linalg.cholesky(innovation.r), float)
    most = limit * np.sqrt(innovation.z.size)
    z = innovation.z * min(1.0, most / max(np.sqrt(innovation.nis), 1e-300))
    rows = np.linalg.solve(low, np.column_stack([z, innovation.hph]))
    hph = np.linalg.solve(low, rows[:, 1:].T)
    return low, np.asarray(rows[:, 0], float), np.asarray(hph, float)
