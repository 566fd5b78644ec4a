"""Monocular direct visual SLAM: images in, camera poses and a sparse map out.

    import ldso
    slam = ldso.Slam(ldso.Calibration.read("camera.txt"))
    for image, timestamp in images:              # numpy, (height, width), uint8, uint16 or float32
        frame = slam.process(image, timestamp)
        print(timestamp, slam.T_world_camera)    # 4 x 4, camera to world; None while there is no pose
    result = slam.finish()
    result.trajectory().write("trajectory.txt")

A whole sequence on disk: ldso.run("sequence", "out"). Everything: docs/python.md.
"""

from ldso._ldso import (
    Calibration,
    Dataset,
    Error,
    Evaluation,
    FoundCamera,
    Frame,
    FrameRecord,
    LoopRecord,
    PinholeIntrinsics,
    PointCloud,
    SequenceRun,
    Settings,
    SimulatedSequence,
    Slam,
    SlamResult,
    Statistics,
    Trajectory,
    TumMonoError,
    Viewer,
    __version__,
    evaluate,
    open,
    run,
    simulate,
)

__all__ = [
    "Calibration", "Dataset", "Error", "Evaluation", "FoundCamera", "Frame", "FrameRecord", "LoopRecord",
    "PinholeIntrinsics", "PointCloud", "SequenceRun", "Settings", "SimulatedSequence", "Slam", "SlamResult",
    "Statistics", "Trajectory", "TumMonoError", "Viewer", "__version__", "evaluate", "open", "run", "simulate",
]
