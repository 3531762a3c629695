"""A car that stands is read no speed, whatever the filter takes it to be doing."""

from dataclasses import replace

import numpy as np
import pytest
from cars import car, learned

from gapless.bridges.combs import Combs
from gapless.bridges.loudness import SILENT
from gapless.bridges.orders import LONGEST, spectrum, window
from gapless.bridges.peak import peak
from gapless.bridges.wheels import Wheels

TRUST = Wheels({}).trust


def standing(log):
    """Windows in which the car stands throughout, a second apart."""
    truth, imu = log.reference, log.imu
    moving = truth.time[np.linalg.norm(truth.v_n, axis=1) > 0.02]
    for end in np.arange(log.start + LONGEST + 2.0, imu.time[-1], 1.0):
        if not np.any((moving > end - LONGEST - 1.0) & (moving < end + 1.0)):
            k = (imu.time > end - LONGEST - 0.4) & (imu.time < end + 0.1)
            felt = np.hstack([imu.dtheta[k], imu.dvel[k]]) / imu.dt[k, None]
            yield end, np.column_stack([imu.time[k], felt])


def read(log, comb, believed, sd):
    """How many windows of a standing car give a speed to a filter that believes another, and of how many."""
    found = []
    for end, rows in standing(log):
        times, steady = end + np.linspace(-LONGEST - 0.2, 0.0, 165), np.full(165, believed)
        heard = spectrum(rows, times, steady, window(times, steady), 47.0)
        found.append(peak(comb, heard, sd, TRUST) is not None)
    return sum(found), len(found)


@pytest.mark.parametrize(
    ("believed", "sd", "few", "most"),
    [(0.8, 1.9, 15, 0), (1.6, 1.2, 40, 0), (3.2, 0.6, 50, 1), (5.0, 2.0, 5, 0)],
)
def test_no_speed_is_read_where_the_car_stands(believed, sd, few, most):
    """By combs alone 31, 80, 81 and 12 of 291 do, with loudness 0, 0, 1 and 0.

    That a car that rolls is heard is told elsewhere.
    """
    comb = Combs.of(learned()).at(believed)
    deaf_to_loudness = replace(comb, levels=SILENT)
    told = [
        (read(car(seed), comb, believed, sd), read(car(seed), deaf_to_loudness, believed, sd))
        for seed in (3, 7)
    ]
    print(told)
    assert sum(with_it for (with_it, _), _ in told) <= most
    assert sum(without for _, (without, _) in told) >= few
