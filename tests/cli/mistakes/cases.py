# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/cases.md."""
import re

from fixtures import fixture


@fixture("half.lumen")
def half(store):
    """The case, of which only half was copied."""
    whole = store.bytes("case.lumen")
    return whole[:len(whole) // 2]


@fixture("damaged.lumen")
def damaged(store):
    """The case with one byte changed in the middle."""
    bytes_ = bytearray(store.bytes("case.lumen"))
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


@fixture("empty.lumen")
def empty_case(store):
    return b""
