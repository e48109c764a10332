# SPDX-License-Identifier: Apache-2.0
"""Work on values in memory: no files, no copies, and names that stand for values."""
import gc
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import lumen
from fixture import sample

# All work that needs no file of the user's.
WORK = """
import numpy, lumen
phantom = lumen.phantom("bifurcation")
volume = phantom.volume
case = lumen.convert(volume, seeds=phantom.seeds, seeds_only=True)
lumen.track(volume, seeds={"a": phantom.truth.tree.centre[200:202]}, seeds_only=True).fit()
lumen.find_vessels(volume)
case.surface(), case.mesh(edge="0.5r"), case.trim(min_radius=0.1), case.picture(size=(64, 48), volume=volume)
case.check(volume), case.compare(phantom.truth), case.measure(), case.info(), lumen.validate(case), lumen.run("info", volume)
labels = numpy.zeros(volume.shape, numpy.uint8)
labels[volume.array > volume.array.mean()] = 1
lumen.case_of(volume, labels=labels, label_table={1: "trunk"})
lumen.targets()
print("done")
"""
TRACED = "openat,open,creat,mkdir,mkdirat,unlink,unlinkat,rename,renameat,renameat2"


def run_child(program, *before, **environment):
    """The ended process of a program that must print "done"."""
    return subprocess.run([*before, sys.executable, "-B", "-c", program], env={**os.environ, **environment}, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)


class NoFilesTest(unittest.TestCase):
    def test_work_on_values_needs_no_folder_for_files(self):
        with tempfile.TemporaryDirectory() as folder:
            ended = run_child(f"import os; os.chdir({folder!r})\n" + WORK, TMPDIR="/nonexistent")
            self.assertEqual(ended.stdout.splitlines()[-1:], ["done"], ended.stdout)
            self.assertEqual(os.listdir(folder), [])

    @unittest.skipIf(shutil.which("strace") is None, "strace (Debian: strace) is missing")
    def test_work_on_values_opens_no_file_for_writing(self):
        with tempfile.TemporaryDirectory() as folder:
            log = os.path.join(folder, "log")
            ended = run_child(WORK, "strace", "-f", "-qq", "-e", f"trace={TRACED}", "-o", log)
            if "ptrace" in ended.stdout:
                self.skipTest("strace may not trace here")
            self.assertEqual(ended.stdout.splitlines()[-1:], ["done"], ended.stdout)
            with open(log, encoding="utf-8", errors="replace") as file:
                calls = [line for line in file if not re.search(r'"/(dev|proc|sys)/', line)]
        self.assertTrue(any("_lumen" in line for line in calls))  # it looked
        wrote = [line for line in calls if re.search(r"O_WRONLY|O_RDWR|O_CREAT|(creat|mkdir|unlink|rename)\w*\(", line)]
        self.assertEqual(wrote, [])


class NamesTest(unittest.TestCase):
    def setUp(self):
        self.case, self.volume = sample().case, sample().phantom.volume

    def test_values_have_names_in_messages(self):
        tracked = lumen.track(self.volume, seeds=sample().phantom.seeds, seeds_only=True)
        with self.assertRaises(lumen.Error) as raised:
            tracked.picture()
        self.assertRegex(str(raised.exception), "^case: ")
        self.assertEqual(raised.exception.file, "case")
        flat = self.volume.like(np.zeros(self.volume.shape, np.uint8))
        with self.assertRaisesRegex(lumen.Error, r"^volume: "):
            lumen.convert(flat)
        with self.assertRaisesRegex(lumen.Error, r"^label_map: "):
            lumen.convert(self.volume, label_map=lumen.Volume(np.full(self.volume.shape, 0.5)))

    def test_a_file_of_the_same_name_is_no_value(self):
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            self.addCleanup(os.chdir, before)
            self.volume.write("volume.nrrd")
            phantom = sample().phantom
            other = self.volume.like(self.volume.array[::-1].copy())
            with self.assertRaisesRegex(lumen.Error, r"^volume\.nrrd"):
                lumen.convert(other, label_map="volume.nrrd")  # grey values, of the file
            with open("case.lumen", "wb") as file:
                file.write(b"no case")
            self.assertLess(self.case.compare(phantom.truth)["assd_mm"], 0.1)  # the value, beside the file
            with self.assertRaisesRegex(lumen.Error, r"^case\.lumen"):
                self.case.compare("case.lumen")
            os.chdir(before)

    def test_the_answer_names_values(self):
        self.assertEqual(self.case.measure(against=self.case)["cases"][0]["case"], "case.lumen")
        self.assertNotIn("/", self.case.info().text.partition("\n")[0])


class VolumesTest(unittest.TestCase):
    def test_the_case_of_an_array_is_that_of_its_file(self):
        phantom, volume = sample().phantom, sample().phantom.volume
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.nrrd")
            volume.write(path)
            self.assertEqual(lumen.Volume.read(path).array.tobytes(), volume.array.tobytes())
            by_file = lumen.convert(path, seeds=phantom.seeds, seeds_only=True)
        self.assertEqual(by_file.metadata["source"], sample().case.metadata["source"])
        np.testing.assert_array_equal(by_file.tree.centre, sample().case.tree.centre)
        np.testing.assert_array_equal(by_file.models.width, sample().case.models.width)

    def test_arrays_in_any_order_of_memory_are_the_same_volume(self):
        volume = sample().phantom.volume
        for array in (np.asfortranarray(volume.array), volume.array.astype(">i2"), volume.array[::-1].copy()[::-1]):
            facts = lumen.run("info", volume.like(array))
            self.assertEqual(facts["size"], list(reversed(volume.shape)))
            case = lumen.track(volume.like(array), seeds=sample().phantom.seeds, seeds_only=True)
            self.assertEqual(case.metadata["source"], sample().case.metadata["source"])

    def test_voxels_are_handed_over_without_a_copy(self):
        volume = sample().phantom.volume
        array, *_ = volume._given()[1]
        self.assertTrue(np.shares_memory(array, volume.array))
        turned = lumen.Volume.of_affine(volume.array.T, np.diag([-1, -1, 1, 1]))
        self.assertTrue(np.shares_memory(turned._given()[1][0], volume.array))

    def test_an_affine_labels_and_a_table_of_names_make_one_case(self):
        phantom, volume = sample().phantom, sample().phantom.volume
        with tempfile.TemporaryDirectory() as folder:
            mask = os.path.join(folder, "mask.nrrd")
            sample().case.check(volume, mask=mask)
            labels = lumen.Volume.read(mask).array
        affine = np.eye(4)
        affine[:3, :3], affine[:3, 3] = volume.direction * volume.spacing, volume.origin
        case = lumen.case_of(volume.array.T, affine=affine, affine_frame="lps", labels=labels.T,
                             label_table={1: "trunk", 2: "twig"})
        self.assertEqual({branch.label for branch in case.branches}, {"trunk", "twig"})
        self.assertLess(case.compare(phantom.truth)["assd_mm"], 0.1)

    def test_several_label_maps_name_in_order_and_roles_are_a_mapping(self):
        volume = sample().phantom.volume
        with tempfile.TemporaryDirectory() as folder:
            mask = os.path.join(folder, "mask.nrrd")
            sample().case.check(volume, mask=mask)
            first = lumen.Volume.read(mask)
            first.array[first.array > 1] = 0

            def names(**options):
                case = lumen.convert(volume, label_map=[first, mask], label_table={1: "trunk", 2: "twig"}, **options)
                return {branch.label for branch in case.branches}
            self.assertEqual(names(), {"trunk", "twig"})
            self.assertNotIn("trunk", names(role={"trunk": "bone"}))
            with self.assertRaisesRegex(lumen.Error, "no label map has the label 7"):
                names(role={7: "bone"})

    def test_the_content_of_a_file_is_the_volume(self):
        volume = sample().phantom.volume
        with tempfile.TemporaryDirectory() as folder:
            for name in ("a.nrrd", "a.nii.gz", "a.nii", "a.mha"):
                path = os.path.join(folder, name)
                volume.write(path)
                with open(path, "rb") as file:
                    again = lumen.Volume.from_bytes(file.read(), name=name)
                np.testing.assert_array_equal(again.array, volume.array)
                np.testing.assert_allclose(again.origin, volume.origin, atol=1e-4)
        with self.assertRaisesRegex(lumen.Error, r"^head\.nrrd: ") as raised:
            lumen.Volume.from_bytes(b"NRRD0004\n", name="head.nrrd")
        self.assertEqual(raised.exception.file, "head.nrrd")


class SurfaceTest(unittest.TestCase):
    def test_arrays_of_a_surface_are_views_that_keep_it_alive(self):
        mesh = sample().case.mesh(edge="0.5r")
        arrays = [mesh.vertices, mesh.triangles, mesh.group, *mesh.attributes.values()]
        for array in arrays:
            self.assertFalse(array.flags.owndata)
            self.assertTrue(array.flags.writeable and array.flags.c_contiguous)
            self.assertIs(array.base, arrays[0].base)
        vertices, triangles = sample().case.surface(edge="0.5r")
        self.assertFalse(vertices.flags.owndata or triangles.flags.owndata)
        expected = mesh.vertices.copy()
        del mesh, arrays, array, triangles
        gc.collect()
        filler = [np.zeros(vertices.size, np.float32) for _ in range(100)]
        np.testing.assert_array_equal(vertices, expected)
        self.assertEqual(len(filler), 100)

    def test_a_surface_is_that_of_the_file(self):
        mesh = sample().case.mesh(edge="0.5r")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.ply")
            lumen.convert(sample().case, path, edge="0.5r")
            with open(path, "rb") as file:
                header, _, body = file.read().partition(b"end_header\n")
        groups = re.findall(r"comment group \d+ (\S+)", header.decode())
        self.assertEqual(mesh.groups, groups)
        names = re.findall(r"property (float|int) (\w+)\n", header.decode())[:-1]
        kind = np.dtype([(name, "<f4" if word == "float" else "<i4") for word, name in names])
        vertex = np.frombuffer(body, kind, len(mesh.vertices))
        face = np.frombuffer(body, np.dtype([("sides", "u1"), ("corners", "<i4", 3), ("group", "<i4")]),
                             len(mesh.triangles), vertex.nbytes)
        self.assertEqual(vertex.nbytes + face.nbytes, len(body))
        for values, columns in ((mesh.vertices, "xyz"), (mesh.attributes["normal"], ("nx", "ny", "nz"))):
            np.testing.assert_array_equal(values, np.stack([vertex[name] for name in columns], axis=1))
        for name in set(mesh.attributes) - {"normal"}:
            np.testing.assert_array_equal(mesh.attributes[name], vertex[name])
        self.assertEqual({"normal", *kind.names[6:]}, set(mesh.attributes))
        np.testing.assert_array_equal(mesh.triangles, face["corners"])
        np.testing.assert_array_equal(mesh.group, face["group"])

    def test_a_case_without_models_gets_some(self):
        tracked = lumen.track(sample().phantom.volume, seeds=sample().phantom.seeds, seeds_only=True)
        np.testing.assert_array_equal(tracked.surface(edge="0.5r")[0], sample().case.surface(edge="0.5r")[0])
        with self.assertRaisesRegex(lumen.Error, "^case: this case has neither models nor wall points"):
            sample().phantom.truth.mesh()

    def test_options_are_those_of_a_mesh_file(self):
        case = sample().case
        for options, sentence in (({"stl_solids": True}, "stl_solids is for writing STL"),
                                  ({"seeds": "a.json"}, "seeds is for"), ({"edg": 1}, "edg: .*did you mean edge"),
                                  ({"time": 0.5}, "time .*motion")):
            with self.assertRaisesRegex(lumen.Error, sentence) as raised:
                case.mesh(**options)
            self.assertEqual(raised.exception.kind, "usage")
        broken = case.copy()
        broken.tree.radius[2] = -1
        with self.assertRaises(lumen.Error) as raised:
            broken.surface()
        self.assertEqual((raised.exception.code, raised.exception.place), ("RADIUS_RANGE", "/tree/radius/2"))


if __name__ == "__main__":
    unittest.main()
