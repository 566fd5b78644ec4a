"""Whole sequences."""

import json
import os
import subprocess

import numpy as np
import pytest

import ldso


def test_a_run_leaves_what_the_program_leaves(sequence, by_program, tmp_path):
    done = []
    run = ldso.run(sequence, tmp_path / "out", progress=lambda i, n: done.append((i, n)))
    assert done == [(i, 60) for i in range(1, 61)]
    assert run.passes == 1 and not run.is_corrected and run.seconds > 0 and run.found_camera is None
    names = {p.name for p in by_program.iterdir()}
    assert names == {p.name for p in (tmp_path / "out").iterdir()}
    for name in ["trajectory.txt", "keyframes.txt", "map.ply", "loops.json", "trajectory_odometry.txt"]:
        assert (tmp_path / "out" / name).read_bytes() == (by_program / name).read_bytes(), name
    told = json.loads((tmp_path / "out" / "run.json").read_text())
    by = json.loads((by_program / "run.json").read_text())
    assert told["evaluation"] == by["evaluation"] and told["sequence"] == by["sequence"]
    subprocess.run([os.environ["LDSO_PROGRAM"], "export", tmp_path / "out", "--format", "colmap,ply"], check=True)


def test_settings_are_keywords(sequence):
    run = ldso.run(sequence, end=20, threads=1, loops={"enabled": False}, **{"window.iterations": 3})
    assert len(run.result.frames) == 20
    with pytest.raises(ldso.Error, match="did you mean") as wrong:
        ldso.run(sequence, thread=1)
    assert "threads" in str(wrong.value)


def test_images_of_a_program(sequence, by_program):
    class Images:
        def __init__(self, dataset):
            self.dataset = dataset

        def __len__(self):
            return len(self.dataset)

        def __getitem__(self, i):
            frame = self.dataset[i]
            return frame.image.astype(np.uint8), frame.timestamp, frame.exposure_ms

    dataset = ldso.open(sequence)
    run = ldso.run(Images(dataset), calibration=dataset.calibration)
    np.testing.assert_allclose(run.result.trajectory().tum, np.loadtxt(by_program / "trajectory.txt"), atol=1e-9)


def test_what_progress_raises_ends_the_run_and_saves_it(sequence, tmp_path):
    def progress(done, count):
        if done == 40:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ldso.run(sequence, tmp_path / "out", progress=progress)
    assert len(np.loadtxt(tmp_path / "out" / "trajectory.txt")) > 10
    assert json.loads((tmp_path / "out" / "run.json").read_text())["interrupted"]


def test_files_of_others_stay(sequence, tmp_path):
    (tmp_path / "trajectory.txt").write_text("mine\n")
    with pytest.raises(ldso.Error) as refused:
        ldso.run(sequence, tmp_path)
    assert (tmp_path / "trajectory.txt").read_text() == "mine\n" and refused.value.remedy
    with pytest.raises(ldso.Error, match="sequence itself"):
        ldso.run(sequence, sequence)


def test_datasets_are_iterated(sequence):
    dataset = ldso.open(sequence, stride=2)
    assert len(dataset) == 30 and dataset.format == "TUM-mono"
    for index, frame in enumerate(dataset):
        assert frame.id == index and frame.image.shape == (240, 320)
    assert index == 29
    assert np.array_equal(dataset[-1].image, frame.image)
    assert len(dataset.ground_truth) == 60
    with pytest.raises(IndexError):
        dataset[30]
    iterator = iter(dataset)
    next(iterator)
    del iterator  # While it reads ahead.


def test_evaluation(sequence, by_program):
    evaluation = ldso.evaluate(by_program / "trajectory.txt", sequence)
    told = json.loads((by_program / "run.json").read_text())["evaluation"]
    assert evaluation.to_dict().keys() == told.keys()
    assert evaluation.ate.rmse == pytest.approx(told["ate_m"]["rmse"], rel=1e-6)
    assert evaluation.ate.rmse == pytest.approx(np.sqrt(np.mean(evaluation.errors ** 2)))
    estimate = ldso.Trajectory.read(by_program / "trajectory.txt")
    truth = ldso.open(sequence).ground_truth
    again = ldso.evaluate(estimate.tum, truth.tum)
    assert again.ate.rmse == pytest.approx(evaluation.ate.rmse, rel=1e-6)
    # The alignment is what it says.
    S = evaluation.S_truth_estimate
    a, b = evaluation.pairs.T
    mapped = estimate.poses[a, :3, 3] @ S[:3, :3].T + S[:3, 3]
    np.testing.assert_allclose(np.linalg.norm(mapped - truth.poses[b, :3, 3], axis=1), evaluation.errors, atol=1e-9)
    assert "ATE" in str(evaluation) and evaluation.rpe_translation.rmse > 0
    with pytest.raises(ldso.Error, match=r"\(N, 8\)"):
        ldso.evaluate(np.zeros((3, 7)), truth)
    both_ends = ldso.Trajectory(truth.timestamps, truth.poses)
    of_both = ldso.evaluate(both_ends, ldso.Trajectory(np.delete(truth.timestamps, slice(12, 48)),
                                                       np.delete(truth.poses, slice(12, 48), 0)))
    assert of_both.tum_mono.e_align < 1e-9 and of_both.rpe_translation is None


def test_trajectories_are_read_and_written(by_program, tmp_path):
    trajectory = ldso.Trajectory.read(by_program / "trajectory.txt")
    again = ldso.Trajectory(trajectory.timestamps, trajectory.poses)
    np.testing.assert_allclose(again.tum, trajectory.tum, atol=1e-9)
    np.testing.assert_allclose(ldso.Trajectory.from_tum(trajectory.tum).poses, trajectory.poses, atol=1e-12)
    for form in ["tum", "kitti", "euroc", "csv"]:
        trajectory.write(tmp_path / form, form)
    assert np.loadtxt(tmp_path / "kitti").shape == (len(trajectory), 12)
    with pytest.raises(ldso.Error, match="no such format"):
        trajectory.write(tmp_path / "x", "x")
