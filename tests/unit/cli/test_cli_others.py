"""inspect, simulate, convert, and the bar."""

import io
import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import gapless as gp
from gapless.cli.progress import progress
from gapless.simulate import CAR


def test_inspect_tells_what_fuse_then_decides(shell, drive, tmp_path):
    choice = ("--outage", "100:130")
    told = shell("inspect", drive, *choice).stdout
    done = shell("fuse", drive, *choice, "--no-report", "--out", tmp_path).stdout
    after = told[told.index("Decisions") :].strip().splitlines()
    assert len(after) > 8  # sensors, noise, lever arm, clocks, mounting, alignment, stops
    assert after == done[done.index("Decisions") :].split("\n\n")[0].splitlines()
    assert max(map(len, told.splitlines())) <= 80


def test_inspect_tells_rates_and_spans(shell, drive):
    lines = shell("inspect", drive).stdout.splitlines()
    (imu,) = (line.split() for line in lines if line.startswith("  imu "))
    assert imu[1:] == ["16000", "100", "Hz", "0.01", "160.00", "none"]


def test_inspect_still_tells_what_is_in_a_drive_that_cannot_start(shell, tmp_path):
    shell("simulate", "--profile", "static", "--duration", 60, "--out", tmp_path / "still")
    said = shell("inspect", tmp_path / "still", code=2)
    assert "imu" in said.stdout
    assert "alignment.min_speed" in said.stderr
    assert said.stderr.count("\n") == 1


def test_simulate_is_the_python_call(shell, tmp_path):
    words = ("--profile", "carpark", "--grade", "tactical", "--duration", 30, "--seed", 7)
    shell("simulate", *words, "--odometer", "--out", tmp_path / "a")
    found = gp.read(tmp_path / "a")
    made = gp.simulate_drive("carpark", "tactical", 30.0, 7)
    # increments are stored as rates beside their interval: one rounding
    assert np.allclose(found.imu.dtheta, made.imu.dtheta, rtol=1e-15, atol=0.0)
    assert found.odometer is not None
    assert found.grade == "tactical"


def test_simulated_wheels(shell, tmp_path):
    words = ("--profile", "carpark", "--duration", 30, "--seed", 7, "--wheels", 2)
    shell("simulate", *words, "--out", tmp_path / "a")
    found = gp.read(tmp_path / "a")
    made = gp.simulate_drive("carpark", duration=30.0, seed=7, chassis=replace(CAR, signal=2.0))
    # increments are stored as rates beside their interval: one rounding
    assert np.allclose(found.imu.dvel, made.imu.dvel, rtol=1e-15, atol=0.0)
    said = shell("simulate", "--wheels", -1, "--out", tmp_path / "b", code=2)
    assert "-1 times as loud" in said.stderr
    assert said.stderr.count("\n") == 1


def test_simulated_silence(shell, tmp_path):
    shell("simulate", "--profile", "carpark", "--duration", 60, "--outage", "20:40", "--out", tmp_path)
    found = gp.read(tmp_path)
    since = found.gnss.time - found.start
    assert not ((since >= 20.0) & (since < 40.0)).any()
    assert len(since) == 41  # 0 to 60 s once a second, less twenty


def test_simulated_lateness(shell, tmp_path):
    """A velocity stamped 0.3 s late fits the truth of 0.3 s before."""
    shell("simulate", "--profile", "carpark", "--duration", 120, "--late", 0.3, "--out", tmp_path)
    found = gp.read(tmp_path)
    truth, gnss = found.reference, found.gnss

    def misfit(late):
        at = np.column_stack([np.interp(gnss.time - late, truth.time, v) for v in truth.v_n.T])
        return np.sqrt(np.mean((gnss.v_n - at)[:, :2] ** 2))

    # the receiver's velocity noise is 0.05 m/s; 119 epochs know that to 5 %
    assert misfit(0.3) < 0.06
    assert misfit(0.3) < min(misfit(0.0), misfit(0.6))


def test_convert_reads_either_order_of_a_pair(shell, tmp_path):
    made = gp.simulate_drive("carpark", duration=40.0, seed=3)
    imu, gnss = made.imu, made.gnss
    np.savetxt(tmp_path / "imu.txt", np.column_stack([imu.time, imu.dtheta, imu.dvel]), "%.12f")
    lla = np.column_stack([np.degrees(gnss.lla[:, :2]), gnss.lla[:, 2]])
    np.savetxt(tmp_path / "gnss.txt", np.column_stack([gnss.time, lla, gnss.sd_position]), "%.12f")
    for out, pair in (("a", ("imu.txt", "gnss.txt")), ("b", ("gnss.txt", "imu.txt"))):
        said = shell("convert", *(tmp_path / name for name in pair), "--out", tmp_path / out).stdout
        assert said.splitlines()[-1] == f"wrote {tmp_path / out}"
        found = gp.read(tmp_path / out)
        # 12 decimals were written
        assert np.allclose(found.imu.dvel, imu.dvel, rtol=0.0, atol=1e-12)
        assert np.allclose(found.gnss.lla[:, :2], gnss.lla[:, :2], rtol=0.0, atol=1e-13)


def test_what_was_mended_is_said(shell, drive, tmp_path):
    broken = tmp_path / "broken"
    broken.mkdir()
    for sensor in ("imu", "gnss"):
        frame = pd.read_parquet(drive / f"{sensor}.parquet")
        if sensor == "gnss":
            frame.loc[30, ["sd_north", "sd_east", "sd_down"]] = 0.0
        frame.to_csv(broken / f"{sensor}.csv", index=False)
    for verb in ("convert", "fuse"):
        said = shell(verb, broken, "--out", tmp_path / verb).stdout
        assert re.search(
            r"^  gnss.*sd_north, sd_east, sd_down missing, zero or absurd",
            said[said.index("Noticed") :],
            re.MULTILINE,
        )


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_a_bar_only_for_people_who_watch(monkeypatch):
    with progress("fusing", 100.0) as tell:
        assert tell is None
    screen = Terminal()
    monkeypatch.setattr("sys.stderr", screen)
    with progress("fusing", 100.0) as tell:
        tell(40.0)
        assert "40%" in screen.getvalue()
    assert "100%" in screen.getvalue()


@pytest.mark.parametrize("name", ["inspect", "fuse", "simulate", "convert"])
def test_verbs_live_in_files_of_their_name(name):
    from importlib import import_module

    assert import_module(f"gapless.cli.{name}").__dict__[name].name == name


@pytest.mark.parametrize(
    ("words", "cure"),
    [
        (("--duration", 0.001), "no two IMU samples"),
        (("--duration", "nan"), "give a positive duration"),
        (("--duration", 1e12), "of at most 86400 s"),
        (("--duration", 20, "--late", "nan"), "give finite numbers"),
        (("--duration", 20, "--mounting", "nan", 0, 0), "give finite numbers"),
    ],
)
def test_a_drive_that_cannot_be_is_refused_in_one_line(shell, tmp_path, words, cure):
    said = shell("simulate", *words, "--out", tmp_path / "a", code=2)
    assert said.stderr.startswith("gapless: ")
    assert said.stderr.count("\n") == 1
    assert cure in said.stderr
    assert list(tmp_path.iterdir()) == []
