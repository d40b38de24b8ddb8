# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Landmark maps of mobile robots, and the effect that an odometry model is missing.

    import trussmap
    recording = trussmap.Recording({"t": t, "left": left, "right": right}, sightings)
    print(trussmap.diagnose(recording, trussmap.Model(wheelbase=0.34)))

docs/python.md teaches it. Lengths are in m, times in s, angles in rad.
"""
from . import _core, _plots
from ._core import *  # noqa: F401,F403
from ._core import __version__  # noqa: F401

_plots.add_plots()
__all__ = [name for name in vars(_core) if not name.startswith("_")] + ["RecordingWarning"]


class RecordingWarning(UserWarning):
    """A column of a recording contradicts another: a unit, a sign, a name, a clock."""
