"""Which triangles of two bodies share a point."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._checks import as_array, as_count, as_number, as_pose, as_poses, check_size, contiguous
from ._errors import bad_input, checked_call, wrong_type
from ._model import Model

MAX_PAIRS = 500_000_000


def _as_model(value: object, name: str) -> _core.Body:
    if not isinstance(value, Model):
        raise wrong_type(
            name, f"is a {type(value).__name__}, not a crashrank.Model", "see load_model"
        )
    return value._body


@checked_call
def collide(a: Model, b: Model, pose: ArrayLike | None = None) -> NDArray[np.int32]:
    """Return every pair of triangles that share a point, exactly.

    Triangles are closed: touching, coplanar and degenerate ones count. A body that lies wholly
    inside another touches nothing. The interpreter's lock is released.

    Parameters
    ----------
    a, b : Model
        The bodies.
    pose : array_like, shape (4, 4), optional
        Row-major pose of B in A's frame, metres: ``x_a = R x_b + t``. Rigid within 1e-6. Copied.
        Default: both share one frame.

    Returns
    -------
    ndarray of int32, shape (n, 2)
        Rows of ``a.faces`` and ``b.faces``, sorted by the first, then the second.

    See Also
    --------
    pose_matrix : a pose from translation and angles.
    """
    first, second = _as_model(a, "a"), _as_model(b, "b")
    return _core.collide(first, second, as_pose(np.eye(4) if pose is None else pose))


@checked_call
def collide_any(a: Model, b: Model, poses: ArrayLike, *, workers: int = 1) -> NDArray[np.bool_]:
    """Return for each pose whether any two triangles share a point.

    The interpreter's lock is released. Ctrl-C raises KeyboardInterrupt.

    Parameters
    ----------
    a, b : Model
        The bodies.
    poses : array_like, shape (N, 4, 4)
        Row-major poses of B in A's frame, metres; rigid within 1e-6. Copied before the lock is
        released. At most 10 million.
    workers : int
        Threads that share the poses, 1 to 64. 1: the calling thread alone.

    Returns
    -------
    ndarray of bool, shape (N,)
    """
    first, second = _as_model(a, "a"), _as_model(b, "b")
    count = as_count(workers, "workers", 1, _core.max_workers)
    return _core.collide_any(first, second, as_poses(poses), count)


@checked_call
def collide_state(a: Model, b: Model, poses: ArrayLike, *, workers: int = 1) -> list[str]:
    """Return for each pose how the bodies stand to each other.

    ``"separate"``, ``"intersecting"``, ``"a_inside_b"``, ``"b_inside_a"``, or ``"unknown_open"``
    where a part of one lies within the bounds of one that is not closed. Exact. The surfaces of
    both bodies are found once for each call. The interpreter's lock is released. Ctrl-C raises
    KeyboardInterrupt.

    Parameters
    ----------
    a, b : Model
        The bodies.
    poses : array_like, shape (N, 4, 4)
        As in `collide_any`.
    workers : int
        As in `collide_any`.

    Returns
    -------
    list of str
    """
    first, second = _as_model(a, "a"), _as_model(b, "b")
    count = as_count(workers, "workers", 1, _core.max_workers)
    return _core.collide_state(first, second, as_poses(poses), count)


@checked_call
def collide_all(
    a: Model, b: Model, poses: ArrayLike, *, workers: int = 1
) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Return the pairs of many poses in one array.

    The interpreter's lock is released. Ctrl-C raises KeyboardInterrupt.

    Parameters
    ----------
    a, b : Model
        The bodies.
    poses : array_like, shape (N, 4, 4)
        As in `collide_any`.
    workers : int
        As in `collide_any`.

    Returns
    -------
    pairs : ndarray of int32, shape (n, 2)
        Pairs of all poses, one pose after the other, each sorted as `collide` does.
    offsets : ndarray of int64, shape (N + 1,)
        Pairs of pose i are ``pairs[offsets[i]:offsets[i + 1]]``.
    """
    first, second = _as_model(a, "a"), _as_model(b, "b")
    count = as_count(workers, "workers", 1, _core.max_workers)
    return _core.collide_all(first, second, as_poses(poses), count)


@checked_call
def pairs_hash(pairs: ArrayLike) -> str:
    """Return the fingerprint of an answer, as ``crashrank collide --json`` prints it.

    The first 16 hex digits of SHA-256 over the sorted pairs as little-endian int32. The same for
    every tree, number of workers and machine.

    Parameters
    ----------
    pairs : array_like of int, shape (n, 2)
        Pairs in any order; sorted here.
    """
    array = as_array(pairs, "pairs", "iu", "integers")
    if array.ndim != 2 or array.shape[1] != 2:
        raise bad_input("pairs", f"has the shape {array.shape}", "give the shape (n, 2)")
    check_size(array.shape[0], MAX_PAIRS, "pairs", "rows")
    if array.size and (int(array.min()) < -(2**31) or int(array.max()) >= 2**31):
        raise bad_input("pairs", "holds an index beyond int32", "give pairs of `collide`")
    return _core.pairs_hash(contiguous(array, np.int32, "pairs"))


@checked_call
def pose_matrix(
    x_m: float = 0.0,
    y_m: float = 0.0,
    z_m: float = 0.0,
    yaw_deg: float = 0.0,
    pitch_deg: float = 0.0,
    roll_deg: float = 0.0,
) -> NDArray[np.float64]:
    """Return the pose that turns by roll about x, pitch about y, yaw about z, then moves.

    Parameters
    ----------
    x_m, y_m, z_m : float
        Translation, m.
    yaw_deg, pitch_deg, roll_deg : float
        Angles, degrees, right-handed: positive yaw is to the left.

    Returns
    -------
    ndarray of float64, shape (4, 4)
        Row-major matrix. Its bits may differ between machines, as sine and cosine do.
    """
    radians = math.pi / 180.0
    return _core.pose_matrix(
        as_number(x_m, "x_m", "metres"),
        as_number(y_m, "y_m", "metres"),
        as_number(z_m, "z_m", "metres"),
        as_number(yaw_deg, "yaw_deg", "degrees") * radians,
        as_number(pitch_deg, "pitch_deg", "degrees") * radians,
        as_number(roll_deg, "roll_deg", "degrees") * radians,
    )
