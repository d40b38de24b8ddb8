# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""How far dead reckoning goes wrong over 30 s in the tour that no answer has seen.

The true path is what the true model makes of the twin without noise. What a model leaves there is the root mean
square over windows of 30 s, every 15 s; ways are in the map's axes where a compass tells them (after the one rotation
that suits best, for a compass begins where it likes), else in the robot's at the window's start.
"""
import csv
import math

WINDOW = 30.0  # s
MOVES = 0.1  # an effect that leaves less than this of the noise moves nothing that is worth a figure


def poses(program, folder, text, scratch):
    model, file = scratch / "held.toml", scratch / "poses.csv"
    model.write_text(text)
    program.run("apply", folder, "--model", model, "--out", file)
    with open(file, newline="") as stream:
        rows = csv.reader(stream)
        next(rows)
        return [tuple(map(float, row[:4])) for row in rows]


def ways(path, since, compass):
    found, to, due = [], 0, since
    for t, x, y, heading in path:
        if t < due:
            continue
        while to < len(path) and path[to][0] < t + WINDOW:
            to += 1
        if to == len(path):
            break
        dx, dy = path[to][1] - x, path[to][2] - y
        c, s = (1.0, 0.0) if compass else (math.cos(heading), math.sin(heading))
        found.append((c * dx + s * dy, c * dy - s * dx))
        due = t + 0.5 * WINDOW
    return found


def apart(one, other):
    along = sum(a * c + b * d for (a, b), (c, d) in zip(one, other))
    across = sum(a * d - b * c for (a, b), (c, d) in zip(one, other))
    c, s = math.cos(math.atan2(across, along)), math.sin(math.atan2(across, along))
    squares = [(c * a - s * b - x) ** 2 + (s * a + c * b - y) ** 2 for (a, b), (x, y) in zip(one, other)]
    return math.sqrt(sum(squares) / max(1, len(squares)))


def errors(program, folder, truth, texts, scratch):
    """What each further model of `texts` leaves, as a share of what noise alone leaves; the first is the true one."""
    since, compass, known = truth["until_s"], truth["robot"]["compass"], {}

    def reckoned(kind, text):
        if (kind, text) not in known:
            known[kind, text] = ways(poses(program, folder / kind, text, scratch), since, compass)
        return known[kind, text]

    true = reckoned("clean", texts[0])
    noise = apart(reckoned("noisy", texts[0]), true)
    return tuple(apart(reckoned("clean", text), true) / noise for text in texts[1:])
