# SPDX-License-Identifier: Apache-2.0
"""lumen: from an angiogram to vessels that a simulator can touch.

    import lumen
    case = lumen.convert("head.nii.gz", progress=print)   # all vessels of a volume
    case.write("head.lumen")
    case.tree.radius                                      # (n,) float32, mm
    case.export("sofa", "head-sofa")                      # a folder that a simulator loads
    lumen.blob.Model(case).query(points).distance         # (n,) mm, negative in the lumen

Lengths are in mm, coordinates LPS (+x left, +y back, +z head). Not a medical device: not for
clinical use.
"""
from ._errors import Error, Warning  # pylint: disable=redefined-builtin
from ._lumen import version as __version__
from ._inputs import Volume
from ._parts import Branch, Change, Mesh, Models, Motion, Picture, Points, Tree
from ._editing import Editor
from ._running import Answer, run
from ._case import Case, read
from ._operations import (Phantom, case_of, check, convert, export, find_vessels, fit, measure, mesh,
                          options_of, phantom, picture, targets, track, validate)
from . import blob, options

__all__ = ["Answer", "Branch", "Case", "Change", "Editor", "Error", "Mesh", "Models", "Motion",
           "Phantom", "Picture", "Points", "Tree", "Volume", "Warning", "blob", "case_of", "check", "convert",
           "export", "find_vessels", "fit", "measure", "mesh", "options", "options_of", "phantom", "picture",
           "read", "run", "targets", "track", "validate"]
