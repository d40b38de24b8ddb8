# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""pip install . : the module is built by the project's CMake, the folder above."""
import os
import re
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parent


def version():
    text = (PROJECT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(trussmap VERSION (\S+)", text).group(1)


class BuildByCMake(build_ext):
    """Configures (in TRUSSMAP_BUILD_DIR, else in build-python beside the sources) and builds the target trussmap_python; its module goes where setuptools wants it."""

    def build_extension(self, extension):
        module = Path(self.get_ext_fullpath(extension.name)).resolve()
        build = Path(os.environ.get("TRUSSMAP_BUILD_DIR", PROJECT / "build-python")).resolve()
        build.mkdir(parents=True, exist_ok=True)
        subprocess.check_call(
            ["cmake", "-S", str(PROJECT), "-B", str(build), "-D", "CMAKE_BUILD_TYPE=Release",
             "-D", "TRUSSMAP_BUILD_PYTHON=ON", "-D", "TRUSSMAP_BUILD_APPS=OFF",
             "-D", "TRUSSMAP_BUILD_TESTS=OFF", "-D", f"Python_EXECUTABLE={sys.executable}",
             "-D", f"TRUSSMAP_PYTHON_DIR={module.parent.parent}"])
        jobs = str(os.cpu_count() or 1)
        subprocess.check_call(["cmake", "--build", str(build), "--parallel", jobs,
                               "--target", "trussmap_python"])
        subprocess.check_call([sys.executable, str(HERE / "make_stubs.py"), str(module.parent)])


setup(
    version=version(),
    packages=["trussmap"],
    package_dir={"": "."},
    package_data={"trussmap": ["py.typed", "*.pyi"]},
    ext_modules=[Extension("trussmap._core", sources=[])],
    cmdclass={"build_ext": BuildByCMake},
)
