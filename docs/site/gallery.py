#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# The gallery: a page for every effect that `trussmap effects` lists. What the command knows is asked
# of it; what happens on a robot stands in the effect's file (src/effects/catalogue, [gallery]); the
# picture is that of a simulated recording, diagnosed when the site is built. Usage: gallery.py --check COMMAND
import hashlib
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.dont_write_bytecode = True  # nothing is left beside the sources

import effects_table
from pages import TOP, slug_of

EFFECTS = TOP / "src/effects/catalogue"
WORLD = "--mesh 4x4 --uneven --tours 2"
GROUPS = ("Wheels", "Turning", "Floor and slip", "Gears and encoders", "Gyro", "Compass", "Sightings",
          "Truth and fixes", "Loops", "Other drives")
FIELDS = ("group", "happens", "look", "effect")

# What a row's motion or reading becomes.
CHANNELS = {
    "travel": r"\mathrm{d}s' = \mathrm{d}s\,(1+g)",
    "left": r"\mathrm{d}L' = \mathrm{d}L\,(1+g)",
    "right": r"\mathrm{d}R' = \mathrm{d}R\,(1+g)",
    "wheels": r"\mathrm{d}L' = \mathrm{d}L\,(1+g), \qquad \mathrm{d}R' = \mathrm{d}R\,(1+g)",
    "difference": r"\mathrm{d}L' = \mathrm{d}L\,(1-\tfrac{g}{2}), \qquad "
                  r"\mathrm{d}R' = \mathrm{d}R\,(1+\tfrac{g}{2})",
    "turn": r"\mathrm{d}\theta' = \mathrm{d}\theta\,(1+g)",
    "drift": r"\mathrm{d}\theta' = \mathrm{d}\theta + g\,\mathrm{d}t",
    "advance": r"\mathrm{d}s' = \mathrm{d}s + g",
    "rotate": r"\mathrm{d}\theta' = \mathrm{d}\theta + g",
    "creep": r"\text{slip to the left} = g\,\mathrm{d}s",
    "compass": r"\text{reading} = \theta + g",
    "bearing": r"\text{reading} = \text{bearing} + g",
    "sighting_yaw": r"\text{reading} = \text{yaw} + g",
    "range": r"\text{reading} = \text{range} + g",
    "range_scale": r"\text{reading} = \text{range}\,(1+g)",
    "gyro": r"\text{reading} = \dot\theta + g",
    "gyro_scale": r"\dot\theta = \text{reading}\,(1+g)",
    "lever": r"\text{sensor} = \text{axle} + g\ \text{ahead}",
    "lever_left": r"\text{sensor} = \text{axle} + g\ \text{to the left}",
    "delay": r"t_{\text{stamp}} = t + g",
    "truth_heading": r"\theta_{\text{truth}} = \theta + g",
    "antenna": r"\text{antenna} = \text{axle} + g\ \text{ahead}",
    "antenna_left": r"\text{antenna} = \text{axle} + g\ \text{to the left}",
    "scanner": r"\text{scanner} = \text{axle} + g\ \text{ahead}",
    "scanner_left": r"\text{scanner} = \text{axle} + g\ \text{to the left}",
    "scanner_yaw": r"\theta_{\text{scanner}} = \theta + g",
    "fix_delay": r"t_{\text{stamp}} = t + g",
    "sideways": r"\mathrm{d}s'_{\text{left}} = \mathrm{d}s_{\text{left}}\,(1+g)",
    "steer": r"\beta' = \beta + g",
    "wheel_left": r"y_{\text{measured}} = y_{\text{stated}} + g",
    "steer_left": r"y_{\text{steered}} = y_{\text{stated}} + g",
    "other_axle": r"\mathrm{d}w' = (1-g)\,\mathrm{d}w + g\,\mathrm{d}w_{\text{other axle}}",
    "steer_gain": r"\beta' = \beta\,(1+g)",
    **{f"wheel{k}": rf"\mathrm{{d}}w_{k}' = \mathrm{{d}}w_{k}\,(1+g)" for k in range(1, 7)},
}


def effect_texts():
    """What the gallery says of each effect."""
    files = [tomllib.loads(path.read_text()) for path in sorted(EFFECTS.glob("*.toml"))]
    return {one["name"]: one["gallery"] for one in files}


def formula_of(shape):
    """A shape as TeX: names upright, products without a star."""
    text = shape.replace("{}", "COLUMN")
    text = re.sub(r"\{([xy])\}", r"\1_0", text)  # the place, not the robot's
    text = re.sub(r"\{(\w+)\}", r"\1", text)
    text = re.sub(r"\b(sin|cos|tan|exp|log|max|min)\b", r"\\\1 ", text)
    text = re.sub(r"\b(abs|sign|sqrt)\b", r"\\operatorname{\1}", text)
    text = re.sub(r"(?<![\\\w{])([a-z_]{2,}|COLUMN)\b",
                  lambda m: r"\text{" + m[1].replace("_", r"\_") + "}", text)
    text = re.sub(r"\bv0\b", "v_0", text)
    return text.replace("*", r"\,")


def picture_title(path):
    return re.search(r"<title>(.*?)</title>", path.read_text())[1]


def sum_of(shapes):
    if len(shapes) == 1:
        return "c" if shapes[0] == "1" else rf"c\,{factor(shapes[0])}"
    return " + ".join(rf"c_{k}\,{factor(shape)}" for k, shape in enumerate(shapes, 1))


def factor(shape):
    """In brackets where it is a sum."""
    depth = 0
    for char in shape:
        depth += {"(": 1, ")": -1}.get(char, 0)
        if depth == 0 and char in "+-":
            return rf"\left({formula_of(shape)}\right)"
    return formula_of(shape)


class Gallery:
    def __init__(self, command):
        self.command = Path(command).resolve()
        self.entries = effects_table.effects_of(self.command)
        self.texts = effect_texts()
        self.slugs = {entry["name"]: slug_of(entry["name"]) for entry in self.entries}
        self.drawn = "--drawing" in self.run(["effects", "--help"])

    def run(self, words, folder=None):
        ran = subprocess.run([self.command, *words], cwd=folder, text=True, capture_output=True,
                             env={**os.environ, "NO_COLOR": "1"})
        if ran.returncode != 0:
            raise RuntimeError(f"trussmap {shlex.join(map(str, words))}: {ran.stderr.strip()}")
        return ran.stdout

    def faults(self):
        """What keeps an effect of the catalogue from having its page."""
        names = [entry["name"] for entry in self.entries]
        found = [f"{name} has no file in {EFFECTS.relative_to(TOP)}" for name in names
                 if name not in self.texts]
        found += [f"{EFFECTS.relative_to(TOP)} has {name}, which the command has not"
                  for name in self.texts if name not in names]
        for name, text in self.texts.items():
            found += [f"{name} has no {field}" for field in FIELDS if not text.get(field)]
            if text.get("group") not in GROUPS:
                found.append(f"{name}: {text.get('group')} is no group, expected one of "
                             + ", ".join(GROUPS))
        found += [f"{entry['name']}: no formula for channel {entry['channel']}"
                  for entry in self.entries if entry["channel"] not in CHANNELS]
        if not effects_table.is_right(self.entries):
            found.append("the table in docs/effects.md is not that of the catalogue: run "
                         "docs/site/effects_table.py COMMAND")
        if len(set(self.slugs.values())) != len(names):
            found.append("two effects have the same page")
        if not names:
            found.append("the command lists no effects")
        return found

    # A recording to try, and what a diagnosis says of it.

    def commands(self, name):
        """The lines that make the recording rec."""
        text = self.texts[name]
        if "recording" in text:
            return text["recording"].strip().splitlines()
        options = text.get("drive", "")
        world = WORLD if "--mesh" not in options else WORLD.replace("--mesh 4x4 ", "")
        words = f"trussmap simulate {world} {options}".split()
        return [" ".join(words) + f' --effect "{text["effect"]}" --out rec']

    def signature(self, entry, folder):
        """Simulates and diagnoses; the diagnosis, and the picture of it. Kept from build to build."""
        name = entry["name"]
        lines = self.commands(name)
        key = hashlib.sha256(json.dumps([self.hash, lines, 3]).encode()).hexdigest()
        kept = folder / "key"
        if not (kept.exists() and kept.read_text() == key):
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            with tempfile.TemporaryDirectory(prefix="trussmap-effect-") as scratch:
                place = Path(scratch)
                (place / "trussmap").symlink_to(self.command)
                script = "\n".join(["trussmap() { ./trussmap \"$@\" --threads 1; }"] + lines + [
                    "trussmap diagnose rec --model rec/model.toml --json diagnosis.json --plots plots "
                    "> diagnosis.txt"])
                ran = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=place, text=True,
                                     capture_output=True, env={**os.environ, "NO_COLOR": "1"})
                if ran.returncode != 0:
                    raise RuntimeError(f"{name}: {ran.stderr.strip() or ran.stdout.strip()}")
                shutil.copy(place / "diagnosis.json", folder)
                shutil.copy(place / "diagnosis.txt", folder)
                shutil.copytree(place / "plots", folder / "plots")
                if self.drawn:
                    self.run(["effects", name, "--drawing", folder / "drawing.svg"])
            kept.write_text(key)
        return {"json": json.loads((folder / "diagnosis.json").read_text()),
                "text": (folder / "diagnosis.txt").read_text(), "folder": folder}

    # Pages.

    def page(self, entry, signature, stage):
        name = entry["name"]
        text = self.texts[name]
        lines = [f"# {name}", "", text["happens"].strip(), "",
                 "| | |", "|---|---|",
                 f"| in a model, in `--effect` | `{entry['in_full']}` |",
                 f"| cause | {entry['cause']} |",
                 f"| what helps | {entry['remedy']} |",
                 f"| acts on | {entry['acts_on']} (channel [`{entry['channel']}`](../effects.md#channels)) |",
                 f"| goes with | {', '.join(f'`{one}`' for one in entry['shape'])} |"]
        if entry["column"]:
            also = "".join(f" or `{one}`" for one in entry["also_of"])
            lines.append(f"| `COLUMN` | a further column of `drive.csv`{also} |")
        for one in entry["parameters"]:
            usual = f", about {one['usual']:g}" if one["usual"] else ""
            lines.append(f"| `{one['name']}` | {one['unit']}{usual}; sought by `diagnose` |")
        lines.append(f"| unit of a coefficient | {entry['unit'] or 'none'} |")
        if entry["detectable"]:
            lines.append(f"| seen from about | {entry['detectable']:g} {entry['channel_unit']} on "
                         "(60 legs of 5 m with survey and compass) |")
        lines += ["", "## Formula", "", f"$${CHANNELS[entry['channel']]}, \\qquad "
                  f"g = {sum_of(entry['shape'])}$$", ""]
        if signature:
            lines += self.shown(entry, signature, stage)
        lines += ["## What to look at on the robot", "", text["look"].strip(), ""]
        if entry.get("drive"):
            lines += ["## What to drive to be sure", "", entry["drive"], ""]
        lines += ["## A recording to try", "", "```sh", *self.commands(name),
                  "trussmap diagnose rec --model rec/model.toml --html page.html", "```", ""]
        if signature:
            first = signature["text"].split("\n\n")[0].strip().splitlines()
            lines += ["It says:", "", "```text", *first, "```", ""]
        return "\n".join(lines)

    def shown(self, entry, signature, stage):
        """Picture, look-alikes, and the drive that tells them apart, as this recording has them."""
        lines = []
        best = self.found(entry, signature)
        picture = signature["folder"] / "plots" / "effect-1.svg"
        drawing = signature["folder"] / "drawing.svg"
        slug = self.slugs[entry["name"]]
        if drawing.exists():
            stage.copy(drawing, f"gallery/{slug}-drawing.svg")
            lines += [f"![Drawing of {entry['name']}]({slug}-drawing.svg)", ""]
        if picture.exists():
            stage.copy(picture, f"gallery/{slug}.svg")
            lines += ["## What it looks like", "",
                      "The error of the [recording below](#a-recording-to-try): points as it shows them, with 95 % "
                      "intervals; the line as the diagnosis found it; dashed what looks nearly the same.", "",
                      f"![{picture_title(picture)}: the error of the recording]({slug}.svg)", ""]
        route_map = signature["folder"] / "plots" / "map-1.svg"
        if route_map.exists():
            stage.copy(route_map, f"gallery/{slug}-map.svg")
            lines += ["On the map: routes coloured by how far their legs end off, as long as the model lacks the "
                      "effect.", "", f"![Map of the recording]({slug}-map.svg)", ""]
        lines += ["## What looks the same", ""]
        rivals = best["indistinguishable_from"]
        if rivals:
            lines += ["In this recording:", "", "| effect | cosine |", "|---|---|"]
            lines += [f"| {self.linked(one['effect'], one)} | {one['cosine']:.3f} |" for one in rivals]
            drive = signature["json"].get("next_drive")
            if drive:
                lines += ["", f"**To tell them apart:** {drive}."]
        else:
            lines.append("In this recording, nothing that was tried.")
        known = self.known_look_alikes(entry["name"])
        if known:
            lines += ["", "What is known of it:", "", "| pair | what to drive, or what decides |", "|---|---|", *known]
        return lines + [""]

    def linked(self, name, one):
        entry = name.split(" (")[0]
        shape = ", ".join(f"`{text}`" for text in one["shape"])
        if entry in self.slugs:
            return f"[{name}]({self.slugs[entry]}.md)"
        return f"`{one['channel']}` × {shape}"

    def known_look_alikes(self, name):
        """Rows of docs/effects.md that speak of it."""
        section = (TOP / "docs/effects.md").read_text().split("\n## Look-alikes", 1)[1].split("\n## ", 1)[0]
        rows = re.findall(r"^(\| .*`.* \|.*\|)$", section, re.M)
        return [row for row in rows if f"`{name}`" in row]

    def found(self, entry, signature):
        """The candidate that is this effect, or that looks the same: else the recording is no good one to try."""
        candidates = signature["json"]["candidates"]
        for best in candidates[:3]:
            alike = [best, *best["indistinguishable_from"]]
            if any(one["effect"].split(" (")[0] == entry["name"] for one in alike):
                return best
        raise RuntimeError(f"{entry['name']}: its recording names {candidates[0]['effect']}")

    def index(self):
        lines = ["# Gallery of effects", "",
                 "Every effect of the [catalogue](../effects.md#catalogue): what happens, how it shows, what looks the "
                 "same, and a recording to try. An effect of your own is as good as one of these "
                 "([effects](../effects.md#an-effect-of-your-own)).", ""]
        for group in GROUPS:
            lines += [f"## {group}", "", "| effect | what causes it | what helps |", "|---|---|---|"]
            lines += [f"| [{one['name']}]({self.slugs[one['name']]}.md) | {one['cause']} | {one['remedy']} |"
                      for one in self.of_group(group)]
            lines.append("")
        names = [self.slugs[one["name"]] for group in GROUPS for one in self.of_group(group)]
        return "\n".join(lines) + "\n```{toctree}\n:hidden:\n\n" + "\n".join(names) + "\n```\n"

    def of_group(self, group):
        return [one for one in self.entries if self.texts[one["name"]]["group"] == group]


def write(stage, command, work):
    gallery = Gallery(command)
    faults = gallery.faults()
    if faults:
        sys.exit("\n".join(faults))
    gallery.hash = hashlib.sha256(gallery.command.read_bytes()).hexdigest()

    def one_page(entry):
        try:
            signature = gallery.signature(entry, work / gallery.slugs[entry["name"]])
            return gallery.page(entry, signature, stage)
        except RuntimeError as error:
            return error

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        pages = list(pool.map(one_page, gallery.entries))
    errors = [str(one) for one in pages if isinstance(one, RuntimeError)]
    if errors:
        sys.exit("gallery:\n" + "\n".join(errors))
    for entry, page in zip(gallery.entries, pages):
        stage.write(f"gallery/{gallery.slugs[entry['name']]}", page)
    stage.write("gallery/index", gallery.index())


def check(command):
    """Every effect of the catalogue has its page, and no other: the test, which builds no site."""
    gallery = Gallery(command)
    faults = gallery.faults()
    for entry in gallery.entries if not faults else []:
        page = gallery.page(entry, None, None)
        if entry["name"] not in page or "$$" not in page:
            faults.append(f"{entry['name']}: its page is empty")
        if f"({gallery.slugs[entry['name']]}.md)" not in gallery.index():
            faults.append(f"{entry['name']} is not in the gallery's index")
    print("\n".join(faults) or f"{len(gallery.entries)} effects, each with its page")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] != "--check":
        sys.exit("usage: gallery.py --check COMMAND")
    check(sys.argv[2])
