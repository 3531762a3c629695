"""A made-up drive and what a navigator might have found of it: random turns, stops, outages, fixes.

Nothing of gapless's navigation is in it: errors grow in the outages as the stated ellipses do.
"""

from __future__ import annotations

import numpy as np

from gapless import earth
from gapless.trip.recording import Gnss, Imu, Note, Recording, Trajectory
from gapless.trip.solution import Decision, Innovations, Solution

START = 1000.0
ORIGIN = np.array([np.radians(44.23), np.radians(-76.49), 95.0])


def smooth(x, rows):
    kernel = np.hanning(rows)
    padded = np.pad(x, rows // 2, mode="edge")
    return np.convolve(padded, kernel / kernel.sum(), mode="same")[rows // 2 :][: len(x)]


def drive(length, rng):
    """Time, NED path, velocity and Euler angles of a drive through a town, at 10 Hz."""
    t = np.arange(0.0, length, 0.1)
    legs = int(length / 25) + 2
    speed = rng.choice([0.0, 8.0, 12.0, 14.0, 17.0], legs, p=[0.14, 0.22, 0.26, 0.22, 0.16])
    speed[0] = 0.0
    turn = np.cumsum(rng.choice([-90.0, 0.0, 0.0, 0.0, 90.0, 25.0], legs)) + 18.0
    at = np.minimum((t / 25).astype(int), legs - 1)
    v = np.maximum(smooth(speed[at], 81) - 0.02, 0.0)
    heading = np.radians(smooth(turn[at], 61) + 6.0 * np.sin(t / 31) + 9.0 * np.sin(t / 83))
    v_n = np.column_stack([v * np.cos(heading), v * np.sin(heading), 0.02 * v * np.sin(t / 47)])
    ned = np.cumsum(v_n * 0.1, axis=0)
    roll = 0.02 * np.gradient(heading, 0.1) * v / 9.81
    pitch = 0.01 * np.sin(t / 40) - 0.02 * np.gradient(v, 0.1)
    return t, ned, v_n, np.column_stack([roll, pitch, (heading + np.pi) % (2 * np.pi) - np.pi])


def red(rng, n, tau, sd):
    """First-order Gauss-Markov noise at 10 Hz."""
    a = np.exp(-0.1 / tau)
    drive_ = rng.standard_normal((n, 3)) * sd * np.sqrt(1 - a * a)
    out = np.zeros((n, 3))
    for k in range(1, n):
        out[k] = a * out[k - 1] + drive_[k]
    return out


def make(
    name="kestrel-avenue",
    length=900.0,
    outages=((240.0, 300.0), (420.0, 480.0), (600.0, 660.0)),
    reference=True,
):
    """A recording and its solution."""
    rng = np.random.default_rng(8)
    t, ned, v_n, euler = drive(length, rng)
    n = len(t)
    lla = earth.ned_to_lla(ned, ORIGIN)
    time = START + t
    age = np.zeros(n)
    for a, b in outages:
        inside = (t >= a) & (t < b)
        age[inside] = t[inside] - a
    along, across = 0.55 + 0.1 * age**1.15, 0.45 + 0.0022 * age**2
    c, s = np.cos(euler[:, 2]), np.sin(euler[:, 2])
    unit = red(rng, n, 15.0, 1.0)
    error = np.column_stack(
        [
            c * along * unit[:, 0] - s * across * unit[:, 1],
            s * along * unit[:, 0] + c * across * unit[:, 1],
            0.9 * unit[:, 2],
        ]
    )
    sd = np.full((n, 9), 0.05)
    sd[:, 0], sd[:, 1] = np.hypot(c * along, s * across), np.hypot(s * along, c * across)
    sd[:, 2] = 0.9 + 0.02 * age
    sd[:, 3:6] += 0.006 * age[:, None] + 0.01 * np.abs(np.sin(t / 9))[:, None]
    sd[:, 6:8] = np.radians(0.12 + 0.5 * np.exp(-t / 60))[:, None]
    sd[:, 8] = np.radians(0.35 + 3.0 * np.exp(-t / 45) + 0.006 * age)
    rows = slice(200, None)
    found = Trajectory(
        time,
        earth.ned_to_lla(ned + error, ORIGIN),
        v_n + 0.04 * red(rng, n, 4.0, 1.0),
        euler + np.radians(0.25) * red(rng, n, 30.0, 1.0),
        sd,
        c * s * (along**2 - across**2),
        np.where(age > 0, "constraints", "gnss"),
    ).take(rows)
    fixes = slice(3, None, 10)
    m = len(t[fixes])
    noise = 1.6 * red(rng, n, 25.0, 1.0)[fixes] + 0.4 * rng.standard_normal((m, 3))
    spikes = rng.random(m) < 0.006
    noise[spikes] += rng.normal(0.0, 25.0, (int(spikes.sum()), 3))
    gnss = Gnss(
        time[fixes],
        earth.ned_to_lla(ned[fixes] + noise, ORIGIN),
        np.full((m, 3), 2.0),
        v_n[fixes] + 0.1 * rng.standard_normal((m, 3)),
        np.full((m, 3), 0.15),
        np.ones(m, int),
    )
    nan = np.full((n, 9), np.nan)
    truth = Trajectory(
        time, lla + np.array([0, 0, 36.4]), v_n, euler, nan, nan[:, 0], np.full(n, "reference")
    )
    imu = Imu.from_rates(time, np.zeros((n, 3)), np.zeros((n, 3)))
    notes = (
        Note("imu.parquet", "time stamps in 10 ms ticks, repeated ones spread evenly", 703),
        Note(
            "gnss.parquet",
            "fixes that jump by more than the speed allows, left to the gate",
            int(spikes.sum()),
        ),
    )
    recording = Recording(
        name, imu, gnss, None, truth.take(slice(0, None, 10)) if reference else None, notes=notes
    )
    solution = Solution(
        name,
        "constraints",
        found,
        *_states(t[rows], rng),
        _innovations(time, t, outages, rng),
        DECISIONS,
        tuple(outages),
        START,
        notes,
    )
    return recording, solution


def _states(t, rng):
    n = len(t)
    decay = np.exp(-t / 120)[:, None]
    size = {
        "gyro_bias": np.radians(0.03),
        "accel_bias": 0.04,
        "mounting": np.radians(0.4),
        "odometer_scale": 0.004,
    }
    final = {
        "gyro_bias": np.radians([0.12, -0.05, 0.02]),
        "accel_bias": np.array([0.21, -0.32, 0.08]),
        "mounting": np.radians([2.4, -3.1]),
        "odometer_scale": np.array([0.011]),
    }
    walk = {
        k: size[k] * 0.25 * np.cumsum(rng.standard_normal((n, len(v))), 0) / np.sqrt(n)
        for k, v in final.items()
    }
    states = {k: v * (1 - 0.8 * decay) + walk[k] for k, v in final.items()}
    sds = {k: size[k] * (0.12 + 2.0 * decay) * np.ones(len(v)) for k, v in final.items()}
    return states, sds


def _innovations(time, t, outages, rng):
    open_sky = np.ones(len(t), bool)
    for a, b in outages:
        open_sky &= ~((t >= a) & (t < b))
    found = {}
    plan = {
        "position": (10, 3, 1.9, True),
        "velocity": (10, 3, 0.18, True),
        "nonholonomic": (2, 2, 0.2, False),
        "zero_velocity": (40, 6, 0.01, False),
        "odometer": (10, 1, 0.12, False),
    }
    for name, (every, d, sd, needs_sky) in plan.items():
        rows = np.arange(220, len(t), every)
        rows = rows[open_sky[rows]] if needs_sky else rows
        z = sd * rng.standard_normal((len(rows), d))
        factor = np.ones(len(rows))
        if needs_sky:
            odd = rng.random(len(rows)) < 0.02
            z[odd] *= rng.uniform(3, 40, (int(odd.sum()), 1))
            factor[odd] = np.where(np.abs(z[odd]).max(1) > 12 * sd, np.inf, 3.0)
        sds = np.full((len(rows), d), sd)
        found[name] = Innovations(time[rows], z, sds, (z**2 / sds**2).sum(1), factor)
    return found


DECISIONS = (
    Decision(
        "clock offset, position",
        0.0,
        "s",
        "data",
        "scan of ±1 s: residual 0.41 m at best, 2.9 m at ±0.3 s",
        0.012,
    ),
    Decision(
        "clock offset, velocity",
        -0.094,
        "s",
        "data",
        "mean over the last epoch: half of it, and the antenna's filter",
        0.02,
    ),
    Decision("initial heading", 18.4, "deg", "data", "GNSS course over 6 s above 5 m/s", 1.2),
    Decision(
        "mounting angles",
        (2.31, -3.08),
        "deg",
        "data",
        "levelling against course over 412 s of straight driving",
        0.21,
    ),
    Decision(
        "grade", "consumer", "", "default", "none named in recording.toml; biases up to 0.5 m/s² expected"
    ),
    Decision("lever arm", (0.0, -0.05, 0.0), "m", "recording", "antenna_lever_arm in recording.toml"),
    Decision(
        "stillness threshold",
        0.0135,
        "m/s²",
        "data",
        "between the 14 stops of this drive and its slowest motion",
    ),
    Decision("non-holonomic constraint", "on", "", "user", "--without left it on"),
)
