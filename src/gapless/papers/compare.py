"""Theirs and ours: means with intervals, orders of methods, ratios between two of them, verdicts."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from gapless.evaluation.pairs import pair
from gapless.evaluation.resampling import Interval, interval, order, resample
from gapless.papers.experiment import Results
from gapless.papers.jobs import Sample
from gapless.papers.model import Experiment
from gapless.papers.published import Claim, Published
from gapless.trip.recording import Array

YES, NO, OPEN, NOT_RUN = "yes", "NO", "open", "not run"
"""Whether the order is the paper's: shown, shown to be the other way round, neither; or not run."""
VERDICTS: Final = {
    YES: "the 95 % interval of our ratio lies on the paper's side of 1",
    NO: "it lies on the other side",
    OPEN: "it holds 1, or the drives are too few for one",
    NOT_RUN: "one of the two methods has no row",
}


@dataclass(frozen=True)
class Ratio:
    """A claim beside what we measured.

    Parameters
    ----------
    claim : Claim
    count : int
        Of windows in which both methods were scored.
    ours : Interval
        Geometric mean over them of better over worse.
    verdict : str
        Of `VERDICTS`.
    """

    claim: Claim
    count: int
    ours: Interval
    verdict: str

    @property
    def size(self) -> float:
        """Our ratio over theirs: above 1 where we gain less than the paper."""
        return self.ours.value / self.claim.ratio


@dataclass(frozen=True)
class Ranking:
    """Methods from the smallest mean error to the largest, as published and as measured.

    Parameters
    ----------
    table, where, column : str
    theirs, ours : tuple of str
    """

    table: str
    where: str
    column: str
    theirs: tuple[str, ...]
    ours: tuple[str, ...]

    @property
    def same(self) -> bool:
        """Whether both agree, on methods that both have."""
        return tuple(m for m in self.theirs if m in self.ours) == self.ours


def mean(samples: Sequence[Sample], key: str) -> Interval:
    """Mean over windows with its 95 % interval.

    Parameters
    ----------
    samples : sequence of Sample
        Of one method.
    key : str

    Returns
    -------
    Interval
        NaN where nothing is known; NaN ends where there are too few.
    """
    known = [s for s in samples if math.isfinite(s.values[key])]
    drawn = resample(order(*_places(known)))
    return interval(_values(known, key), drawn, lambda x: np.asarray(np.mean(x, axis=-1)))


def claims_of(experiment: Experiment) -> Iterator[Claim]:
    """All ratios that an experiment's tables give, and those that its text states.

    Parameters
    ----------
    experiment : Experiment

    Yields
    ------
    Claim
    """
    for table in experiment.tables:
        yield from _of_table(table)
    yield from experiment.claims


def _of_table(table: Published) -> Iterator[Claim]:
    own = {line.where: line for line in table.lines if line.method == table.subject}
    for line in table.lines:
        if line.method == table.subject or line.where not in own:
            continue
        for column, ours, theirs in zip(table.columns, own[line.where].values, line.values, strict=True):
            if math.isfinite(ours) and math.isfinite(theirs):
                yield Claim(table.label, line.where, table.subject, line.method, column.key, ours / theirs)


def ratios(results: Results) -> list[Ratio]:
    """Each claim beside what was measured.

    Parameters
    ----------
    results : Results

    Returns
    -------
    list of Ratio
    """
    return [_ratio(results, claim) for claim in claims_of(results.experiment)]


def _ratio(results: Results, claim: Claim) -> Ratio:
    better, worse = (results.of(method, claim.where) for method in (claim.better, claim.worse))
    count, found = _paired(better, worse, claim.key)
    return Ratio(claim, count, found, verdict(claim.ratio, found) if count else NOT_RUN)


def _place(sample: Sample) -> Hashable:
    return sample.drive, sample.start


def _paired(
    first: Sequence[Sample],
    second: Sequence[Sample],
    key: str,
    place: Callable[[Sample], Hashable] = _place,
) -> tuple[int, Interval]:
    """Geometric mean of first over second in the same windows of the same drives."""
    a, b = ({place(s): s for s in samples} for samples in (first, second))
    both = [k for k in a if k in b and _both(a[k], b[k], key)]
    rows = [a[k] for k in both]
    found = pair(_values(rows, key), _values([b[k] for k in both], key), order(*_places(rows)))
    return len(both), found.geometric


def _both(a: Sample, b: Sample, key: str) -> bool:
    return all(math.isfinite(s.values[key]) and s.values[key] > 0.0 for s in (a, b))


def verdict(theirs: float, ours: Interval) -> str:
    """Whether a measured ratio puts two methods in the published order.

    Parameters
    ----------
    theirs : float
    ours : Interval

    Returns
    -------
    str
        Of `VERDICTS`.
    """
    if not ours.hi < 1.0 and not ours.lo > 1.0:
        return OPEN
    return YES if (ours.hi < 1.0) == (theirs < 1.0) else NO


def beside(aside: Results, main: Results, method: str, where: str, key: str) -> tuple[int, Interval]:
    """The same method on the same seeds under another assumption: theirs over those of the main experiment.

    Parameters
    ----------
    aside, main : Results
    method, where, key : str

    Returns
    -------
    count : int
        Of windows that both have.
    ratio : Interval
        Geometric mean; NaN without any.
    """
    return _paired(aside.of(method, where), main.of(method, where), key, lambda s: s.drive)


def rankings(results: Results) -> list[Ranking]:
    """Orders of methods, table by table, window by window, column by column.

    Parameters
    ----------
    results : Results

    Returns
    -------
    list of Ranking
        Where two methods at least were both published and run.
    """
    found = []
    for table in results.experiment.tables:
        for where in dict.fromkeys(line.where for line in table.lines):
            lines = [line for line in table.lines if line.where == where]
            for k, column in enumerate(table.columns):
                theirs = {line.method: line.values[k] for line in lines if math.isfinite(line.values[k])}
                ours = {m: mean(results.of(m, where), column.key).value for m in theirs}
                ours = {m: v for m, v in ours.items() if math.isfinite(v)}
                if len(ours) > 1:
                    found.append(Ranking(table.label, where, column.title, _ranked(theirs), _ranked(ours)))
    return found


def _ranked(values: dict[str, float]) -> tuple[str, ...]:
    return tuple(sorted(values, key=lambda name: values[name]))


def _values(samples: Sequence[Sample], key: str) -> Array:
    return np.array([s.values[key] for s in samples], float)


def _places(samples: Sequence[Sample]) -> tuple[list[str], Array, Array]:
    starts, ends = (np.array([getattr(s, name) for s in samples], float) for name in ("start", "end"))
    return [s.drive for s in samples], starts, ends
