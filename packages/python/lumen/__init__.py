# SPDX-License-Identifier: Apache-2.0
"""lumen: from an angiogram to vessels that a simulator can touch.

    import lumen
    case = lumen.convert("head.nii.gz", progress=print)   # all vessels of a volume
    case.write("head.lumen")
    case.tree.radius                                      # (n,) float32, mm
    case.export("sofa", "head-sofa")                      # a folder that a simulator loads
    lumen.blob.Model(case).query(points).distance         # (n,) mm, negative in the lumen

Work:
    convert, case_of      a volume, a surface, labels or a centerline to a case or a file; a volume in memory to a case
    track, fit            the two steps of it: centerlines with wall points; the models of their wall
    find_vessels          vessels of a volume as seeds to edit
    read, validate        a case from its file; all faults of one
    mesh, picture         the surface of a case as arrays; its picture as a PNG
    xray                  what a C-arm sees of it, as an array
    measure, check        numbers on vessels, with uncertainties; agreement of a case with its volume
    export, targets       a folder that a simulator loads; the simulators
    phantom               a synthetic volume with its truth
    run, options_of       any command of the program; the options of one

Values:
    Case                  metadata, a tree, wall points and models: .write(), .mesh(), .edit...
    Tree, Branch          its centerlines; a vessel of them
    Points, Models        its wall points; its implicit surfaces
    Motion                the poses of its nodes over time
    Editor, Change        its corrections by hand; the relation of a corrected case to that before
    Volume                voxels and their place; Volume.read(), Volume.of()
    Mesh, Picture         triangles and groups; the bytes of a PNG
    Answer, Phantom       the answer of a command, .tables() for pandas; a volume, its truth and seeds
    Error, ValueFault     a fault; one of an argument, which is a ValueError, too
    MissingFile           a file that is not there, which is a FileNotFoundError, too
    Warning               a fact that makes a result doubtful

Modules:
    blob                  signed distance, gradient and normal at many points
    options               groups of keywords: Tracking, Fitting...
    torch                 the distance as an operation of PyTorch (import lumen.torch)
    gym                   guidewires as environments of Gymnasium (import lumen.gym)

Lengths are in mm, coordinates LPS (+x left, +y back, +z head). Not a medical device: not for
clinical use.
"""
from ._errors import Error, MissingFile, ValueFault, Warning  # pylint: disable=redefined-builtin
from ._lumen import version as __version__
from ._inputs import Volume
from ._parts import Branch, Change, Mesh, Models, Motion, Picture, Points, Tree
from ._editing import Editor
from ._running import Answer, run
from ._case import Case, read
from ._operations import (Phantom, case_of, check, convert, export, find_vessels, fit, measure, mesh,
                          options_of, phantom, picture, targets, track, validate, xray)
from . import blob, options

__all__ = ["Answer", "Branch", "Case", "Change", "Editor", "Error", "Mesh", "MissingFile", "Models",
           "Motion", "Phantom", "Picture", "Points", "Tree", "ValueFault", "Volume", "Warning", "blob",
           "case_of", "check", "convert", "export", "find_vessels", "fit", "measure", "mesh", "options", "options_of",
           "phantom", "picture", "read", "run", "targets", "track", "validate", "xray"]


def __dir__():
    return [*__all__, *(name for name in ("__version__", "torch") if name in globals())]
