# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/cases.md."""
import json, re

from fixtures import fixture


@fixture("half.lumen")
def half(store):
    """The truth, of which only half was copied: its bytes, unlike a tracked case's, stay when the tracker changes."""
    whole = store.bytes("truth.lumen")
    return whole[:len(whole) // 2]


@fixture("damaged.lumen")
def damaged(store):
    """The truth with one byte changed in the middle."""
    bytes_ = bytearray(store.bytes("truth.lumen"))
    bytes_[len(bytes_) // 2] ^= 1
    return bytes(bytes_)


@fixture("plain.lumen.json")
def plain(store):
    store.path("truth.lumen")
    store.lumen("convert", "truth.lumen", "plain.lumen.json")


@fixture("comma.lumen.json")
def comma(store):
    return store.bytes("plain.lumen.json").replace(b"]\n", b"],\n", 1)


@fixture("negative.lumen.json")
def negative(store):
    """A case whose first radius was made negative by hand."""
    text = store.text("plain.lumen.json")
    at = text.index("[", text.index('"radius"')) + 1
    return (text[:at] + "-" + text[at:].lstrip()).encode()


@fixture("future.lumen.json")
def future(store):
    return re.sub(r'"(version|minimumReader)": "[^"]*"', r'"\1": "2.0"', store.text("plain.lumen.json"), count=2).encode()


@fixture("hurried.lumen.json")
def hurried(store):
    """A case whose first node moves for a second, with a period of 0.8 s."""
    case = json.loads(store.text("plain.lumen.json"))
    first = case["tree"]["centre"][0]
    case.update(version="1.2", motion=dict(period=0.8, time=[0, 1], node=[0], centre=[[first], [first]],
                                           rotation=[[[0, 0, 0, 1]]] * 2, factor=[[1], [1]]))
    return json.dumps(case).encode()


@fixture("empty.lumen")
def empty_case(store):
    return b""


SMALL = """{
  "format": "lumen", "version": "1.1", "minimumReader": "1.0",
  "metadata": {"coordinateSystem": "LPS", "units": "mm", "steps": []},
  "tree": {
    "branches": [
      {"label": "a", "kind": "vessel", "parentNode": -1, "firstNode": 0, "nodeCount": 2, "stopReason": "unknown"}
    ],
    "centre": [[1,2,3], [1,2,4]], "direction": [[0,0,1], [0,0,1]],
    "radius": [1, 1], "height": [0.5, 0.5], "parent": [-1, 0], "branch": [0, 0]
  }
}
"""


def changed(old, new):
    """The small case with one change."""
    assert SMALL.count(old) == 1
    return SMALL.replace(old, new).encode()


@fixture("metres.lumen.json")
def metres(store):
    """A case in metres."""
    return changed('"mm"', '"m"')


@fixture("forged.lumen.json")
def forged(store):
    """A unit that would print a line of its own."""
    return changed('"mm"', '"m\\nforged.lumen.json: valid\\u001b[2K"')


@fixture("misspelt.lumen.json")
def misspelt(store):
    """A key of another name."""
    return changed('"units"', '"unit"')


@fixture("huge.lumen.json")
def huge(store):
    """A radius that no f32 holds."""
    return changed('"radius": [1, 1]', '"radius": [1, 1e39]')


@fixture("whole.lumen.json")
def whole(store):
    """A node number with a point."""
    return changed('"parent": [-1, 0]', '"parent": [-1, 0.0]')


@fixture("faults.lumen.json")
def faults(store):
    """Faults and a warning."""
    return changed('"radius": [1, 1], "height": [0.5, 0.5]', '"radius": [-1, 0], "height": [-0.0, 0.5]')


@fixture("warning.lumen.json")
def warning(store):
    """A negative zero, which is legal."""
    return changed('"height": [0.5, 0.5]', '"height": [-0.0, 0.5]')


@fixture("other.nrrd")
def other(store):
    """A tube as the case's volume, with other noise."""
    store.lumen("phantom", "tube", "other.nrrd", "--size", "40", "--seed", "2")


@fixture("moved.nrrd")
def moved(store):
    """The case's volume with an origin a metre away."""
    data = store.bytes("tube.nrrd")
    assert data.count(b"space origin: (0,0,0)") == 1, data[:400]
    return data.replace(b"space origin: (0,0,0)", b"space origin: (1000,0,0)")


@fixture("negated.nrrd")
def negated(store):
    """The case's volume with x and y negated, as if RAS were LPS."""
    data = store.bytes("tube.nrrd")
    directions = re.search(rb"space directions: \(([^,]*),0,0\) \(0,([^,]*),0\)", data)
    return data.replace(directions[0], b"space directions: (-%s,0,0) (0,-%s,0)" % directions.groups())
