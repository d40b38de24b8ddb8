# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Long calls let other threads run, tell their progress and stop at Ctrl-C; errors are one line;
what is made and dropped leaves nothing behind."""
import ctypes
import gc
import os
import resource
import signal
import threading
import time
import unittest

import trussmap
from places import MAPS, scratch_folder

RIDDLE = MAPS / "riddle"
MODEL = RIDDLE / "model.toml"


def large():
    """A recording whose diagnosis takes many seconds."""
    return trussmap.simulate(mesh="8x8", tours=6, seed=3)


def resident():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * resource.getpagesize()


class LongCalls(unittest.TestCase):
    def test_other_threads_run_meanwhile(self):
        ended = threading.Event()
        turns = 0

        def count():
            nonlocal turns
            while not ended.is_set():
                turns += 1
                time.sleep(0.001)

        counting = threading.Thread(target=count)
        counting.start()
        began = time.monotonic()
        trussmap.diagnose(RIDDLE, MODEL)
        took = time.monotonic() - began
        ended.set()
        counting.join()
        # Had the lock been held, the other thread would have had a turn or two.
        self.assertGreater(turns, 20 * took)

    def test_blas_has_no_threads_of_its_own_meanwhile(self):
        try:
            blas = ctypes.CDLL("libopenblas.so.0", mode=os.RTLD_NOLOAD | os.RTLD_NOW)
        except OSError:
            self.skipTest("the BLAS in use is not OpenBLAS")
        before = blas.openblas_get_num_threads()
        self.addCleanup(blas.openblas_set_num_threads, before)
        for threads in (3, 1):
            blas.openblas_set_num_threads(threads)
            meanwhile = set()
            calls = [threading.Thread(target=trussmap.compare, args=(RIDDLE, MODEL), kwargs={
                "progress": lambda what, done: meanwhile.add(blas.openblas_get_num_threads())
                if 0.0 < done < 1.0 else None}) for _ in range(3)]
            for call in calls:
                call.start()
            for call in calls:
                call.join()
            self.assertIn(1, meanwhile)
            self.assertEqual(blas.openblas_get_num_threads(), threads)

    def test_ctrl_c_stops_them(self):
        simulated = large()
        began = time.monotonic()
        pressed = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
        pressed.start()
        with self.assertRaises(KeyboardInterrupt):
            while True:  # should a machine be so fast that one diagnosis takes less than a second
                trussmap.discover(simulated.recording, simulated.model)
                self.assertLess(time.monotonic() - began, 600.0)
        # And the library is as before.
        self.assertTrue(trussmap.build_map(RIDDLE, MODEL).chi2 > 0.0)

    def test_a_handler_of_ones_own_is_asked(self):
        class Enough(Exception):
            pass

        def handler(number, frame):
            raise Enough

        simulated = large()
        before = signal.signal(signal.SIGALRM, handler)
        signal.setitimer(signal.ITIMER_REAL, 0.5)
        try:
            with self.assertRaises(Enough):
                while True:
                    trussmap.diagnose(simulated.recording, simulated.model)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            signal.signal(signal.SIGALRM, before)

    def test_progress_is_told(self):
        told = []
        trussmap.diagnose(RIDDLE, MODEL, progress=lambda what, done: told.append((what, done)))
        self.assertEqual([what for what, _ in told],
                         ["reading", "fitting the map", "looking for what is missing", "done"])
        shares = [done for _, done in told]
        self.assertEqual(shares, sorted(shares))
        self.assertEqual((shares[0], shares[-1]), (0.0, 1.0))

    def test_what_a_callback_raises_comes_through(self):
        def refuse(what, done):
            raise LookupError(what)

        with self.assertRaisesRegex(LookupError, "reading"):
            trussmap.compare(RIDDLE, MODEL, progress=refuse)

    def test_a_discovery_tells_what_it_fits(self):
        told = []
        trussmap.discover(RIDDLE, MODEL, most=1,
                          progress=lambda what, done: told.append((what, done)))
        self.assertIn("hard iron", " ".join(what for what, _ in told))
        shares = [done for _, done in told]
        self.assertEqual(shares, sorted(shares))


class Errors(unittest.TestCase):
    def test_name_file_and_line(self):
        folder = scratch_folder(self)
        (folder / "drive.csv").write_text("t,left,right\n0.1,0,0\n0.1,0,0\n", encoding="utf-8")
        (folder / "sightings.csv").write_text("t,landmark\n0.1,a\n", encoding="utf-8")
        with self.assertRaises(trussmap.InputError) as caught:
            trussmap.Recording.read(folder)
        error = caught.exception
        self.assertIsInstance(error, ValueError)
        self.assertEqual((error.file, error.line), (str(folder / "drive.csv"), 3))
        self.assertEqual(str(error), f"{folder}/drive.csv:3: time 0.1 is repeated, expected a later "
                                     "time")

    def test_say_what_has_no_answer(self):
        lost = trussmap.MapBuilder()
        lost.start("dock")
        with self.assertRaises(trussmap.SolveError) as caught:
            lost.start("elsewhere")
        self.assertNotIn("\n", str(caught.exception))
        self.assertIsInstance(caught.exception, RuntimeError)

    def test_of_values_out_of_range(self):
        for wrong, words in (({"level": 0.9}, "level"), ({"holdout": 2.0}, "holdout"),
                             ({"without": ["sun"]}, "sun"), ({"gate": -1.0}, "gate")):
            with self.assertRaisesRegex(ValueError, words):
                trussmap.compare(RIDDLE, MODEL, **wrong)
        with self.assertRaisesRegex(ValueError, "adjustment"):
            trussmap.build_map(RIDDLE, MODEL, method="magic")
        with self.assertRaisesRegex(ValueError, "no effect to fit"):
            trussmap.fit(RIDDLE, MODEL)
        with self.assertRaises(TypeError):
            trussmap.compare(3, MODEL)
        with self.assertRaises(trussmap.InputError):
            trussmap.compare("nowhere", MODEL)

    def test_of_times_to_leave_out(self):
        for wrong, words in (([(1.0, 2.0, 3.0)], "from, to"), ([(9.0, 5.0)], "the earlier first"),
                             ([(1e6, 2e6)], "no part of it"), ([("a", "b")], "exclude")):
            with self.assertRaisesRegex(ValueError, words):
                trussmap.compare(RIDDLE, MODEL, exclude=wrong)
        with self.assertRaisesRegex(ValueError, "each of the recordings"):
            trussmap.compare([RIDDLE, RIDDLE], MODEL, exclude=[(10.0, 20.0)])
        with self.assertRaises(TypeError):
            trussmap.compare(RIDDLE, MODEL, exclude=3.0)

    def test_mistakes_in_recordings_are_warnings(self):
        recording = trussmap.Recording.read(RIDDLE)
        columns = dict(recording.drive)
        columns["left"] = 100.0 * columns["left"]
        columns["right"] = 100.0 * columns["right"]
        wrong = trussmap.Recording(columns, recording.sightings, survey=recording.survey)
        with self.assertWarns(trussmap.RecordingWarning):
            trussmap.build_map(wrong, MODEL)
        self.assertGreater(len(trussmap.check(wrong, MODEL)), 0)


class Leaks(unittest.TestCase):
    def test_a_thousand_objects_in_threads_leave_nothing(self):
        recording = trussmap.Recording.read(RIDDLE)
        columns = recording.drive
        model = trussmap.Model.read(MODEL)

        def make_and_drop():
            for _ in range(125):
                one = trussmap.Recording(columns, recording.sightings)
                kept = [one.t, one.drive, one.sightings]
                poses = trussmap.apply(one, model.with_effect(trussmap.Effect("wheelbase", [0.01])))
                kept.append(poses.covariance)
                builder = trussmap.MapBuilder()
                builder.start("dock")
                builder.arrive("door", [4.0, 0.1], [[1e-4, 0.0], [0.0, 1e-4]])
                del one, poses, kept, builder

        def rounds(count):
            for _ in range(count):
                threads = [threading.Thread(target=make_and_drop) for _ in range(8)]
                for one in threads:
                    one.start()
                for one in threads:
                    one.join()
                gc.collect()

        rounds(1)  # what is made once, and what the allocator keeps
        before = resident()
        rounds(2)
        # 2000 recordings of this size hold some 300 MB.
        self.assertLess(resident() - before, 20e6)


if __name__ == "__main__":
    unittest.main()
