# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/surfaces.md."""
import math
import re
import struct

from fixtures import fixture


@fixture("labels.nrrd")
def labels(store):
    """The lumen of the tube as label 1."""
    store.path("case.lumen")
    store.lumen("check", "tube.nrrd", "case.lumen", "--mask", "labels.nrrd")


@fixture("angiogram.nrrd")
def angiogram(store):
    """The tube as an angiogram of few grey values: 0 around it, 1 to 160 in it."""
    store.lumen("phantom", "tube", "tube.nii", "--size", "40")
    voxels = struct.unpack("<64000h", store.folder.joinpath("tube.nii").read_bytes()[352:])
    header = ("NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 40 40 40\n"
              "space directions: (0.2,0,0) (0,0.2,0) (0,0,0.2)\nspace origin: (0,0,0)\nencoding: raw\n\n")
    return header.encode() + bytes(min(max((v - 500) // 4, 0), 160) for v in voxels)


@fixture("far-labels.nrrd")
def elsewhere(store):
    """Those labels, 900 mm to the patient's left."""
    header, voxels = store.bytes("labels.nrrd").split(b"\n\n", 1)
    return re.sub(rb"space origin: \([^,]*,", b"space origin: (900,", header) + b"\n\n" + voxels


@fixture("twice.csv")
def twice(store):
    return b"value,name\n1,ica\n1,mca\n"


@fixture("colours.csv")
def colours(store):
    return b"artery,red\nvein,blue\n"


@fixture("open.obj")
def open_tube(store):
    """A tube, 40 mm long, of 2 mm radius, open at both ends."""
    lines = []
    for i in range(41):
        for k in range(24):
            angle = 2 * math.pi * k / 24
            lines.append(f"v {i} {2 * math.cos(angle):.6f} {2 * math.sin(angle):.6f}")
    for i in range(40):
        for k in range(24):
            a, b = 24 * i + k + 1, 24 * i + (k + 1) % 24 + 1
            lines += [f"f {a} {b + 24} {b}", f"f {a} {a + 24} {b + 24}"]
    return ("\n".join(lines) + "\n").encode()


@fixture("negated.swc")
def negated(store):
    """The axis of that tube, with x and y negated."""
    return "".join(f"{i} 0 {-i} 0 0 2 {i - 1 if i > 1 else -1}\n" for i in range(1, 40)).encode()


def scene(*nodes):
    """A scene of SOFA."""
    return ('<Node name="root">\n' + "\n".join(nodes) + "\n</Node>\n").encode()


@fixture("two.scn")
def two(store):
    return scene('<Node name="Arteries"><MeshOBJLoader name="loader" filename="open.obj"/></Node>',
                 '<Node name="Tip"><MeshSTLLoader name="tip" filename="tip.stl"/></Node>')


@fixture("elsewhere.scn")
def elsewhere(store):
    return scene('<MeshOBJLoader name="loader" filename="../../etc/arteries.obj"/>')


@fixture("volumetric.scn")
def volumetric(store):
    return scene('<Node name="Vessels"><MeshGmshLoader filename="vessels.msh"/></Node>')
