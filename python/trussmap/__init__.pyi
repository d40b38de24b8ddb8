# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
from ._core import *
from ._core import __version__ as __version__

__all__: list[str]

class RecordingWarning(UserWarning): ...
