# SPDX-License-Identifier: Apache-2.0
"""The stubs beside the package (stubtest) and beside a program that uses it (mypy)."""
import os
import re
import subprocess
import sys
import tempfile
import unittest

try:
    import mypy  # noqa: F401  pylint: disable=unused-import
except ImportError:
    mypy = None

# Modules that are not for users or need packages that are not here, aliases of types, classes that users do not make, pybind11's metaclass.
EXPECTED = re.compile(r"lumen\._|lumen\.(blob\.)?(Floats|PathLike|Report|Seeds|\w+Like|Doubles|Nodes|Truth) is not present"
                      r"|lumen\.(torch|gym) failed to import|.*metaclass differs|lumen\.(blob\.)?(Case|Mesh|Models|Motion|Points|Tree|Answer|Approaches|Hessian|Hits|Nearest)"
                      r"\.__init__ is inconsistent")
PROGRAM = """
import lumen
import numpy as np
case = lumen.convert("a.nrrd", seeds={"a": np.zeros((2, 3))}, inlier_rate=0.6, root=[(0, 0, 1)])
reveal_type(case)
reveal_type(lumen.convert(case, "b.glb", colour="radius"))
reveal_type(case.tree.radius)
reveal_type(lumen.blob.Model(case).query(np.zeros((3, 3))).distance)
lumen.convert("a.nrrd", inlier_rte=0.6)
case.picture(view="back")
from lumen.options import Fitting, Tracking
reveal_type(lumen.convert("a.nrrd", **Tracking(inlier_rate=0.6), **Fitting(accuracy=0.2)))
Tracking(inlier_rte=0.6)
class Image:
    affine: object
    dataobj: object
reveal_type(lumen.convert(Image(), label_map=[np.zeros((2, 3, 4)), "a.nii"], label_table={1: "BA"}, role={"BA": "artery"}))
reveal_type(lumen.fit("a.lumen").surface())
"""


@unittest.skipIf(mypy is None, "mypy (Debian: mypy) is missing")
class StubsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def run_module(self, *arguments):
        ended = subprocess.run([sys.executable, "-m", *arguments], cwd=self.folder, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        return ended.stdout

    def test_signatures_are_those_of_the_package(self):
        out = self.run_module("mypy.stubtest", "lumen", "--ignore-missing-stub", "--concise")
        self.assertIn("lumen.blob.Model is inconsistent, metaclass differs", out)  # it ran
        self.assertEqual([line for line in out.splitlines() if not EXPECTED.match(line)], [])

    def test_a_program_is_checked(self):
        with open(os.path.join(self.folder, "use.py"), "w", encoding="utf-8") as file:
            file.write(PROGRAM)
        lines = self.run_module("mypy", "--strict", "use.py").splitlines()
        revealed = [re.search(r'"(.*)"', line)[1] for line in lines if "Revealed" in line]
        self.assertEqual(revealed[:2], ["lumen.Case", "lumen.Answer"])
        self.assertIn("_32Bit", revealed[2])
        self.assertIn("_64Bit", revealed[3])
        self.assertEqual(revealed[4:6], ["lumen.Case", "lumen.Case"])
        self.assertIn("_32Bit", revealed[6])
        wrong = [line.split(":")[1] for line in lines if ": error: " in line]
        self.assertEqual(wrong, ["9", "10", "13"])


if __name__ == "__main__":
    unittest.main()
