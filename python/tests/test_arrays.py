# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Numbers go in with one copy and come out without one."""
import gc
import resource
import unittest

import numpy

import trussmap
from places import MAPS, scratch_folder

ROWS = 10**6
COLUMN = 8 * ROWS  # bytes


def drive(rows=4):
    return {"t": 0.1 * numpy.arange(1, rows + 1), "left": numpy.full(rows, 0.05),
            "right": numpy.full(rows, 0.051)}


def resident():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * resource.getpagesize()


class Columns(unittest.TestCase):
    def test_come_back_as_they_went_in(self):
        columns = drive() | {"heading": numpy.array([0.1, numpy.nan, 0.3, 0.4]),
                             "payload_kg": numpy.arange(4.0)}
        recording = trussmap.Recording(columns, {"t": [0.1, 0.4], "landmark": ["a", 7]},
                                       name="mine")
        for name, column in columns.items():
            numpy.testing.assert_array_equal(recording.drive[name], column)
        self.assertIsNone(recording.yaw_rate)
        self.assertEqual(recording.sightings["landmark"], ["a", "7"])
        self.assertTrue(numpy.isnan(recording.sightings["range"]).all())
        self.assertEqual((recording.name, len(recording)), ("mine", 4))

    def test_are_views_that_cannot_be_written(self):
        recording = trussmap.Recording(drive())
        column = recording.left
        self.assertFalse(column.flags.owndata)
        self.assertFalse(column.flags.writeable)
        with self.assertRaises(ValueError):
            column[0] = 1.0
        self.assertEqual(recording.left.ctypes.data, column.ctypes.data)

    def test_outlive_the_name_of_their_recording(self):
        recording = trussmap.Recording(drive(1000))
        column = recording.t
        del recording
        gc.collect()
        numpy.testing.assert_array_equal(column, drive(1000)["t"])

    def test_of_any_type_and_stride(self):
        table = numpy.arange(12, dtype=numpy.float32).reshape(4, 3)
        recording = trussmap.Recording(
            {"t": range(1, 5), "left": table[:, 1], "right": numpy.array([1, 2, 3, 4], numpy.int16)})
        numpy.testing.assert_array_equal(recording.left, [1.0, 4.0, 7.0, 10.0])
        numpy.testing.assert_array_equal(recording.right, [1.0, 2.0, 3.0, 4.0])

    def test_of_records(self):
        table = numpy.zeros(4, [("t", float), ("left", float), ("right", float)])
        table["t"] = [1.0, 2.0, 3.0, 4.0]
        self.assertEqual(len(trussmap.Recording(table)), 4)

    def test_of_data_frames(self):
        try:
            import pandas
        except ImportError:
            self.skipTest("needs pandas")
        recording = trussmap.Recording(
            pandas.DataFrame(drive()),
            pandas.DataFrame({"t": [0.1, 0.4], "landmark": ["a", "b"], "range": [1.0, 2.0],
                              "bearing": [0.0, 0.1]}))
        numpy.testing.assert_array_equal(recording.sightings["range"], [1.0, 2.0])
        self.assertEqual(list(pandas.DataFrame(recording.drive)), ["t", "left", "right"])
        self.assertEqual(len(pandas.DataFrame(recording.sightings)), 2)

    def test_go_through_a_folder_without_loss(self):
        folder = scratch_folder(self) / "rec"
        recording = trussmap.Recording(drive(50), {"t": [0.1, 0.2], "landmark": ["a", "b"]})
        recording.write(folder)
        again = trussmap.Recording.read(folder)
        self.assertEqual(again.fingerprint, recording.fingerprint)

    def test_of_a_bag(self):
        folder = scratch_folder(self)
        log = MAPS / "logs" / "warehouse.mcap"
        (folder / "map.toml").write_text(trussmap.inspect_bag(log), encoding="utf-8")
        recording = trussmap.Recording.from_bag(log, folder / "map.toml")
        bag = trussmap.read_bag(log, folder / "map.toml")
        self.assertGreater(len(recording), 100)
        self.assertEqual(bag.recording.fingerprint, recording.fingerprint)


class Memory(unittest.TestCase):
    """Of a drive with three columns of a million rows: 24 MB."""

    def test_one_copy_goes_in_and_none_comes_out(self):
        columns = drive(ROWS)
        trussmap.Recording(drive())  # what is made once
        before = resident()
        recording = trussmap.Recording(columns)
        within = resident() - before
        self.assertLess(within, 3 * COLUMN + COLUMN // 2)
        before = resident()
        views = [recording.t, recording.left, recording.right]
        total = sum(float(view[::1000].sum()) for view in views)
        self.assertGreater(total, 0.0)
        self.assertLess(resident() - before, COLUMN // 4)
        del columns

    def test_poses_come_out_without_a_copy(self):
        poses = trussmap.apply(trussmap.Recording(drive(ROWS)), trussmap.Model())
        before = resident()
        for column in (poses.t, poses.x, poses.y, poses.heading, poses.covariance):
            self.assertEqual(len(column), ROWS + 1)
            self.assertFalse(column.flags.owndata)
            self.assertFalse(column.flags.writeable)
        self.assertLess(resident() - before, COLUMN // 4)
        self.assertEqual(poses.covariance.shape, (ROWS + 1, 3, 3))


class Refused(unittest.TestCase):
    def assert_refused(self, words, *arguments, **named):
        with self.assertRaises(ValueError) as caught:
            trussmap.Recording(*arguments, **named)
        self.assertIn(words, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))

    def test_columns_that_are_no_numbers(self):
        self.assert_refused("column left of drive", drive() | {"left": ["a", "b", "c", "d"]})
        self.assert_refused("column left of drive", drive() | {"left": [1.0, None, {}, 2.0]})

    def test_columns_of_different_lengths(self):
        self.assert_refused("has 3 rows, expected 4", drive() | {"right": [0.0, 0.0, 0.0]})
        self.assert_refused("column range has", drive(),
                            {"t": [0.1], "landmark": ["a"], "range": [1.0, 2.0]})

    def test_columns_that_nothing_knows(self):
        self.assert_refused("\"heigth\" is unknown", drive(),
                            {"t": [0.1], "landmark": ["a"], "heigth": [1.0]})
        self.assert_refused("cannot be a covariate", drive() | {"speed": [0.0] * 4})

    def test_columns_that_are_missing(self):
        self.assert_refused("column t is missing", {"left": [0.0, 0.0], "right": [0.0, 0.0]})

    def test_what_is_no_table(self):
        with self.assertRaises(TypeError):
            trussmap.Recording([1, 2, 3])

    def test_what_the_library_refuses(self):
        wrong = trussmap.Recording(drive() | {"t": [0.4, 0.3, 0.2, 0.1]})
        with self.assertRaisesRegex(ValueError, "does not increase"):
            trussmap.apply(wrong, trussmap.Model(), adjusted=True)


if __name__ == "__main__":
    unittest.main()
