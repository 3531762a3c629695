"""What must not help does no harm, and the decisions say why.

Each drive has five outages of a minute. The bound everywhere: largest errors, floored at 2 m as the judge
does, within 5 % of constraints alone, in the geometric mean.
"""

from dataclasses import replace

import numpy as np
import pytest
from cars import car, deaf, driven, injected, learned, ratio, said, worst
from scipy.signal import butter, sosfiltfilt

from gapless.bridges import BRIDGES
from gapless.bridges.base import Saying
from gapless.measurements.base import Observation
from gapless.simulate import CAR, WheelComb
from gapless.systems.adjust import changed, named
from gapless.units import DEG

HARM = 1.05
OTHER = replace(CAR, wheels=(WheelComb(circumference=2.31),))


def harmless(log, solution):
    """No harm, and told that nobody speaks or that the wheels had nothing to say."""
    found = ratio(worst(solution, log), worst(driven(log, "constraints"), log))
    who, how = said(solution, "bridge chosen")
    print(f"{found:.3f} {who} | {how} | {said(solution, 'rehearsed, wheels')}")
    assert found < HARM
    return who


@pytest.mark.parametrize("stretch", [1.0, 1.13])
def test_the_template_of_another_car(stretch):
    """Of wheels of another size; the own car's, stretched by 13 %."""
    log = car()
    memory = learned(OTHER) if stretch == 1.0 else learned(CAR)
    assert harmless(log, driven(log, "auto", injected(memory, stretch))) == "nobody"


def test_the_own_template_injected_helps():
    """The control of the control: what is injected does speak, where it is right."""
    log = car()
    solution = driven(log, "auto", injected(learned(CAR)))
    assert said(solution, "bridge chosen")[0] == "wheels"
    assert ratio(worst(solution, log), worst(driven(log, "constraints"), log)) < 0.8


def split(log):
    """Increments per second: what is slower than 3 Hz, and the rest."""
    both = np.hstack([log.imu.dtheta, log.imu.dvel]) / log.imu.dt[:, None]
    slow = sosfiltfilt(butter(4, 3.0, fs=100.0, output="sos"), both, axis=0)
    return slow, both - slow


def joined(log, both):
    both = both * log.imu.dt[:, None]
    return replace(log, imu=replace(log.imu, dtheta=both[:, :3], dvel=both[:, 3:]))


def test_shuffled_vibration():
    """As loud as before in every second, without a comb."""
    log = car()
    slow, fast = split(log)
    rng, n = np.random.default_rng(1), len(fast) // 100 * 100
    for k in range(0, n, 100):
        fast[k : k + 100] = fast[k + rng.permutation(100)]
    log = joined(log, slow + fast)
    assert harmless(log, driven(log, "auto")) == "nobody"


def test_a_low_passed_log():
    """Nothing above 5 Hz: what wheels are left to hear may help, and must not harm."""
    log = car()
    both = np.hstack([log.imu.dtheta, log.imu.dvel]) / log.imu.dt[:, None]
    log = joined(log, sosfiltfilt(butter(8, 5.0, fs=100.0, output="sos"), both, axis=0))
    harmless(log, driven(log, "auto"))


def test_wheels_that_nobody_can_hear_and_a_fan():
    """A tone of 13 Hz that does not know the speed."""
    log = car(chassis=deaf())
    both = np.hstack([log.imu.dtheta, log.imu.dvel]) / log.imu.dt[:, None]
    size = np.array([0.1 * DEG, 0.1 * DEG, 0.05 * DEG, 0.05, 0.05, 0.08])
    tone = np.sin(2.0 * np.pi * 13.0 * log.imu.time[:, None] + np.arange(6)) * size
    log = joined(log, both + tone)
    assert harmless(log, driven(log, "auto")) == "nobody"


class Dice:
    """A bridge that says a speed at random, ten per cent about the filter's, and is sure of it."""

    reach = 0.0

    def __init__(self, sensors):
        self.rng, self.due, self.fixed = np.random.default_rng(1), -np.inf, -np.inf

    def feel(self, block):
        pass

    def hear(self, belief, reading, used):
        self.fixed = reading.time

    def tick(self, belief, motion):
        if motion.time < self.due or motion.time < self.fixed + 2.5:
            return ()
        self.due = motion.time + 0.95
        v = belief.estimate()[3:6]
        speed = float(np.linalg.norm(v))
        h = np.zeros((1, belief.layout.n))
        h[0, 3:6] = v / max(speed, 0.1)
        off = 0.1 * speed * self.rng.normal()
        return (Saying("bridge_dice", Observation(np.array([off]), h, np.array([[0.04]]))),)

    def lost(self):
        pass

    def decisions(self, start):
        return ()

    def learned(self):
        return None

    def copy(self):
        new = Dice(None)
        new.rng.bit_generator.state = self.rng.bit_generator.state
        new.due, new.fixed = self.due, self.fixed
        return new


def test_a_bridge_that_throws_dice(monkeypatch):
    monkeypatch.setitem(BRIDGES, "dice", Dice)
    log = car(chassis=deaf())
    solution = driven(log, changed(named("auto"), {"bridge.model": "dice"}, ""))
    found = ratio(worst(solution, log), worst(driven(log, "constraints"), log))
    print(found, said(solution, "bridge chosen"), said(solution, "rehearsed, dice"))
    assert said(solution, "bridge chosen")[0] == "nobody"
    assert said(solution, "rehearsed, dice")[0] == "not better"
    assert found < HARM
    always = driven(log, changed(named("wheels"), {"bridge.model": "dice"}, ""))
    assert ratio(worst(always, log), worst(driven(log, "constraints"), log)) > 1.1, "it harms where it may"
