"""Types of the module; its docstrings say the rest: help(ldso.Slam)."""

import os
from typing import Any, Callable, Dict, Iterator, List, Optional, Protocol, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

Path = Union[str, "os.PathLike[str]"]
Log = Callable[[bool, str], Any]
TrajectoryLike = Union["Trajectory", ArrayLike, Path]
SettingsLike = Union["Settings", Dict[str, Any], None]
Item = Union[Tuple[ArrayLike, float], Tuple[ArrayLike, float, Optional[float]]]


class _Images(Protocol):
    def __len__(self) -> int: ...
    def __getitem__(self, index: int) -> Item: ...


__version__: str

class Error(RuntimeError):
    context: str
    problem: str
    remedy: str
    file: Optional[str]
    line: Optional[int]

class PinholeIntrinsics:
    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    K: NDArray[np.float64]

class Calibration:
    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    readout_ms: float
    model: str
    distortion: List[float]
    inverse_response: Optional[NDArray[np.float32]]
    vignette: Optional[NDArray[np.float32]]
    description: str
    warnings: List[str]
    def __init__(self, width: int, height: int, fx: float, fy: float, cx: float, cy: float, *, model: str = "pinhole",
                 distortion: Sequence[float] = (), readout_ms: float = 0.0, rectification: str = "") -> None: ...
    @staticmethod
    def read(path: Path, photometric: bool = True) -> "Calibration": ...
    def write(self, path: Path) -> None: ...

class Settings:
    def __init__(self, values: Optional[Dict[str, Any]] = None, **settings: Any) -> None: ...
    @staticmethod
    def read(path: Path) -> "Settings": ...
    def write(self, path: Path) -> None: ...
    def update(self, values: Dict[str, Any]) -> None: ...
    def to_dict(self) -> Dict[str, Any]: ...
    def copy(self) -> "Settings": ...
    def __getitem__(self, name: str) -> Any: ...
    def __setitem__(self, name: str, value: Any) -> None: ...
    def __getattr__(self, name: str) -> Any: ...
    def __setattr__(self, name: str, value: Any) -> None: ...

class Trajectory:
    timestamps: NDArray[np.float64]
    poses: NDArray[np.float64]
    tum: NDArray[np.float64]
    frame_ids: NDArray[np.int64]
    def __init__(self, timestamps: ArrayLike, poses: ArrayLike) -> None: ...
    @staticmethod
    def from_tum(rows: ArrayLike) -> "Trajectory": ...
    @staticmethod
    def read(path: Path) -> "Trajectory": ...
    def write(self, path: Path, format: str = "tum") -> None: ...
    def __len__(self) -> int: ...

class FrameRecord:
    frame_id: int
    timestamp: float
    state: str
    is_tracked: bool
    reason: str
    is_keyframe: bool
    keyframe_id: int
    T_keyframe_frame: NDArray[np.float64]
    residual_rmse: float
    brightness_a: float
    brightness_b: float

class LoopRecord:
    keyframe_id: int
    candidate_id: int
    accepted: bool
    reason: str
    score: float
    inliers: int
    S_keyframe_candidate: NDArray[np.float64]
    matches: NDArray[np.float32]

class PointCloud:
    xyz: NDArray[np.float64]
    intensity: NDArray[np.float32]
    idepth_stddev: NDArray[np.float32]
    keyframe_ids: NDArray[np.int64]
    pixels: NDArray[np.float32]
    def write_ply(self, path: Path) -> None: ...
    def __len__(self) -> int: ...

class SlamResult:
    parts: int
    frames: List[FrameRecord]
    loops: List[LoopRecord]
    camera: PinholeIntrinsics
    better_calibration: Optional[Calibration]
    initializations: List[int]
    restarts: int
    skipped: int
    stage_times: Dict[str, Dict[str, float]]
    def trajectory(self, corrected: bool = True, part: int = 0) -> Trajectory: ...
    def keyframe_trajectory(self, corrected: bool = True, part: int = 0) -> Trajectory: ...
    def points(self, corrected: bool = True, part: int = 0) -> PointCloud: ...
    def write_colmap(self, folder: Path) -> None: ...

class Viewer:
    url: str
    def __init__(self, address: str = "", name: str = "") -> None: ...
    def finish(self) -> None: ...

class Slam:
    T_world_camera: Optional[NDArray[np.float64]]
    rectified_camera: PinholeIntrinsics
    def __init__(self, calibration: Calibration, settings: SettingsLike = None, *, log: Optional[Log] = None,
                 observer: Any = None) -> None: ...
    def process(self, image: ArrayLike, timestamp: float, exposure_ms: Optional[float] = None) -> FrameRecord: ...
    def snapshot(self) -> SlamResult: ...
    def finish(self) -> SlamResult: ...

class Frame:
    id: int
    timestamp: float
    exposure_ms: Optional[float]
    name: str
    image: NDArray[np.float32]

class Dataset:
    calibration: Calibration
    ground_truth: Optional[Trajectory]
    format: str
    warnings: List[str]
    def timestamp(self, index: int) -> float: ...
    def __len__(self) -> int: ...
    def __getitem__(self, index: int) -> Frame: ...
    def __iter__(self) -> Iterator[Frame]: ...

class FoundCamera:
    stddevs: NDArray[np.float64]
    doubt: str

class SequenceRun:
    result: SlamResult
    calibration: Calibration
    passes: int
    is_corrected: bool
    proof: str
    refused_correction: str
    found_camera: Optional[FoundCamera]
    seconds: float

class Statistics:
    count: int
    rmse: float
    mean: float
    median: float
    stddev: float
    min: float
    max: float

class TumMonoError:
    e_align: float
    e_rmse: float
    e_translation: float
    e_rotation_deg: float
    e_scale: float

class Evaluation:
    ate: Statistics
    rpe_translation: Optional[Statistics]
    rpe_rotation_deg: Optional[Statistics]
    tum_mono: Optional[TumMonoError]
    path_length: float
    ate_percent_of_path: float
    errors: NDArray[np.float64]
    pairs: NDArray[np.int64]
    S_truth_estimate: NDArray[np.float64]
    def to_dict(self) -> Dict[str, Any]: ...

class SimulatedSequence:
    calibration: Calibration
    ground_truth: Trajectory
    path_length: float
    def depth(self, index: int) -> NDArray[np.float32]: ...
    def T_world_camera(self, index: int) -> NDArray[np.float64]: ...
    def write(self, folder: Path, layout: str = "tum-mono", depth: bool = False) -> int: ...
    def __len__(self) -> int: ...
    def __getitem__(self, index: int) -> Frame: ...

def open(path: Path, *, start: int = 0, end: Optional[int] = None, stride: int = 1, reverse: bool = False,
         calibration: Optional[Path] = None, fps: Optional[float] = None, pattern: str = "",
         topic: str = "") -> Dataset: ...
def run(source: Union[Path, Dataset, _Images], out: Optional[Path] = None, *,
        calibration: Union[Path, Calibration, None] = None, settings: SettingsLike = None,
        progress: Optional[Callable[[int, int], Any]] = None, log: Optional[Log] = None, observer: Any = None,
        report: bool = True, loop_pictures: bool = False, **more: Any) -> SequenceRun: ...
def evaluate(estimate: TrajectoryLike, truth: TrajectoryLike, *, align: str = "sim3",
             max_time_difference: float = 0.01, pair_by_index: bool = False, delta: int = 1,
             all_pairs: bool = False) -> Evaluation: ...
def simulate(world: str = "room", *, threads: int = 2, **options: Any) -> SimulatedSequence: ...
