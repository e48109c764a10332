# SPDX-License-Identifier: Apache-2.0
"""Operations of the engine: results, options, progress, Ctrl-C, threads."""
import contextlib
import inspect
import io
import os
import re
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings
import zlib

import numpy as np

try:
    import _testcapi
except ImportError:
    _testcapi = None

import lumen
from fixture import sample

# A volume that takes seconds to track, and one that a run can be stopped in.
SLOW = "patient"


class VolumeTest(unittest.TestCase):
    def test_a_written_volume_has_the_mode_of_the_umask_which_stays(self):
        volume = lumen.Volume(np.zeros((2, 2, 2), np.uint8))
        before = os.umask(0o027)
        try:
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "a.nrrd")
                volume.write(path)
                self.assertEqual(os.stat(path).st_mode & 0o777, 0o640)
                with self.assertRaises(lumen.Error) as raised:
                    volume.write(os.path.join(folder, "absent", "a.nrrd"))
                self.assertEqual(raised.exception.kind, "failed")
                with self.assertRaisesRegex(lumen.Error, "a volume is written as .*nrrd"):
                    volume.write(os.path.join(folder, "a.jpg"))
                self.assertEqual(os.listdir(folder), ["a.nrrd"])
        finally:
            os.umask(before)

    def test_a_written_volume_is_read_with_its_geometry(self):
        turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])
        array = np.arange(24, dtype=np.int16).reshape(2, 3, 4)
        volume = lumen.Volume(array, (0.5, 0.6, 0.7), (1, 2, 3), turn)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.nrrd")
            volume.write(path)
            again = lumen.Volume.read(path)
            info = lumen.run("info", path)
        np.testing.assert_array_equal(again.array, array)
        np.testing.assert_allclose(again.spacing, volume.spacing)
        np.testing.assert_allclose(again.origin, volume.origin)
        np.testing.assert_allclose(again.direction, turn)
        np.testing.assert_allclose(again.position((1, 1, 1)), turn @ (0.5, 0.6, 0.7) + (1, 2, 3))
        self.assertEqual(info["size"], [4, 3, 2])

    def test_the_array_that_was_read_points_into_the_volume(self):
        array = sample().phantom.volume.array
        self.assertFalse(array.flags.owndata)
        self.assertEqual(array.ndim, 3)

    def test_other_arrays_are_refused(self):
        for array in (np.zeros((2, 2)), np.zeros((2, 2, 0)), np.zeros((2, 2, 2), complex),
                      np.full((2, 2, 2), 2**31)):
            with self.assertRaises(ValueError):
                lumen.Volume(array)

    def test_every_type_of_voxels_gives_its_values(self):
        for kind in ("i1", "u1", "i2", "u2", "i4", "u4", "i8", ">u8", "f4", "f8", ">i2", "?"):
            array = np.array([[[0, 1], [1, 0]]] * 2).astype(kind)
            for ending in ("nrrd", "nii", "nii.gz", "mha"):
                with tempfile.TemporaryDirectory() as folder:
                    path = os.path.join(folder, f"a.{ending}")
                    lumen.Volume(array).write(path)
                    again = lumen.Volume.read(path)
                np.testing.assert_array_equal(again.array, array.astype(float), err_msg=f"{kind} {ending}")

    def test_nrrd_holds_types_as_they_are(self):
        for kind, name in (("i4", "int"), ("u4", "unsigned int"), ("f8", "double"), ("i1", "signed char"), ("?", "unsigned char")):
            array = np.array([[[0, 1], [1, 0]]] * 2).astype(kind)
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "a.nrrd")
                lumen.Volume(array).write(path)
                with open(path, "rb") as file:
                    header, _, voxels = file.read().partition(b"\n\n")
            self.assertIn(f"\ntype: {name}\n", header.decode())
            self.assertEqual(zlib.decompress(voxels, zlib.MAX_WBITS + 16), array.tobytes())


class ResultsTest(unittest.TestCase):
    def setUp(self):
        self.sample = sample()
        self.case = self.sample.case

    def test_the_case_is_close_to_the_truth(self):
        scores = self.case.compare(self.sample.phantom.truth)
        self.assertLess(scores["assd_mm"], 0.1)
        self.assertEqual({b.label for b in self.case.branches},
                         {s["label"] for s in self.sample.phantom.seeds})

    def test_tracking_and_fit_are_the_parts_of_a_conversion(self):
        phantom = self.sample.phantom
        tracked = lumen.track(phantom.volume, seeds=phantom.seeds, seeds_only=True)
        self.assertIsNone(tracked.models)
        fitted = tracked.fit()
        np.testing.assert_array_equal(fitted.tree.centre, self.case.tree.centre)
        np.testing.assert_array_equal(fitted.models.width, self.case.models.width)

    def test_vessels_are_found_without_a_click(self):
        seeds = lumen.find_vessels(self.sample.phantom.volume)
        self.assertGreaterEqual(len(seeds), 2)
        truth = self.sample.phantom.truth.tree
        for seed in seeds:
            point = seed["points"][0]
            point = point["position"] if isinstance(point, dict) else point
            away = np.linalg.norm(truth.centre - point, axis=1)
            self.assertLess(away.min(), truth.radius[away.argmin()])

    def test_seeds_may_be_points_by_label(self):
        points = {seed["label"]: [p["position"] if isinstance(p, dict) else p for p in seed["points"]]
                  for seed in self.sample.phantom.seeds[:1]}
        case = lumen.track(self.sample.phantom.volume, seeds=points, seeds_only=True)
        self.assertEqual([b.label for b in case.branches], list(points))

    def test_a_mesh_is_closed_and_as_large_as_the_lumen(self):
        mesh = self.case.mesh()
        self.assertEqual(mesh.vertices.dtype, np.float32)
        edges = np.sort(mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        _, uses = np.unique(edges, axis=0, return_counts=True)
        self.assertTrue((uses == 2).all())
        self.assertIn("wall", mesh.groups)
        self.assertEqual(set(np.unique(mesh.group)), set(range(1, len(mesh.groups) + 1)))
        np.testing.assert_allclose(np.linalg.norm(mesh.attributes["normal"], axis=1), 1, atol=1e-3)
        model = lumen.blob.Model(self.case)
        wall = np.unique(mesh.triangles[mesh.group == 1 + mesh.groups.index("wall")])
        away = np.abs(model.query(mesh.vertices[wall]).distance)
        self.assertLess(np.median(away), 0.02)
        self.assertGreater(mesh.volume(), 0)

    def test_a_mesh_file_is_written_by_its_name(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.glb")
            answer = lumen.convert(self.case, path, colour="radius")
            with open(path, "rb") as file:
                self.assertEqual(file.read(4), b"glTF")
        self.assertEqual(answer["branches"], len(self.case.branches))

    def test_measures_have_units_in_their_names(self):
        measures = self.case.measure()
        vessels = measures["cases"][0]["vessels"]
        self.assertEqual(measures["cases"][0]["case"], "case.lumen")
        lengths = [vessel["length_mm"]["value"] for vessel in vessels]
        self.assertAlmostEqual(sum(lengths), 42, delta=5)

    def test_the_check_agrees_with_the_volume(self):
        self.assertEqual(self.case.check(self.sample.phantom.volume).code, 0)

    def test_an_export_is_a_folder_of_files(self):
        self.assertIn("sofa", [target["name"] for target in lumen.targets()])
        with tempfile.TemporaryDirectory() as folder:
            self.case.export("sofa", os.path.join(folder, "out"))
            self.assertIn("lumen-export.json", os.listdir(os.path.join(folder, "out")))

    def test_a_picture_is_a_png_of_its_size_and_not_blank(self):
        picture = self.case.picture(size=(320, 240), view="left")
        self.assertEqual(picture[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(struct.unpack(">2I", picture[16:24]), (320, 240))
        self.assertEqual(self.case._repr_png_()[:4], b"\x89PNG")
        self.assertIsNone(lumen.track(self.sample.phantom.volume, seeds=self.sample.phantom.seeds,
                                      seeds_only=True)._repr_png_())

    def test_an_xray_is_an_array_of_attenuation(self):
        ray = self.case.xray(size=(64, 48), lao=30, tissue=0)
        self.assertEqual((ray.shape, ray.dtype), ((48, 64), np.float32))
        self.assertEqual(ray[0, 0], 0)  # nothing but air at the corner
        self.assertGreater(ray.max(), 0.1)
        turned = self.case.xray(size=(64, 48), lao=30, tissue=0, iodine=0)
        self.assertEqual(turned.max(), 0)  # without contrast agent the vessel is not seen


class OptionsTest(unittest.TestCase):
    def setUp(self):
        self.case = sample().case

    def test_an_unknown_name_gets_the_engines_suggestion(self):
        with self.assertRaisesRegex(lumen.Error, "max_subdivision: .*did you mean max_subdivisions") as e:
            self.case.fit(max_subdivision=3)
        self.assertEqual((e.exception.exit_code, e.exception.kind), (2, "usage"))

    def test_a_value_out_of_range_is_refused_with_both_values(self):
        with self.assertRaises(lumen.Error) as raised:
            self.case.fit(max_subdivisions=-3)
        self.assertRegex(str(raised.exception), "^max_subdivisions: found -3, expected ")
        self.assertEqual(raised.exception.found, "-3")

    def test_errors_have_their_file_and_place(self):
        volume, missing = sample().phantom.volume, "absent.nrrd"
        calls = ((lambda: lumen.convert(missing), missing, None),
                 (lambda: lumen.Volume.read(missing), missing, None),
                 (lambda: lumen.track(volume, seeds=[{"label": "a"}]), "seeds", "/branches/0"),
                 (lambda: self.case.export("sofaa", "nowhere"), None, None))
        for call, file, place in calls:
            with self.assertRaises(lumen.Error) as raised:
                call()
            self.assertEqual((raised.exception.file, raised.exception.place), (file, place))
        self.assertEqual(lumen.Error("a.nrrd: line 3: found x, expected y").place, "line 3")

    def test_volumes_lie_behind_pictures_and_name_branches(self):
        volume = sample().phantom.volume
        plain, behind = (self.case.picture(size=(320, 240), view="anterior", volume=v)
                         for v in (None, volume))
        self.assertNotEqual(plain, behind)
        with tempfile.TemporaryDirectory() as folder:
            mask = os.path.join(folder, "mask.nrrd")
            self.case.check(volume, mask=mask)
            labels = lumen.Volume.read(mask)
        self.assertEqual(set(np.unique(labels.array)), {0, 1, 2})
        made = lumen.convert(lumen.Volume(labels.array > 0, labels.spacing, labels.origin), mask=True)
        self.assertLess(made.compare(sample().phantom.truth)["assd_mm"], 0.1)

    def test_options_are_in_docstrings_groups_and_stubs(self):
        members = {name: group for name, group in vars(lumen.options).items() if inspect.isclass(group)}
        for function, command in ((lumen.track, "track"), (lumen.convert, "convert"), (lumen.fit, "fit"),
                                  (lumen.Case.fit, "fit"), (lumen.Case.picture, "picture")):
            self.assertEqual(list(inspect.signature(function).parameters)[-4:],
                             ["progress", "threads", "strict", "options"])
            for row in lumen.options_of(command):
                if row["keyword"] in ("to", "turntable"):
                    continue
                self.assertRegex(function.__doc__, rf"(?m)(^|\W){row['keyword']}\b")
                if row["keyword"] + " : " not in function.__doc__:
                    named = [name for name in members if f"lumen.options.{name}\n" in function.__doc__]
                    self.assertTrue(any(f"{row['keyword']} : " in members[name].__doc__ and
                                        row["keyword"] in inspect.signature(members[name]).parameters
                                        for name in named), row["keyword"])
        folder = os.path.dirname(lumen.__file__)
        for name, line in (("__init__", "inlier_rate: Optional[float] = None"), ("options", "inlier_rate: float")):
            with open(os.path.join(folder, name + ".pyi"), encoding="utf-8") as file:
                text = file.read()
            self.assertNotIn("{", text)
            self.assertIn(line, text)
            compile(text, name, "exec")

    def test_groups_of_options_are_keywords(self):
        group = lumen.options.Fitting(max_subdivisions=-3)
        with self.assertRaisesRegex(lumen.Error, "^max_subdivisions: found -3, expected "):
            self.case.fit(**group)
        with self.assertRaisesRegex(lumen.Error, "max_subdivision: .*did you mean max_subdivisions"):
            self.case.fit(**lumen.options.Fitting(max_subdivision=3))
        self.assertEqual(lumen.options.Mesh.__module__, "lumen.options")

    def test_functions_of_a_case_take_its_path(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.lumen")
            self.case.write(path)
            np.testing.assert_array_equal(lumen.fit(path).models.width, self.case.models.width)
            np.testing.assert_array_equal(lumen.mesh(case=path).vertices, self.case.mesh().vertices)
            self.assertEqual(lumen.measure(path)["cases"][0]["case"], path)
            self.assertEqual(lumen.check(sample().phantom.volume, path).code, 0)
            self.assertEqual(lumen.picture(path, size=(320, 240)), self.case.picture(size=(320, 240)))

    def test_what_the_package_offers_is_in_the_stubs(self):
        stub = os.path.join(os.path.dirname(lumen.__file__), "__init__.pyi")
        with open(stub, encoding="utf-8") as file:
            text = file.read()
        for name in lumen.__all__:
            self.assertRegex(text, rf"(class|def|import) {name}\b|as {name}\b")
            value = getattr(lumen, name)
            if inspect.isclass(value) and value.__module__.startswith("lumen"):
                for member in vars(value):
                    if not member.startswith("_") and not issubclass(value, tuple):
                        self.assertRegex(text, rf"\b{member}\b", name)

    def test_warnings_are_warnings_and_errors_with_strict(self):
        volume = sample().phantom.volume
        outside = [{"label": "far", "points": [[1e4, 0, 0]]}, *sample().phantom.seeds]
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            lumen.track(volume, seeds=outside, seeds_only=True)
        caught = [w for w in caught if issubclass(w.category, lumen.Warning)]
        self.assertTrue(caught)
        self.assertEqual(caught[0].filename, __file__)
        with self.assertRaisesRegex(lumen.Error, "strict"):
            lumen.track(volume, seeds=outside, seeds_only=True, strict=True)


class NamesTest(unittest.TestCase):
    def test_names_in_docstrings_and_in_the_guide_exist(self):
        folder = os.path.dirname(lumen.__file__)
        guide = os.path.join(os.path.dirname(__file__), "../../../docs/python.md")
        texts = [guide, *(os.path.join(folder, name) for name in os.listdir(folder) if name.endswith(".py"))]
        names = set()
        for path in texts:
            with open(path, encoding="utf-8") as file:
                names.update(re.findall(r"(?<![\w./-])lumen((?:\.[A-Za-z]\w*)+)", file.read()))
        self.assertGreater(len(names), 20)
        for name in names - {".libs", ".json"}:
            if name.startswith((".torch", ".gym")):
                continue  # need PyTorch and Gymnasium
            value = lumen
            for part in name.split(".")[1:]:
                self.assertTrue(hasattr(value, part), f"lumen{name}")
                value = getattr(value, part)


class WatchedTest(unittest.TestCase):
    def test_progress_is_reported_by_the_calling_thread(self):
        calls = []
        lumen.track(sample().phantom.volume, seeds=sample().phantom.seeds, seeds_only=True,
                    progress=lambda *state: calls.append((threading.current_thread(), state)))
        self.assertTrue(calls)
        self.assertEqual({thread for thread, _ in calls}, {threading.current_thread()})
        for _, (stage, done, total) in calls:
            self.assertIsInstance(stage, str)
            self.assertTrue(total == 0 or done <= total)

    def test_an_exception_of_progress_stops_the_work(self):
        class Enough(Exception):
            pass

        def stop(*_):
            raise Enough

        for work in (lambda: lumen.phantom(SLOW, progress=stop), lambda: sample().case.surface(progress=stop)):
            with self.assertRaises(Enough):
                work()

    @unittest.skipIf(_testcapi is None, "Python's module _testcapi is missing")
    def test_a_state_that_cannot_be_handed_over_stops_the_work(self):
        seen = []

        def arm(*state):
            is_first = not any(total > 256 for _, _, total in seen)
            seen.append(state)
            if is_first and state[2] > 256:  # Python makes an object for such a number
                _testcapi.set_nomemory(1, 2)  # the next text is made, the number behind it is not

        self.addCleanup(_testcapi.remove_mem_hooks)
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaises(RuntimeError):  # of the binding: there is no exception of Python for it
                lumen.run("phantom", SLOW, os.path.join(folder, "a.nrrd"), progress=arm)
            _testcapi.remove_mem_hooks()
            self.assertEqual(os.listdir(folder), [])  # the work did not go on to its end

    def interrupted(self, work, *arguments):
        """The output of a child whose work is interrupted soon after its begin."""
        program = ("import lumen, sys\n"
                   "case = lumen.Case.from_bytes(sys.stdin.buffer.read())\n"
                   "print('ready', flush=True)\n"
                   "try:\n"
                   f"    {work}\n"
                   "    print('ended')\n"
                   "except KeyboardInterrupt:\n"
                   "    print('interrupted')\n")
        with subprocess.Popen([sys.executable, "-c", program, *arguments], stdin=subprocess.PIPE,
                              stdout=subprocess.PIPE) as child:
            child.stdin.write(sample().case.to_bytes())
            child.stdin.close()
            self.assertEqual(child.stdout.readline(), b"ready\n")
            time.sleep(0.3)
            child.send_signal(signal.SIGINT)
            began = time.monotonic()
            out = child.stdout.read()
            self.assertEqual(child.wait(timeout=30), 0)
        self.assertLess(time.monotonic() - began, 10)
        return out

    def test_ctrl_c_raises_and_leaves_nothing_half_written(self):
        with tempfile.TemporaryDirectory() as folder:
            out = self.interrupted(f"lumen.run('phantom', {SLOW!r}, sys.argv[1])", os.path.join(folder, "a.nrrd"))
            self.assertEqual((out, os.listdir(folder)), (b"interrupted\n", []))

    def test_ctrl_c_ends_the_work_on_a_surface(self):
        self.assertEqual(self.interrupted("case.surface(edge='0.04r')"), b"interrupted\n")

    def test_other_threads_run_meanwhile(self):
        counted = [0]
        done = threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        began = time.monotonic()
        sample().case.mesh()
        seconds = time.monotonic() - began
        done.set()
        thread.join()
        self.assertGreater(counted[0], 50 * seconds)

    def test_two_threads_get_the_same_result(self):
        results = []
        work = lambda: results.append(sample().case.fit(threads=1))
        threads = [threading.Thread(target=work) for _ in range(2)]
        sample()
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(results), 2)
        self.assertEqual(results[0], results[1])

    def test_nothing_is_printed(self):
        with contextlib.redirect_stdout(io.StringIO()) as out:
            sample().case.info()
        self.assertEqual(out.getvalue(), "")


if __name__ == "__main__":
    unittest.main()
