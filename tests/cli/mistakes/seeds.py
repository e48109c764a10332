# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/seeds.md."""
import json

from fixtures import fixture


def changed(store, change):
    """The seeds after `change(document)`."""
    seeds = json.loads(store.bytes("seeds.json"))
    change(seeds)
    return json.dumps(seeds).encode()


def placed(store, place):
    """The seeds with every position p at `place(p)`."""
    def change(seeds):
        for branch in seeds["branches"]:
            for point in branch["points"]:
                point["position"] = place(point["position"])
    return changed(store, change)


def with_branch(store, branch):
    """The seeds and one branch more."""
    return changed(store, lambda seeds: seeds["branches"].append(branch))


@fixture("unknown-key.json")
def unknown_key(store):
    """The seeds with a misspelt key."""
    def change(seeds):
        seeds["branches"][0]["lable"] = seeds["branches"][0].pop("label")
    return changed(store, change)


@fixture("ras.json")
def ras(store):
    return placed(store, lambda p: [-p[0], -p[1], p[2]])


@fixture("voxels.json")
def voxels(store):
    return placed(store, lambda p: [x / 0.2 for x in p])


@fixture("metres.json")
def metres(store):
    return placed(store, lambda p: [x / 1000 for x in p])


@fixture("astray.json")
def astray(store):
    return with_branch(store, {"label": "astray", "points": [[50, 1, 1]]})


@fixture("wide.json")
def wide(store):
    return changed(store, lambda seeds: seeds["branches"][0]["points"][0].update(radius=1300))


@fixture("narrow.json")
def narrow(store):
    return changed(store, lambda seeds: seeds["branches"][0]["points"][0].update(radius=0.0013))


@fixture("no-frame.json")
def no_frame(store):
    return changed(store, lambda seeds: seeds.pop("coordinateSystem"))


@fixture("inches.json")
def inches(store):
    return changed(store, lambda seeds: seeds.update(units="in"))


@fixture("twice.json")
def twice(store):
    return changed(store, lambda seeds: seeds["branches"].append(seeds["branches"][0]))


@fixture("orphan.json")
def orphan(store):
    return with_branch(store, {"label": "child", "parent": "trunk", "points": [[4, 4, 4]]})


@fixture("cycle.json")
def cycle(store):
    return changed(store, lambda seeds: seeds["branches"].extend([
        {"label": "a", "parent": "b", "points": [[4, 4, 4]]}, {"label": "b", "parent": "a", "points": [[4, 4, 5]]}]))


@fixture("no-radius.json")
def no_radius(store):
    return with_branch(store, {"label": "sac", "kind": "aneurysm", "points": [[4, 4, 4]]})


@fixture("two-numbers.json")
def two_numbers(store):
    return with_branch(store, {"label": "flat", "points": [[4, 4]]})


@fixture("none.json")
def none(store):
    return changed(store, lambda seeds: seeds["branches"].clear())


@fixture("cut.json")
def cut(store):
    return store.bytes("seeds.json")[:-20]


@fixture("points.csv")
def points_csv(store):
    return b"x,y,z\n4.1,3.9,4.0\n"


HEADER = b"# Markups fiducial file version = 4.11\n"
COLUMNS = b"# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n"


@fixture("nan.fcsv")
def nan_fcsv(store):
    return HEADER + b"# CoordinateSystem = LPS\n" + COLUMNS + b"1,nan,3.9,4,0,0,0,1,1,1,0,F-1,,\n"


@fixture("no-frame.fcsv")
def no_frame_fcsv(store):
    return HEADER + COLUMNS + b"1,4.1,3.9,4,0,0,0,1,1,1,0,F-1,,\n"


@fixture("plane.mrk.json")
def plane(store):
    return json.dumps({"markups": [{"type": "Plane", "coordinateSystem": "LPS", "controlPoints": []}]}).encode()


@fixture("unplaced.mrk.json")
def unplaced(store):
    return json.dumps({"markups": [{"type": "Curve", "coordinateSystem": "LPS", "controlPoints": [
        {"position": [0, 0, 0], "positionStatus": "undefined"}]}]}).encode()


@fixture("doubled.mrk.json")
def doubled(store):
    """A curve up the tube that was clicked twice at its beginning."""
    (x, y, z) = json.loads(store.bytes("seeds.json"))["branches"][0]["points"][0]["position"]
    return json.dumps({"markups": [{"type": "Curve", "coordinateSystem": "LPS", "controlPoints": [
        {"position": [x, y, z + dz]} for dz in (0, 0, 1)]}]}).encode()


@fixture("forged.json")
def forged(store):
    return with_branch(store, {"label": "a\nlumen: valid\x1b[2J", "points": [[4, 4, 4]]})
