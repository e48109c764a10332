# SPDX-License-Identifier: Apache-2.0
"""Arguments that a user gets wrong: faults in the words of the caller, before any work."""
import os
import pickle
import re
import tempfile
import unittest
import unittest.mock
import warnings

import numpy as np

import lumen
from fixture import sample
from test_images import VOXELS, itk_like, nibabel_like, package, simple_itk_like, xarray_like

GREY = np.arange(24, dtype=np.int16).reshape(2, 3, 4)  # too small for a vessel


class FaultsTest(unittest.TestCase):
    def refuse(self, sentence, function, *arguments, kind=lumen.ValueFault, **options):
        with self.assertRaisesRegex(kind, sentence) as raised:
            function(*arguments, **options)
        self.assertIsInstance(raised.exception, lumen.Error)
        return raised.exception


class LabelsBesideTest(FaultsTest):
    """Labels as an array have the axes of arrays of their source."""

    def labels_of(self, source, labels, function=lumen.case_of, **options):
        """The label map [k, j, i] that the engine gets."""
        with unittest.mock.patch("lumen._operations.case_made") as made_of:
            function(source, labels=labels, label_table={1: "BA"}, **options)
        return made_of.call_args.kwargs["label_map"].array

    def test_each_source_has_its_own_axes(self):
        labels = VOXELS.astype(np.uint8)
        square = np.arange(27, dtype=np.int16).reshape(3, 3, 3)  # of one shape in all axes
        eye = np.eye(3)
        with unittest.mock.patch.dict("sys.modules", {**simple_itk_like(eye)[1], **itk_like(eye)[1]}):
            sources = [(nibabel_like(eye)[0], labels.T), (simple_itk_like(eye)[0], labels), (itk_like(eye)[0], labels),
                       (lumen.Volume(VOXELS), labels), (VOXELS, labels), (xarray_like(None)[0], labels),
                       (xarray_like(None, "xzy")[0], labels.transpose(2, 0, 1)), (nibabel_like(eye)[0], labels.T[..., None])]
            for source, beside in sources:
                for function in (lumen.case_of, lumen.convert, lumen.track):
                    np.testing.assert_array_equal(self.labels_of(source, beside, function), labels)
        np.testing.assert_array_equal(self.labels_of(nibabel_like(eye, square)[0], square), square.T)
        np.testing.assert_array_equal(self.labels_of(VOXELS.T, labels.T, affine=np.eye(4)), labels)

    def test_another_shape_is_refused_in_those_axes(self):
        turned, labels = np.zeros((2, 3, 4)), np.zeros((4, 3, 2))
        for options, source, beside, axes, shape in (
                ({}, nibabel_like(np.eye(3))[0], turned, "i, j, k", labels.shape), ({}, VOXELS, labels, "k, j, i", turned.shape),
                ({}, xarray_like(None, "xzy")[0], turned, "i, k, j", (4, 2, 3)),
                ({"affine": np.eye(4)}, VOXELS.T, turned, "i, j, k", labels.shape)):
            self.refuse(rf"^labels: found shape {re.escape(str(beside.shape))}, expected that of the volume in its own axes "
                        rf"\[{axes}\], {re.escape(str(shape))}$", lumen.case_of, source, labels=beside, **options)
        self.refuse("^labels: found an array beside a value without axes", lumen.convert, "a.nii", labels=labels)

    def test_nibabel(self):
        nibabel = package("nibabel")
        labels = (VOXELS > 9).astype(np.uint8)
        image = nibabel.Nifti1Image(VOXELS.T, np.eye(4))
        np.testing.assert_array_equal(self.labels_of(image, labels.T), labels)

    def test_labels_that_a_grey_volume_does_not_hold(self):
        for source in (GREY, GREY + 0.5):
            fault = self.refuse("did you mean label_table", lumen.case_of, source, labels={77: "BA"}, kind=lumen.Error)
            self.assertEqual(fault.file, "volume")


class ArgumentsTest(FaultsTest):
    def test_an_affine_is_for_arrays(self):
        image = nibabel_like(np.eye(3))[0]
        self.refuse(r"^affine: the image has its own; leave it out, or pass image.get_fdata\(\)$", lumen.case_of, image,
                    affine=np.eye(4))
        for source in (lumen.Volume(GREY), "a.nii", xarray_like(None)[0]):
            self.refuse("^affine: the .* has its own place", lumen.case_of, source, affine=np.eye(4))
        for function in (lumen.convert, lumen.track):
            self.refuse(r"^affine: use lumen.case_of\(array, affine=...\)", function, GREY, affine=np.eye(4))

    def test_threads_progress_and_flags(self):
        for threads in ("two", 1.5, 0, -1, True, np.zeros(3)):
            self.refuse("^threads: found .*, expected a whole number above 0$", lumen.run, "info", GREY, threads=threads)
        self.refuse("^threads: found 'two', ", lumen.run, "info", GREY, threads="two")
        self.refuse("^progress: found True, expected a function", lumen.run, "info", GREY, progress=True)
        self.refuse("^progress: found 3, ", lumen.Volume.read, "a.nrrd", progress=3)
        for value in ("yes", "true", 1, 0, np.ones(3), []):
            self.refuse("^seeds_only: found .*, expected True or False$", lumen.convert, GREY, seeds_only=value)
        self.refuse("^seeds_only: found 'yes', expected True or False$", lumen.convert, GREY, seeds_only="yes")
        self.refuse("^strict: found 'no', ", lumen.run, "info", GREY, strict="no")
        self.assertEqual(lumen.run("info", GREY, threads=np.int64(1), strict=np.bool_(False))["size"], [4, 3, 2])
        for flag in (True, np.True_):  # a flag: the engine takes it
            self.refuse("seeds_only does nothing without seeds", lumen.convert, GREY, seeds_only=flag, kind=lumen.Error)

    def test_messages_of_the_compiled_module_show_no_arrays(self):
        from lumen import _calls, _lumen  # pylint: disable=import-outside-toplevel
        secret = np.full((2, 2), 4711)
        fault = self.refuse("^found arguments of the types str, ndarray, ", _calls.called, _lumen.run, "info", secret)
        self.assertNotRegex(str(fault), "4711|Invoked|argument types")
        self.assertTrue(fault.__suppress_context__)
        self.assertNotRegex(str(self.refuse("types list", lumen.blob.pack, [secret])), "4711")

        def stop(*_):
            raise TypeError("incompatible function arguments of mine")
        with self.assertRaisesRegex(TypeError, "of mine"):
            _calls.called(stop)

    def test_seeds(self):
        point = [1.0, 2, 3]
        nowhere = [point, [0, float("nan"), 0]]
        for seeds in ({"ICA": nowhere}, [{"label": "ICA", "points": np.array(nowhere)}]):
            self.refuse("^seeds: branch 'ICA', point 1: found nan, expected finite numbers$", lumen.track, GREY, seeds=seeds)
        for seeds in (5, [point], "x".split()):
            self.refuse("^seeds: found .*, expected a path, ", lumen.track, GREY, seeds=seeds)
        branches = lambda seeds: lumen._running.seeds_document(seeds)["branches"]
        one = [{"label": "BA", "points": [point]}]
        for seeds in ({"label": "BA", "points": [point]}, {"label": "BA", "points": point}, {"BA": point},
                      {"BA": np.array(point)}, [{"label": "BA", "points": np.array([point])}]):
            self.assertEqual(branches(seeds), one)
        self.assertEqual(branches({"points": [point]}), [{"label": "points", "points": [point]}])

    def test_small_mistakes(self):
        other = xarray_like(None)[0]
        type(other).dims = ("a", "b", "c")
        self.refuse("found the dims a, b, c, expected x, y and z", lumen.convert, other)
        self.refuse("it has no voxels", lumen.run, "info", np.zeros((0, 3, 4)))
        self.refuse(r"^label_table: found 'BA' as a label, expected \{1: 'BA'\}$", lumen.case_of, GREY, label_table={"BA": 1})
        self.refuse(r"pass \*\*Tracking\(\.\.\.\)$", lumen.convert, GREY, lumen.options.Tracking(rays=162))
        self.refuse(r"pass \*\*Tracking\(\.\.\.\)$", lumen.run, "info", lumen.options.Tracking(rays=162))
        self.refuse(r"choose one of its numbers or volumes first, such as array\[\.\.\., 0\]", lumen.convert, np.zeros((2, 3, 4, 3)))
        colours = np.zeros((2, 3, 4), np.dtype([("R", "u1"), ("G", "u1"), ("B", "u1")]))
        self.refuse(r"found 3 numbers a voxel, expected 1: .*array\['R'\]", lumen.convert, nibabel_like(np.eye(3), colours)[0])
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "crop.nii.gz")
            lumen.Volume(GREY).write(path)
            fault = self.refuse("lumen.Volume.read reads a volume, and lumen.convert", lumen.read, path, kind=lumen.Error)
            self.assertEqual((fault.file, fault.code), (path, "NOT_LUMEN"))


class ClassesTest(FaultsTest):
    def test_corrections_of_a_case_with_bad_arrays_raise(self):
        whole = sample().case
        for array, value in (("parent", 10**9), ("branch", 4 * 10**9)):
            for correct in (lambda e: e.root(0), lambda e: e.widen(5, 2.0, 10.0), lambda e: e.delete_node(3), lambda e: e.refit([3]),
                            lambda e: e.push(3, (0, 0, 0), (1, 0, 0), 1.0), lambda e: e.delete(0), lambda e: e.rename(0, "other")):
                case = whole.copy()
                getattr(case.tree, array)[:] = value
                with self.assertRaises(lumen.Error):
                    correct(case.edit)
        with self.assertRaises(IndexError):
            whole.edit.refit([10**6])

    def test_objects_whose_init_did_not_run_are_refused(self):
        blob, points = lumen.blob, np.zeros((2, 3))
        model = blob.Model(sample().case)
        unmade, cursor = blob.Model.__new__(blob.Model), blob.Cursor.__new__(blob.Cursor)
        for use in (lambda: unmade.query(points), lambda: len(unmade), lambda: unmade.bounds, lambda: unmade.cursor(points),
                    lambda: blob.pack([model, unmade]), lambda: blob.pack([None]), lambda: model.query(points, cursor),
                    lambda: cursor.node, lambda: len(cursor), lambda: model.query(points, out=blob.Answer.__new__(blob.Answer)),
                    lambda: blob.Hits.__new__(blob.Hits).t, lambda: lumen._lumen.Case.__new__(lumen._lumen.Case).branches):
            with self.assertRaises((TypeError, ValueError)):
                use()

    def test_a_fault_of_a_value_is_an_error_of_lumen_and_of_python(self):
        calls = ((lumen.Volume, (np.zeros((2, 2)),)), (lumen.Volume.of_affine, (GREY, np.eye(3))), (lumen.convert, ([1, 2],)),
                 (lumen.Case, (3,)), (lumen.Volume(GREY).like, (np.zeros(2),)))
        for function, arguments in calls:
            fault = self.refuse("expected|lumen.read", function, *arguments)
            self.assertIsInstance(fault, ValueError)
            self.assertIsInstance(fault, TypeError)
            self.assertEqual((fault.kind, fault.exit_code), ("usage", 2))
        again = pickle.loads(pickle.dumps(fault))
        self.assertEqual((type(again), str(again)), (lumen.ValueFault, str(fault)))

    def test_a_missing_file_is_one_of_python(self):
        for function, name in ((lumen.read, "a.lumen"), (lumen.convert, "a.nii"), (lumen.Volume.read, "a.nrrd"),
                               (lumen.measure, "a.lumen"), (lumen.blob.Model, "a.lumen")):
            fault = self.refuse(f"^{name}: (?!.*IO_)", function, f"{name}", kind=FileNotFoundError)
            self.assertIsInstance(fault, lumen.MissingFile)
            self.assertEqual((fault.file, fault.exit_code), (name, 3))
        self.assertIsInstance(pickle.loads(pickle.dumps(fault)), lumen.MissingFile)
        with tempfile.NamedTemporaryFile(suffix=".lumen") as file:
            self.assertNotIsInstance(self.refuse("", lumen.read, file.name, kind=lumen.Error), FileNotFoundError)

    def test_found_and_expected_are_those_of_the_message(self):
        for message, found, expected in (("a: found 3, expected 4", "3", "4"), ("a: found 3; expected [x, y]", "3", "[x, y]"),
                                         ("a: has a voxel of 0.5; expected labels", None, "labels"), ("a: is bad", None, None)):
            error = lumen.Error(message)
            self.assertEqual((error.found, error.expected), (found, expected))


class WordsTest(FaultsTest):
    """Messages speak of what the user gave."""

    def warned(self, image, **options):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            answer = lumen.run("info", image, **options)
        self.assertEqual(answer.warnings, [str(one.message) for one in caught])
        return answer.warnings

    def test_headers_of_images(self):
        image = nibabel_like(np.eye(3), codes=(0, 0), unit="unknown")[0]
        place, unit = self.warned(image)
        self.assertRegex(place, "^volume: its header does not state where the patient's left, back and head are")
        self.assertEqual(unit, 'volume: its header states no unit of length, so lengths are taken as mm; pass unit="mm" '
                         "to state it [file-assumption]")
        self.assertEqual(len(self.warned(image, unit="mm")), 1)
        self.refuse("^volume: its header .*strict", lumen.run, "info", image, strict=True, kind=lumen.Error)

    def test_an_image_has_the_name_of_its_file(self):
        image = nibabel_like(np.eye(3), unit="unknown")[0]
        type(image).get_filename = lambda _: "/home/someone/head.nii.gz"
        self.assertRegex(self.warned(image)[0], "^head.nii.gz: its header states no unit")
        fault = self.refuse("^head.nii.gz: ", lumen.run, "info", image, strict=True, kind=lumen.Error)
        self.assertEqual(fault.file, "head.nii.gz")
        type(image).get_filename = lambda _: None
        self.assertRegex(self.warned(image)[0], "^volume: ")

    def test_a_surface_is_no_file(self):
        case = sample().case
        calls = ([np.empty((0, 3))] * 2 + [[], [], {}], ["mesh.ply: is small"], [])
        with unittest.mock.patch("lumen._lumen.mesh_of", lambda *_: (*calls[0], *calls[1:])):
            with self.assertWarnsRegex(lumen.Warning, "^surface: is small$"):
                case.surface()

    def test_the_module_lists_its_names(self):
        listed = set(re.findall(r"\w+", " ".join(line[:26] for line in lumen.__doc__.splitlines() if line.startswith("    "))))
        self.assertLessEqual(set(lumen.__all__), listed)
        self.assertEqual({*dir(lumen), "torch"}, {*lumen.__all__, "__version__", "torch"})


if __name__ == "__main__":
    unittest.main()
