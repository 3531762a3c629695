"""P' = Phi P Phi' + Q, without ever multiplying Phi as a dense matrix.

Beyond the nine navigation rows Phi is diagonal, so

    Phi = | F  G |      M = (F  G) P      P' = | M (F G)'   M_B E      |
          | 0  E |                             | E M_B'     E P_BB E   |

with M_B the columns of M beyond the ninth. `apply` makes M, `fold` does the blocks that need only
E and transposes M, `apply` again, on nine columns, gives the leading block. Each reads only what
can differ from zero, in loops over columns that a compiler turns into vectors.
"""

from __future__ import annotations

from typing import Any

from gapless._numba import inline
from gapless.inertial.increments import Three
from gapless.inertial.layout import NAV, ROW
from gapless.trip.recording import Array


@inline
def apply(phi: Array, columns: int, p: Array, out: Array) -> None:
    """Out = (F G) p, the fifteen core states' part.

    Parameters
    ----------
    phi : ndarray, shape (NAV * ROW,)
        From `transition`.
    columns : int
        How many columns of `p`.
    p, out : ndarray, shape (ROW * ROW,)
        Rows of fixed length, so that their distances are constants.
    """
    n, e, d = 0, ROW, 2 * ROW
    for j in range(columns):
        pn, pe, pd = p[j], p[j + ROW], p[j + 2 * ROW]
        vn, ve, vd = p[j + 3 * ROW], p[j + 4 * ROW], p[j + 5 * ROW]
        out[j + n] = phi[n] * pn + phi[n + 2] * pd + phi[n + 3] * vn
        out[j + e] = phi[e] * pn + phi[e + 1] * pe + phi[e + 2] * pd + phi[e + 4] * ve
        out[j + d] = pd + phi[d + 5] * vd
    n, e, d = 3 * ROW, 4 * ROW, 5 * ROW
    for j in range(columns):
        pn, pd = p[j], p[j + 2 * ROW]
        vn, ve, vd = p[j + 3 * ROW], p[j + 4 * ROW], p[j + 5 * ROW]
        an, ae, ad = p[j + 6 * ROW], p[j + 7 * ROW], p[j + 8 * ROW]
        x, y, z = p[j + 12 * ROW], p[j + 13 * ROW], p[j + 14 * ROW]
        out[j + n] = (
            (phi[n] * pn + phi[n + 2] * pd + phi[n + 3] * vn + phi[n + 4] * ve + phi[n + 5] * vd)
            + (phi[n + 7] * ae + phi[n + 8] * ad)
            + (phi[n + 12] * x + phi[n + 13] * y + phi[n + 14] * z)
        )
        out[j + e] = (
            (phi[e] * pn + phi[e + 2] * pd + phi[e + 3] * vn + phi[e + 4] * ve + phi[e + 5] * vd)
            + (phi[e + 6] * an + phi[e + 8] * ad)
            + (phi[e + 12] * x + phi[e + 13] * y + phi[e + 14] * z)
        )
        out[j + d] = (
            (phi[d] * pn + phi[d + 2] * pd + phi[d + 3] * vn + phi[d + 4] * ve + vd)
            + (phi[d + 6] * an + phi[d + 7] * ae)
            + (phi[d + 12] * x + phi[d + 13] * y + phi[d + 14] * z)
        )
    n, e, d = 6 * ROW, 7 * ROW, 8 * ROW
    for j in range(columns):
        pn, pd, vn, ve = p[j], p[j + 2 * ROW], p[j + 3 * ROW], p[j + 4 * ROW]
        an, ae, ad = p[j + 6 * ROW], p[j + 7 * ROW], p[j + 8 * ROW]
        x, y, z = p[j + 9 * ROW], p[j + 10 * ROW], p[j + 11 * ROW]
        out[j + n] = (
            (phi[n] * pn + phi[n + 2] * pd + phi[n + 4] * ve)
            + (an + phi[n + 7] * ae + phi[n + 8] * ad)
            + (phi[n + 9] * x + phi[n + 10] * y + phi[n + 11] * z)
        )
        out[j + e] = (
            (phi[e + 2] * pd + phi[e + 3] * vn)
            + (phi[e + 6] * an + ae + phi[e + 8] * ad)
            + (phi[e + 9] * x + phi[e + 10] * y + phi[e + 11] * z)
        )
        out[j + d] = (
            (phi[d] * pn + phi[d + 2] * pd + phi[d + 4] * ve)
            + (phi[d + 6] * an + phi[d + 7] * ae + ad)
            + (phi[d + 9] * x + phi[d + 10] * y + phi[d + 11] * z)
        )


@inline
def apply_extras(phi: Array, offsets: Any, columns: int, p: Array, out: Array) -> None:
    """Add the optional states' part of (F G) p to `out`.

    Parameters
    ----------
    phi : ndarray, shape (NAV * ROW,)
        From `transition`.
    offsets : ndarray of int, shape (7,)
        `Layout.offsets`: the first block drives the attitude, the next two the velocity.
    columns : int
        How many columns of `p`.
    p, out : ndarray, shape (ROW * ROW,)
    """
    for k in range(3):
        block, first = offsets[k], 6 if k == 0 else 3
        if block >= 0:
            source = block * ROW
            for i in range(first, first + 3):
                row = i * ROW
                a, b, c = phi[row + block], phi[row + block + 1], phi[row + block + 2]
                for j in range(columns):
                    x, y, z = p[source + j], p[source + ROW + j], p[source + 2 * ROW + j]
                    out[row + j] += a * x + b * y + c * z


@inline
def fold(tail: Array, width: int, m: Array, p: Array) -> None:
    """Every block of P' but the leading one, and M transposed.

    Parameters
    ----------
    tail : ndarray, shape (ROW,)
        Diagonal of E, after nine ones.
    width : int
        Columns in use.
    m : ndarray, shape (ROW * ROW,)
        Nine rows of M on entry; nine columns of its transpose on return.
    p : ndarray, shape (ROW * ROW,)
        P on entry.
    """
    for i in range(NAV):
        for j in range(width):
            p[i * ROW + j] = m[i * ROW + j] * tail[j]
    for i in range(NAV):
        for j in range(i):
            swap = m[i * ROW + j]
            m[i * ROW + j] = m[j * ROW + i]
            m[j * ROW + i] = swap
    for i in range(NAV, width):
        for j in range(width):
            p[i * ROW + j] *= tail[i] * tail[j]
        for j in range(NAV):
            m[i * ROW + j] = m[j * ROW + i]
            p[i * ROW + j] = tail[i] * m[i * ROW + j]


@inline
def apply_to_vector(phi: Array, tail: Array, error: Array, work: Array) -> None:
    """Error = Phi error, in place.

    Parameters
    ----------
    phi, tail : ndarray, shape (NAV * ROW,), (ROW,)
        From `transition`; here every entry counts, so those never written must be 0 and 1.
    error : ndarray, shape (n,)
    work : ndarray, shape (NAV or more,)
    """
    for i in range(NAV):
        work[i] = 0.0
        for j in range(error.size):
            work[i] += phi[i * ROW + j] * error[j]
    for i in range(error.size):
        error[i] = work[i] if i < NAV else tail[i] * error[i]


@inline
def add_noise(noise: Array, w: Three, dt: Any, p: Array) -> None:
    """Add Q over one interval; velocity noise reaches the position with its half-interval moment.

    Parameters
    ----------
    noise : ndarray, shape (5,)
        Spectral densities: gyro [rad^2/s], accelerometer [m^2/s^3], gyro bias [rad^2/s^3],
        accelerometer bias [m^2/s^5]; then the variance of a turn's proportional error [1].
    w : tuple of 3
        Body rate integrated over the interval [rad].
    dt : float
        [s]
    p : ndarray, shape (ROW * ROW,)
    """
    turn = (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]) / dt
    angle = noise[0] * dt + noise[4] * turn
    cross = 0.5 * noise[1] * dt * dt
    for i in range(3):
        p[i * ROW + 3 + i] += cross
        p[(3 + i) * ROW + i] += cross
        p[(3 + i) * ROW + 3 + i] += noise[1] * dt
        p[(6 + i) * ROW + 6 + i] += angle
        p[(9 + i) * ROW + 9 + i] += noise[2] * dt
        p[(12 + i) * ROW + 12 + i] += noise[3] * dt
