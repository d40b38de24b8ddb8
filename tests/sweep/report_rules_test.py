#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Each rule finds what it is for, and nothing in a report that is right."""
import copy
import unittest

from report_rules import Report, broken_rules, rules_across

BUILD = {"verdict": "good", "warnings": [], "chi2": 100.0, "dof": 100, "landmarks": 2, "routes": 1,
         "positions": {"A": {"x": 0, "y": 0}, "B": {"x": 4, "y": 0}}, "rejected": [],
         "quality": {"sightings": 3}}
BUILD_TEXT = "map of 2 landmarks and 1 routes, method adjustment\ngood: nothing speaks against this map\n"
COMPARE = {"verdict": "consistent", "chi2": 100.0, "dof": 100, "p_value": 0.48, "level": 0.05, "legs": 9,
           "landmarks": 4, "heldout": {"legs": 2}, "trends": [], "warnings": []}
COMPARE_TEXT = "consistent: the model explains them\n  chi2 100.0, dof 100, p 0.48; 9 legs, 4 landmarks\n"


def broken(command, text, data, **known):
    return [what for _, what in broken_rules(Report(command, text, "", data, known))]


def changed(data, **changes):
    return {**copy.deepcopy(data), **changes}


class Rules(unittest.TestCase):
    def test_nothing_in_what_is_right(self):
        self.assertEqual(broken("build", BUILD_TEXT, BUILD), [])
        self.assertEqual(broken("compare", COMPARE_TEXT, COMPARE, gyro=True, compass=True), [])

    def finds(self, word, command, text, data, **known):
        self.assertIn(word, " ".join(broken(command, text, data, **known)))

    def test_a_good_map_with_bad_figures(self):
        self.finds("good, with chi2", "build", BUILD_TEXT, changed(BUILD, chi2=300.0))
        self.finds("with 1 warnings", "build", BUILD_TEXT, changed(BUILD, warnings=["torn in two parts here"]))
        self.finds("from the survey", "build", BUILD_TEXT, changed(BUILD, survey={"rms_m": 1.0}))
        self.finds("positions", "build", BUILD_TEXT, changed(BUILD, positions={}))

    def test_a_verdict_against_its_chi2(self):
        self.finds("consistent, with chi2", "compare", COMPARE_TEXT, changed(COMPARE, chi2=200.0))
        self.finds("significant trend", "compare", COMPARE_TEXT,
                   changed(COMPARE, trends=[{"p_adjusted": 0.01}]))
        self.finds("expected", "compare", COMPARE_TEXT, changed(COMPARE, p_value=0.1))
        self.finds("text ('100.0', '100'), JSON", "compare", COMPARE_TEXT, changed(COMPARE, dof=101))

    def test_figures_that_are_none(self):
        for line, word in (("error nan m", "nan"), ("size 2 +- m", "blank"), ("x  -0.00  m", "minus nothing"),
                           ("errors are 1.0 times what is allowed", "as large as it should be"),
                           ("the wheel is 0.00 % smaller", "size of nothing")):
            self.finds(word, "compare", COMPARE_TEXT + line + "\n", COMPARE)

    def test_instruments_that_are_there(self):
        self.finds("a gyro would help", "compare", COMPARE_TEXT + "a gyro would help most\n", COMPARE, gyro=True)
        self.assertEqual(broken("compare", COMPARE_TEXT + "a gyro would help most\n", COMPARE, gyro=False), [])

    def test_warnings_of_one_side_alone(self):
        self.finds("JSON alone warns", "compare", COMPARE_TEXT, changed(COMPARE, warnings=["a long warning of it"]))
        self.finds("the text has 1", "compare", COMPARE_TEXT + "warning: of the text\n", COMPARE)

    def test_commands_that_differ(self):
        one = Report("compare", "", "", COMPARE, {})
        other = Report("diagnose", "", "", changed(COMPARE, chi2=90.0), {})
        self.assertEqual(len(list(rules_across([one, other]))), 1)
        self.assertEqual(list(rules_across([one, one])), [])


if __name__ == "__main__":
    unittest.main()
