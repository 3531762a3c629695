"""Order spectra: what shakes the box, over cycles per metre instead of cycles per second.

A turning wheel excites a comb of harmonics at orders k / circumference. In an ordinary spectrum it is
smeared, since the speed changes within a window; in a time warped to constant speed it is a comb again
(order tracking; Fyfe & Munck 1997). `gather` sums what spectra have in common over orders, whatever
their speed: the template of this car (`comb`); `evidence` is how much better a spectrum fits it at a
speed than not at all.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np

from gapless._numba import inline, kernel
from gapless.trip.recording import Array

CHANNELS: Final = 6
WINDOW: Final = 4.0
"""Length of a spectrum's window [s], longer where the car is slow."""
LONGEST: Final = 8.0
"""But no longer than this [s]: the inertial course of the speed is as good as its tilt."""
WAY: Final = 15.0
"""A window is so long that the car goes this far [m]: orders are told apart by the way they have in it."""
CRAWL: Final = 0.5
"""Time is not warped to slower speeds [m/s]."""
TOP: Final = 40.0
"""Above this frequency the comb of a wheel adds nothing [Hz]."""
PAD: Final = 4
"""Windows are padded with zeros to so many times the shortest."""
WIDTH: Final = 1.0 / (PAD * WINDOW)
"""Of a bin [Hz]."""
BINS: Final = int(TOP / WIDTH) + 2
LEAST_POINTS: Final = 512
"""Of the shortest window: enough for `TOP`."""
LOWEST, STEP, ORDERS = 0.2, 0.01, 311
"""First order of a template, distance of orders, and how many there are [cycles/m]."""
BASE: Final = 31
"""Bins of the running median, every `PAD`-th one: those between are no news. 7.75 Hz in all."""
RUMBLE: Final = 3.0
"""What is slower than this is the car's way, not its shaking [Hz]."""
TINY: Final = 1e-12


@kernel
def warp(samples: Array, times: Array, speeds: Array, begin: float, end: float, n: int) -> Array:
    """Signals over a time in which the speed is constant, with a Hann window on them.

    Parameters
    ----------
    samples : ndarray, shape (k, 7)
        Time [s], rates [rad/s], specific forces [m/s^2].
    times, speeds : ndarray, shape (m,)
        Speed history, within which the window must lie [s], [m/s]; positive.
    begin, end : float
        The window [s].
    n : int
        Points, equally far apart on the road.

    Returns
    -------
    ndarray, shape (6, n)
    """
    m = times.size
    way = np.zeros(m)
    for i in range(1, m):
        way[i] = way[i - 1] + 0.5 * (speeds[i] + speeds[i - 1]) * (times[i] - times[i - 1])
    first, last = _between(times, way, begin), _between(times, way, end)
    out = np.empty((CHANNELS, n))
    mean = np.zeros(CHANNELS)
    i, j = 1, 1
    for p in range(n):
        s = first + (last - first) * p / n
        while i < m - 1 and way[i] < s:
            i += 1
        t = times[i - 1] + (s - way[i - 1]) / max(way[i] - way[i - 1], TINY) * (times[i] - times[i - 1])
        while j < samples.shape[0] - 1 and samples[j, 0] < t:
            j += 1
        share = (t - samples[j - 1, 0]) / (samples[j, 0] - samples[j - 1, 0])
        share = min(max(share, 0.0), 1.0)
        for c in range(CHANNELS):
            a = (1.0 - share) * samples[j - 1, c + 1] + share * samples[j, c + 1]
            out[c, p] = a
            mean[c] += a / n
    for p in range(n):
        w = 0.5 - 0.5 * np.cos(2.0 * np.pi * p / (n - 1))
        for c in range(CHANNELS):
            out[c, p] = (out[c, p] - mean[c]) * w
    return out


@inline
def _between(x: Any, y: Any, at: Any) -> Any:
    """Linear interpolation in a short increasing table."""
    i = 1
    while i < x.size - 1 and x[i] < at:
        i += 1
    return y[i - 1] + (at - x[i - 1]) / max(x[i] - x[i - 1], TINY) * (y[i] - y[i - 1])


@kernel
def window(times: Array, speeds: Array) -> Any:
    """Length of the window that ends now: `WAY` is gone in it, as far as the car was not too slow.

    Parameters
    ----------
    times, speeds : ndarray, shape (m,)
        The last one is now [s], [m/s].

    Returns
    -------
    float
        From `WINDOW` to `LONGEST`, or 0 where no window can be warped [s].
    """
    way, begin = 0.0, times.size - 1
    while begin > 0 and speeds[begin - 1] >= CRAWL:
        begin -= 1
        dt = times[begin + 1] - times[begin]
        way += 0.5 * (speeds[begin] + speeds[begin + 1]) * dt
        if way >= WAY and times[-1] - times[begin] >= WINDOW:
            break
    length = min(times[-1] - times[begin], LONGEST)
    return length if speeds[-1] >= CRAWL and length >= WINDOW else 0.0


@kernel
def whiten(power: Array) -> Array:
    """Log power less its running median over frequency: lines stay, colour goes.

    Parameters
    ----------
    power : ndarray, shape (6, k)

    Returns
    -------
    ndarray, shape (6, BINS)
    """
    half = BASE // 2
    n = min(power.shape[1] // PAD, BINS // PAD + half + 1)
    out, log, window = np.empty((CHANNELS, BINS)), np.empty(n), np.empty(BASE)
    for c in range(CHANNELS):
        for i in range(n):
            log[i] = np.log(power[c, PAD * i] + TINY)
        for i in range(BASE):
            window[i] = log[max(0, i - half)]
        window.sort()
        for i in range(BINS // PAD + 1):
            if i > 0:
                _exchange(window, log[max(0, i - 1 - half)], log[min(n - 1, i + half)])
            for k in range(PAD * i, PAD * i + PAD):
                if k < BINS:
                    out[c, k] = np.log(power[c, k] + TINY) - window[half]
    return out


@inline
def _exchange(window: Any, gone: Any, new: Any) -> None:
    """Replace a value in a sorted window."""
    k = np.searchsorted(window, gone)
    while k > 0 and window[k - 1] > new:
        window[k] = window[k - 1]
        k -= 1
    while k < window.size - 1 and window[k + 1] < new:
        window[k] = window[k + 1]
        k += 1
    window[k] = new


class Spectrum(NamedTuple):
    """A whitened spectrum of one window.

    Parameters
    ----------
    log : ndarray, shape (6, bins)
        Log power above the running median.
    top : float
        No bin from this frequency on counts [Hz].
    speed : float
        Mean speed in the window [m/s].
    level : float
        Loudness: mean over rates and forces of the log of what their power spectra hold in sum.
    length : float
        Of the window [s].
    """

    log: Array
    top: float
    speed: float
    level: float
    length: float = WINDOW


def spectrum(samples: Array, times: Array, speeds: Array, length: float, top: float) -> Spectrum:
    """Order spectrum of the window that ends at the last time.

    Parameters
    ----------
    samples : ndarray, shape (k, 7)
        As `warp` takes them; they cover the window.
    times, speeds : ndarray, shape (m,)
    length : float
        Of the window, from `WINDOW` to `LONGEST` [s].
    top : float
        Highest frequency [Hz].

    Returns
    -------
    Spectrum
    """
    rate = (len(samples) - 1) / (samples[-1, 0] - samples[0, 0])
    least = max(LEAST_POINTS, 1 << int(np.ceil(np.log2(WINDOW * rate))))
    n, begin = round(least * length / WINDOW), times[-1] - length
    f = np.fft.rfft(warp(samples, times, speeds, begin, times[-1], n), PAD * least, axis=1)
    power, top = f.real**2 + f.imag**2, min(top, TOP)
    mean = float(speeds[times >= begin].mean())
    return Spectrum(whiten(power), top, mean, loudness(power, top, n * least), length)


def loudness(power: Array, top: float, points: int) -> float:
    """Mean over rates and forces of the log of their summed power between `RUMBLE` and a frequency.

    Parameters
    ----------
    power : ndarray, shape (6, k)
        Of a padded window.
    top : float
        [Hz]
    points : int
        Of the window, times those of the shortest.

    Returns
    -------
    float
        Half of it: of an amplitude.
    """
    heard = power[:, int(RUMBLE / WIDTH) : int(top / WIDTH)].sum(axis=1) / points + TINY
    return float(0.25 * (np.log(heard[:3].sum()) + np.log(heard[3:].sum())))


@kernel
def gather(log: Array, top: float, speed: float, total: Array, count: Array, square: Array) -> None:
    """Add a spectrum to sums over orders.

    Parameters
    ----------
    log, top, speed
        As in `Spectrum`.
    total : ndarray, shape (6, orders)
    count : ndarray, shape (orders,)
    square : ndarray, shape (6,)
    """
    for j in range(ORDERS):
        f = (LOWEST + STEP * j) * speed / WIDTH
        k = int(f)
        if f * WIDTH >= top:
            break
        w = f - k
        count[j] += 1.0
        for c in range(CHANNELS):
            a = (1.0 - w) * log[c, k] + w * log[c, k + 1]
            total[c, j] += a
            square[c] += a * a
