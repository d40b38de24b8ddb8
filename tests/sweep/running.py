# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Runs the command with a limit of time and memory, and tells what no run may do."""
import collections
import os
import pathlib
import re
import resource
import subprocess

Ran = collections.namedtuple("Ran", "arguments status out err")

HANG = -1000  # status of a run that had to be stopped

# Of libraries: what they say is of their insides.
INSIDES = re.compile(r"json\.exception|parse error|Error while parsing|basic_string|vector::|map::at|"
                     r"\bsto[id]\b|std::|bad_alloc|what\(\)|terminate called|SQL logic|SQLITE_|filesystem error|"
                     r"iostream|CLI::|unordered_map|Assertion|runtime error|AddressSanitizer|"
                     r"cholmod|Eigen")


class Command:
    """The program under test. `seconds` are of one processor; `memory` is the address space [bytes],
    None for no limit."""

    def __init__(self, path, seconds=20, memory=2 << 30):
        self.path = pathlib.Path(path).resolve()
        self.seconds = seconds
        self.memory = memory
        self.environment = dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")

    def run(self, *arguments, cwd=None):
        arguments = [str(one) for one in arguments]

        def limited():
            if self.memory:
                resource.setrlimit(resource.RLIMIT_AS, (self.memory, self.memory))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            resource.setrlimit(resource.RLIMIT_CPU, (self.seconds, self.seconds + 1))

        process = subprocess.Popen([self.path, *arguments], stdout=subprocess.PIPE, cwd=cwd,
                                   stderr=subprocess.PIPE, stdin=subprocess.DEVNULL,
                                   env=self.environment, preexec_fn=limited)
        try:
            out, err = process.communicate(timeout=20 * self.seconds)
            status = SLOW if process.returncode in (-24, -9) else process.returncode
        except subprocess.TimeoutExpired:
            process.kill()
            out, err = process.communicate()
            status = HANG
        return Ran(arguments, status, out.decode(errors="replace"), err.decode(errors="replace"))


SLOW = -1001  # and one that used its processor time up


def wrong_way_out(ran):
    """What is wrong with how a run ended, whatever it was given; None: nothing."""
    if ran.status in (HANG, SLOW):
        return "did not end in time"
    if ran.status not in (0, 1, 2):
        return f"status {ran.status}"
    said = INSIDES.search(ran.err)
    if said:
        return f"a library speaks: {said.group()}"
    if ran.status == 2 or (ran.status == 1 and not ran.out):
        complaints = [line for line in ran.err.splitlines() if not line.startswith(("warning: ", "  "))]
        if len(complaints) != 1:
            return f"{len(complaints)} lines of complaint"
    return None
