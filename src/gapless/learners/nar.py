"""Autoregression: a series from its own past, by any regressor; ASFP is one with longer steps."""

from __future__ import annotations

from numbers import Real
from typing import Any, ClassVar, Final, Self

import numpy as np
from sklearn.base import BaseEstimator, clone
from sklearn.utils._param_validation import Integral, Interval, StrOptions
from sklearn.utils.validation import check_array, check_is_fitted, validate_data

from gapless.trip.recording import Array

MAX_ORDER: Final = 20
"""The longest lag that "auto" looks at."""


def autocorrelation(series: Array, max_lag: int) -> Array:
    """Biased sample autocorrelation of every column; 0 for a constant one.

    Parameters
    ----------
    series : ndarray, shape (n, k)
    max_lag : int
        Less than n.

    Returns
    -------
    ndarray, shape (max_lag + 1, k)
        From lag 0.
    """
    centred = series - series.mean(axis=0)
    power = (centred**2).sum(axis=0)
    n = len(series)
    sums = np.array([(centred[: n - lag] * centred[lag:]).sum(axis=0) for lag in range(max_lag + 1)])
    rho: Array = np.divide(sums, power, out=np.zeros_like(sums), where=power > 0.0)
    return rho


def autocorrelation_order(series: Any, max_order: int = MAX_ORDER) -> int:
    """The lag at which a series knows least of itself, as aslinezhad2020 chooses q.

    Least is the mean over the columns of the absolute autocorrelation; the paper finds 13 or 16
    and takes 5, all that its processor could do.

    Parameters
    ----------
    series : array-like, shape (n,) or (n, k)
    max_order : int

    Returns
    -------
    int
        1 to max_order, and at most n - 1.
    """
    columns = np.asarray(series, dtype=np.float64).reshape(len(series), -1)
    rho = autocorrelation(columns, min(max_order, len(columns) - 1))
    return 1 + int(np.argmin(np.abs(rho[1:]).mean(axis=1)))


def lagged(series: Array, order: int, segment: int = 1) -> tuple[Array, Array]:
    """Windows of the past and what follows them: inputs and targets for any regressor.

    Parameters
    ----------
    series : ndarray, shape (n, k)
    order : int
        q, rows of the past.
    segment : int
        Rows that follow.

    Returns
    -------
    X : ndarray, shape (n - order - segment + 1, order k)
        Rows y(t-q)...y(t-1), oldest first.
    Y : ndarray, shape (n - order - segment + 1, segment k)
        y(t)...y(t+segment-1).
    """
    count = len(series) - order - segment + 1
    windows = np.array([series[i : i + order + segment].ravel() for i in range(count)])
    split = order * series.shape[1]
    return windows[:, :split], windows[:, split:]


class NAR(BaseEstimator):
    """y(t)...y(t+s-1) = f(y(t-1)...y(t-q)), which feeds itself (aslinezhad2020 eq. 31).

    The first share of the series trains f; the rest tells how good it is, one step at a time. A
    `segment` of one is NAR; of more, the forward prediction segment by segment of ASFP
    (Semeniuk and Noureldin 2006).

    Parameters
    ----------
    regressor : estimator
        f; whatever `make` makes.
    order : int or "auto"
        q; "auto" takes it from the autocorrelation.
    segment : int
        s.
    train_share : float
        The paper trains on 75 % and tests on 25 %.

    Attributes
    ----------
    regressor_ : estimator
    order_ : int
    test_rms_ : ndarray, shape (k,)
        Of the prediction one segment ahead in the part kept for the test; NaN where it is too short.
    last_ : ndarray, shape (order_, k)
        The end of the series.
    """

    _parameter_constraints: ClassVar[dict[str, Any]] = {
        "regressor": "no_validation",
        "order": [Interval(Integral, 1, None, closed="left"), StrOptions({"auto"})],
        "segment": [Interval(Integral, 1, None, closed="left")],
        "train_share": [Interval(Real, 0.0, 1.0, closed="right")],
    }

    def __init__(
        self, regressor: Any, order: int | str = 5, segment: int = 1, train_share: float = 0.75
    ) -> None:
        self.regressor = regressor
        self.order = order
        self.segment = segment
        self.train_share = train_share

    def fit(self, X: Any, y: Any = None) -> Self:
        """Learn from a series.

        Parameters
        ----------
        X : array-like, shape (n, k)
            Rows at equal intervals, oldest first.
        y : None
            Not used.

        Returns
        -------
        NAR

        Raises
        ------
        ValueError
            If the part that trains is shorter than a window and its segment.
        """
        self._validate_params()
        series = validate_data(self, X, dtype=np.float64, ensure_min_samples=2)
        cut = max(1, round(self.train_share * len(series)))
        self.order_ = autocorrelation_order(series[:cut]) if self.order == "auto" else int(self.order)
        need = self.order_ + self.segment
        if cut < need:
            raise ValueError(
                f"n_samples = {len(series)} rows leave {cut} to train on, order {self.order_} and segment "
                f"{self.segment} need {need}; give a longer series or a smaller order"
            )
        inputs, targets = lagged(series[:cut], self.order_, self.segment)
        self.regressor_ = clone(self.regressor)
        self.regressor_.fit(inputs, targets)
        self.test_rms_ = self._rms(series[cut - self.order_ :])
        self.last_ = series[-self.order_ :]
        return self

    def _rms(self, series: Array) -> Array:
        columns = series.shape[1]
        if len(series) < self.order_ + self.segment:
            return np.full(columns, np.nan)
        inputs, targets = lagged(series, self.order_, self.segment)
        error = (self._ahead(inputs) - targets).reshape(-1, columns)
        rms: Array = np.sqrt((error**2).mean(axis=0))
        return rms

    def _ahead(self, windows: Array) -> Array:
        answer: Array = np.reshape(self.regressor_.predict(windows), (len(windows), -1))
        return answer

    def forecast(self, steps: int, past: Any = None) -> Array:
        """What follows, each segment predicted from those before.

        Parameters
        ----------
        steps : int
        past : array-like, shape (>= order_, k), optional
            The end of the series that is to go on; that of the fit if not given.

        Returns
        -------
        ndarray, shape (steps, k)
        """
        check_is_fitted(self)
        rows = self.last_ if past is None else check_array(past, dtype=np.float64)
        if len(rows) < self.order_ or rows.shape[1] != self.n_features_in_:
            wanted = f"{self.order_} rows or more of {self.n_features_in_} columns"
            raise ValueError(f"past has shape {rows.shape}; give {wanted}")
        window, parts = rows[-self.order_ :], [np.zeros((0, self.n_features_in_))]
        for _ in range(-(-steps // self.segment)):
            parts.append(self._ahead(window.reshape(1, -1)).reshape(self.segment, -1))
            window = np.vstack([window, parts[-1]])[-self.order_ :]
        ahead: Array = np.vstack(parts)[:steps]
        return ahead
