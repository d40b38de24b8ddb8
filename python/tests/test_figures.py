# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Figures and texts are the command's, to the last digit: two ways through the same library that
must not part."""
import unittest
import warnings

import numpy

import trussmap
from places import MAPS, SHARED, printed_and_json, run_command, scratch_folder

PRACTICE = sorted(SHARED.glob("hidden/?"))
RIDDLE = MAPS / "riddle"


def setUpModule():
    warnings.simplefilter("ignore", trussmap.RecordingWarning)  # the command has them on stderr


def model_of(recording):
    return recording / "model.toml"


class TheSame(unittest.TestCase):
    maxDiff = None

    def assert_printed(self, result, printed):
        self.assertEqual(str(result) + "\n", printed)

    def check_comparison(self, recording):
        printed, told = printed_and_json(scratch_folder(self), "compare", recording, "--model",
                                         model_of(recording))
        result = trussmap.compare(recording, model_of(recording))
        self.assert_printed(result, printed)
        for key in ("verdict", "chi2", "dof", "p_value", "legs", "landmarks"):
            self.assertEqual(getattr(result, key), told[key], key)
        self.assertEqual([one.score for one in result.trends],
                         [one["score"] for one in told["trends"]])
        self.assertEqual([one.chi2 for one in result.worst], [one["chi2"] for one in told["worst"]])
        self.assertEqual([(one.source, one.factor, one.sd) for one in result.noise],
                         [(one["source"], one["factor"], one["sd"]) for one in told["noise"]])
        self.assertEqual(result.heldout.arrival_rms_m, told["heldout"]["arrival_rms_m"])

    def check_diagnosis(self, recording):
        printed, told = printed_and_json(scratch_folder(self), "diagnose", recording, "--model",
                                         model_of(recording))
        result = trussmap.diagnose(recording, model_of(recording))
        self.assert_printed(result, printed)
        for key in ("verdict", "missing", "chi2", "dof", "p_value", "tried"):
            self.assertEqual(getattr(result, key), told[key], key)
        self.assertEqual(
            [(one.effect.name, one.score, one.p_adjusted, one.coefficients, one.status)
             for one in result.candidates],
            [(one["effect"], one["score"], one["p_adjusted"], one["coefficients"], one["status"])
             for one in told["candidates"]])

    def check_map(self, recording, *options, **named):
        printed, told = printed_and_json(scratch_folder(self), "build", recording, "--model",
                                         model_of(recording), *options)
        result = trussmap.build_map(recording, model_of(recording), **named)
        self.assert_printed(result, printed.split("\n  written: ")[0])
        self.assertEqual(result.chi2, told["chi2"])
        self.assertEqual(result.quality.median_sd_m, told["quality"]["median_sd_m"])
        places = told["positions"]
        self.assertEqual(result.landmarks, list(places))
        self.assertEqual([tuple(at) for at in result.positions],
                         [(at["x"], at["y"]) for at in places.values()])

    def test_the_riddle(self):
        self.check_comparison(RIDDLE)
        self.check_diagnosis(RIDDLE)

    def test_times_left_out(self):
        printed, told = printed_and_json(scratch_folder(self), "compare", RIDDLE, "--model",
                                         model_of(RIDDLE), "--exclude", "20:60,100:110")
        result = trussmap.compare(RIDDLE, model_of(RIDDLE), exclude=[(20.0, 60.0), (100.0, 110.0)])
        self.assert_printed(result, printed)
        self.assertEqual(result.chi2, told["chi2"])
        self.assertLess(result.dof, trussmap.compare(RIDDLE, model_of(RIDDLE)).dof)
        printed, told = printed_and_json(scratch_folder(self), "diagnose", RIDDLE, "--model",
                                         model_of(RIDDLE), "--exclude", "20:60")
        result = trussmap.diagnose(RIDDLE, model_of(RIDDLE), exclude=numpy.array([[20.0, 60.0]]))
        self.assert_printed(result, printed)
        self.assertEqual([(one.effect.name, one.cosine, one.chi2_behind)
                          for one in result.candidates[0].indistinguishable_from],
                         [(one["effect"], one["cosine"], one["chi2_behind"])
                          for one in told["candidates"][0]["indistinguishable_from"]])

    def test_maps_by_every_method(self):
        for method in ("adjustment", "elastic", "elastic-printed", "gauss-markov"):
            with self.subTest(method):
                self.check_map(RIDDLE, "--method", method, method=method)

    def test_a_fit(self):
        model = trussmap.Model.read(model_of(RIDDLE)).with_effect("hard iron")
        file = scratch_folder(self) / "model.toml"
        model.write(file)
        printed, told = printed_and_json(scratch_folder(self), "fit", RIDDLE, "--model", file,
                                         "--noise")
        result = trussmap.fit(RIDDLE, model, noise=True)
        self.assert_printed(result, printed)
        self.assertEqual(result.chi2, told["chi2"])
        self.assertEqual(result.effects[0].coefficients, told["effects"][0]["coefficients"])
        self.assertEqual(result.effects[0].sd, told["effects"][0]["sd"])

    def test_a_discovery(self):
        printed, told = printed_and_json(scratch_folder(self), "discover", RIDDLE, "--model",
                                         model_of(RIDDLE))
        result = trussmap.discover(RIDDLE, model_of(RIDDLE))
        self.assert_printed(result, printed)
        self.assertEqual([step.chi2 for step in result.steps],
                         [step["chi2"] for step in told["steps"]])
        self.assertEqual([one.in_words for one in result.effects],
                         [one["in_words"] for one in told["effects"]])

    def test_poses(self):
        folder = scratch_folder(self)
        for adjusted in (False, True):
            file = folder / "poses.csv"
            printed = run_command("apply", RIDDLE, "--model", model_of(RIDDLE), "--out", file,
                                  *(["--adjusted"] if adjusted else []))
            poses = trussmap.apply(RIDDLE, model_of(RIDDLE), adjusted=adjusted)
            kept = [line for line in printed.split("\n") if not line.startswith("written: ")]
            self.assertEqual(str(poses), "\n".join(kept).rstrip("\n"))
            ours = folder / "ours.csv"
            poses.write(ours)
            self.assertEqual(ours.read_bytes(), file.read_bytes())

    def test_a_check(self):
        self.assert_printed(trussmap.check(RIDDLE, model_of(RIDDLE)),
                            run_command("check", RIDDLE, "--model", model_of(RIDDLE)))

    def test_squares_and_wheel_noise(self):
        squares = MAPS / "square_runs.csv"
        printed, told = printed_and_json(scratch_folder(self), "umbmark", squares, "--side", 4,
                                         "--wheelbase", 0.34)
        result = trussmap.umbmark(squares, wheelbase=0.34, side=4.0)
        self.assert_printed(result, printed)
        self.assertEqual(result.E_d, (told["exact"]["E_d"], told["exact"]["sd_E_d"]))
        folder = scratch_folder(self)
        runs = folder / "runs.csv"
        printed, told = printed_and_json(folder, "noise", "--simulate", "--true-k-left", 0.004,
                                         "--true-k-right", 0.003, "--seed", 5, "--write", runs)
        result = trussmap.wheel_noise(runs, wheelbase=0.34)
        self.assert_printed(result, printed)
        self.assertEqual((result.left.k, result.right.k), (told["k_left"], told["k_right"]))

    def test_a_simulation(self):
        folder = scratch_folder(self)
        run_command("simulate", "--mesh", "3x3", "--tours", 1, "--seed", 7, "--effect",
                    "wheelbase=0.02", "--out", folder / "theirs")
        ours = trussmap.simulate(trussmap.Effect("wheelbase", [0.02]), folder / "ours", mesh="3x3",
                                 tours=1, seed=7)
        for file in ("drive.csv", "sightings.csv", "survey.csv", "model.toml"):
            self.assertEqual((folder / "ours" / file).read_bytes(),
                             (folder / "theirs" / file).read_bytes(), file)
        self.assertIn("wheelbase", str(ours))

    @unittest.skipUnless((SHARED / "posegraph").exists(), "needs the data sets beside the project")
    def test_a_pose_graph(self):
        graph = sorted((SHARED / "posegraph").rglob("*ntel*.g2o*"))[0]
        printed, told = printed_and_json(scratch_folder(self), "adjust", graph)
        result = trussmap.adjust_pose_graph(graph)
        untimed = [line for line in printed.split("\n") if not line.startswith("  time ")]
        ours = [line for line in (str(result) + "\n").split("\n")
                if not line.startswith("  time ")]
        self.assertEqual(ours, untimed)
        self.assertEqual(result.chi2, told["chi2"])

    @unittest.skipUnless((SHARED / "optiodom").exists(), "needs the data sets beside the project")
    def test_a_calibration(self):
        runs = sorted((SHARED / "optiodom").rglob("diff/square/*/*_run-0?.csv.xz"))[:2]
        self.assertTrue(runs)
        folder = scratch_folder(self)
        for k, run in enumerate(runs):
            run_command("convert", run, folder / str(k))
        recordings = [folder / str(k) for k in range(len(runs))]
        printed, told = printed_and_json(folder, "calibrate", *recordings, "--model",
                                         recordings[0] / "model.toml")
        result = trussmap.calibrate(recordings, recordings[0] / "model.toml")
        self.assert_printed(result, printed)
        self.assertEqual(result.E_d, (told["E_d"], told["sd_E_d"]))


@unittest.skipUnless(PRACTICE, "needs the data sets beside the project")
class ThePracticeRecordings(TheSame):
    """Each of the ten, compared, diagnosed and built."""

    def test_all(self):
        for recording in PRACTICE:
            with self.subTest(recording.name):
                self.check_comparison(recording)
                self.check_diagnosis(recording)
                self.check_map(recording)


def load_tests(loader, tests, pattern):
    """The tests of the class above run once, not again for the one that has it as its base."""
    suite = loader.loadTestsFromTestCase(TheSame)
    suite.addTest(ThePracticeRecordings("test_all"))
    return suite


if __name__ == "__main__":
    unittest.main()
