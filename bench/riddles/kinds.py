# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""What riddles may hide: robots, effects of the catalogue, formulas that it does not have, gross constants."""
import math

# Kind: how many of the 200.
KINDS = {"single": 40, "double": 40, "triple": 20, "off-catalogue": 30, "rough": 20, "gross": 20,
         "none": 15, "none, rough": 15}

DRIVES = ["differential", "skid-steer", "differential", "tricycle", "differential", "ackermann",
          "differential", "omni3", "mecanum", "wheels"]
TWO_SIDES = ("differential", "skid-steer")
STEERING = ("tricycle", "ackermann")
SIDEWAYS = ("omni3", "mecanum", "wheels")
WHEELS = {"omni3": 3, "mecanum": 4, "wheels": 4}
ROUGH = ["half", "memory", "haze", "tails", "floor", "half,haze", "memory,tails"]


def rough(has):
    """Kinds of rough noise that concern this robot."""
    return [one for one in ROUGH if has["compass"] or "haze" not in one]


def world(draw, turn):
    """A robot and its world, as arguments of `simulate`, and what it has. `turn` chooses the drive, so that all take
    their turns within a kind."""
    chance = lambda share: draw.random() < share
    columns, rows = draw.choice([(4, 4), (5, 4), (5, 5), (6, 4)])
    has = {"drive": DRIVES[turn % len(DRIVES)], "compass": chance(0.65), "gyro": chance(0.35),
           "survey": chance(0.9), "overrun": chance(0.25), "fixes": chance(0.15), "loops": chance(0.15),
           "markers": chance(0.15), "tours": draw.choice([2, 3]), "ramp": chance(0.5),
           "sees": draw.choices(["", "range-sensor", "beacons", "camera"], [0.64, 0.12, 0.12, 0.12])[0],
           "spacing": round(draw.uniform(3.5, 6.0), 1)}
    has["extent"] = [has["spacing"] * (columns - 1), has["spacing"] * (rows - 1)]
    arguments = ["--mesh", f"{columns}x{rows}", "--spacing", has["spacing"], "--uneven", "--rests",
                 "--drive", has["drive"], "--full-turns", draw.choice([0, 1, 2]),
                 "--speeds", f"0.25,{draw.uniform(0.7, 1.1):.2f}",
                 "--wheel-noise", round(draw.uniform(0.002, 0.005), 4),
                 "--compass-noise", round(draw.uniform(0.01, 0.04), 3),
                 "--overrun", 0.4 if has["overrun"] else 0]
    for word in ("gyro", "loops", "markers"):
        arguments += [f"--{word}"] if has[word] else []
    arguments += ["--ramp", 0.5] if has["ramp"] else []
    arguments += ["--fixes", 0.5] if has["fixes"] else []
    arguments += [f"--{has['sees']}"] if has["sees"] else []
    arguments += [] if has["compass"] else ["--no-compass"]
    arguments += [] if has["survey"] else ["--no-survey"]
    return [str(one) for one in arguments], has


def place(draw, has, low=0.15, high=0.85):
    return [draw.uniform(low, high) * side for side in has["extent"]]


def catalogue(draw, has):
    """Names of the catalogue that this robot could show, in any order."""
    drive = has["drive"]
    x, y = place(draw, has)
    spot = f"(x={x:.1f}, y={y:.1f}, r={has['spacing'] * draw.uniform(0.6, 1.0):.1f})"
    names = ["wheelbase", "travel scale", "wheel scale", "constant creep", "cross-slope creep", "slope",
             "centrifugal side-slip", "slip with speed", "loss per start", "arc loss", "spin loss", "turn scrub",
             "turn asymmetry", "twist per spin", "load on both wheels (payload_kg)", "tyre drift (distance)",
             "tyre drift (t)", "tyre drift (temperature_C)", f"slippery patch {spot}", "lever arm",
             "lever arm to the left"]
    names += ["heading drift"] if drive != "ackermann" else []
    if drive in TWO_SIDES:
        names += ["wheel diameter ratio", "load on one wheel (payload_kg)",
                  f"missed ticks (v0={draw.uniform(0.4, 0.6):.2f})", "backlash twist",
                  f"missed ticks of the right wheel (v0={draw.uniform(0.4, 0.6):.2f})"]
        names += ["sampling skew"] if has["ramp"] else []
    if drive in STEERING:
        names += ["steering offset", "steering gain", "steering offset by direction", "angle read beside the middle"]
    names += [f"radius of wheel {k + 1}" for k in range(WHEELS.get(drive, 0))]
    names += ["roller slip"] if drive in SIDEWAYS else []
    if has["compass"]:
        names += ["compass offset", "hard iron", "soft iron", "compass lag", "motor current",
                  "compass disturbance (lights)", f"local magnetic anomaly {spot}"]
    names += ["gyro bias", "gyro scale", "gyro asymmetry", "gyro temperature drift (temperature_C)"] if has["gyro"] else []
    names += ["range bias", "range scale"] if has["sees"] in ("range-sensor", "beacons") else []
    names += ["bearing offset"] if has["sees"] in ("range-sensor", "camera") else []
    names += ["antenna ahead of the axle", "antenna beside the axle", "fix delay"] if has["fixes"] else []
    names += ["scanner ahead of the axle", "scanner turned"] if has["loops"] else []
    names += ["yaw offset"] if has["markers"] else []
    names += ["sighting delay"] if has["overrun"] else []
    draw.shuffle(names)
    return names


def formulas(draw, has, duration):
    """Effects that no catalogue has, in any order. `duration` [s] is of the part that the riddle shows."""
    seconds = lambda low, high: round(duration * draw.uniform(low, high))

    def edge():
        angle = draw.uniform(-math.pi, math.pi)
        a, b = math.cos(angle), math.sin(angle)
        x, y = place(draw, has, 0.33, 0.67)
        return f"{a:.3f}*x+({b:.3f})*y>({a * x + b * y:.2f})"

    def wave():
        angle = draw.uniform(-math.pi, math.pi)
        k = 2.0 * math.pi / (max(has["extent"]) * draw.uniform(0.4, 1.2))
        return f"sin({k * math.cos(angle):.4f}*x+({k * math.sin(angle):.4f})*y+({draw.uniform(-3.0, 3.0):.2f}))"

    texts = [
        # thresholds and levels
        f"travel x max(0, speed-{draw.uniform(0.4, 0.65):.2f})", f"travel x payload_kg>{draw.uniform(6, 14):.1f}",
        f"turn x max(0, abs(turn_rate)-{draw.uniform(0.4, 0.7):.2f})", f"creep x speed>{draw.uniform(0.4, 0.65):.2f}",
        f"turn x turn_rate^2/({draw.uniform(0.1, 0.3):.2f}+turn_rate^2)",
        # powers
        "travel x speed^2", "turn x turn_rate^2", "wheels x payload_kg^2", "turn x sqrt(abs(turn_rate))",
        # exponentials
        f"travel x exp(-t/{seconds(0.08, 0.3)})", f"turn x exp(-t/{seconds(0.08, 0.3)})",
        f"wheels x 1-exp(-t/{seconds(0.08, 0.3)})",
        # products
        "travel x payload_kg*speed", "turn x payload_kg*abs(turn_rate)", "creep x payload_kg*turn_rate",
        # the floor
        f"travel x {wave()}", f"creep x {wave()}", f"wheels x {edge()}", f"creep x {edge()}", f"turn x {edge()}",
        "travel x sin(4*heading); cos(4*heading)",
        # changes in time
        f"turn x t>{seconds(0.3, 0.7)}", f"travel x t>{seconds(0.3, 0.7)}", f"creep x t>{seconds(0.3, 0.7)}",
    ]
    if has["compass"]:
        texts += ["compass x sin(4*heading); cos(4*heading)", "compass x payload_kg*speed", f"compass x {wave()}",
                  f"compass x t>{seconds(0.3, 0.7)}"]
    draw.shuffle(texts)
    return texts


def constants(draw, has):
    """Names of constants that may be grossly wrong, in any order."""
    names = ["wheelbase", "wheel scale"]
    if has["drive"] == "differential":
        names += ["left x 1", "right x 1"]
    if has["drive"] in STEERING:
        names += ["steering gain"]
    names += [f"radius of wheel {draw.randint(1, WHEELS[has['drive']])}"] if has["drive"] in WHEELS else []
    names += ["gyro scale"] if has["gyro"] else []
    draw.shuffle(names)
    return names
