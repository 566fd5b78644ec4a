"""ldso as a baseline of VSLAM-LAB: copy this file to its Baselines/baseline_files/ and register the class in
Baselines/get_baseline.py; docs/benchmark-suites.md has the lines for its pixi.toml."""

from Baselines.BaselineVSLAMLAB import BaselineVSLAMLAB


class LDSO_baseline(BaselineVSLAMLAB):
    """Monocular direct SLAM with loop closing; runs vslamlab_ldso_mono.py."""

    def __init__(self, baseline_name: str = "ldso", baseline_folder: str = "ldso") -> None:
        default_parameters = {"verbose": 0, "mode": "mono", "loops": 1}
        super().__init__(baseline_name, baseline_folder, default_parameters)
        self.command_style = "cpp"  # KEY:VALUE
        self.modes = ["mono"]
        self.cam_models = ["pinhole", "radtan4", "radtan5", "equid4"]
        self.color = (0.20, 0.45, 0.70)

    def is_installed(self) -> tuple[bool, str]:
        program = self.baseline_path / "build" / "release" / "ldso"
        return (True, "is installed") if program.is_file() else (False, "not installed (auto install available)")
