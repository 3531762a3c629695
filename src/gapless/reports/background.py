"""A GeoJSON file beneath the track: roads, buildings, shores, whatever its user has."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from gapless.errors import ConfigError
from gapless.trip.motion import offset_ned
from gapless.trip.recording import Array
from gapless.units import DEG

_AROUND = 1.0
"""Features further from the track than this many of its own extents are left out."""
_POINTS = 60_000
"""Most points that a page holds of a background."""


class Feature(NamedTuple):
    """One line or area.

    Parameters
    ----------
    area : bool
        Filled, or a line.
    rings : tuple of ndarray, shape (n, 2)
        Longitude, latitude [deg].
    """

    area: bool
    rings: tuple[Array, ...]


def read_background(path: Path) -> list[Feature]:
    """Lines and polygons of a GeoJSON file (RFC 7946).

    Parameters
    ----------
    path : Path

    Returns
    -------
    list of Feature
        At least one.

    Raises
    ------
    ConfigError
        If the file is not there, is not GeoJSON, or holds neither lines nor polygons.
    """
    try:
        found = list(_features(json.loads(path.read_text(encoding="utf-8"))))
    except OSError as error:
        raise ConfigError(f"{path}: {error.strerror}; --background takes a GeoJSON file") from error
    except (ValueError, TypeError, LookupError, AttributeError, RecursionError) as error:
        raise ConfigError(
            f"{path}: not GeoJSON ({error}); --background takes lines and polygons as GeoJSON"
        ) from error
    if not found:
        raise ConfigError(f"{path}: holds no lines and no polygons; choose another --background")
    return found


def _features(node: Any) -> Iterator[Feature]:
    kind = node["type"]
    if kind == "FeatureCollection":
        for one in node["features"]:
            yield from _features(one)
    elif kind == "Feature":
        if node["geometry"] is not None:
            yield from _features(node["geometry"])
    elif kind == "GeometryCollection":
        for one in node["geometries"]:
            yield from _features(one)
    elif kind in ("Point", "MultiPoint"):
        return
    else:
        yield from _shape(kind, node["coordinates"])


def _shape(kind: str, coordinates: Any) -> Iterator[Feature]:
    if kind == "LineString":
        yield Feature(False, (_ring(coordinates),))
    elif kind == "MultiLineString":
        yield Feature(False, tuple(_ring(one) for one in coordinates))
    elif kind == "Polygon":
        yield Feature(True, tuple(_ring(one) for one in coordinates))
    elif kind == "MultiPolygon":
        for one in coordinates:
            yield Feature(True, tuple(_ring(ring) for ring in one))
    else:
        raise ValueError(f"unknown type {kind!r}")


def _ring(coordinates: Any) -> Array:
    ring = np.array([[float(point[0]), float(point[1])] for point in coordinates]).reshape(-1, 2)
    if not (np.isfinite(ring).all() and (np.abs(ring) <= [180.0, 90.0]).all()):
        raise ValueError("coordinates beyond 180 and 90 degrees; longitude comes first")
    return ring


def east_north(lla: Array, origin: Array) -> Array:
    """Metres east and north of an origin.

    Parameters
    ----------
    lla : ndarray, shape (n, 3)
        Latitude, longitude [rad], height [m].
    origin : ndarray, shape (3,)

    Returns
    -------
    ndarray, shape (n, 2)
    """
    return offset_ned(lla, np.broadcast_to(origin, lla.shape))[:, 1::-1]


def placed(features: Sequence[Feature], lla: Array, origin: Array | None = None) -> list[dict[str, Any]]:
    """Those features that are near a track, as its map draws them.

    Parameters
    ----------
    features : sequence of Feature
    lla : ndarray, shape (n, 3)
        The track: latitude, longitude [rad], height [m].
    origin : ndarray, shape (3,), optional
        Of the map; otherwise the middle row of the track.

    Returns
    -------
    list of dict
        `area`, and `rings`: x, y, x, y, ... [m] east and north.
    """
    if not features or not len(lla):
        return []
    origin = lla[len(lla) // 2] if origin is None else origin
    track = east_north(lla[np.isfinite(lla[:, :2]).all(axis=1)], origin)
    low, high = track.min(axis=0), track.max(axis=0)
    reach = _AROUND * max(float((high - low).max()), 200.0)
    found, left = [], _POINTS
    for feature in features:
        rings = [_metres(ring, origin) for ring in feature.rings if len(ring) > 1]
        if not rings:
            continue
        points = np.concatenate(rings)
        left -= len(points)
        if (points.max(axis=0) < low - reach).any() or (points.min(axis=0) > high + reach).any():
            left += len(points)
        elif left >= 0:
            found.append({"area": feature.area, "rings": [np.round(r, 1).ravel().tolist() for r in rings]})
    return found


def _metres(ring: Array, origin: Array) -> Array:
    lla = np.column_stack([ring[:, ::-1] * DEG, np.full(len(ring), origin[2])])
    return east_north(lla, origin)
