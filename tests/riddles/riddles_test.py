#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Three riddles of bench/riddles: perfect answers are right, none and exchanged ones are wrong.

Usage: tests/riddles/riddles_test.py --command build/trussmap
"""
import argparse
import csv
import filecmp
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

BENCH = pathlib.Path(__file__).resolve().parents[2] / "bench" / "riddles"
NOTHING, ONE, OTHER = "001", "002", "003"  # a riddle without effect, and two with one
sys.path.insert(0, str(BENCH))


class Riddles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.scratch.name) / "out"
        cls.make(cls.out, "1..3")
        cls.truth = {name: json.loads((cls.out / "truth" / f"{name}.json").read_text()) for name in (NOTHING, ONE, OTHER)}

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def run_script(cls, script, *arguments):
        return subprocess.run([sys.executable, BENCH / script, *map(str, arguments)], capture_output=True, text=True)

    @classmethod
    def make(cls, out, seeds):
        ran = cls.run_script("make_riddles.py", out, "--command", COMMAND, "--seeds", seeds)
        if ran.returncode != 0:
            raise AssertionError(ran.stderr)

    def answers(self, rows):
        file = pathlib.Path(self.scratch.name) / "answers.csv"
        with open(file, "w", newline="") as stream:
            writer = csv.writer(stream)
            writer.writerow(["riddle", "class", "effect", "coefficients", "alternatives"])
            writer.writerows(rows)
        return file

    def score(self, rows, seeds="1..3"):
        """The row of each riddle."""
        each = pathlib.Path(self.scratch.name) / "each.csv"
        ran = self.run_script("score.py", self.out, self.answers(rows), "--command", COMMAND, "--each", each,
                              "--seeds", seeds)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        with open(each, newline="") as stream:
            return {row["riddle"]: row for row in csv.DictReader(stream)}

    def true_row(self, name, of=None, times=1.0):
        one = self.truth[of or name]["effects"][0]
        return [name, "effect", one["name"], " ".join(str(times * c) for c in one["coefficients"]), ""]

    def test_perfect_answers_are_right(self):
        scores = self.score([[NOTHING, "nothing", "", "", ""], self.true_row(ONE), self.true_row(OTHER)])
        for name, row in scores.items():
            self.assertEqual(row["class right"], "True", name)
            self.assertEqual(row["false"], "0", name)
        for name in (ONE, OTHER):
            for key in ("all found", "form right", "size right", "listed"):
                self.assertEqual(scores[name][key], "True", key)
            self.assertLess(float(scores[name]["left"]), 1e-6)
            self.assertGreater(float(scores[name]["before"]), 1e-3)

    def test_no_answers_are_wrong(self):
        for name, row in self.score([]).items():
            self.assertEqual(row["class right"], "False", name)
            self.assertEqual(row["all found"], "False", name)
            self.assertEqual(row["left"], row["before"], name)

    def test_exchanged_answers_are_false_alarms(self):
        scores = self.score([self.true_row(NOTHING, ONE), self.true_row(ONE, OTHER), self.true_row(OTHER, ONE)])
        for name, row in scores.items():
            self.assertEqual(row["false"], "1", name)
            self.assertEqual(row["all found"], "False", name)
        self.assertEqual(scores[NOTHING]["class right"], "False")

    def test_half_the_size_is_found_and_not_right(self):
        row = self.score([self.true_row(ONE, times=0.5)], "2")[ONE]
        self.assertEqual((row["all found"], row["size right"]), ("True", "False"))

    def test_cannot_tell_counts_what_it_lists_and_is_never_found(self):
        listed = f"wheelbase | {self.truth[ONE]['effects'][0]['name']}"
        scores = self.score([[ONE, "cannot tell", "travel scale", "", listed],
                             [OTHER, "cannot tell", "travel scale", "", "wheelbase"]], "2..3")
        self.assertEqual((scores[ONE]["all found"], scores[ONE]["listed"]), ("False", "True"))
        self.assertEqual((scores[OTHER]["all found"], scores[OTHER]["listed"]), ("False", "False"))

    def test_a_class_that_is_none_is_told_with_its_line(self):
        ran = self.run_script("score.py", self.out, self.answers([[ONE, "perhaps", "", "", ""]]), "--command", COMMAND)
        self.assertEqual(ran.returncode, 2)
        self.assertIn('answers.csv:2: class "perhaps"', ran.stderr)

    def test_the_same_seed_makes_the_same_riddle(self):
        again = pathlib.Path(self.scratch.name) / "again"
        self.make(again, "1")
        for file in ("drive.csv", "sightings.csv", "model.toml"):
            self.assertTrue(filecmp.cmp(self.out / "riddles" / NOTHING / file, again / "riddles" / NOTHING / file, False))

    def test_what_is_to_be_guessed_is_not_among_what_is_shown(self):
        shown = {one.name for one in (self.out / "riddles" / ONE).iterdir()}
        self.assertEqual(shown & {"truth.csv", "truth.json", "effects.toml"}, set())
        self.assertNotIn("effect", (self.out / "riddles" / ONE / "model.toml").read_text())

    def test_legs_of_the_baselines_have_the_simulators_kinematics(self):
        try:
            import numpy as np
        except ImportError:
            self.skipTest("python3-numpy is not installed")
        import legs
        plain = legs.Riddle(self.out / "heldout" / NOTHING / "clean")
        lengths = plain.residuals([], [])[:len(plain.legs)] * plain.scales[0]
        self.assertGreater(len(lengths), 50)
        self.assertLess(np.abs(lengths).max(), 1e-3)  # m
        effect = self.truth[OTHER]["effects"][0]
        self.assertEqual(effect["name"], "constant creep")
        drive = legs.Riddle(self.out / "heldout" / OTHER / "clean")
        creep = legs.Term("creep", "1", np.ones_like(drive.t))
        found = float(legs.refined(drive, [creep])[0])
        self.assertAlmostEqual(found / effect["coefficients"][0], 1.0, delta=0.03)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--command", required=True)
    options, rest = parser.parse_known_args()
    COMMAND = pathlib.Path(options.command).resolve()
    unittest.main(argv=[sys.argv[0], *rest])
