# SPDX-License-Identifier: Apache-2.0
"""Images of SimpleITK, ITK, nibabel and xarray: stand-ins of their classes, and the packages where they are installed."""
import importlib
import itertools
import os
import sys
import tempfile
import types
import unittest
import unittest.mock
import warnings

import numpy as np

import lumen
from fixture import sample

SPACING, ORIGIN, SIZE = (0.5, 0.75, 1.25), (11.0, -7.0, 3.0), (4, 3, 2)
VOXELS = np.arange(24, dtype=np.int16).reshape(2, 3, 4)
RAS = np.diag([-1.0, -1, 1])


def turned():
    """Directions of index axes, LPS: oblique ones, and each set of signs, half of them left-handed."""
    about, tilt = np.radians((20, 35))
    first = np.array([[np.cos(about), -np.sin(about), 0], [np.sin(about), np.cos(about), 0], [0, 0, 1]])
    second = np.array([[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)], [0, np.sin(tilt), np.cos(tilt)]])
    yield first @ second
    yield first @ second @ np.diag([1, 1, -1.0])
    yield np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0.0]])
    yield from (np.diag(signs) for signs in itertools.product((1.0, -1.0), repeat=3))


def made(module, **members):
    """An object whose class says that it is of a module."""
    return type("Image", (), {"__module__": module, **members})()


def itk_like(direction, array=VOXELS, numbers=1):
    image = made("itk.itkImagePython", GetImageDimension=lambda _: array.ndim, GetSpacing=lambda _: SPACING,
                 GetOrigin=lambda _: ORIGIN, GetDirection=lambda _: direction,
                 GetNumberOfComponentsPerPixel=lambda _: numbers)
    package = types.SimpleNamespace(array_from_image=lambda _: array, array_from_matrix=np.asarray)
    return image, {"itk": package}


def simple_itk_like(direction, array=VOXELS, numbers=1):
    image = made("SimpleITK.SimpleITK", GetDimension=lambda _: array.ndim, GetSpacing=lambda _: SPACING,
                 GetOrigin=lambda _: ORIGIN, GetDirection=lambda _: tuple(direction.ravel()),
                 GetNumberOfComponentsPerPixel=lambda _: numbers)
    return image, {"SimpleITK": types.SimpleNamespace(GetArrayFromImage=lambda _: array)}


def affine_of(direction):
    """nibabel's: to RAS."""
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = RAS @ direction * SPACING, RAS @ ORIGIN
    return affine


class Header(dict):
    unit = "mm"

    def get_xyzt_units(self):
        return self.unit, "sec"

    def get_qform(self):
        raise AssertionError("nobody needs it")

    def get_zooms(self):
        return SPACING


def nibabel_like(direction, array=VOXELS, codes=(1, 1), unit="mm"):
    header = Header(qform_code=codes[0], sform_code=codes[1])
    header.unit = unit
    return made("nibabel.nifti1", affine=affine_of(direction), dataobj=array.T, header=header), {}


def xarray_like(direction, dims="zyx", coords=None, units=None):
    class Coordinate(types.SimpleNamespace):
        attrs = {} if units is None else {"units": units}

    places = {axis: ORIGIN[a] + SPACING[a] * np.arange(SIZE[a]) for a, axis in enumerate("xyz")}
    coords = {axis: Coordinate(data=data) for axis, data in {**places, **(coords or {})}.items() if data is not None}
    array = VOXELS.transpose(["zyx".index(axis) for axis in dims if axis in "xyz"])
    order = lambda _, *axes: types.SimpleNamespace(data=array.transpose([dims.index(axis) for axis in axes]))
    attrs = {} if direction is None else {"direction": np.flip(direction)}
    return made("xarray.core.dataarray", dims=tuple(dims), coords=coords, attrs=attrs, transpose=order), {}


class StandInTest(unittest.TestCase):
    def volume_of(self, image, modules):
        with unittest.mock.patch.dict(sys.modules, modules):
            return lumen.Volume.of(image)

    def assert_placed(self, volume, direction, scale=1.0):
        np.testing.assert_array_equal(volume.array, VOXELS)
        np.testing.assert_allclose(volume.spacing, np.multiply(SPACING, scale))
        np.testing.assert_allclose(volume.origin, np.multiply(ORIGIN, scale))
        np.testing.assert_allclose(volume.direction, direction, atol=1e-12)

    def test_each_package_has_its_own_axes_and_frame(self):
        for direction in turned():
            for like in (itk_like, simple_itk_like, nibabel_like, xarray_like):
                with self.subTest(like=like.__name__, direction=direction.tolist()):
                    self.assert_placed(self.volume_of(*like(direction)), direction)
            volume = lumen.Volume.of_affine(VOXELS.T, affine_of(direction))
            self.assert_placed(volume, direction)
            volume = lumen.Volume.of_affine(VOXELS.T, np.diag([-1, -1, 1, 1]) @ affine_of(direction), "lps")
            self.assert_placed(volume, direction)

    def test_an_image_reaches_the_engine_by_its_geometry(self):
        direction = next(turned())
        for like in (itk_like, simple_itk_like, nibabel_like, xarray_like):
            image, modules = like(direction)
            with unittest.mock.patch.dict(sys.modules, modules):
                facts = lumen.run("info", image)
            self.assertEqual(facts["size"], list(SIZE))
            np.testing.assert_allclose(facts["spacing_mm"], SPACING, err_msg=like.__name__)
            np.testing.assert_allclose(facts["origin_mm"], ORIGIN, err_msg=like.__name__)
            np.testing.assert_allclose(facts["direction"], direction.ravel(), err_msg=like.__name__, atol=1e-12)

    def test_units_of_a_header_become_mm(self):
        for unit, scale in (("mm", 1), ("meter", 1e3), ("micron", 1e-3)):
            self.assert_placed(self.volume_of(*nibabel_like(np.eye(3), unit=unit)), np.eye(3), scale)
        for unit, scale in (("mm", 1), ("m", 1e3), ("um", 1e-3)):
            self.assert_placed(self.volume_of(*xarray_like(None, units=unit)), np.eye(3), scale)
        with self.assertRaisesRegex(ValueError, "found the units 'furlong' of x, expected one of meter"):
            self.volume_of(*xarray_like(None, units="furlong"))

    def test_a_header_that_leaves_place_or_unit_open_is_doubted_by_the_engine(self):
        nowhere = nibabel_like(np.diag([-1.0, 1, 1]), codes=(0, 0))
        for given, sentence in ((nowhere, "does not state where the patient's left"),
                                (nibabel_like(np.eye(3), unit="unknown"), "its header states no unit of length")):
            with self.assertWarnsRegex(lumen.Warning, sentence):
                lumen.run("info", given[0])
            with self.assertRaisesRegex(lumen.Error, "strict"):
                lumen.run("info", given[0], strict=True)
        volume = lumen.Volume.of(nowhere[0])
        np.testing.assert_array_equal(volume.direction, np.eye(3))
        self.assertEqual(volume.origin, (0, 0, 0))

    def test_dims_of_a_data_array_may_have_any_order_and_run_backwards(self):
        for dims in itertools.permutations("xyz"):
            self.assert_placed(self.volume_of(*xarray_like(None, "".join(dims))), np.eye(3))
        places = ORIGIN[1] - SPACING[1] * np.arange(3)
        self.assert_placed(self.volume_of(*xarray_like(None, coords={"y": places})), np.diag([1.0, -1, 1]))

    def test_images_that_are_no_volumes_are_refused_with_what_was_found(self):
        many = np.zeros((2, 2, 2, 2))
        uneven = {"x": np.array([0, 1, 2, 4.0])}
        cases = ((simple_itk_like(np.eye(4), many), "found 4 axes and 1 numbers a voxel, expected 3 and 1"),
                 (itk_like(np.eye(3), numbers=3), "found 3 axes and 3 numbers a voxel, expected 3 and 1"),
                 (nibabel_like(np.eye(3), np.zeros((5, 2, 3, 4))), "found 4 axes, 4 x 3 x 2 x 5, expected 3: .*slicer"),
                 (xarray_like(None, "zyxt"), "found the dims z, y, x, t, expected x, y and z"),
                 (xarray_like(None, coords={"x": None}), "found no coordinates of the dim x"),
                 (xarray_like(None, coords=uneven), "found uneven steps along x"))
        for (image, modules), sentence in cases:
            with self.assertRaisesRegex(ValueError, sentence), unittest.mock.patch.dict(sys.modules, modules):
                lumen.convert(image)
        with self.assertRaisesRegex(TypeError, "found builtins.list, expected a path, a lumen.Case, .*nibabel"):
            lumen.convert([1, 2])

    def test_further_axes_of_one_step_are_no_axes(self):
        self.assert_placed(self.volume_of(*nibabel_like(np.eye(3), VOXELS[None])), np.eye(3))

    def test_affines_that_place_no_voxels_are_refused(self):
        flat, wrong = np.eye(4), np.eye(4)
        flat[:, 0] = 0
        wrong[3, 0] = 1
        for affine, sentence in ((flat, "an axis without a length"), (wrong, "last row"), (np.full((4, 4), np.nan), "finite"),
                                 (np.eye(3), r"matrix \(4, 4\)")):
            with self.assertRaisesRegex(ValueError, sentence):
                lumen.Volume.of_affine(VOXELS.T, affine)
        with self.assertRaisesRegex(ValueError, "found 'RAS', expected 'ras' or 'lps'"):
            lumen.Volume.of_affine(VOXELS.T, np.eye(4), "RAS")
        sheared = np.eye(4)
        sheared[0, 1] = 2
        with self.assertRaisesRegex(lumen.Error, "not orthogonal unit vectors"):
            lumen.case_of(VOXELS.T, affine=sheared)


def package(name):
    """A package, or the reason why it is missing."""
    try:
        return importlib.import_module(name)
    except ImportError:
        raise unittest.SkipTest(f"{name} is missing") from None


class PackagesTest(unittest.TestCase):
    """A file that a package has read is where lumen's own reader has it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def check(self, path, image):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", lumen.Warning)
            own = lumen.Volume.read(path)
        volume = lumen.Volume.of(image)
        np.testing.assert_array_equal(volume.array, own.array)
        np.testing.assert_allclose(volume.spacing, own.spacing, rtol=1e-5)
        np.testing.assert_allclose(volume.origin, own.origin, atol=1e-4)
        np.testing.assert_allclose(volume.direction, own.direction, atol=1e-5)

    def written(self):
        """Files by lumen: NRRD in every direction."""
        for number, direction in enumerate(turned()):
            path = os.path.join(self.folder, f"{number}.nrrd")
            lumen.Volume(VOXELS, SPACING, ORIGIN, direction).write(path)
            yield path

    def test_simple_itk(self):
        simple = package("SimpleITK")
        for path in self.written():
            image = simple.ReadImage(path)
            self.check(path, image)
            nifti = path.replace(".nrrd", ".nii.gz")
            simple.WriteImage(image, nifti)
            self.check(nifti, simple.ReadImage(nifti))
        for other in (simple.JoinSeries([image, image]), simple.Compose(image, image)):
            with self.assertRaisesRegex(ValueError, "expected 3 and 1"):
                lumen.Volume.of(other)
        array = lumen.Volume.of(simple.ReadImage(path)).array  # its memory outlives the image
        np.testing.assert_array_equal(array, VOXELS)

    def test_itk(self):
        itk = package("itk")
        for path in self.written():
            self.check(path, itk.imread(path))
        array = lumen.Volume.of(itk.imread(path)).array  # its memory outlives the image
        np.testing.assert_array_equal(array, VOXELS)

    def test_data_arrays_of_itk(self):
        itk = package("itk")
        package("xarray")
        for path in self.written():
            array = itk.xarray_from_image(itk.imread(path))
            self.check(path, array)
            self.check(path, array.transpose("x", "z", "y"))

    def test_nibabel(self):
        nibabel = package("nibabel")
        path = os.path.join(self.folder, "a.nii.gz")
        for direction in turned():
            image = nibabel.Nifti1Image(VOXELS.T, affine_of(direction))
            for unit, codes in (("mm", (1, 1)), ("meter", (0, 2)), ("micron", (1, 0)), ("unknown", (1, 1)),
                                ("mm", (0, 0))):
                image.header.set_xyzt_units(unit)
                for name, code in zip(("qform", "sform"), codes):
                    getattr(image, f"set_{name}")(affine_of(direction), code)
                nibabel.save(image, path)
                with self.subTest(unit=unit, codes=codes, direction=direction.tolist()):
                    self.check(path, nibabel.load(path))
        several = nibabel.Nifti1Image(np.zeros((2, 3, 4, 5), np.int16), np.eye(4))
        with self.assertRaisesRegex(ValueError, "found 4 axes, 2 x 3 x 4 x 5, expected 3"):
            lumen.convert(several)
        self.assertEqual(lumen.Volume.of(several.slicer[..., :1]).shape, (4, 3, 2))


class CaseOfTest(unittest.TestCase):
    def setUp(self):
        self.phantom = sample().phantom
        volume = self.phantom.volume
        self.affine = np.eye(4)
        self.affine[:3, :3] = RAS @ volume.direction * volume.spacing
        self.affine[:3, 3] = RAS @ volume.origin

    def test_an_array_with_its_affine_is_the_case_of_the_volume(self):
        options = lumen.options.Tracking(seeds=self.phantom.seeds, seeds_only=True)
        case = lumen.case_of(self.phantom.volume.array.T, affine=self.affine, **options)
        np.testing.assert_allclose(case.tree.centre, sample().case.tree.centre, atol=1e-3)

    def test_an_array_whose_voxel_size_nobody_states_is_warned_of(self):
        tube = np.zeros((32, 32, 32), np.uint8)
        tube[14:18, 14:18, :] = 1
        with self.assertWarnsRegex(lumen.Warning, "volume: an array states no voxel size") as warned:
            lumen.case_of(tube)
        self.assertEqual(warned.warning.code, "file-assumption")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            lumen.case_of(tube, spacing=0.5)
            lumen.case_of(lumen.Volume(tube, spacing=1))

    def test_labels_beside_an_array_name_its_branches(self):
        volume = self.phantom.volume
        with tempfile.TemporaryDirectory() as folder:
            mask = os.path.join(folder, "mask.nrrd")
            sample().case.check(volume, mask=mask)
            labels = lumen.Volume.read(mask).array
        table = {1: "trunk", 2: "twig"}
        given = ((volume, labels, None), (volume.array.T, labels.T, self.affine), (volume, volume.like(labels), None))
        for source, beside, affine in given:
            case = lumen.case_of(source, affine=affine, labels=beside, label_table=table)
            self.assertEqual({branch.label for branch in case.branches}, set(table.values()))
        alone = lumen.case_of(volume.like(labels), labels=table)
        self.assertEqual({branch.label for branch in alone.branches}, set(table.values()))
        with self.assertRaisesRegex(ValueError, r"found shape \(1, 1, 1\), expected that of the volume"):
            lumen.case_of(volume, labels=np.zeros((1, 1, 1)))


if __name__ == "__main__":
    unittest.main()
