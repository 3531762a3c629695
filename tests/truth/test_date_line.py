"""A drive across 180 degrees is navigated, scored and drawn as the same drive elsewhere."""

import json
from dataclasses import replace
from functools import cache
from itertools import pairwise
from xml.etree import ElementTree

import numpy as np
import pytest

from gapless import io
from gapless.evaluation import score
from gapless.reports.payload import payload
from gapless.runs.fuse import fuse
from gapless.runs.smooth import smooth
from gapless.scenarios import Outage
from gapless.simulate import simulate
from gapless.systems.recipe import Clock, Mounting, System

LATITUDE = -16.8 * np.pi / 180.0
OUTAGES = (Outage(130.0, 150.0),)
TOLD = System(clock=Clock(0.0, 0.0), mounting=Mounting(0.0, 0.0))
"""What is searched for turns roundings of 1e-9 m into tenths of a millisecond, between any two places."""
SEAM = np.pi - 2e-4
"""1.2 km before the date line: a car at 30 m/s crosses it after the alignment and before the outage."""


@cache
def driven(longitude, run=fuse):
    drive = simulate("highway", "consumer", 180.0, 3, origin=(LATITUDE, longitude, 20.0), heading=0.5 * np.pi)
    drive = replace(drive, grade=None)
    solution = run(drive, TOLD, outages=OUTAGES)
    return drive, solution


def crossings(longitude):
    return int((np.abs(np.diff(longitude)) > np.pi).sum())


@pytest.mark.parametrize("run", [fuse, smooth])
def test_as_accurate_as_elsewhere(run):
    (drive, there), (other, here) = driven(SEAM, run), driven(1.0, run)
    assert crossings(drive.gnss.lla[:, 1]) == crossings(drive.reference.lla[:, 1]) == 1
    assert crossings(there.trajectory.lla[:, 1]) == 1
    assert (np.abs(there.trajectory.lla[:, 1]) <= np.pi).all()
    a, b = score(there, drive).errors, score(here, other).errors
    for name in ("position", "velocity", "attitude"):
        # m, m/s, rad: longitudes are rounded by 3e-9 m at pi, and the filter's start forgets its rounding
        np.testing.assert_allclose(getattr(a, name), getattr(b, name), rtol=0.0, atol=1e-4)
    np.testing.assert_allclose(there.trajectory.sd, here.trajectory.sd, rtol=1e-4)


def test_drawn_as_elsewhere():
    (drive, there), (plain, here) = driven(SEAM), driven(1.0)
    a, b = (payload(s, d, score(s, d))["track"] for s, d in ((there, drive), (here, plain)))
    for one, other in ((a, b), (a["reference"], b["reference"])):
        for axis in ("x", "y"):
            # the middle row, which is the origin, moves with the alignment: 30 m/s, a row or two
            np.testing.assert_allclose(
                [f(one[axis]) for f in (min, max)], [f(other[axis]) for f in (min, max)], atol=6.0
            )


def test_lines_are_cut_at_the_date_line(tmp_path):
    """RFC 7946, 3.1.9: two lines, one ending at 180 degrees, the other beginning at -180."""
    _, solution = driven(SEAM)
    io.write(solution, tmp_path / "s.geojson")
    geometries = [f["geometry"] for f in json.loads((tmp_path / "s.geojson").read_text())["features"]]
    (cut,) = [g["coordinates"] for g in geometries if g["type"] == "MultiLineString"]
    assert (cut[0][-1][0], cut[1][0][0]) == (180.0, -180.0)
    assert cut[0][-1][1:] == cut[1][0][1:]
    assert min(cut[0][-2][1], cut[1][1][1]) <= cut[0][-1][1] <= max(cut[0][-2][1], cut[1][1][1])
    io.write(solution, tmp_path / "s.kml")
    lines = ElementTree.parse(tmp_path / "s.kml").iter("{http://www.opengis.net/kml/2.2}coordinates")
    drawn = [[float(point.split(",")[0]) for point in line.text.split()] for line in lines]
    drawn += [[point[0] for point in line] for line in cut]
    for line in drawn:
        assert len(line) > 1
        assert all(abs(b - a) < 1.0 for a, b in pairwise(line))
