# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/seeds.md."""
import json

from fixtures import fixture


def changed(store, change):
    """The seeds after a change to the file's object."""
    seeds = json.loads(store.bytes("seeds.json"))
    change(seeds)
    return json.dumps(seeds).encode()


def moved(store, place):
    """The seeds with every position at another place, without directions and radii."""
    def change(seeds):
        for branch in seeds["branches"]:
            branch.pop("direction", None)
            branch["points"] = [place(point["position"]) for point in branch["points"]]
    return changed(store, change)


@fixture("unknown-key.json")
def unknown_key(store):
    def change(seeds):
        seeds["branches"][0]["lable"] = seeds["branches"][0].pop("label")
    return changed(store, change)


@fixture("ras.json")
def ras(store):
    return moved(store, lambda p: [-p[0], -p[1], p[2]])


@fixture("voxels.json")
def voxels(store):
    return moved(store, lambda p: [round(x / 0.2) for x in p[:2]] + [20])


@fixture("metres.json")
def metres(store):
    return moved(store, lambda p: [x / 1000 for x in p])


@fixture("elsewhere.json")
def elsewhere(store):
    return moved(store, lambda p: [x + 500 for x in p])


@fixture("one-astray.json")
def one_astray(store):
    def change(seeds):
        seeds["branches"].append({"label": "astray", "points": [[900, 0, 0]]})
    return changed(store, change)


@fixture("wide.json")
def wide(store):
    def change(seeds):
        seeds["branches"][0]["points"][0]["radius"] = 1300
    return changed(store, change)


@fixture("twins.json")
def twins(store):
    def change(seeds):
        seeds["branches"] *= 2
    return changed(store, change)


@fixture("orphan.json")
def orphan(store):
    def change(seeds):
        seeds["branches"][0]["parent"] = "aorta"
    return changed(store, change)


@fixture("comma.json")
def comma(store):
    return store.bytes("seeds.json").replace(b"}\n", b"},\n", 1)


@fixture("no-branches.json")
def no_branches(store):
    return changed(store, lambda seeds: seeds.update(branches=[]))
