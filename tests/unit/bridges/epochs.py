"""Made-up epochs in a row."""

import numpy as np

from gapless import earth
from gapless.bridges.epochs import Epoch, unknown

ORIGIN = np.array([0.56, 2.07, 20.0])


def drive(n: int, seed: int = 0, speed: float = 10.0, segment_every: int = 10**6) -> list[Epoch]:
    """A car that turns gently; its INS errs by 0.1 a squared second of age, north, and half of it east."""
    rng = np.random.default_rng(seed)
    place, heading, made = ORIGIN.copy(), 0.3, []
    for k in range(n):
        rate = 0.02 * np.sin(0.05 * k)
        heading += rate
        v_n = speed * np.array([np.cos(heading), np.sin(heading), 0.0])
        place = earth.ned_to_lla(v_n, place)
        age = float(k % segment_every)
        drift = np.array([0.1, 0.05, 0.0]) * age**2
        error = np.concatenate([drift, 0.2 * np.array([0.1, 0.05, 0.0]) * age, np.zeros(3)])
        noise = 0.01 * rng.normal(size=6)
        x = unknown().shadow.copy()
        x[:3] = earth.ned_to_lla(error[:3], place)
        x[3:6] = v_n + error[3:6]
        turn, force = np.array([0.0, 0.0, rate]), np.array([0.0, speed * rate, -9.8])
        dt, segment, way = 1.0 if k else np.nan, k // segment_every, earth.lla_to_ned(x[:3], ORIGIN)
        seen = error[:6] + noise
        made.append(Epoch(float(k), dt, segment, age, x, way, v_n, turn, force, seen, error, place))
    return made
