"""What the page shows of the wheels: their order spectrum and the speeds that were read from it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from gapless.reports.charts import chart
from gapless.reports.numbers import known, number
from gapless.trip.exhibits import Heard
from gapless.trip.recording import Array, Gnss

DECIBEL = 10.0 / math.log(10.0)
"""Of a natural logarithm of power."""
HOST = "wheels-charts"
_NEAR = 1.5
"""A reading is compared with fixes where there is one on either side within this [s]."""


def text(summary: Mapping[str, Any]) -> str:
    """What was heard, in words.

    Parameters
    ----------
    summary : mapping

    Returns
    -------
    str
        HTML; "" where nothing listened.
    """
    told = summary.get("wheels")
    if not told:
        return ""
    words = [f"{told['spectra']} spectra of this drive were laid over cycles per metre instead of hertz."]
    if told["circumference"] is None:
        words.append("No comb stands out of them: these wheels were not heard clearly.")
    else:
        around = told["circumference"]
        words.append(
            f"Lines at multiples of {number(1.0 / around)} cycles/m stand out: wheels of "
            f"<b>{number(around, 'm')}</b> circumference."
        )
    readings, refused = told["readings"], told["refused"]
    if readings["time"]:
        words.append(
            f"While GNSS was silent {len(readings['time'])} speeds were read, their standard deviation "
            f"{number(float(np.median(readings['sd'])), 'm/s', 2)} as a rule; {refused} spectra said too "
            "little and were left out."
        )
        words.append(_slip(np.array(readings["slips"], float)))
    else:
        words.append(f"No speed was read in silence ({refused} spectra said too little).")
    return f'<p>{" ".join(words)}</p><div class="group" id="{HOST}"></div>'


def _slip(slips: Array) -> str:
    """How many windows were of slipping wheels, in words."""
    windows = int((slips > 0.5).sum())
    if windows == 0:
        return "No slip was noticed."
    seemed = "One of them seems" if windows == 1 else f"{windows} of them seem"
    return f"{seemed} to be of wheels that slipped."


def charts(summary: Mapping[str, Any], gnss: Gnss | None) -> Iterator[dict[str, Any]]:
    """Its charts, not decimated yet.

    Parameters
    ----------
    summary : mapping
    gnss : Gnss, optional
        All fixes, those that were withheld too.

    Yields
    ------
    dict
        See `gapless.reports.charts`.
    """
    told = summary.get("wheels")
    if not told:
        return
    yield _orders(told)
    if told["readings"]["time"]:
        yield from _speeds(told["readings"], known(summary["start"]), gnss)


def _orders(told: Mapping[str, Any]) -> dict[str, Any]:
    height, error = (DECIBEL * np.array(told[key], float) for key in ("height", "error"))
    orders = told["first_order"] + told["order_step"] * np.arange(height.shape[1])
    parts = {"gyros": slice(0, 3), "accelerometers": slice(3, 6)}
    series = [(name, height[part].mean(axis=0)) for name, part in parts.items()]
    bands = np.column_stack([np.sqrt((error[part] ** 2).sum(axis=0)) / 3.0 for part in parts.values()])
    found = chart("", "Order spectrum of this car", "dB", orders, series, bands)
    around, marks = told["circumference"], list[float]()
    note = "Mean of three axes, with its standard error, above what is around a line."
    if around is not None:
        marks = [round(k / around, 4) for k in range(1, int(orders[-1] * around) + 1)]
        note += " Upright: turns of the wheel and their harmonics."
    where = {"host": HOST, "over": "orders", "unitX": "1/m", "span": [0.0, round(float(orders[-1]), 2)]}
    return found | where | {"marks": marks, "note": note, "wide": True}


def _speeds(readings: Mapping[str, Any], start: float, gnss: Gnss | None) -> Iterator[dict[str, Any]]:
    time, speed, sd, own, slips = (np.array(readings[key], float) for key in Heard._fields)
    series, none = [("wheels", speed), ("filter before", own)], np.full(len(time), math.nan)
    bands = np.column_stack([sd, none])
    withheld = none if gnss is None else speed_at(gnss, time)
    if np.isfinite(withheld).any():
        series, bands = [*series, ("fixes, withheld", withheld)], np.column_stack([bands, none])
    yield chart("", "Speed read in silence", "m/s", time - start, series, bands) | {"host": HOST}
    against, name = (withheld, "the withheld fixes") if len(series) > 2 else (own, "the filter before")
    off = speed - against
    half = 1.1 * max(float(np.nanmax(np.abs(off))), 2.0 * float(sd.max()))
    title = f"Reading less {name}"
    apart = chart(
        "", title, "m/s", time - start, [("reading", off)], sd[:, None], range=(-half, half), dots=True
    )
    yield apart | {
        "host": HOST,
        "lift": True,
        "note": "Shaded: the standard deviation that the filter was told.",
    }
    note = "Judged by how readings follow the inertial course; the likelier, the less a reading counts."
    slip = chart(
        "", "Probability that the wheels slip", "", time - start, [("slip", slips)], range=(0.0, 1.0)
    )
    yield slip | {"host": HOST, "note": note}


def speed_at(gnss: Gnss, time: Array) -> Array:
    """Speed of the fixes, between them; NaN where there is none near.

    Parameters
    ----------
    gnss : Gnss
    time : ndarray, shape (n,)
        [s]

    Returns
    -------
    ndarray, shape (n,)
        [m/s]
    """
    fixes = gnss.take(np.isfinite(gnss.v_n).all(axis=1))
    if len(fixes) < 2:
        return np.full(len(time), math.nan)
    after = np.clip(np.searchsorted(fixes.time, time), 1, len(fixes) - 1)
    gap = np.maximum(time - fixes.time[after - 1], fixes.time[after] - time)
    speed = np.interp(time, fixes.time, np.linalg.norm(fixes.v_n, axis=1))
    return np.where(gap <= _NEAR, speed, math.nan)
