"""Rods in Python: scenes, methods, tensions, and rods in place of stiff springs."""

import numpy as np
import pytest

import qddot


def pendulum(**changes):
    given = dict(
        positions=[[0.0, 0.0], [0.7, 0.0]],
        springs=[[0, 1]],
        stiffness=0.0,
        rigid=True,
        mass=2.0,
        pinned=[0],
        gravity=[0.0, -9.81],
        until=1.0,
    )
    return qddot.Scene(**{**given, **changes})


def test_a_pendulum_keeps_its_length_and_has_a_tension():
    times = np.linspace(0, 1, 11)
    solution = qddot.solve(pendulum(), "rattle8", step_size=0.01, save_at=times).or_raise()
    x = solution.q[:, 1]
    assert np.abs(np.linalg.norm(x, axis=1) - 0.7).max() < 1e-15
    # m g cos(theta) + m |v|^2/L, with |v|^2 = 2 g L cos(theta) from the horizontal.
    expected = 3 * 2 * 9.81 * -x[:, 1] / 0.7
    assert solution.tensions.shape == (11, 1)
    assert np.abs(solution.tensions[:, 0] - expected).max() < 1e-9  # energy to 1e-11
    end = qddot.solve(pendulum(), "rattle8", step_size=0.01)
    assert np.array_equal(end.tensions[0], solution.tensions[-1])


def test_methods_without_rods_are_refused_by_name():
    with pytest.raises(ValueError, match="take rattle"):
        qddot.solve(pendulum(), "verlet", step_size=0.01)
    with pytest.raises(ValueError, match="no rods"):
        qddot.solve(qddot.Scene.load("pendulum"), "rattle", step_size=0.001)


def test_scenes_have_rods():
    scene = pendulum()
    assert scene.rigid.tolist() == [True]
    again = qddot.Scene.from_toml(scene.to_toml())
    assert again.rigid.tolist() == [True] and again.rest_length.tolist() == [0.7]
    assert scene.replace(rigid=False, stiffness=50.0).rigid.tolist() == [False]
    above = pendulum(rigid=None, stiffness=1e7, rods_above=1e6)
    assert above.rigid.tolist() == [True]
    with pytest.raises(qddot.InvalidInput, match="the rod between nodes 0 and 1 is 0.6"):
        pendulum(rest_length=0.6)


def test_an_answer_on_rods_has_an_error_bar():
    answer = qddot.solve(pendulum(), accuracy=1e-8).or_raise()
    exact = qddot.solve(pendulum(), "rattle8", step_size=0.0005)
    scale = np.linalg.norm(exact.end.q[1] - [0.7, 0])
    assert np.linalg.norm(answer.end.q[1] - exact.end.q[1]) / scale <= answer.error_estimate
    assert answer.left_out == ""


def test_stiff_springs_are_rods_where_an_accuracy_lets_them():
    scene = qddot.Scene.from_toml('[generator]\nkind = "hemmed_cloth"\nnodes = 8\nuntil = 0.1\n')
    answer = qddot.solve(scene, accuracy=1e-2, save_at=[0.05, 0.1]).or_raise()
    assert answer.left_out.startswith("left out: 21 stiff springs are rods here")
    assert np.isfinite(answer.tensions).any() and answer.tensions.shape[0] == 2
    springs = qddot.solve(scene, accuracy=1e-5, keep=["rods"]).or_raise()
    assert springs.left_out == "" and springs.tensions is None
    scale = np.linalg.norm(springs.end.q - scene.positions, axis=1).max()
    apart = np.linalg.norm(answer.end.q - springs.end.q, axis=1).max() / scale
    assert apart <= answer.error_estimate <= 1e-2
    # So small an accuracy shows the stretch of the hem.
    assert qddot.solve(scene, accuracy=1e-6).or_raise().left_out == ""
