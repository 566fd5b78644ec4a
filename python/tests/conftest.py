"""What the tests share: the program, a small rendered sequence, and what the program makes of it."""

import os
import pathlib
import subprocess

import pytest

import ldso


@pytest.fixture(scope="session")
def sequence():
    return pathlib.Path(os.environ["LDSO_SEQUENCE"])


@pytest.fixture(scope="session")
def by_program(sequence, tmp_path_factory):
    """The folder that `ldso run` leaves of the sequence."""
    out = tmp_path_factory.mktemp("program") / "out"
    subprocess.run([os.environ["LDSO_PROGRAM"], "run", sequence, "-o", out, "--quiet"], check=True)
    return out


@pytest.fixture(scope="session")
def result(sequence):
    """Of the frames one by one."""
    dataset = ldso.open(sequence)
    slam = ldso.Slam(dataset.calibration)
    for frame in dataset:
        slam.process(frame.image, frame.timestamp, frame.exposure_ms)
    return slam.finish()
