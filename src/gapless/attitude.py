"""Attitude: quaternions, direction cosine matrices, Euler angles, rotation vectors.

`q_nb` is (w, x, y, z) and turns body vectors into the navigation frame; `C_nb` is its matrix;
Euler angles are roll, pitch, heading of the ZYX sequence, in radians. Functions whose arguments
are tuples take scalars or arrays per component, and kernels inline them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gapless._numba import inline, kernel

Array = NDArray[np.float64]
Four = tuple[Any, Any, Any, Any]


@inline
def product(p: Four, q: Four) -> Four:
    """Hamilton product p * q.

    Parameters
    ----------
    p, q : tuple of 4
        Quaternions (w, x, y, z).

    Returns
    -------
    tuple of 4
    """
    return (
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    )


@inline
def small_rotation(x: Any, y: Any, z: Any) -> Four:
    """Quaternion of a rotation vector of less than about 0.5 rad, by its series to sixth order.

    Parameters
    ----------
    x, y, z : float or ndarray
        Rotation vector [rad]; at 0.3 rad the truncation error is below 1e-12.

    Returns
    -------
    tuple of 4
    """
    s = 0.25 * (x * x + y * y + z * z)
    k = 0.5 * (1.0 - s * (1.0 / 6.0 - s * (1.0 / 120.0 - s * (1.0 / 5040.0))))
    return 1.0 - s * (0.5 - s * (1.0 / 24.0 - s * (1.0 / 720.0))), k * x, k * y, k * z


@inline
def matrix_rows(q: Four) -> tuple[Any, Any, Any, Any, Any, Any, Any, Any, Any]:
    """Elements of the direction cosine matrix of a unit quaternion, row by row.

    Parameters
    ----------
    q : tuple of 4
        Unit quaternion (w, x, y, z).

    Returns
    -------
    tuple of 9
    """
    w, x, y, z = q
    return (
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y - w * z),
        2.0 * (x * z + w * y),
        2.0 * (x * y + w * z),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z - w * x),
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        1.0 - 2.0 * (x * x + y * y),
    )


def _split(q: ArrayLike) -> Four:
    q = np.asarray(q, float)
    return q[..., 0], q[..., 1], q[..., 2], q[..., 3]


def multiply(p: ArrayLike, q: ArrayLike) -> Array:
    """Hamilton product of quaternion arrays.

    Parameters
    ----------
    p, q : array_like, shape (..., 4)

    Returns
    -------
    ndarray, shape (..., 4)
    """
    return np.stack(product(_split(p), _split(q)), axis=-1)


def to_matrix(q: ArrayLike) -> Array:
    """Direction cosine matrices of unit quaternions.

    Parameters
    ----------
    q : array_like, shape (..., 4)

    Returns
    -------
    ndarray, shape (..., 3, 3)
    """
    rows = np.stack(matrix_rows(_split(q)), axis=-1)
    return rows.reshape(*rows.shape[:-1], 3, 3)


@kernel
def matrix(q: Array) -> Array:
    """Direction cosine matrix of one unit quaternion.

    Parameters
    ----------
    q : ndarray, shape (4,)

    Returns
    -------
    ndarray, shape (3, 3)
    """
    c = np.empty((3, 3))
    (c[0, 0], c[0, 1], c[0, 2], c[1, 0], c[1, 1], c[1, 2], c[2, 0], c[2, 1], c[2, 2]) = matrix_rows(
        (q[0], q[1], q[2], q[3])
    )
    return c


def from_rotation_vector(r: ArrayLike) -> Array:
    """Quaternion of a rotation vector of any length.

    Parameters
    ----------
    r : array_like, shape (..., 3)
        Rotation vector [rad].

    Returns
    -------
    ndarray, shape (..., 4)
    """
    r = np.asarray(r, float)
    half = 0.5 * np.linalg.norm(r, axis=-1, keepdims=True)
    return np.concatenate([np.cos(half), 0.5 * np.sinc(half / np.pi) * r], axis=-1)


def from_euler(euler: ArrayLike) -> Array:
    """Quaternion q_nb of roll, pitch, heading.

    Parameters
    ----------
    euler : array_like, shape (..., 3)
        Roll, pitch, heading [rad].

    Returns
    -------
    ndarray, shape (..., 4)
    """
    half = 0.5 * np.asarray(euler, float)
    zero = np.zeros_like(half[..., 0])
    c, s = np.cos(half), np.sin(half)
    roll = (c[..., 0], s[..., 0], zero, zero)
    pitch = (c[..., 1], zero, s[..., 1], zero)
    heading = (c[..., 2], zero, zero, s[..., 2])
    return np.stack(product(product(heading, pitch), roll), axis=-1)


def to_euler(q: ArrayLike) -> Array:
    """Roll, pitch, heading of q_nb; heading in (-pi, pi].

    Parameters
    ----------
    q : array_like, shape (..., 4)

    Returns
    -------
    ndarray, shape (..., 3)
        [rad]; Groves (2013), eq. 2.23.
    """
    return matrix_to_euler(to_matrix(q))


def matrix_to_euler(c_nb: ArrayLike) -> Array:
    """Roll, pitch, heading of C_nb.

    Parameters
    ----------
    c_nb : array_like, shape (..., 3, 3)

    Returns
    -------
    ndarray, shape (..., 3)
        [rad].
    """
    c = np.asarray(c_nb, float)
    roll = np.arctan2(c[..., 2, 1], c[..., 2, 2])
    pitch = np.arcsin(np.clip(-c[..., 2, 0], -1.0, 1.0))
    return np.stack([roll, pitch, np.arctan2(c[..., 1, 0], c[..., 0, 0])], axis=-1)


def from_matrix(c_nb: ArrayLike) -> Array:
    """Quaternion of one direction cosine matrix, w >= 0 (Bar-Itzhack 2000: also for noisy ones).

    Parameters
    ----------
    c_nb : array_like, shape (3, 3)

    Returns
    -------
    ndarray, shape (4,)
    """
    c = np.asarray(c_nb, float)
    k = np.array(
        [
            [c[0, 0] + c[1, 1] + c[2, 2], c[2, 1] - c[1, 2], c[0, 2] - c[2, 0], c[1, 0] - c[0, 1]],
            [c[2, 1] - c[1, 2], c[0, 0] - c[1, 1] - c[2, 2], c[0, 1] + c[1, 0], c[0, 2] + c[2, 0]],
            [c[0, 2] - c[2, 0], c[0, 1] + c[1, 0], c[1, 1] - c[0, 0] - c[2, 2], c[1, 2] + c[2, 1]],
            [c[1, 0] - c[0, 1], c[0, 2] + c[2, 0], c[1, 2] + c[2, 1], c[2, 2] - c[0, 0] - c[1, 1]],
        ]
    )
    q: Array = np.linalg.eigh(k)[1][:, -1]
    return q if q[0] >= 0.0 else -q


def skew(v: ArrayLike) -> Array:
    """Cross-product matrix [v x].

    Parameters
    ----------
    v : array_like, shape (..., 3)

    Returns
    -------
    ndarray, shape (..., 3, 3)
    """
    v = np.asarray(v, float)
    m = np.zeros((*v.shape, 3))
    m[..., 0, 1], m[..., 0, 2], m[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    m[..., 1, 0], m[..., 2, 0], m[..., 2, 1] = v[..., 2], -v[..., 1], v[..., 0]
    return m


def wrap(angle: Any) -> Any:
    """Angle in [-pi, pi).

    Parameters
    ----------
    angle : float or ndarray
        [rad]

    Returns
    -------
    float or ndarray
    """
    return (np.asarray(angle) + np.pi) % (2.0 * np.pi) - np.pi
