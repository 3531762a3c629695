"""Where a spectrum fits a comb: the speed, or none."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from gapless.bridges.loudness import too_quiet
from gapless.bridges.orders import Spectrum
from gapless.bridges.template import Comb

SLOWEST: Final = 1.5
"""Below this speed no comb is heard [m/s]: such speeds are the null hypothesis."""
GRID: Final = 0.08
"""Distance of the speeds that are looked at [m/s]."""
NEAR: Final = 0.6
"""Half width of a peak [m/s]."""


class Peak(NamedTuple):
    """What a spectrum says about the speed.

    Parameters
    ----------
    off : float
        Speed less that of the filter [m/s].
    variance : float
        [m^2/s^2]
    """

    off: float
    variance: float


class Trust(NamedTuple):
    """How likelihoods are believed.

    Parameters
    ----------
    temper : float
        Factor on log likelihoods.
    deaf : float
        Prior probability that there is no comb to be heard, whatever the speed.
    evidence : float
        Log likelihood ratio against no comb that is asked for.
    mass : float
        Share of the probability that the peak must hold.
    widest : float
        Speeds farther from the filter's are not looked at [m/s].
    """

    temper: float
    deaf: float
    evidence: float
    mass: float
    widest: float


def peak(comb: Comb, heard: Spectrum, sd: float, trust: Trust) -> Peak | None:
    """The speed that fits, where one does; speeds without a comb have a likelihood ratio of one.

    Parameters
    ----------
    comb : Comb
    heard : Spectrum
    sd : float
        Of the filter's speed, as it is believed here [m/s].
    trust : Trust

    Returns
    -------
    Peak or None
    """
    reach = min(max(3.5 * sd, 0.8), trust.widest)
    speeds = np.arange(max(0.0, heard.speed - reach), heard.speed + reach, GRID)
    log, audible = np.zeros(len(speeds)), speeds >= SLOWEST
    if audible.sum() < 5:
        return None
    ratio = np.exp(trust.temper * comb.evidence(heard, speeds[audible]))
    log[audible] = np.log((1.0 - trust.deaf) * ratio + trust.deaf)
    log[audible] += too_quiet(comb.levels, heard.level, speeds[audible])
    prior = np.exp(-0.5 * ((speeds - heard.speed) / sd) ** 2)
    posterior = log + np.log(prior)
    k = int(posterior.argmax())
    if k in (0, len(speeds) - 1) or log[k] < trust.evidence or speeds[k] < SLOWEST + 0.1:
        return None
    share = np.exp(posterior - posterior[k])
    near = np.abs(speeds - speeds[k]) < NEAR
    everywhere = sd * math.sqrt(2.0 * math.pi) / GRID  # a speed beyond the search has no comb either
    beyond = max(0.0, everywhere - float(prior.sum())) * math.exp(-posterior[k])
    if share[near].sum() < trust.mass * (share.sum() + beyond):
        return None
    weight = np.exp(log[near] - log[near].max())
    weight /= weight.sum()
    mean = float(weight @ speeds[near])
    return Peak(mean - heard.speed, float(weight @ (speeds[near] - mean) ** 2))
