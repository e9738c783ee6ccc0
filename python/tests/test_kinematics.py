"""Kinematics, many points at once."""

import threading
import time
from pathlib import Path

import numpy as np
import post
import pytest

CHECKOUT = Path(__file__).parents[2]
NAMES = sorted(path.stem for path in (CHECKOUT / "machines").glob("*.toml"))


def loaded(name: str) -> post.Machine:
    return post.Machine.load(name, tool_length=120)


def values(machine: post.Machine, count: int, seed: int = 1) -> np.ndarray:
    """Axis values inside travel."""
    numbers = np.random.default_rng(seed)
    columns = []
    for axis in machine.axes:
        least, most = axis.travel or (-180.0, 180.0)
        if axis.rotary:
            least, most = max(least, -170.0), min(most, 170.0)
        columns.append(numbers.uniform(least, most, count))
    return np.column_stack(columns)


def turned(difference: np.ndarray, machine: post.Machine) -> np.ndarray:
    """Angles on their nearest turn."""
    rotary = np.array([axis.rotary for axis in machine.axes])
    return np.where(rotary, (difference + 180.0) % 360.0 - 180.0, difference)


def test_slides_take_the_tip_along() -> None:
    """By hand: of three slides the tip goes along with them, and the tool stays upright."""
    machine = post.Machine.load("vmc", tool_length=50)
    assert [axis.name for axis in machine.axes if axis.rotary] == []
    q = values(machine, 10)
    tip, axis = machine.forward(q)
    order = [[axis.name for axis in machine.axes].index(name) for name in "XYZ"]
    np.testing.assert_allclose(tip - tip[0], (q - q[0])[:, order], atol=1e-9)
    np.testing.assert_array_equal(axis, np.tile([0.0, 0.0, 1.0], (10, 1)))


@pytest.mark.parametrize("name", NAMES)
def test_inverse_comes_back_to_the_tip(name: str) -> None:
    machine = loaded(name)
    q = values(machine, 200)
    tip, axis = machine.forward(q)
    edge = np.tile([1.0, 0.0, 0.0], (200, 1)) if machine._native.has_edge else None
    solutions, count = machine.inverse(tip, axis, edge=edge)
    assert solutions.shape == (200, solutions.shape[1], len(machine.axes))
    assert count.dtype == np.int64
    reached = 0
    for point, found in enumerate(count):
        assert np.isnan(solutions[point, found:]).all()
        own = solutions[point, :found]
        assert np.isfinite(own).all()
        if found:
            reached += 1
            again, pointed = machine.forward(own)
            np.testing.assert_allclose(again, np.tile(tip[point], (found, 1)), atol=1e-5)
    assert reached > 0


@pytest.mark.parametrize("name", ["ac-trunnion", "bc-fork", "nutating-head", "head-table-bc"])
def test_the_axis_values_are_among_the_solutions(name: str) -> None:
    machine = loaded(name)
    q = values(machine, 500)
    tip, axis = machine.forward(q)
    solutions, count = machine.inverse(tip, axis)
    assert (count == 2).all()
    off = np.abs(turned(solutions - q[:, None, :], machine)).max(axis=2).min(axis=1)
    assert off.max() < 1e-6
    near, count = machine.inverse(tip, axis, near=q[0], within_travel=True)
    assert (count >= 1).all()
    for column, one in enumerate(machine.axes):
        if one.travel is not None:
            found = near[..., column][np.isfinite(near[..., column])]
            assert found.min() >= one.travel[0] - 1e-6
            assert found.max() <= one.travel[1] + 1e-6


def test_a_point_out_of_reach_has_no_solution() -> None:
    machine = loaded("vmc")
    tip, axis = machine.forward(values(machine, 1))
    solutions, count = machine.inverse([tip[0], tip[0]], [axis[0], [0.0, 0.0, -1.0]])
    assert count[0] > 0
    assert count[1] == 0 and np.isnan(solutions[1]).all()


def test_deviation_is_that_of_the_axes_in_between() -> None:
    machine = loaded("ac-trunnion")
    q = values(machine, 40)
    shares = np.array([0.0, 0.3, 0.5, 1.0])
    tip, axis = machine.deviation(q[:-1], q[1:], shares)
    assert tip.shape == (39, 4, 3) and axis.shape == (39, 4)
    ends, axes = machine.forward(q)
    for place, share in enumerate(shares):
        middle, pointed = machine.forward(q[:-1] + share * (q[1:] - q[:-1]))
        straight = ends[:-1] + share * (ends[1:] - ends[:-1])
        np.testing.assert_allclose(tip[:, place], middle - straight, atol=1e-9)
        angle = np.arccos(np.clip((axes[:-1] * axes[1:]).sum(axis=1), -1, 1))
        circle = (
            np.sin((1 - share) * angle)[:, None] * axes[:-1] + np.sin(share * angle)[:, None] * axes[1:]
        ) / np.sin(angle)[:, None]
        off = np.degrees(2 * np.arcsin(np.linalg.norm(circle - pointed, axis=1) / 2))
        np.testing.assert_allclose(axis[:, place], off, atol=1e-5)
    assert np.abs(tip[:, [0, 3]]).max() < 1e-9 and np.abs(tip[:, 2]).max() > 1.0


def test_a_route_is_one_solution_in_one_piece() -> None:
    machine = loaded("ac-trunnion")
    along = np.linspace(0.0, 1.0, 200)
    tip = np.column_stack([60 * along, 10 * along, 0 * along])
    lean = np.radians(30) * np.sin(3 * along) + 0.1
    axis = np.column_stack([np.sin(lean), 0 * along, np.cos(lean)])
    q = machine.route(tip, axis, along > 0)
    again, pointed = machine.forward(q)
    np.testing.assert_allclose(again, tip, atol=1e-9)
    np.testing.assert_allclose(pointed, axis, atol=1e-12)
    assert np.abs(np.diff(q, axis=0)).max() < 5.0
    solutions, _ = machine.inverse(tip, axis)
    off = np.abs(turned(solutions - q[:, None, :], machine)).max(axis=2).min(axis=1)
    assert off.max() < 1e-6


def test_a_route_out_of_travel_is_refused() -> None:
    machine = loaded("ac-trunnion")
    with pytest.raises(post.PostError) as refused:
        machine.route([[0, 0, 0], [5000, 0, 0]], [0, 0, 1])
    codes = {why.code for why in refused.value.diagnostics}
    assert codes == {"over-travel"}
    assert refused.value.diagnostics[0].message.startswith("point 1: ")


def test_shapes_and_numbers_are_checked() -> None:
    machine = loaded("ac-trunnion")
    with pytest.raises(ValueError, match=r"q has the shape \(4,\), not \(n, 5\)"):
        machine.forward(np.zeros(4))
    with pytest.raises(ValueError, match="axis has the shape"):
        machine.inverse(np.zeros((3, 3)), np.ones((2, 3)))
    with pytest.raises(post.PostError, match="is no direction"):
        machine.inverse([0, 0, 0], [0, 0, 0])
    with pytest.raises(post.PostError, match="not finite"):
        machine.inverse([0, np.nan, 0], [0, 0, 1])
    # No points are no fault.
    tip, axis = machine.forward(np.zeros((0, 5)))
    assert tip.shape == axis.shape == (0, 3)
    solutions, count = machine.inverse(tip, axis)
    assert solutions.shape == (0, 1, 5) and count.shape == (0,)
    assert machine.route(tip, axis).shape == (0, 5)
    # Any layout and any kind of number.
    q = np.asfortranarray(values(machine, 7))
    np.testing.assert_array_equal(machine.forward(q)[0], machine.forward(q.tolist())[0])


def test_settings_are_those_of_the_command() -> None:
    plain = post.Machine.load("ac-trunnion", tool_length=120)
    moved = post.Machine.load("ac-trunnion", tool_length=120, mount=(0, 0, 25))
    longer = post.Machine.load("ac-trunnion", tool_length=130)
    assert moved.forward(np.zeros(5))[0][0, 2] == pytest.approx(plain.forward(np.zeros(5))[0][0, 2] - 25)
    assert longer.forward(np.zeros(5))[0][0, 2] == pytest.approx(plain.forward(np.zeros(5))[0][0, 2] - 10)
    with pytest.raises(post.PostError) as refused:
        post.Machine.load("ac-trunnion", set={"accuracy.tolerence": 1})
    (why,) = refused.value.diagnostics
    assert why.severity == "error" and why.help is not None and "did you mean `tolerance`" in why.help
    with pytest.raises(post.PostError, match="there is no machine ac-trunion"):
        post.Machine.load("ac-trunion")


def test_other_threads_run_meanwhile() -> None:
    machine = loaded("ac-trunnion")
    tip, axis = machine.forward(np.tile(values(machine, 1000), (300, 1)))
    counted, over = [], threading.Event()

    def count() -> None:
        while not over.is_set():
            counted.append(time.perf_counter())
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    began = time.perf_counter()
    machine.inverse(tip, axis)
    ended = time.perf_counter()
    over.set()
    counter.join()
    inside = [at for at in counted if began < at < ended]
    # It waits a thousandth of a second each time: with the lock held it would not have been heard of.
    assert len(inside) > 20 * (ended - began)
