# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Legs and what effects do to them, for the baselines: nothing of trussmap is used here but its file formats.

Drive rows become the body's motion by the kinematics of docs/formats.md. A leg is the drive between two stops on
surveyed landmarks. Each leg gives its length against the survey's; its direction, against the compass (averaged over
the leg) or, without one, against that of the leg before; and what compass and gyro say of its turn against the
wheels. Ranges, bearings, fixes, loops and yaws are not used.
"""
import csv
import tomllib

import numpy as np

COLUMNS = {"differential": ["left", "right"], "skid-steer": ["left", "right"], "tricycle": ["wheel", "steer"],
           "ackermann": ["wheel", "steer"], "omni3": ["wheel1", "wheel2", "wheel3"],
           "mecanum": ["front_left", "front_right", "rear_left", "rear_right"], "wheels": []}
STEP = 1e-4  # of a coefficient, for derivatives


def table(file):
    with open(file, newline="") as stream:
        rows = list(csv.reader(stream))
    number = lambda text: float(text) if text.strip() else np.nan
    return {name: np.array([number(row[k]) for row in rows[1:]]) for k, name in enumerate(rows[0])}


def wrapped(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


class Riddle:
    def __init__(self, folder):
        self.robot = tomllib.loads((folder / "model.toml").read_text())["robot"]
        self.drive = table(folder / "drive.csv")
        self.t = self.drive["t"]
        self.dt = np.diff(np.r_[2 * self.t[0] - self.t[1], self.t])
        self.kind = self.robot.get("drive", "differential")
        wheels = [one["column"] for one in self.robot.get("wheel", [])]
        self.columns = self.robot.get("columns", wheels or COLUMNS[self.kind])
        self.compass, self.gyro = self.drive.get("heading"), self.drive.get("yaw_rate")
        known = {"t", "heading", "yaw_rate", *self.columns}
        self.covariates = {name: one for name, one in self.drive.items() if name not in known}
        self.names, self.scales = [], None
        self._stops(folder)
        self.variables = self._variables()
        if not len(self.legs):
            return
        plain = self.residuals([], [])
        self.scales = np.array([self._scale(plain, name) for name in range(len(self.names))])

    def _stops(self, folder):
        self.legs = np.zeros((0, 2), int)
        if not (folder / "survey.csv").is_file():
            return
        with open(folder / "survey.csv", newline="") as stream:
            place = {row["landmark"]: (float(row["x"]), float(row["y"])) for row in csv.DictReader(stream)}
        stops = []
        with open(folder / "sightings.csv", newline="") as stream:
            for row in csv.DictReader(stream):
                afar = row.get("range") or row.get("bearing")
                if not afar and row["landmark"] in place:
                    at = int(np.searchsorted(self.t, float(row["t"]) - 1e-6)) + (float(row["t"]) > self.t[0] - 1e-6)
                    stops.append((min(at, len(self.t)), place[row["landmark"]]))  # rows driven until then
        self.places = sorted(set(place.values()))
        pairs = [(a, b) for a, b in zip(stops, stops[1:]) if a[1] != b[1] and b[0] > a[0]]
        self.legs = np.array([(a[0], b[0]) for a, b in pairs], int).reshape(-1, 2)
        ways = np.array([np.subtract(b[1], a[1]) for a, b in pairs]).reshape(-1, 2)
        self.lengths, self.directions = np.hypot(*ways.T), np.arctan2(ways[:, 1], ways[:, 0])
        self.follows = np.r_[False, self.legs[1:, 0] == self.legs[:-1, 1]]

    def motion(self, wheels):
        """Ahead, to the left, turned: of every row."""
        w, robot = wheels, self.robot
        if self.kind in ("differential", "skid-steer"):
            side = len(w) // 2
            left, right = np.mean(w[:side], axis=0), np.mean(w[side:], axis=0)
            return (left + right) / 2, 0 * left, (right - left) / robot.get("wheelbase", 0.34)
        if self.kind == "tricycle":
            tilt = robot.get("steer_left", 0.0) / robot["length"]
            return w[0] * (np.cos(w[1]) + np.sin(w[1]) * tilt), 0 * w[0], w[0] * np.sin(w[1]) / robot["length"]
        if self.kind == "ackermann":
            tangent = np.tan(w[1])
            k = tangent / (robot["length"] + robot.get("steer_left", 0.0) * tangent)
            ahead = w[0] / (1 - robot.get("wheel_left", 0.0) * k)
            return ahead, 0 * ahead, ahead * k
        if self.kind == "omni3":
            return (w[1] - w[0]) / np.sqrt(3), (2 * w[2] - w[0] - w[1]) / 3, -(w[0] + w[1] + w[2]) / (3 * robot["radius"])
        if self.kind == "mecanum":
            across = 2 * (robot["wheelbase"] + robot["length"])
            return sum(w) / 4, (-w[0] + w[1] + w[2] - w[3]) / 4, (-w[0] + w[1] - w[2] + w[3]) / across
        return self._matrix() @ np.array(w)

    def _matrix(self):
        if "matrix" in self.robot:
            return np.array(self.robot["matrix"])
        rows = []  # what each wheel shows of the body's motion; with more than three, least squares
        for one in self.robot["wheel"]:
            rolls, roller = one.get("direction", 0.0), one.get("roller", 0.0)
            held = np.array([np.cos(rolls + roller), np.sin(rolls + roller)])
            held = held / np.cos(roller)
            rows.append([*held, -one.get("y", 0.0) * held[0] + one.get("x", 0.0) * held[1]])
        return np.linalg.pinv(np.array(rows))

    def _variables(self):
        ahead, left, turned = self.motion([self.drive[name] for name in self.columns])
        way = np.hypot(ahead, left)
        still = (way < 1e-4) & (np.abs(turned) < 1e-4)
        spins = ~still & (way < 0.05 * np.abs(turned))
        state = np.where(still, 0, np.where(spins, 1, 2))
        new = np.r_[True, np.diff(state) != 0]
        run = np.cumsum(new) - 1
        rate = lambda one: self._smoothed(one / self.dt, run)
        heading = self._headings(turned)
        x, y = self._places(ahead, left, turned)
        sign = np.sign(rate(ahead))
        return {"speed": rate(ahead), "turn_rate": rate(turned), "heading": heading, "x": x, "y": y,
                "t": self.t - self.t[0], "distance": np.cumsum(way), "starts": 1.0 * (new & (state == 2)),
                "spins": 1.0 * (new & (state == 1)), "sign(speed)": sign, "spin_angle": np.where(state == 1, np.abs(turned), 0),
                "arc_angle": np.where(state == 2, np.abs(turned), 0), **self.covariates}

    def _smoothed(self, values, run, reach=5):
        """Mean over about a second, within one run of driving, spinning or standing."""
        sums, counts = np.zeros_like(values), np.zeros_like(values)
        for shift in range(-reach, reach + 1):
            a, b = max(0, shift), len(values) + min(0, shift)
            same = run[a:b] == run[a - shift:b - shift]
            sums[a:b] += np.where(same, values[a - shift:b - shift], 0.0)
            counts[a:b] += same
        return sums / counts

    def _headings(self, turned):
        """In the map's axes: by the compass, else by the wheels from each leg's surveyed direction."""
        swept = np.cumsum(turned)
        if self.compass is not None:
            off = np.nan_to_num(wrapped(self.compass - swept))
            window = 101
            smooth = lambda one: np.convolve(np.pad(one, window // 2, mode="edge"), np.ones(window) / window, "valid")
            return swept + np.arctan2(smooth(np.sin(off)), smooth(np.cos(off)))
        heading = swept.copy()
        for (a, b), true in zip(self.legs, self.directions if len(self.legs) else []):
            heading[a:b] = swept[a:b] + true - swept[(a + b) // 2]
        return heading

    def _places(self, ahead, left, turned):
        h = self._headings(turned)
        return np.cumsum(ahead * np.cos(h) - left * np.sin(h)), np.cumsum(ahead * np.sin(h) + left * np.cos(h))

    def residuals(self, effects, coefficients):
        """Every leg's errors with these effects: length, direction, turn by compass, by gyro. Scaled once known."""
        wheels = [self.drive[name].copy() for name in self.columns]
        body = {name: 0.0 for name in ("travel", "turn", "drift", "creep", "advance", "rotate", "sideways", "compass", "gyro",
                                       "gyro_scale", "lever", "lever_left")}
        for effect, c in zip(effects, coefficients):
            g = c * effect.values
            if effect.channel in body:
                body[effect.channel] = body[effect.channel] + g
            for k, name in enumerate(self.columns):
                self._wheel(wheels, k, name, effect.channel, g)
        ahead, left, turned = self.motion(wheels)
        ahead = ahead * (1 + body["travel"]) + np.sign(ahead) * body["advance"]
        left = left * (1 + body["sideways"]) + body["creep"] * ahead
        turned = turned * (1 + body["turn"]) + body["drift"] * self.dt + np.sign(turned) * body["rotate"]
        return self._leg_errors(ahead, left, turned, body)

    def _wheel(self, wheels, k, name, channel, g):
        travels = name != "steer"
        left = k < len(self.columns) / 2
        if channel == "wheels" and travels or channel == f"wheel{k + 1}" or channel == ("left" if left else "right"):
            wheels[k] = wheels[k] * (1 + g)
        if channel == "difference":
            wheels[k] = wheels[k] * (1 - g / 2 if left else 1 + g / 2)
        if channel == "steer" and not travels:
            wheels[k] = wheels[k] + g
        if channel == "steer_gain" and not travels:
            wheels[k] = wheels[k] * (1 + g)

    def _leg_errors(self, ahead, left, turned, body):
        swept = np.r_[0.0, np.cumsum(turned)]
        middle = (swept[1:] + swept[:-1]) / 2
        x = np.r_[0.0, np.cumsum(ahead * np.cos(middle) - left * np.sin(middle))]
        y = np.r_[0.0, np.cumsum(ahead * np.sin(middle) + left * np.cos(middle))]
        sensor = [np.broadcast_to(body[name], self.t.shape).mean() for name in ("lever", "lever_left")]
        x = x + sensor[0] * np.cos(swept) - sensor[1] * np.sin(swept)
        y = y + sensor[0] * np.sin(swept) + sensor[1] * np.cos(swept)
        a, b = self.legs.T
        dx, dy = x[b] - x[a], y[b] - y[a]
        errors, self.names = [self.lengths - np.hypot(dx, dy)], ["length"]
        off = wrapped(self.directions - np.arctan2(dy, dx))  # of the swept axes
        if self.compass is not None:
            read = wrapped(self.compass + body["compass"] - swept[1:])
            mean = np.array([np.arctan2(np.nansum(np.sin(read[i:j])), np.nansum(np.cos(read[i:j]))) for i, j in self.legs])
            errors += [wrapped(off - mean), np.where(self.follows, np.r_[0.0, wrapped(np.diff(mean))], 0.0)]
            self.names += ["direction", "compass"]
        else:
            errors += [np.where(self.follows, np.r_[0.0, wrapped(np.diff(off))], 0.0)]
            self.names += ["direction"]
        if self.gyro is not None:
            said = np.r_[0.0, np.cumsum((1 + body["gyro_scale"]) * (np.nan_to_num(self.gyro) + body["gyro"]) * self.dt)]
            errors += [(said[b] - said[a]) - (swept[b] - swept[a])]
            self.names += ["gyro"]
        found = np.concatenate(errors)
        return found if self.scales is None else found / np.repeat(self.scales, len(self.legs))

    def _scale(self, plain, k):
        part = plain[k * len(self.legs):(k + 1) * len(self.legs)]
        return max(1.4826 * np.median(np.abs(part - np.median(part))), 1e-6) if len(part) else 1.0

    def column(self, effect, effects=(), coefficients=()):
        """What a unit of an effect does to all errors, beside others."""
        one = STEP / max(np.max(np.abs(effect.values)), 1e-9)
        changed = self.residuals([*effects, effect], [*coefficients, one]) - self.residuals(effects, coefficients)
        return changed / one


class Term:
    def __init__(self, channel, shape, values):
        self.channel, self.shape, self.values = channel, shape, np.nan_to_num(values)

    def text(self):
        return f"{self.channel} x {self.shape}"


def shapes_of(riddle):
    v = riddle.variables
    shapes = {"1": np.ones_like(v["t"]), "sign(speed)": v["sign(speed)"]}
    for name in ("speed", "turn_rate"):
        shapes |= {name: v[name], f"abs({name})": np.abs(v[name]), f"{name}^2": v[name] ** 2}
    shapes |= {"sign(turn_rate)": np.sign(np.where(np.abs(v["turn_rate"]) > 1e-3, v["turn_rate"], 0.0)),
               "sqrt(abs(turn_rate))": np.sqrt(np.abs(v["turn_rate"])), "speed*turn_rate": v["speed"] * v["turn_rate"]}
    for k in (1, 2, 4):
        angle = f"{k}*heading" if k > 1 else "heading"
        shapes |= {f"sin({angle})": np.sin(k * v["heading"]), f"cos({angle})": np.cos(k * v["heading"])}
    shapes |= {name: v[name] for name in ("x", "y", "t", "distance")}
    for share in (0.2, 0.35, 0.5, 0.65, 0.8):
        shapes[f"t>{share * v['t'][-1]:.0f}"] = 1.0 * (v["t"] > share * v["t"][-1])
        edge = np.quantile(np.abs(v["speed"][np.abs(v["speed"]) > 0.05]), share)
        shapes[f"max(0, speed-{edge:.2f})"] = np.maximum(0, v["speed"] - edge)
    shapes[f"exp(-t/{0.2 * v['t'][-1]:.0f})"] = np.exp(-v["t"] / (0.2 * v["t"][-1]))
    for name, one in riddle.covariates.items():
        shapes |= {name: one, f"{name}^2": one ** 2, f"{name}*speed": one * v["speed"],
                   f"{name}*abs(turn_rate)": one * np.abs(v["turn_rate"])}
    return shapes


def patches(riddle):
    """Bells about the landmarks, as wide as most of a leg."""
    v, wide = riddle.variables, 0.7 * float(np.median(riddle.lengths))
    for x, y in riddle.places:
        shape = f"exp(-((x-{x:.2f})^2+(y-{y:.2f})^2)/(2*{wide:.2f}^2))"
        yield shape, np.exp(-((v["x"] - x) ** 2 + (v["y"] - y) ** 2) / (2 * wide ** 2))


def library(riddle):
    """All effects that the baselines choose from: lists of terms of one channel (a sine and its cosine are one
    effect) with their columns; those that change nothing are left out."""
    channels = ["travel", "turn", "creep"] + (["compass"] if riddle.compass is not None else [])
    channels += ["gyro", "gyro_scale"] if riddle.gyro is not None else []
    if riddle.kind in ("differential", "skid-steer"):
        channels += ["left", "right", "difference"]
    shapes, events = shapes_of(riddle), ("starts", "spins", "arc_angle", "spin_angle")
    terms = [Term(channel, shape, values) for channel in channels for shape, values in shapes.items()]
    terms += [Term(channel, name, riddle.variables[name]) for channel in ("advance", "rotate") for name in events]
    plain = ["wheels", "drift", "lever", "lever_left", "sideways", "steer", "steer_gain"]
    plain += [f"wheel{k + 1}" for k in range(len(riddle.columns))] if riddle.kind in ("omni3", "mecanum", "wheels") else []
    terms += [Term(channel, "1", shapes["1"]) for channel in plain]
    terms += [Term("steer", "sign(speed)", shapes["sign(speed)"])]
    terms += [Term(channel, shape, values) for channel in ("wheels", "compass") if channel in [*channels, "wheels"]
              for shape, values in patches(riddle)]
    effects = []
    for one in terms:
        column = riddle.column(one)
        if not np.all(np.isfinite(column)) or np.linalg.norm(column) < 1e-6:
            continue
        sine = one.shape.startswith("cos") and effects and effects[-1][0][0].text() == \
            one.text().replace("cos", "sin", 1)
        if sine:
            effects[-1] = (effects[-1][0] + [one], np.column_stack([effects[-1][1], column]))
        else:
            effects.append(([one], column[:, None]))
    return effects


def refined(riddle, terms, rounds=5):
    """Coefficients by Gauss-Newton, for constants that are far off."""
    c = np.zeros(len(terms))
    for _ in range(rounds):
        J = np.column_stack([riddle.column(one, terms, c) for one in terms])
        c = c - np.linalg.lstsq(J, riddle.residuals(terms, c), rcond=None)[0]
    return c
