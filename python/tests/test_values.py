"""Calibrations, settings, errors, rendered worlds, and that the stubs tell the truth."""

import ast
import inspect
import pathlib

import numpy as np
import pytest

import ldso


def test_errors_have_parts(tmp_path):
    camera = tmp_path / "camera.txt"
    camera.write_text("RadTan 500 500 320 240 0 0 0 zero\n640 480\ncrop\n640 480\n")
    with pytest.raises(ldso.Error) as wrong:
        ldso.Calibration.read(camera)
    error = wrong.value
    assert isinstance(error, RuntimeError)
    assert error.file == str(camera) and error.line == 1
    assert error.remedy and error.problem and error.remedy in str(error)
    # A text with several semicolons: of the lens that a calibration of another program has.
    lens = tmp_path / "camchain.yaml"
    lens.write_text("cam0:\n  camera_model: pinhole\n  distortion_model: brown9\n  distortion_coeffs: [0, 0, 0, 0]\n"
                    "  intrinsics: [500, 500, 320, 240]\n  resolution: [640, 480]\n")
    with pytest.raises(ldso.Error) as unknown:
        ldso.Calibration.read(lens)
    error = unknown.value
    assert str(error) == f"{error.context}: {error.problem}; {error.remedy}"
    assert "; " in error.remedy and error.remedy.startswith("radtan"), error.remedy
    with pytest.raises(ldso.Error) as missing:
        ldso.open(tmp_path / "nothing")
    assert missing.value.file == str(tmp_path / "nothing") and missing.value.line is None


def test_calibrations_are_made_read_and_written(sequence, tmp_path):
    read = ldso.Calibration.read(pathlib.Path(sequence) / "camera.txt")
    assert read.model == "radtan" and read.inverse_response.shape == (256,)
    assert read.vignette.shape == (read.height, read.width)
    made = ldso.Calibration(read.width, read.height, read.fx, read.fy, read.cx, read.cy, model="radtan",
                            distortion=read.distortion)
    made.write(tmp_path / "camera.txt")
    again = ldso.Calibration.read(tmp_path / "camera.txt")
    assert again.distortion == read.distortion and again.fx == read.fx and again.inverse_response is None
    again.inverse_response = np.arange(256)
    again.vignette = np.ones((again.height, again.width))
    assert again.inverse_response[255] == 255 and again.vignette.dtype == np.float32
    with pytest.raises(ldso.Error, match="no such camera model"):
        ldso.Calibration(640, 480, 500, 500, 320, 240, model="wide")
    with pytest.raises(ldso.Error):
        ldso.Slam(ldso.Calibration(640, 480, -500, 500, 320, 240))


def test_settings(tmp_path):
    settings = ldso.Settings(threads=1, loops={"enabled": False})
    assert settings.threads == 1 and settings["loops.enabled"] is False
    settings.window.iterations = 8
    settings["selection.strategy"] = "gradient"
    assert settings["window"]["iterations"] == 8 and settings.selection.strategy == "gradient"
    settings.write(tmp_path / "settings.yaml")
    assert ldso.Settings.read(tmp_path / "settings.yaml").to_dict() == settings.to_dict()
    copy = settings.copy()
    copy.threads = 2
    assert settings.threads == 1 and "iterations" in dir(settings.window)
    assert not hasattr(settings, "no_such_setting")
    with pytest.raises(ldso.Error, match="did you mean 'window.iterations'"):
        settings["window.iteration"] = 3
    with pytest.raises(ldso.Error, match="out of range"):
        settings.window.iterations = 1000
    with pytest.raises(ldso.Error, match="neither"):
        ldso.Slam(ldso.Calibration(640, 480, 500, 500, 320, 240), 3)


def test_worlds_know_their_depth():
    world = ldso.simulate("room", size=(160, 120), seed=5, frames=20, lens="pinhole")
    assert len(world) == 20 and world.ground_truth.poses.shape == (20, 4, 4)
    frame, depth = world[10], world.depth(10)
    assert frame.image.shape == depth.shape == (120, 160)
    np.testing.assert_array_equal(world.T_world_camera(10), world.ground_truth.poses[10])
    # Points of one frame lie, seen from another, where that one's depth says.
    c = world.calibration
    v, u = np.mgrid[20:100:8, 30:130:8]
    z = depth[v, u]
    p = np.stack([(u - c.cx) / c.fx * z, (v - c.cy) / c.fy * z, z, np.ones_like(z)])
    T = np.linalg.inv(world.T_world_camera(12)) @ world.T_world_camera(10)
    q = np.tensordot(T, p, 1)
    u2, v2 = c.fx * q[0] / q[2] + c.cx, c.fy * q[1] / q[2] + c.cy
    inside = (u2 > 0) & (v2 > 0) & (u2 < 159) & (v2 < 119)
    other = world.depth(12)[np.round(v2[inside]).astype(int), np.round(u2[inside]).astype(int)]
    assert inside.sum() > 50 and np.median(np.abs(other / q[2][inside] - 1)) < 0.01
    with pytest.raises(ldso.Error, match="no option fog"):
        ldso.simulate("room", fog=True)
    with pytest.raises(IndexError):
        world.depth(20)


def test_the_stubs_tell_what_there_is():
    stub = ast.parse((pathlib.Path(ldso.__file__).parent / "__init__.pyi").read_text())
    told = {}
    for node in stub.body:
        if isinstance(node, ast.ClassDef):
            told[node.name] = {n.name for n in node.body if isinstance(n, ast.FunctionDef)} | {
                n.target.id for n in node.body if isinstance(n, ast.AnnAssign)}
        elif isinstance(node, ast.FunctionDef):
            told[node.name] = None
        elif isinstance(node, ast.AnnAssign):
            told[node.target.id] = None
    told = {name: members for name, members in told.items() if name != "_Images"}  # A type of an argument.
    assert set(told) == set(ldso.__all__)
    for name, members in told.items():
        if members is None or name == "Error":
            continue
        there = {m for m in vars(getattr(ldso, name)) if not m.startswith("_")}
        assert there == {m for m in members if not m.startswith("_")}, name


def test_everything_public_has_a_docstring():
    for name in ldso.__all__:
        thing = getattr(ldso, name)
        if inspect.isclass(thing) or callable(thing):
            assert thing.__doc__, name
