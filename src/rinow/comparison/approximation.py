"""ε-isometries and (ε, δ)-approximations between finite metric spaces.

Both questions are answered in one way: a good correspondence of the spaces says yes, a lower bound of their distance
no, and what is left goes to a clause-learning solver, which may run out of time.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow._arrays import as_number
from rinow._printing import OneLine
from rinow.comparison import bounds, large, steps
from rinow.comparison.clock import Clock
from rinow.comparison.engine import MAP, RELATION, Engine, worst_of
from rinow.comparison.gromov_hausdorff import first_interval
from rinow.comparison.satisfiability import Satisfiability, solver_installed
from rinow.errors import InvalidInputError
from rinow.metric_space import MetricSpace, both_distances

__all__ = ["Approximation", "EpsilonIsometry", "MetricSpace", "find_approximation", "find_epsilon_isometry"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class EpsilonIsometry(OneLine):
    """Whether an ε-isometry exists, and one.

    Attributes
    ----------
    found : bool or None
        Whether there is one; None when the time was over before either was proved.
    map : (n,) ndarray of int
        Image in Y of each point of X; empty unless `found` is true.
    proof_checked : bool or None
        Whether the proof of a "no" by a clause-learning solver was checked; None where no solver gave it.
    """

    found: bool | None
    map: Indices
    proof_checked: bool | None = None


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Approximation(OneLine):
    """Whether two spaces are (ε, δ)-approximations of each other, and the nets that show it.

    Attributes
    ----------
    found : bool or None
        Whether there is one; None when the time was over before either was proved.
    pairs : (k, 2) ndarray of int
        Points of the two nets that correspond; empty unless `found` is true.
    proof_checked : bool or None
        Whether the proof of a "no" by a clause-learning solver was checked; None where no solver gave it.
    """

    found: bool | None
    pairs: Indices
    proof_checked: bool | None = None


def find_epsilon_isometry(
    X: Any, Y: Any, epsilon: float, *, time_limit: float = 60.0, verify: bool = False
) -> EpsilonIsometry:
    r"""Find a map that changes no distance by more than ε and comes within ε of every point.

    Parameters
    ----------
    X, Y : MetricSpace or square array_like of float
        Two finite metric spaces of n and m points.
    epsilon : float
        At least 0, in the unit of the distances; with 0 the map is an isometry.
    time_limit : float, default 60
        Seconds after which the question is left undecided.
    verify : bool, default False
        Check the proof of a "no", as in `gromov_hausdorff`; a wrong one leaves the question undecided.

    Returns
    -------
    result : EpsilonIsometry
        The answer, and a map if it is yes.

    Raises
    ------
    InvalidInputError
        If an argument is not a space or is empty, `epsilon` or the limit is negative or nan.
    NotAMetricError
        If a matrix is not a metric.

    See Also
    --------
    distortion : Recomputes the distortion of the map.
    find_approximation, gromov_hausdorff

    Notes
    -----
    A map f with :math:`\mathrm{dis} f \le \varepsilon` whose image is an ε-net.  Such a map gives
    :math:`d_{GH} \le 3\varepsilon/2`, and :math:`d_{GH} < \varepsilon/2` gives such a map (Corollary 2.37 of the paper;
    its proof prints dil for dis).  The relation is not symmetric in X and Y.

    Examples
    --------
    A unit segment and the same with its middle point: the middle is missed by 1/2.

    >>> X, Y = [[0, 1], [1, 0]], [[0, 0.5, 1], [0.5, 0, 0.5], [1, 0.5, 0]]
    >>> find_epsilon_isometry(X, Y, 0.5).map, find_epsilon_isometry(X, Y, 0.4).found
    (array([0, 2]), False)
    """
    clock = Clock.of(time_limit)
    _check_scale(epsilon, "epsilon")
    DX, DY = both_distances(X, Y)
    found, pairs = _by_relation(DX, DY, clock, wanted=epsilon, hopeless=3.0 * epsilon)
    checked = None
    if found is None:
        engine, near = Engine(DX, DY, MAP, both=False, clock=clock), (np.eye(len(DX), dtype=bool), DY <= epsilon)
        found, pairs, checked = _decide(engine, epsilon, clock, near, verify=verify)
    f = np.empty(len(DX) if found else 0, np.intp)
    if found:
        f[pairs[:, 0]] = pairs[:, 1]
    return EpsilonIsometry(found, f, checked)


def find_approximation(
    X: Any, Y: Any, epsilon: float, delta: float, *, time_limit: float = 60.0, verify: bool = False
) -> Approximation:
    r"""Find nets of two spaces that correspond to each other: whether they are (ε, δ)-approximations.

    Parameters
    ----------
    X, Y : MetricSpace or square array_like of float
        Two finite metric spaces.
    epsilon : float
        Largest distance of a point from the net of its space, at least 0.
    delta : float
        Above 0; distances of corresponding points differ by less than this.
    time_limit : float, default 60
        Seconds after which the question is left undecided.
    verify : bool, default False
        As in `find_epsilon_isometry`.

    Returns
    -------
    result : Approximation
        The answer, and the points of the nets if it is yes.

    Raises
    ------
    InvalidInputError
        If an argument is not a space or is empty, `epsilon` is negative, `delta` not positive, or the limit negative.
    NotAMetricError
        If a matrix is not a metric.

    See Also
    --------
    distortion : Recomputes how well the nets agree.
    find_epsilon_isometry, gromov_hausdorff

    Notes
    -----
    Points :math:`x_i` and :math:`y_i`, i = 1 … N, form ε-nets of X and of Y with
    :math:`|d(x_i, x_j) - d(y_i, y_j)| < \delta` (Definition 2.41 of the paper); points may be repeated.  Then
    :math:`d_{GH} \le 2\varepsilon + \delta/2`, and :math:`d_{GH} < \varepsilon` makes them
    :math:`(5\varepsilon, 5\varepsilon)`-approximations (Proposition 2.42).

    Examples
    --------
    Eleven points of a unit segment are approximated by three of them:

    >>> line = np.abs(np.subtract.outer(np.linspace(0, 1, 11), np.linspace(0, 1, 11)))
    >>> ends = line[::5, ::5]
    >>> find_approximation(line, ends, 0.25, 0.01).found, find_approximation(line, ends, 0.1, 0.01).found
    (True, False)
    """
    clock = Clock.of(time_limit)
    _check_scale(epsilon, "epsilon")
    if not as_number(delta, "delta") > 0.0:
        raise InvalidInputError(f"delta = {delta} is not a positive length; distances must differ by less than it.")
    DX, DY = both_distances(X, Y)
    level = float(np.nextafter(delta, 0.0))
    net_x, net_y = _net(DX, epsilon), _net(DY, epsilon)
    NX, NY = DX[np.ix_(net_x, net_x)], DY[np.ix_(net_y, net_y)]
    found, pairs = _by_relation(NX, NY, clock.part(0.3 * clock.left), wanted=level, hopeless=level)
    if found:
        return Approximation(True, np.stack([net_x[pairs[:, 0]], net_y[pairs[:, 1]]], axis=1))
    found, pairs = _by_relation(DX, DY, clock, wanted=level, hopeless=4.0 * epsilon + delta)
    checked = None
    if found is None:
        engine, near = Engine(DX, DY, RELATION, both=False, clock=clock), (DX <= epsilon, DY <= epsilon)
        found, pairs, checked = _decide(engine, level, clock, near, verify=verify)
    return Approximation(found, pairs if found else np.empty((0, 2), np.intp), checked)


def _check_scale(value: float, name: str) -> None:
    if not as_number(value, name) >= 0.0:
        raise InvalidInputError(f"{name} = {value} is not a length; give a number >= 0.")


def _by_relation(
    DX: Floats, DY: Floats, clock: Clock, *, wanted: float, hopeless: float
) -> tuple[bool | None, Indices]:
    """What the distance decides, and the best relation: true if that is within the level, false if none is by far."""
    interval = first_interval(DX, DY, 0.0)
    if interval.upper > wanted and interval.lower <= hopeless and not clock.over:
        interval.raise_lower(bounds.packing_bound(DX, DY), "packing")
        if len(DX) * len(DY) * (len(DX) + len(DY)) >= large.LARGE:
            large.approach(DX, DY, interval, clock.part(0.5 * clock.left))
        else:
            engine = Engine(DX, DY, clock=clock)
            interval.raise_lower(engine.row_bound, "sorted distances")
            if interval.lower <= hopeless:
                steps.warm_start(engine, interval, clock.part(0.2 * clock.left), target=wanted)
    found = True if interval.upper <= wanted else False if interval.lower > hopeless else None
    return found, interval.pairs


def _net(D: Floats, epsilon: float) -> Indices:
    """Farthest points in turn until every point is within ε of one."""
    nearest, chosen = D[0].copy(), [0]
    while nearest.max() > epsilon:
        chosen.append(int(nearest.argmax()))
        np.minimum(nearest, D[chosen[-1]], out=nearest)
    return np.array(chosen, np.intp)


def _decide(
    engine: Engine, level: float, clock: Clock, near: tuple[Flags, Flags], *, verify: bool
) -> tuple[bool | None, Indices, bool | None]:
    """Whether pairs within the level exist that come near all points of both spaces, such pairs, `proof_checked`."""
    none = np.empty((0, 2), np.intp)
    possible = np.ones(engine.shape, np.bool_)
    if engine.kind == MAP:  # every point has an image, so arc consistency over the points of X is right
        left = engine.consistent(level, clock)
        if left is None:
            return False, none, None
        possible = left
    if not solver_installed() or clock.over:
        return None, none, None
    with Satisfiability(engine, possible, level, clock, near=near, verify=verify) as solver:
        refuted, pairs = solver.run(clock)
        right = solver.proof_is_right(clock) if refuted else None
    if pairs is not None and worst_of(engine.kind, engine.DX, engine.DY, pairs) <= level:
        return True, pairs, None
    if not refuted or right is False:
        return None, none, None
    return False, none, right is True
