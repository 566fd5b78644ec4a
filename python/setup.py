"""A wheel of the module: CMake builds it as it builds everything else. `pip install ./python`, or `pip wheel ./python
--no-build-isolation --no-deps` without a network."""

import os
import pathlib
import re
import subprocess

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

PROJECT = pathlib.Path(__file__).resolve().parent.parent
VERSION = re.search(r"project\(ldso VERSION ([0-9.]+)", (PROJECT / "CMakeLists.txt").read_text()).group(1)


class CMakeBuild(build_ext):
    """Configures, builds and installs the component `python`. LDSO_CMAKE_OPTIONS: further options of CMake."""

    def build_extension(self, extension):
        target = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve().parent.parent
        build = pathlib.Path(os.environ.get("LDSO_WHEEL_BUILD", self.build_temp)).resolve()
        options = ["-DCMAKE_BUILD_TYPE=Release", "-DLDSO_BUILD_TESTS=OFF", "-DLDSO_UNITY_BUILD=ON", "-DLDSO_BUILD_PYTHON=ON",
                   f"-DPython_EXECUTABLE={os.sys.executable}", "-DLDSO_PYTHON_DIR=.",
                   *os.environ.get("LDSO_CMAKE_OPTIONS", "").split()]
        subprocess.run(["cmake", "-S", PROJECT, "-B", build, "-G", "Ninja", *options], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "ldso_python"], check=True)
        subprocess.run(["cmake", "--install", build, "--component", "python", "--prefix", target, "--strip"], check=True)


setup(
    name="ldso",
    version=VERSION,
    description="Monocular direct visual SLAM: images to a camera trajectory and a sparse map",
    license="BSD-3-Clause",
    python_requires=">=3.9",
    install_requires=["numpy"],
    packages=["ldso"],
    package_data={"ldso": ["*.pyi", "py.typed"]},
    ext_modules=[Extension("ldso._ldso", [])],
    cmdclass={"build_ext": CMakeBuild},
    zip_safe=False,
)
