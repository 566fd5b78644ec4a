#!/usr/bin/env python3
"""From nothing to pictures: renders a room, tracks a camera through it frame by frame, and compares what came out with
what is known of a rendered world.

    PYTHONPATH=build/release/python python3 python/tutorial/tutorial.py [FOLDER]

writes tutorial_map.png and tutorial_depth.png to FOLDER (default: the current one).
"""

import pathlib
import sys

import matplotlib
import numpy as np

import ldso

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")

# 1. A world: images of a camera that is carried through a room, and everything that there is to know about them.
world = ldso.simulate("room", seed=1, size=(480, 360), frames=300)
print(f"{len(world)} frames, {world.path_length:.1f} m")

# 2. Track them one by one. A frame has a pose once the map has begun.
slam = ldso.Slam(world.calibration, log=lambda is_warning, text: print("  ", text))
for index in range(len(world)):
    frame = world[index]
    slam.process(frame.image, frame.timestamp, frame.exposure_ms)
result = slam.finish()

# 3. How good is it? A single camera knows no unit: the estimate is laid over the truth by a similarity first.
estimate, points = result.trajectory(), result.points()
evaluation = ldso.evaluate(estimate, world.ground_truth)
print(f"ATE {1000 * evaluation.ate.rmse:.2f} mm, {evaluation.ate_percent_of_path:.4f} % of the path")

# 4. The map and the way of the camera from above, in the world of the truth.
S = evaluation.S_truth_estimate
to_truth = lambda xyz: xyz @ S[:3, :3].T + S[:3, 3]
xyz, way, truth = to_truth(points.xyz), to_truth(estimate.tum[:, 1:4]), world.ground_truth.tum[:, 1:4]
figure, axes = plt.subplots(figsize=(7, 6))
axes.scatter(xyz[:, 0], xyz[:, 2], c=points.intensity, s=1, cmap="gray", vmin=0, vmax=300)
axes.plot(truth[:, 0], truth[:, 2], color="tab:orange", linewidth=4, label="truth")
axes.plot(way[:, 0], way[:, 2], color="tab:blue", linewidth=1.5, label=f"ldso, ATE {1000 * evaluation.ate.rmse:.2f} mm")
axes.set(xlabel="x [m]", ylabel="z [m]", aspect="equal", title="A room from above")
axes.legend()
figure.savefig(folder / "tutorial_map.png", dpi=110, bbox_inches="tight")

# 5. Depths of one keyframe's points, beside the exact ones of the rendered world at the same pixels.
keyframe = result.keyframe_trajectory()
host = np.flatnonzero(keyframe.frame_ids == np.bincount(points.keyframe_ids).argmax())[0]
mine = points.keyframe_ids == keyframe.frame_ids[host]
to_camera = np.linalg.inv(keyframe.poses[host])
scale = np.cbrt(np.linalg.det(S[:3, :3]))
z = scale * (points.xyz[mine] @ to_camera[:3, :3].T + to_camera[:3, 3])[:, 2]

# Where the points are in the image that the camera took: the map knows pixels of the rectified one.
pinhole, camera = result.camera, world.calibration
x, y = (points.pixels[mine] - [pinhole.cx, pinhole.cy]).T / np.array([[pinhole.fx], [pinhole.fy]])
k1, k2, p1, p2 = camera.distortion[:4]
r2 = x * x + y * y
bend = 1 + k1 * r2 + k2 * r2 * r2
u = camera.fx * (x * bend + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + camera.cx
v = camera.fy * (y * bend + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + camera.cy
exact = world.depth(int(keyframe.frame_ids[host]))[np.round(v).astype(int), np.round(u).astype(int)]
error = np.abs(z / exact - 1)
print(f"depths of keyframe {keyframe.frame_ids[host]}: median error {100 * np.median(error):.2f} %")

figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4), constrained_layout=True)
left.imshow(world[int(keyframe.frame_ids[host])].image, cmap="gray")
shown = left.scatter(u, v, c=z, s=6, cmap="turbo")
figure.colorbar(shown, ax=left, label="depth [m]")
left.set_title(f"Points of keyframe {keyframe.frame_ids[host]}")
right.loglog(exact, z, ".", markersize=3)
right.axline((1, 1), (2, 2), color="gray", linewidth=1)
right.set(xlabel="exact depth [m]", ylabel="depth of the map [m]", title=f"Median error {100 * np.median(error):.2f} %")
figure.savefig(folder / "tutorial_depth.png", dpi=110, bbox_inches="tight")
print(f"pictures in {folder.resolve()}")
