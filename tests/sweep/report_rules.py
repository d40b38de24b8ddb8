# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""What no report may say, of whatever recording: a rule is a function of a Report that yields what is
wrong. A report is what one call of a command printed, and the JSON that it wrote."""
import json
import math
import re
import statistics

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
LEAST_P = 1e-4   # of a fit that is called good: as build has it
SLIGHT = 1.1     # chi2/dof that is never held against a map


class Report:
    def __init__(self, command, text, err, written, known):
        self.command = command
        self.text = text
        self.err = err
        self.json = written
        self.known = known

    @property
    def first(self):
        """The sentence of the verdict."""
        lines = self.text.splitlines()
        if self.command.startswith("build"):
            return lines[1] if len(lines) > 1 else ""
        return lines[0] if lines else ""


def found(pattern, text, kind=float):
    """The groups of a pattern in a text as numbers, or None."""
    match = re.search(pattern, text)
    return tuple(kind(one) for one in match.groups()) if match else None


def p_of(chi2, dof):
    """Chance of so large a chi^2 (Wilson and Hilferty's approximation; good to some percent)."""
    if dof <= 0:
        return 1.0
    z = ((max(chi2, 0.0) / dof) ** (1 / 3) - (1 - 2 / (9 * dof))) / math.sqrt(2 / (9 * dof))
    return 1.0 - statistics.NormalDist().cdf(z)


def walk(value, path=""):
    """Every leaf of the JSON with its path."""
    if isinstance(value, dict):
        for key, one in value.items():
            yield from walk(one, f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        for one in value:
            yield from walk(one, path + "[]")
    else:
        yield path, value


# ----------------------------------------
# Of all commands.

VERDICTS = {
    "build": r"^(good|doubtful): \S", "compare": r"^(consistent|misfit)[:,] \S",
    "diagnose": r"^(missing: \S|nothing missing: \S|unexplained misfit[:,] \S|cannot tell: \S)",
    "discover": r"^(consistent|unexplained misfit): \S", "calibrate": r"^(not )?calibrated\b",
    "watch": r"^model (held|ceased to hold): \S",
    "check": r"^(nothing found: \S|\d+ findings?\b|\S+\.csv)", "fit": r"^\S+", "apply": r"^(\d+ poses, |warning: )\S",
    "umbmark": r"^((still )?worth correcting|doubtful|nothing (left )?to correct)[:,] \S", "adjust": r"^\S+ .*\S",
    "tape": r"^\S+ .*\S", "noise": r"^\S+ .*\S", "tour": r"^after \d+ tours?", "explore": r"^explored: \d"}


def has_a_verdict(report):
    pattern = VERDICTS[report.command.split()[0]]
    if not re.search(pattern, report.first):
        yield f"no sentence of a verdict: {report.first[:80]!r}"


def no_figure_is_missing(report):
    for line in report.text.splitlines():
        odd = re.search(r"(?<![\w.-])[-+]?(nan|inf|infinity|null)(?![\w-])", line, re.I)
        if odd:
            yield f"{odd.group()}: {line.strip()[:90]}"
        if re.search(r"(\+-|±)\s*(?![\s\d.])|\(\s*\)|(?<!the )(\+-|±)$|: *[,;]|\bby\s+m\b|, ,", line):
            yield f"a blank figure: {line.strip()[:90]}"
        if re.search(r"(?<![\w.])-0(\.0+)?(?![\d.e])", line):
            yield f"minus nothing: {line.strip()[:90]}"
        if re.search(r"\b(std::|0x[0-9a-f]{6,}|\{\}|\{:|%[sdf]\b)", line):
            yield f"insides: {line.strip()[:90]}"


def no_figure_is_beyond_reason(report):
    for path, value in walk(report.json):
        if isinstance(value, float) and abs(value) > 1e100 and not path.endswith("evidence"):
            yield f"{path} = {value:g}"
        name = path.rsplit(".", 1)[-1]
        if name.startswith("sd") and isinstance(value, (int, float)) and value < 0:
            yield f"{path} = {value:g}"
        if name in ("p_value", "p_adjusted", "probability", "share") and value is not None \
                and not isinstance(value, str) and not -1e-9 <= value <= 1 + 1e-9:
            yield f"{path} = {value}"
        if name in ("chi2", "dof") and value is not None and value < -1e-6:
            yield f"{path} = {value}"


def warnings_are_the_same(report):
    """What JSON warns of stands in the text (shortened or as the verdict), and the reverse."""
    flat = " ".join((report.text + " " + report.err).split())
    written = [one for path, one in walk(report.json) if path.split(".")[-1] == "warnings[]"]
    for warning in written:
        # Long words are cut in the middle: any long piece may stand for it.
        pieces = [" ".join(warning.split())[k:k + 40] for k in (0, 20, 40)]
        if not any(piece in flat for piece in pieces if piece):
            yield f"JSON alone warns: {warning[:90]}"
    told = len(re.findall(r"^warning: ", report.text, re.M))
    if "warnings" in report.json and told > len(written):
        yield f"the text has {told} warnings, JSON {len(written)}"


def instruments_are_not_recommended_twice(report):
    for article, name in re.findall(r"\b(an?) ((?:better )?\w+) would help", report.text):
        if name in ("gyro", "compass") and report.known.get(name):
            yield f"{article} {name} would help a robot that has one"
    for name, words in (("gyro", r"(drive|go on) without a gyro|has no gyro"),
                        ("compass", r"(has|have) no compass\b|without a compass, ")):
        if report.known.get(name) and re.search(words, report.text):
            yield f"no {name}, for a robot that has one"


TURNING = ("wheels", "gyro", "heading_per", "turn", "drift", "difference", "left", "right", "rotate",
           "steer")  # sources of noise that turn the robot


def shares_add_up(report):
    for budget in report.json.get("noise_budget") or []:
        total = sum(one["share"] for one in budget["shares"])
        if budget["shares"] and abs(total - 1.0) > 1e-6:
            yield f"shares of the noise come to {total:.4f}"
        for share, words in re.findall(r"(\d+) % is ([^,;]+)", budget["in_words"]):
            if int(share) > 100 or not words.strip():
                yield f"a share of {share} %"
        turning = sum(one["share"] for one in budget["shares"] if one["source"].startswith(TURNING))
        if "gyro would help" in budget["in_words"] and turning < 0.3:
            yield f"a gyro against what is no turning: {budget['in_words']}"


def no_sentence_says_nothing(report):
    """A size that is none: 1.0 times what is allowed, 0.0 % smaller."""
    for line in report.text.splitlines():
        if re.search(r"\b1\.0+ times (what|as)\b", line):
            yield f"as large as it should be, and told: {line.strip()[:90]}"
        if re.search(r"(?<![\d.])0(\.0+)? (%|times) (smaller|larger|too|more|less|as)", line):
            yield f"a size of nothing: {line.strip()[:90]}"
        if re.search(r"one of 0 recordings|\b1 (effects|warnings|findings|poses|runs|landmarks are) ", line):
            yield f"a number that is none: {line.strip()[:90]}"


# ----------------------------------------
# Of single commands.

def build_is_as_its_figures(report):
    if not report.command.startswith("build"):
        return
    said, text = report.json, report.text
    good = said["verdict"] == "good"
    if report.first.startswith("good") != good:
        yield f"text and JSON differ in the verdict: {said['verdict']}"
    if good == bool(said["warnings"]):
        yield f"{said['verdict']} with {len(said['warnings'])} warnings"
    chi2, dof = said.get("chi2"), said.get("dof")
    if good and chi2 is not None and dof and p_of(chi2, dof) < LEAST_P / 3 and chi2 > SLIGHT * 1.01 * dof:
        yield f"good, with chi2 {chi2:.1f} of {dof}"
    counts = found(r"^map of (\d+) landmarks? and (\d+) routes?", text, int)
    if counts and counts != (said["landmarks"], said["routes"]):
        yield f"headline {counts}, JSON {said['landmarks']}, {said['routes']}"
    if counts and counts[0] != len(said["positions"]):
        yield f"{counts[0]} landmarks, {len(said['positions'])} positions"
    left_out = found(r"sightings left out +(\d+)  of (\d+)", text, int)
    if left_out and left_out != (len(said["rejected"]), said["quality"]["sightings"]):
        yield f"left out {left_out}, JSON {len(said['rejected'])} of {said['quality']['sightings']}"
    if left_out:
        listed = len(re.findall(r"seen [\d.]+ m from where the map has it", text))
        more = found(r"and (\d+) more \(--json", text, int)
        if listed + (more[0] if more else 0) != left_out[0]:
            yield f"{left_out[0]} left out, {listed} listed"
    survey = said.get("survey")
    if good and survey and survey.get("contradicting"):
        yield "good, and the survey contradicts"
    if good and survey:
        extent = extent_of(said["positions"])
        if survey["rms_m"] > 0.1 * extent and extent > 0:
            yield f"good, {survey['rms_m']:.3f} m from the survey over {extent:.2f} m"
    if survey and "mirror" in text and survey["rms_m"] < 1e-3 * max(1e-9, extent_of(said["positions"])):
        yield "mirrored, and on the survey"


def extent_of(positions):
    places = [(one["x"], one["y"]) for one in positions.values()]
    if not places:
        return 0.0
    mx, my = (sum(one[k] for one in places) / len(places) for k in (0, 1))
    return math.sqrt(sum((x - mx) ** 2 + (y - my) ** 2 for x, y in places) / len(places))


def chi2_is_said_once(report):
    """chi2 and dof of the text are JSON's, and p is theirs."""
    if report.command not in ("compare", "diagnose"):
        return
    said = report.json
    told = re.search(rf"chi2 ({NUMBER}), dof (\d+)", report.text)
    if told and (told.group(1), int(told.group(2))) != (f"{said['chi2']:.1f}", said["dof"]):
        yield f"text {told.groups()}, JSON {said['chi2']}, {said['dof']}"
    p, expected = said["p_value"], p_of(said["chi2"], said["dof"])
    if report.command == "compare" and said["dof"] > 10 and p is not None \
            and abs(p - expected) > 0.02 + 0.2 * expected:
        yield f"p {p:.3g} of chi2 {said['chi2']:.1f} and dof {said['dof']}, expected {expected:.3g}"


def compare_is_as_its_figures(report):
    if report.command != "compare":
        return
    said = report.json
    if not report.first.startswith(said["verdict"]):
        yield f"text {report.first[:20]!r}, JSON {said['verdict']}"
    if said["verdict"] == "consistent":
        if p_of(said["chi2"], said["dof"]) < said["level"] / 2 and said["dof"] > 5:
            yield f"consistent, with chi2 {said['chi2']:.1f} of {said['dof']}"
        if any(one["p_adjusted"] < said["level"] for one in said["trends"] if one["p_adjusted"] < said["level"] / 2):
            yield "consistent, with a significant trend"
        if re.search(r"is too large|misfit|Where the residuals go", report.text):
            yield "consistent, and what speaks against it"
    times = found(r"errors are ([\d.]+) times", report.first)
    if times and abs(times[0] - math.sqrt(said["chi2"] / max(1, said["dof"]))) > 0.051:
        yield f"{times[0]} times by the sentence, chi2 {said['chi2']:.1f} of {said['dof']}"
    counts = found(r"; (\d+) legs?, (\d+) landmarks?", report.text, int)
    if counts and counts != (said["legs"], said["landmarks"]):
        yield f"text {counts}, JSON {said['legs']}, {said['landmarks']}"
    held = found(r"^  (\d+) legs? not used in the fit end", report.text, int) or \
        found(r"\n  (\d+) legs? not used in the fit end", report.text, int)
    if held and held[0] != said["heldout"]["legs"]:
        yield f"{held[0]} held-out legs, JSON {said['heldout']['legs']}"


def diagnosis_is_as_its_figures(report):
    if report.command != "diagnose":
        return
    said = report.json
    if said["verdict"] == "missing":
        if f"missing: {said['missing']}" not in report.text:
            yield f"JSON misses {said['missing']!r}, the text another"
        named = [one for one in said["candidates"] if one["effect"] == said["missing"]]
        if not named or named[0]["status"] != "missing":
            yield f"{said['missing']!r} is missing, and in the table it is not"
        told = found(r"legs end ([\d.]+) (?:mm|m) off, with (?:it|them) ([\d.]+) ", report.text)
        if told and told[1] > 1.5 * told[0] and "predicted worse" not in report.text:
            yield f"missing, and predicts much worse: {told}"
    else:
        if said["missing"]:
            yield f"{said['verdict']}, and missing {said['missing']!r}"
        if any(one["status"] == "missing" for one in said["candidates"]):
            yield f"{said['verdict']}, and an effect with status missing"
    if said["verdict"] == "nothing missing" and said["dof"] > 5 and \
            not said["noise_estimated"]["changed"] and \
            p_of(said["chi2"], said["dof"]) < said["level"] / 3:
        yield f"nothing missing, with chi2 {said['chi2']:.1f} of {said['dof']}"
    tried = found(r"of (\d+) effects tried", report.text, int)
    if tried and tried[0] != said["tried"]:
        yield f"{tried[0]} tried by the sentence, {said['tried']} by JSON"
    total = sum(one["probability"] for one in said.get("explanations", []))
    if total > 1 + 1e-6:
        yield f"probabilities of the sets come to {total:.3f}"


def discovery_is_as_its_figures(report):
    if report.command != "discover":
        return
    said = report.json
    if not report.first.startswith(said["verdict"]):
        yield f"text {report.first[:20]!r}, JSON {said['verdict']}"
    counted = re.match(r"[\w ]+: (one|\d+) effects? found", report.first)
    named = re.findall(r"^  (?!model|as given|\+ |-)(.+?): ", report.text.split("\n\n")[0], re.M)
    if counted:
        number = 1 if counted.group(1) == "one" else int(counted.group(1))
        if number != len(said["effects"]) or number != len(named):
            yield f"{number} found, {len(named)} listed, {len(said['effects'])} in JSON"
    elif said["effects"] and "nothing found" in report.first:
        yield "nothing found, and effects in JSON"
    last = said["steps"][-1]
    if said["verdict"] == "consistent" and not said["noise_estimated"]["changed"] and last["dof"] > 5 \
            and p_of(last["chi2"], last["dof"]) < 0.05 / 3:
        yield f"consistent, with chi2 {last['chi2']:.1f} of {last['dof']}"
    for step in said["steps"]:
        if f"{step['chi2']:.1f}" not in report.text:
            yield f"chi2 {step['chi2']:.1f} of a step is not in the text"


def findings_are_counted(report):
    if report.command != "check":
        return
    count = len(report.json["findings"])
    if (count == 0) != report.text.startswith("nothing found"):
        yield f"{count} findings, and the text begins {report.first[:40]!r}"
    for one in report.json["findings"]:
        if one["kind"] not in report.text or not one["evidence"] or not one["remedy"]:
            yield f"a finding that is not told: {one['kind']}"


def calibration_is_as_its_figures(report):
    if report.command != "calibrate":
        return
    said = report.json
    for key in ("E_d", "E_b", "E_s"):
        told = found(rf"^  {key} .* ({NUMBER})  ±", report.text) or \
            found(rf"\n  {key} .* ({NUMBER})  ±", report.text)
        if told and said[key] is not None and abs(told[0] - said[key]) > 0.0051 * max(1, abs(said[key])):
            yield f"{key} {told[0]}, JSON {said[key]}"
    told = found(rf"chi2/dof ({NUMBER}) with (\d+)", report.text)
    if told and said["dof"] and abs(told[0] - said["chi2"] / said["dof"]) > 0.006 * max(1, told[0]):
        yield f"chi2/dof {told[0]}, JSON {said['chi2'] / said['dof']}"
    if said["dof"] > 20 and said["chi2"] > 2.1 * said["dof"] and "errors are" not in report.first:
        yield f"calibrated without a word, with chi2/dof {said['chi2'] / said['dof']:.1f}"


def watch_is_as_its_figures(report):
    if report.command != "watch":
        return
    ceased = report.text.startswith("model ceased")
    if ceased != (report.json["verdict"] == "alarm"):
        yield f"text {report.first[:30]!r}, JSON {report.json['verdict']}"
    told = found(r"watched +(\d+) legs?", report.text, int)
    if told and told[0] != report.json["legs"]:
        yield f"{told[0]} legs, JSON {report.json['legs']}"


RULES = [has_a_verdict, no_figure_is_missing, no_figure_is_beyond_reason, warnings_are_the_same,
         instruments_are_not_recommended_twice, shares_add_up, no_sentence_says_nothing,
         build_is_as_its_figures, chi2_is_said_once, compare_is_as_its_figures,
         diagnosis_is_as_its_figures, discovery_is_as_its_figures, findings_are_counted,
         calibration_is_as_its_figures, watch_is_as_its_figures]


def broken_rules(report):
    for rule in RULES:
        try:
            for what in rule(report):
                yield rule.__name__, what
        except (KeyError, TypeError, ValueError) as error:
            yield rule.__name__, f"cannot be read: {error!r}"


def rules_across(reports):
    """Figures that several commands say of the same recording and model."""
    chi2 = {}
    for report in reports:
        if report.json.get("noise_estimated", {}).get("changed"):
            continue  # of a model with other noise
        if report.command in ("compare", "diagnose"):
            chi2[report.command] = (report.json["chi2"], report.json["dof"])
        elif report.command == "discover":
            first = report.json["steps"][0]
            chi2["discover"] = (first["chi2"], first["dof"])
    for one, (value, dof) in chi2.items():
        for other, (value2, dof2) in chi2.items():
            if one < other and dof == dof2 and abs(value - value2) > 1e-3 * (1 + abs(value)):
                yield "across", f"{one} has chi2 {value:.2f} of {dof}, {other} {value2:.2f} of {dof2}"


def read_json(path):
    with open(path) as stream:
        return json.load(stream)
