# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Fleets: rows, their store and their report, beside the command and beside sums by numpy."""
import datetime
import unittest

import numpy

import trussmap
from places import run_command, scratch_folder

WHEELBASE = 0.02  # all robots have it; R3 has more


class Fleet(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = None
        cls.rows = []
        for robot in range(6):
            for day in (1, 2):
                size = WHEELBASE + (0.05 if robot == 3 else 0.0)
                made = trussmap.simulate(trussmap.Effect("wheelbase", [size]), mesh="3x3", tours=2,
                                         seed=10 * robot + day)
                cls.model = cls.model or made.model
                cls.rows.append(trussmap.fleet_row(
                    f"R{robot}", datetime.date(2026, 3, day), made.recording, cls.model,
                    metadata={"tyre": "AB"[robot % 2]}))
        cls.report = trussmap.fleet_report(cls.rows)

    def test_a_row_says_whose_it_is(self):
        row = self.rows[1]
        self.assertEqual((row.robot, row.date, row.metadata), ("R0", "2026-03-02", {"tyre": "A"}))
        self.assertEqual(row.S.shape, (len(row.g), len(row.columns)))
        numpy.testing.assert_allclose(row.S, row.S.T, rtol=1e-9, atol=1e-9 * abs(row.S).max())

    def test_what_is_common_is_found_and_who_differs(self):
        (finding,) = self.report.findings
        (one,) = finding.coefficients
        self.assertEqual((finding.effect, one.common), ("wheelbase", True))
        self.assertLess(abs(one.mean - WHEELBASE), 3.0 * one.sd)
        self.assertEqual([robot.robot for robot in one.each if robot.differs], ["R3"])
        self.assertEqual({row["robot"] for row in self.report.table("robots")},
                         {f"R{robot}" for robot in range(6)})
        self.assertIn("R3", str(self.report))
        self.assertIn("R3", self.report._repr_html_())

    def test_pooled_scores_are_those_of_the_sums(self):
        column = self.rows[0].columns.index(("wheelbase", "1"))
        g = sum(row.g[column] for row in self.rows)
        S = sum(row.S[column, column] for row in self.rows)
        (test,) = [one for one in self.report.pooled_tests if one.effect == "wheelbase"]
        # But for a weak prior on sizes; residuals are predicted less measured.
        self.assertAlmostEqual(test.score / (g * g / S), 1.0, places=3)
        self.assertAlmostEqual(test.coefficients[0] / (-g / S), 1.0, places=3)

    def test_stores_are_those_of_the_command(self):
        folder = scratch_folder(self)
        for number, row in enumerate(self.rows):
            trussmap.add_to_fleet(folder / f"{number % 2}.db", row)
        merged = folder / "all.db"
        self.assertEqual(trussmap.merge_fleets(merged, [folder / "1.db", folder / "0.db"]), 12)
        self.assertEqual([row.robot for row in trussmap.read_fleet(merged)],
                         sorted(row.robot for row in self.rows))
        report = trussmap.fleet_report(merged)
        self.assertEqual(str(report), str(self.report))
        self.assertEqual(str(report) + "\n", run_command("fleet", "report", merged))

    def test_mistakes_are_said(self):
        store = scratch_folder(self) / "fleet.db"
        trussmap.add_to_fleet(store, self.rows[0])
        with self.assertRaises(trussmap.InputError):
            trussmap.add_to_fleet(store, self.rows[0])
        trussmap.add_to_fleet(store, self.rows[0], replace=True)
        with self.assertRaises(trussmap.InputError):
            trussmap.fleet_row("R9", "yesterday", trussmap.simulate(mesh="2x2").recording,
                               self.model)
        with self.assertRaisesRegex(ValueError, "level"):
            trussmap.fleet_report(self.rows, level=2.0)
        with self.assertRaisesRegex(ValueError, "expected one of"):
            self.report.table("nothing")
        with self.assertRaises(trussmap.InputError):
            trussmap.fleet_report([])


if __name__ == "__main__":
    unittest.main()
