# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Results: what they say, their tables, their pictures; models and effects; what runs on a robot."""
import subprocess
import sys
import unittest

import numpy

import trussmap
from places import MAPS, scratch_folder

RIDDLE = MAPS / "riddle"
MODEL = RIDDLE / "model.toml"


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.diagnosis = trussmap.diagnose(RIDDLE, MODEL)
        cls.comparison = trussmap.compare(RIDDLE, MODEL)
        cls.map = trussmap.build_map(RIDDLE, MODEL)

    def test_the_riddle_is_solved(self):
        self.assertEqual((self.diagnosis.verdict, self.diagnosis.missing), ("missing", "hard iron"))
        fitted = trussmap.fit(RIDDLE, self.diagnosis.model)
        self.assertLess(fitted.heldout.arrival_rms_m, 0.1 * fitted.without_effects["heldout"].arrival_rms_m)
        self.assertEqual(trussmap.compare(RIDDLE, fitted.model).verdict, "consistent")

    def test_say_what_helps_on(self):
        self.assertEqual(self.comparison.next_command[0], "diagnose")
        self.assertEqual(self.diagnosis.next_command[0], "discover")
        self.assertEqual(trussmap.discover(RIDDLE, MODEL).next_command[0], "build")

    def test_cannot_be_changed(self):
        for result in (self.diagnosis, self.comparison, self.map, self.diagnosis.candidates[0]):
            with self.assertRaises(AttributeError):
                result.chi2 = 0.0
            with self.assertRaises(AttributeError):
                result.score = 0.0

    def test_tables_are_what_pandas_takes(self):
        for result, tables in ((self.diagnosis, ("candidates", "noise", "noise laws", "outliers",
                                                 "unobservable")),
                               (self.comparison, ("trends", "legs", "routes", "landmarks", "noise",
                                                  "outliers")),
                               (self.map, ("landmarks", "routes", "left out"))):
            for what in tables:
                for row in result.table(what):
                    self.assertIsInstance(row, dict)
            with self.assertRaisesRegex(ValueError, "expected one of"):
                result.table("nothing")
        first = self.diagnosis.table()[0]
        self.assertEqual((first["effect"], first["status"]), ("hard iron", "missing"))
        self.assertEqual(first["score"], self.diagnosis.candidates[0].score)
        try:
            import pandas
        except ImportError:
            return
        frame = pandas.DataFrame(self.map.table())
        numpy.testing.assert_array_equal(frame[["x", "y"]].to_numpy(), self.map.positions)

    def test_a_map_has_its_covariances(self):
        self.assertEqual(self.map.covariances.shape, (len(self.map.landmarks), 2, 2))
        row = self.map.table()[1]
        self.assertEqual(row["c_xy"], self.map.covariances[1, 0, 1])

    def test_are_parts_of_a_notebook(self):
        html = self.diagnosis._repr_html_()
        self.assertIn("<section class=\"trussmap\">", html)
        self.assertIn("<svg", html)
        self.assertIn("hard iron", html)
        self.assertNotIn("<script", html)
        self.assertEqual(html, self.diagnosis._repr_html_())
        self.assertIn("<svg", self.map._repr_html_())

    def test_are_pages_of_their_own(self):
        folder = scratch_folder(self)
        for result in (self.diagnosis, self.map,
                       trussmap.umbmark(MAPS / "square_runs.csv", wheelbase=0.34)):
            result.write_html(folder / "page.html")
            page = (folder / "page.html").read_text(encoding="utf-8")
            self.assertTrue(page.startswith("<!DOCTYPE html>"))
            self.assertIn(result._repr_html_(), page)
            charts = result.charts()
            self.assertGreater(len(charts), 0)
            for svg in charts.values():
                self.assertIn("<svg", svg)
        with self.assertRaisesRegex(trussmap.InputError, "no/such"):
            self.diagnosis.write_html(folder / "no/such/page.html")

    def test_show_where_a_model_fails(self):
        fitted = trussmap.fit(RIDDLE, self.diagnosis.model)
        for result in (self.comparison, self.diagnosis, fitted):
            first = result.responses[0]
            self.assertEqual((first.channel, first.unit, first.variable),
                             ("compass", "rad", "heading"))
            numpy.testing.assert_array_equal(first.at, [row["at"] for row in first.table()])
            self.assertTrue(numpy.all((first.low <= first.at) & (first.at <= first.high)))
        # What the points show is what was fitted: their curve, with the fitted coefficients.
        shown = fitted.responses[0]
        self.assertEqual(shown.name, "hard iron")
        a, b = fitted.effects[0].coefficients
        angle, error = shown.curve.T  # but for a constant, which an offset would be
        self.assertLess(numpy.std(error - a * numpy.sin(angle) - b * numpy.cos(angle)), 1e-9)
        off = (shown.estimate - numpy.interp(shown.at, angle, error)) / shown.sd
        self.assertLess(numpy.sqrt(numpy.mean(off ** 2)), 2.0)

    def test_say_a_status_as_the_table_does(self):
        printed = str(self.diagnosis)
        for one in self.diagnosis.candidates[:8]:
            self.assertIn(one.status_in_words, printed)
        self.assertEqual(self.diagnosis.candidates[0].status_in_words, "missing")

    def test_are_drawn(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("needs matplotlib")
        matplotlib.use("Agg")
        for result in (self.diagnosis, self.comparison, self.map,
                       trussmap.apply(RIDDLE, MODEL),
                       trussmap.umbmark(MAPS / "square_runs.csv", wheelbase=0.34)):
            self.assertTrue(result.plot().has_data())
        self.assertTrue(self.diagnosis.responses[0].plot().has_data())

    def test_say_what_drawing_needs(self):
        hidden = ("import sys; sys.modules['matplotlib'] = None; import trussmap\n"
                  f"trussmap.apply({str(RIDDLE)!r}, {str(MODEL)!r}).plot()")
        done = subprocess.run([sys.executable, "-c", hidden], capture_output=True, text=True,
                              check=False)
        self.assertIn("plot() draws with matplotlib, which is not installed", done.stderr)

    def test_drawing_is_not_imported_before(self):
        done = subprocess.run([sys.executable, "-c", "import sys, trussmap; "
                               "print('matplotlib' in sys.modules)"], capture_output=True,
                              text=True, check=True)
        self.assertEqual(done.stdout, "False\n")

    def test_every_name_says_what_it_is(self):
        for name in trussmap.__all__:
            thing = getattr(trussmap, name)
            self.assertTrue(thing.__doc__, name)
            said = [thing.__doc__, *(value.__doc__ or "" for value in vars(thing).values())] \
                if isinstance(thing, type) else [thing.__doc__]
            for text in said:
                self.assertNotRegex(text, r"Throws|invalid_argument|nullptr|std::(?!__cxx11)", name)
            if not isinstance(thing, type):
                continue
            undocumented = [key for key, value in vars(thing).items()
                            if isinstance(value, property) and not value.__doc__]
            # A member that its header leaves without a word: its name says it.
            self.assertLess(len(undocumented), 12, (name, undocumented))


class Models(unittest.TestCase):
    def test_go_through_a_file(self):
        model = trussmap.Model(0.5, noise={"left": 0.004}, effects=["wheelbase"]).with_effect(
            trussmap.Effect("mine", [0.1, 0.2], channel="compass", shape=["1", "sin(2*heading)"]))
        file = scratch_folder(self) / "model.toml"
        model.write(file)
        again = trussmap.Model.read(file)
        self.assertEqual(again, model)
        self.assertEqual(again.noise["left"], 0.004)
        self.assertEqual([one.name for one in again.effects], ["wheelbase", "mine"])
        self.assertEqual(str(again) + "\n", file.read_text(encoding="utf-8"))

    def test_are_made_anew_and_do_not_change(self):
        model = trussmap.Model()
        other = model.with_noise(compass=0.1)
        self.assertNotEqual(model, other)
        self.assertEqual(model, trussmap.Model())
        self.assertEqual(other.with_effect("wheelbase").without_effect("wheelbase"), other)

    def test_of_other_drives(self):
        model = trussmap.Model(drive="tricycle", length=0.6)
        self.assertEqual((model.drive, model.length, model.columns),
                         ("tricycle", 0.6, ["wheel", "steer"]))

    def test_refuse_what_makes_no_sense(self):
        for make in (lambda: trussmap.Model(-1.0), lambda: trussmap.Model(noise={"sun": 1.0}),
                     lambda: trussmap.Model(noise={"left": -1.0}),
                     lambda: trussmap.Model(drive="hover"), lambda: trussmap.Effect("no such"),
                     lambda: trussmap.Effect("mine", channel="compass"),
                     lambda: trussmap.Effect("mine", channel="compass", shape="sin("),
                     lambda: trussmap.Effect("wheelbase", [1.0, 2.0]),
                     lambda: trussmap.Model(effects=["wheelbase", "wheelbase"])):
            with self.assertRaises(ValueError):
                make()

    def test_effects_say_what_they_are(self):
        effect = trussmap.Effect("wheelbase", [-0.02])
        self.assertIn("wheelbase", effect.in_words([0.001]))
        self.assertEqual((effect.channel, effect.shape), ("turn", ["1"]))
        self.assertIn("hard iron", [entry.name for entry in trussmap.catalogue()])


class OnTheRobot(unittest.TestCase):
    def test_a_map_is_corrected_at_every_arrival(self):
        builder = trussmap.MapBuilder()
        builder.start("dock")
        covariance = numpy.diag([4e-4, 1e-4])
        kinds = [builder.arrive(name, leg, covariance).kind
                 for name, leg in (("door", (4.1, 0.3)), ("stairs", (0.2, 5.0)),
                                   ("dock", (-4.27, -5.27)))]
        self.assertEqual(kinds, ["new landmark", "new landmark", "loop closed"])
        self.assertEqual(builder.landmarks, ["dock", "door", "stairs"])
        # The loop's error of (0.03, 0.03) is shared out among its three legs.
        numpy.testing.assert_allclose(builder.position("door"), [4.09, 0.29], atol=0.003)
        self.assertEqual(builder.here, "dock")
        with self.assertRaises(KeyError):
            builder.position("nowhere")
        with self.assertRaisesRegex(ValueError, "displacement"):
            builder.arrive("door", [1.0], covariance)

    def test_a_planner_asks_its_map(self):
        store = trussmap.MapStore(scratch_folder(self) / "map.db")
        builder = trussmap.MapBuilder()
        sides = [("b", (3.0, 0.0)), ("c", (0.0, 4.0)), ("d", (-3.0, 0.0)), ("a", (0.0, -4.0))]
        for one in (store, builder):
            one.start("a")
            for name, leg in sides:
                one.arrive(name, leg, numpy.eye(2) * 1e-4)
            self.assertEqual(one.nearest((2.9, 0.1), 2), ["b", "a"])
            self.assertEqual(one.path("a", "c"), ["a", "b", "c"])
            self.assertEqual(one.path("a", "b", by="uncertainty"), ["a", "b"])
            # One side beside three: the flexibilities of 1e-4 and 3e-4, side by side.
            numpy.testing.assert_allclose(one.covariance_between("a", "b"),
                                          numpy.eye(2) * 0.75e-4, atol=1e-12)
            numpy.testing.assert_allclose(one.covariances()[2], numpy.eye(2) * 1e-4, atol=1e-12)
            short, whole = one.expected_falls([["a", "b"], ["a", "b", "c", "d", "a"]])
            # Once more all of it: every variance halves; the sum was 2 (0.75 + 1 + 0.75) 1e-4.
            self.assertAlmostEqual(whole, 2.5e-4, delta=1e-10)
            self.assertGreater(whole, short)
            with self.assertRaises(KeyError):
                one.path("a", "nowhere")
            with self.assertRaisesRegex(ValueError, "expected length"):
                one.path("a", "b", by="luck")

    def test_a_store_goes_on(self):
        file = scratch_folder(self) / "map.db"
        store = trussmap.MapStore(file)
        store.start("dock")
        store.arrive("door", [4.1, 0.3], numpy.eye(2) * 1e-4)
        del store
        again = trussmap.MapStore(file)
        self.assertEqual((again.landmarks, again.legs), (["dock", "door"], 2))

    def test_odometry_is_corrected_as_apply_does_it(self):
        recording = trussmap.Recording.read(RIDDLE)
        model = trussmap.Model.read(MODEL).with_effect(trussmap.Effect("wheelbase", [0.02]))
        columns = dict(recording.drive)
        bare = trussmap.Recording({name: columns[name] for name in ("t", "left", "right")})
        odometry = trussmap.CorrectedOdometry(model)
        before = bare.t[0] - (bare.t[1] - bare.t[0])
        for t, left, right in zip(bare.t, bare.left, bare.right):
            row = odometry.drive(t - before, left, right)
            before = t
        poses = trussmap.apply(bare, model)
        numpy.testing.assert_allclose(row.pose, (poses.x[-1], poses.y[-1], poses.heading[-1]),
                                      rtol=1e-9, atol=1e-9)
        numpy.testing.assert_allclose(row.covariance, poses.covariance[-1], rtol=1e-6, atol=1e-12)


if __name__ == "__main__":
    unittest.main()
