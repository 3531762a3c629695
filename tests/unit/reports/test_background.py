import json

import numpy as np
import pymap3d
import pytest

from gapless.errors import ConfigError
from gapless.reports.background import placed, read_background

LAT, LON = 44.23, -76.49
LINE = [[LON, LAT], [LON + 0.01, LAT], [LON + 0.01, LAT + 0.01]]
SQUARE = [[LON, LAT], [LON + 0.001, LAT], [LON + 0.001, LAT + 0.001], [LON, LAT]]
TRACK = np.column_stack([np.radians([LAT, LAT + 0.02]), np.radians([LON, LON + 0.02]), [100.0, 100.0]])


def geojson(tmp_path, node):
    path = tmp_path / "ground.geojson"
    path.write_text(node if isinstance(node, str) else json.dumps(node), "utf-8")
    return path


def feature(kind, coordinates):
    return {"type": "Feature", "properties": {}, "geometry": {"type": kind, "coordinates": coordinates}}


def test_every_kind_of_line_and_area_is_read(tmp_path):
    parts = [
        feature("LineString", LINE),
        feature("MultiLineString", [LINE, LINE]),
        feature("Polygon", [SQUARE]),
        feature("MultiPolygon", [[SQUARE], [SQUARE, SQUARE]]),
        feature("Point", LINE[0]),
        {"type": "Feature", "properties": None, "geometry": None},
        {"type": "GeometryCollection", "geometries": [{"type": "LineString", "coordinates": LINE}]},
    ]
    found = read_background(geojson(tmp_path, {"type": "FeatureCollection", "features": parts}))
    assert [(one.area, len(one.rings)) for one in found] == [
        (False, 1),
        (False, 2),
        (True, 1),
        (True, 1),
        (True, 2),
        (False, 1),
    ]


def test_it_is_placed_in_metres_about_the_middle_of_the_track(tmp_path):
    found = placed(read_background(geojson(tmp_path, feature("LineString", LINE))), TRACK)
    xy = np.array(found[0]["rings"][0]).reshape(-1, 2)
    lon, lat = np.array(LINE).T
    middle = TRACK[1]
    east, north, _ = pymap3d.geodetic2enu(lat, lon, middle[2], *np.degrees(middle[:2]), middle[2])
    # Along the ellipsoid against the tangent plane: d_east d_north tan(lat) / R, 0.6 m at 2 km;
    # and 0.1 m of rounding.
    np.testing.assert_allclose(xy, np.column_stack([east, north]), rtol=1e-3, atol=0.8)


def test_what_is_far_away_is_left_out(tmp_path):
    far = [[lon + 3.0, lat] for lon, lat in LINE]
    parts = {
        "type": "FeatureCollection",
        "features": [feature("LineString", far), feature("Polygon", [SQUARE])],
    }
    found = placed(read_background(geojson(tmp_path, parts)), TRACK)
    assert [one["area"] for one in found] == [True]


@pytest.mark.parametrize(
    ("node", "words"),
    [
        ("{", "not GeoJSON"),
        ("[]", "not GeoJSON"),
        ({"type": "Road"}, "not GeoJSON"),
        (feature("LineString", [[5000.0, 2.0], [1.0, 2.0]]), "longitude comes first"),
        (feature("LineString", [[1.0], [2.0]]), "not GeoJSON"),
        (feature("Point", [1.0, 2.0]), "no lines and no polygons"),
    ],
)
def test_a_bad_file_is_refused_in_one_line(tmp_path, node, words):
    path = geojson(tmp_path, node)
    with pytest.raises(ConfigError, match=words) as caught:
        read_background(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_refused_in_one_line(tmp_path):
    with pytest.raises(ConfigError, match="No such file"):
        read_background(tmp_path / "nothing.geojson")
