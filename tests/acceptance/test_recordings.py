"""Real cars: seven recordings fuse from one call, and their figures are those of the answer sheet.

The recordings are not part of the project: GAPLESS_RECORDINGS names their folder, `../shared/data` is
looked at otherwise, and without them everything here is skipped.
"""

import os
import tomllib
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from gapless import io
from gapless.errors import RecordingError
from gapless.evaluation import score, solution_errors
from gapless.evaluation.errors import gnss_truth
from gapless.evaluation.statistics import rms
from gapless.runs.decide import decide, decide_before
from gapless.runs.forks import piece, run_with_forks
from gapless.runs.fuse import fuse
from gapless.runs.prepare import withhold_from
from gapless.scenarios import plan
from gapless.simulate import spikes
from gapless.systems.library import load
from gapless.systems.recipe import System
from gapless.units import DEG

DATA = Path(os.environ.get("GAPLESS_RECORDINGS", Path(__file__).parents[3] / "shared" / "data"))
NAMES = ("beijing-a", "beijing-c", "beijing-d", "beijing-e1", "beijing-e2", "colorado", "kingston")
CLOCKS = {
    "beijing-a": (-0.15, -0.60),
    "beijing-c": (-0.10, -0.12),
    "beijing-d": (-0.15, -0.22),
    "beijing-e1": (-0.06, -0.10),
    "beijing-e2": (-0.06, -0.10),
    "colorado": (0.21, 0.09),
    "kingston": (0.0, 0.0),
}
"""What must be added to position and velocity stamps [s]; found by scanning, good to 0.03 s."""

CHANNELS = ("position", "velocity")

pytestmark = pytest.mark.skipif(
    not all((DATA / name).is_dir() for name in NAMES),
    reason=f"real recordings are not in {DATA}; set GAPLESS_RECORDINGS to their folder",
)


@cache
def recording(name):
    return io.read(DATA / name)


@cache
def solution(name):
    return fuse(recording(name))


@cache
def scores(name):
    return score(solution(name), recording(name))


def clock(decisions, channel):
    return next(d.value for d in decisions if d.name == f"clock offset, {channel}")


@pytest.mark.parametrize("name", NAMES)
def test_fuses_without_being_told_anything(name):
    t = solution(name).trajectory
    log = recording(name)
    # to the last hole of the log, from the third fix in a row at speed on
    fast = np.flatnonzero(np.hypot(*log.gnss.v_n[:, :2].T) > 5.0)
    assert t.time[0] < log.gnss.time[fast[0]] + 60.0
    holes = log.imu.time[1:][np.diff(log.imu.time) > 10.0]
    assert t.time[-1] > min([log.imu.time[-1], *(holes - 20.0)]) - 1.0
    assert all(np.isfinite(column).all() for column in (t.lla, t.v_n, t.euler, t.sd))
    apart = solution_errors(t, gnss_truth(log.gnss, *(clock(solution(name).decisions, c) for c in CHANNELS)))
    # Raw fixes stray by up to 69 m (kingston); a solution that had diverged would be further off.
    assert np.nanmax(apart.horizontal) < 75.0
    assert np.nanmedian(apart.horizontal) < 3.0


@pytest.mark.parametrize("name", NAMES)
def test_clock_offsets_are_those_of_the_answer_sheet(name):
    found = [clock(solution(name).decisions, channel) for channel in CHANNELS]
    print(name, found, CLOCKS[name])
    assert abs(found[0] - CLOCKS[name][0]) < 0.05
    assert abs(found[1] - CLOCKS[name][1]) < 0.1


def test_odometer_offset():
    assert abs(clock(solution("kingston").decisions, "odometer") - 0.30) < 0.05


@pytest.mark.parametrize("shift", [-0.3, 0.3])
@pytest.mark.parametrize("name", ["beijing-a", "colorado", "kingston"])
def test_shifted_stamps_move_the_offset_by_as_much(name, shift):
    log = recording(name)
    moved = replace(log, gnss=replace(log.gnss, time=log.gnss.time + shift))
    found = decide(moved, System()).offsets
    before = {c: clock(solution(name).decisions, c) for c in CHANNELS}
    change = {c: found[c] - before[c] for c in CHANNELS}
    print(name, shift, change)
    for channel in CHANNELS:
        assert abs(change[channel] + shift) < 0.02, channel


@pytest.mark.parametrize("name", NAMES)
def test_axes_are_named_where_nobody_states_them(name, tmp_path):
    for file in (DATA / name).glob("*.parquet"):
        (tmp_path / file.name).symlink_to(file)
    stated = tomllib.loads((DATA / name / "recording.toml").read_text())["imu_axes"]
    with pytest.raises(RecordingError, match=f'say so with imu_axes = "{stated}"'):
        io.read(tmp_path)


def test_vague_offset_of_positions_follows_that_of_velocities():
    """In the city some minutes of positions say little of their clock; velocities of the same receiver do."""
    log = recording("kingston")
    late = replace(log, gnss=replace(log.gnss, time=log.gnss.time + 0.5))
    found = decide(late, System(), late.start + 960.0).decisions
    assert "weighed against" in next(d.evidence for d in found if d.name == "clock offset, position")
    # What is weighed is known better than to 0.1 s; taken as logged it would be off by 0.5 s.
    assert clock(found, "position") == pytest.approx(-0.5, abs=0.1)


def test_two_devices_in_one_car_agree():
    """On GNSS time, where both were driving with GNSS: their raw fixes differ by 2.1 m RMS."""
    one, other = ("beijing-e1", "beijing-e2")
    fixes = [
        replace(
            solution(n).trajectory,
            time=solution(n).trajectory.time - clock(solution(n).decisions, "position"),
        )
        for n in (one, other)
    ]
    apart = solution_errors(fixes[0], fixes[1]).horizontal
    print(f"e1 - e2: {rms(apart):.2f} m")
    assert np.isfinite(apart).mean() > 0.9
    assert rms(apart) < 1.9


@pytest.mark.parametrize("name", ["beijing-a", "kingston"])
def test_closer_to_the_reference_than_the_fixes(name):
    s = scores(name)
    print(f"{name}: {s.aided.horizontal_rmse:.2f} m, fixes {s.fixes_rmse:.2f} m")
    assert s.aided.horizontal_rmse < s.fixes_rmse


def test_kingston_attitude():
    errors = scores("kingston").errors
    found = [rms(errors.attitude[:, i]) / DEG for i in range(3)]
    print("roll, pitch, heading: {:.2f} {:.2f} {:.2f} deg".format(*found))
    assert max(found[:2]) < 0.5
    assert found[2] < 1.0


def rows_after_the_holes(name):
    """Of the solution, and of the fixes: the log has two holes of 17 s after 860 s."""
    log, t = recording(name), solution(name).trajectory
    holes = np.flatnonzero(np.diff(log.imu.time) > 10.0)
    assert len(holes) == 2
    return t.time > log.imu.time[holes[1]] + 30.0, log.gnss.time > log.imu.time[holes[0]]


@pytest.mark.parametrize("name", ["beijing-e1", "beijing-e2"])
def test_nothing_goes_astray_through_holes_in_the_log(name):
    _, late = rows_after_the_holes(name)
    fixes = gnss_truth(recording(name).gnss, clock(solution(name).decisions, "position"))
    apart = solution_errors(solution(name).trajectory, fixes).horizontal[late]
    assert not np.any(apart > 15.0)


@pytest.mark.parametrize("name", ["beijing-e1", "beijing-e2"])
def test_navigation_goes_on_after_holes_in_the_log(name):
    rows, _ = rows_after_the_holes(name)
    assert rows.sum() > 600


@pytest.mark.parametrize("name", ["beijing-a", "colorado", "kingston"])
def test_injected_spikes_do_no_harm(name):
    """One epoch in fifty jumps by 20 to 500 m and 10 to 400 m/s, its stated deviations as they were."""
    log = recording(name)
    count = len(log.gnss) // 50
    struck, _ = spikes(log.gnss, np.random.default_rng(1), count, (20.0, 500.0), (10.0, 400.0))
    found = fuse(replace(log, gnss=struck)).trajectory
    apart = solution_errors(found, solution(name).trajectory).horizontal
    print(f"{name}: {count} spikes, {rms(apart):.2f} m RMS, {np.nanmax(apart):.2f} m at most")
    assert np.nanpercentile(apart, 95.0) < 3.0
    assert np.nanmax(apart) < 15.0


def test_isolated_outages_on_kingston_are_whole_runs_with_that_outage_alone():
    """Every seventh of thirty; `benchmarks/honesty.py --recording` has them all, and the time it takes."""
    log, system = recording("kingston"), load("constraints")
    texts = [f"every=180,length=60,first=240,shift={shift}" for shift in (0, 60, 120)]
    outages = tuple(o for text in texts for o in plan([text], log))
    decided = decide_before(withhold_from(log, outages), system, outages)
    whole, forks = run_with_forks(log, system, (), outages, decided, 10.0)
    compared = 0
    for fork in forks[::7]:
        part = piece(fork, log, whole, system, decided)
        run = fuse(log, system, [fork.outage], decided=decided).trajectory
        if len(part):
            run = run.take((run.time >= part.time[0]) & (run.time <= part.time[-1]))
            assert len(part) > 600
            for name in ("time", "lla", "v_n", "euler", "sd", "horizontal", "source"):
                assert np.array_equal(getattr(part, name), getattr(run, name)), (str(fork.outage), name)
            compared += 1
    assert compared >= 3
