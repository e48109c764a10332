# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/tracking.md."""
import json

from fixtures import fixture

SIZE, EDGE = 40, 0.2  # of the volumes made here, like the tube: voxels, mm


def nrrd(values, edges=(EDGE, EDGE, EDGE)):
    """A volume of unsigned bytes."""
    spaces = " ".join("(" + ",".join(str(edges[a]) if a == b else "0" for b in range(3)) + ")" for a in range(3))
    header = ("NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\n"
              f"sizes: {SIZE} {SIZE} {SIZE}\nspace directions: {spaces}\nspace origin: (0,0,0)\nencoding: raw\n\n")
    return header.encode() + bytes(values)


def inside():
    """For every voxel, whether it lies in a tube of 1 mm up the middle."""
    middle = (SIZE - 1) / 2
    return [((i - middle) ** 2 + (j - middle) ** 2) * EDGE ** 2 < 1 for k in range(SIZE) for j in range(SIZE) for i in range(SIZE)]


def seed(*position, **more):
    """A seeds file with one vessel."""
    return json.dumps({"format": "lumen-seeds", "version": 1, "coordinateSystem": "LPS", "units": "mm",
                       "branches": [{"label": "vessel", "points": [list(position)], **more}]}).encode()


@fixture("mask.nrrd")
def mask(store):
    return nrrd([int(v) for v in inside()])


@fixture("dark.nrrd")
def dark(store):
    return nrrd([20 if v else 200 - n % 3 for n, v in enumerate(inside())])


@fixture("blank.nrrd")
def blank(store):
    return nrrd([7] * SIZE ** 3)


@fixture("uneven.nrrd")
def uneven(store):
    return nrrd([n % 7 for n in range(SIZE ** 3)], (0.001, 0.001, 5))


@fixture("middle.json")
def middle(store):
    return seed(3.9, 3.9, 3.9, radius=1.0)


@fixture("corner.json")
def corner(store):
    return seed(0.02, 0.02, 100, radius=1.0)


@fixture("background.json")
def background(store):
    return seed(1, 7, 4, radius=0.5)


@fixture("again.json")
def again(store):
    seeds = json.loads(store.bytes("seeds.json"))
    first = seeds["branches"][0]
    seeds["branches"].append({**first, "label": "again"})
    return json.dumps(seeds).encode()
