"""Images one by one."""

import gc
import pathlib
import threading

import numpy as np
import pytest

import ldso


def images(sequence, count=30):
    """The frames as 8-bit images, as a camera gives them."""
    for frame in ldso.open(sequence, end=count):
        assert np.array_equal(frame.image, np.round(frame.image))
        yield frame.image.astype(np.uint8), frame.timestamp, frame.exposure_ms


def test_the_results_are_those_of_the_program_to_the_bit(result, by_program, tmp_path):
    result.trajectory().write(tmp_path / "trajectory.txt")
    result.keyframe_trajectory().write(tmp_path / "keyframes.txt")
    result.points().write_ply(tmp_path / "map.ply")
    for name in ["trajectory.txt", "keyframes.txt", "map.ply"]:
        assert (tmp_path / name).read_bytes() == (by_program / name).read_bytes(), name


def test_every_pixel_type_is_the_same_image(sequence):
    slams = [ldso.Slam(ldso.open(sequence).calibration) for _ in range(4)]
    for image, timestamp, exposure in images(sequence):
        wide = np.zeros((image.shape[0], image.shape[1] + 6), np.uint8)
        wide[:, 2:-4] = image
        cut = wide[:, 2:-4]
        assert not cut.flags["C_CONTIGUOUS"]
        for slam, given in zip(slams, [image, image.astype(np.uint16) * 257, image.astype(np.float32), cut]):
            slam.process(given, timestamp, exposure)
    rows = [slam.finish().trajectory().tum for slam in slams]
    assert len(rows[0]) > 10
    for other in rows[1:]:
        np.testing.assert_allclose(rows[0], other, atol=1e-6)
    assert np.array_equal(rows[0], rows[2]) and np.array_equal(rows[0], rows[3])


def test_the_live_pose_is_that_of_the_newest_frame(sequence):
    slam = ldso.Slam(ldso.open(sequence).calibration)
    for image, timestamp, exposure in images(sequence):
        record = slam.process(image, timestamp, exposure)
        assert record.is_tracked == (slam.T_world_camera is not None)
        assert record.is_tracked or record.reason
        if not record.is_tracked:
            continue
        so_far = slam.snapshot().trajectory()
        assert so_far.frame_ids[-1] == record.frame_id
        np.testing.assert_allclose(so_far.poses[-1], slam.T_world_camera, atol=1e-12)
    result = slam.finish()
    T = result.trajectory().poses
    assert T.shape[1:] == (4, 4)
    np.testing.assert_allclose(np.einsum("nij,nkj->nik", T[:, :3, :3], T[:, :3, :3]), np.tile(np.eye(3), (len(T), 1, 1)),
                               atol=1e-9)
    with pytest.raises(ldso.Error, match="finished"):
        slam.process(image, timestamp)


def test_results_are_arrays(result):
    trajectory, points = result.trajectory(), result.points()
    n = len(trajectory)
    assert trajectory.poses.shape == (n, 4, 4) and trajectory.tum.shape == (n, 8)
    assert trajectory.timestamps.shape == trajectory.frame_ids.shape == (n,)
    np.testing.assert_array_equal(trajectory.tum[:, 1:4], trajectory.poses[:, :3, 3])
    assert points.xyz.shape == (len(points), 3) and points.pixels.shape == (len(points), 2)
    assert points.intensity.dtype == np.float32 and points.intensity.max() <= 255
    assert (points.idepth_stddev > 0).all() and np.isfinite(points.xyz).all()
    assert set(points.keyframe_ids) <= set(result.keyframe_trajectory().frame_ids)
    assert result.parts == 1 and result.restarts == 0 and len(result.frames) == 60
    assert result.stage_times["odometry"]["calls"] == 60


def test_points_project_to_their_pixels(result):
    points, keyframes, camera = result.points(), result.keyframe_trajectory(), result.camera
    pose_of = dict(zip(keyframes.frame_ids, keyframes.poses))
    T_camera_world = np.linalg.inv([pose_of[i] for i in points.keyframe_ids])
    p = np.einsum("nij,nj->ni", T_camera_world[:, :3, :3], points.xyz) + T_camera_world[:, :3, 3]
    uv = (camera.K @ (p / p[:, 2:]).T).T[:, :2]
    assert np.median(np.abs(uv - points.pixels)) < 0.1


@pytest.mark.parametrize("image, message", [
    (np.zeros((240, 320, 3), np.uint8), "3 dimensions"),
    (np.zeros((240, 320), np.float64), "float64"),
    (np.zeros((240, 300), np.uint8), "300 x 240"),
    ([[1, 2], [3, 4]], "it is a list"),
])
def test_images_that_are_none_are_refused(sequence, image, message):
    slam = ldso.Slam(ldso.open(sequence).calibration)
    with pytest.raises(ldso.Error, match=message) as refused:
        slam.process(image, 0.0)
    assert refused.value.remedy
    with pytest.raises(ldso.Error, match="not finite"):
        slam.process(np.zeros((240, 320), np.uint8), float("nan"))


def test_the_lock_is_released_while_a_frame_is_processed(sequence):
    """Another thread gets on: it counts while nobody but Slam works."""
    slam = ldso.Slam(ldso.open(sequence).calibration)
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1

    frames = list(images(sequence))
    thread = threading.Thread(target=count)
    thread.start()
    before_and_after = []
    for image, timestamp, exposure in frames:
        before = counted[0]
        slam.process(image, timestamp, exposure)
        before_and_after.append((before, counted[0]))
    stop.set()
    thread.join()
    # A thread that is waiting for the lock is let in at the end of process() at the latest; counting far beyond that
    # shows that it ran meanwhile.
    assert sum(after - before > 1000 for before, after in before_and_after) > len(frames) / 2


def test_an_observer_hears_of_everything(sequence):
    class Observer:
        def __init__(self):
            self.starts, self.frames, self.keyframes, self.views = [], [], [], []

        def on_start(self, camera):
            self.starts.append(camera)

        def on_frame(self, event):
            self.frames.append(event)

        def on_keyframe(self, keyframe):
            self.keyframes.append(keyframe)

        def on_view(self, view):
            self.views.append(view)

    observer, messages = Observer(), []
    slam = ldso.Slam(ldso.open(sequence).calibration, {"loops.enabled": False}, observer=observer,
                     log=lambda is_warning, text: messages.append(text))
    for image, timestamp, exposure in images(sequence):
        slam.process(image, timestamp, exposure)
    result = slam.finish()
    assert len(observer.starts) == 1 and len(observer.views) == 30
    assert len([e for e in observer.frames if not e["is_late"]]) == 30
    assert len(observer.keyframes) == len(result.keyframe_trajectory())
    assert observer.views[-1]["image"].shape == (observer.starts[0].height, observer.starts[0].width)
    assert observer.keyframes[0]["points"].shape[1] == 5
    assert any("the map is initialized" in text for text in messages)


def test_an_observer_that_raises_changes_nothing(sequence, capsys, monkeypatch):
    raised = []
    monkeypatch.setattr("sys.unraisablehook", raised.append)

    class Observer:
        def on_frame(self, event):
            raise ValueError("of the observer")

    plain, observed = (ldso.Slam(ldso.open(sequence).calibration, observer=o) for o in (None, Observer()))
    for image, timestamp, exposure in images(sequence):
        plain.process(image, timestamp, exposure)
        observed.process(image, timestamp, exposure)
    assert np.array_equal(plain.finish().trajectory().tum, observed.finish().trajectory().tum)
    assert len(raised) >= 30


def test_one_that_is_dropped_in_the_middle_ends(sequence):
    slam = ldso.Slam(ldso.open(sequence).calibration, log=lambda is_warning, text: None)
    for image, timestamp, exposure in images(sequence):
        slam.process(image, timestamp, exposure)
    del slam
    gc.collect()


def test_a_wrong_calibration_is_said():
    world = ldso.simulate("room", size=(320, 240), seed=3, frames=200)
    wrong = world.calibration
    wrong.fx *= 1.05
    wrong.fy *= 1.05
    warnings = []
    slam = ldso.Slam(wrong, log=lambda is_warning, text: is_warning and warnings.append(text))
    for frame in (world[i] for i in range(len(world))):
        slam.process(frame.image, frame.timestamp, frame.exposure_ms)
    better = slam.finish().better_calibration
    assert better is not None and abs(better.fx / world.calibration.fx - 1) < 0.02
    assert any("contradict the calibration" in text for text in warnings)


def test_the_readme_loop_writes_a_trajectory(sequence, tmp_path):
    slam = ldso.Slam(ldso.Calibration.read(pathlib.Path(sequence) / "camera.txt"))
    for image, timestamp, _ in images(sequence):
        slam.process(image, timestamp)
    slam.finish().trajectory().write(tmp_path / "trajectory.txt")
    rows = np.loadtxt(tmp_path / "trajectory.txt")
    assert rows.shape[1] == 8 and len(rows) > 15
