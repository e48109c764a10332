# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/commands.md."""
from fixtures import fixture


@fixture("volume.lumen")
def volume_named_like_a_case(store):
    return store.bytes("tube.nrrd")


@fixture("case.nrrd")
def case_named_like_a_volume(store):
    return store.bytes("case.lumen")


@fixture("download.nrrd")
def web_page(store):
    return b"<!DOCTYPE html>\n<title>Please log in</title>\n"


@fixture("options.toml")
def misspelt_option(store):
    return b"threads = 1\n[convert]\ncel = 0.5\n"


@fixture("section.toml")
def misspelt_section(store):
    return b"[confert]\ncell = 0.5\n"


@fixture("value.toml")
def wrong_value(store):
    return b"[convert]\ndraco = true  # smaller\ncell = -1\n"


@fixture("line.toml")
def line_without_value(store):
    return b"draco\n"


@fixture("twice.toml")
def set_twice(store):
    return b"threads = 1\n\nthreads = 2\n"


@fixture("scans/", "results/")
def folders(store):
    for name in ("scans", "results"):
        (store.folder / name).mkdir()


@fixture("head.img")
def volume_without_ending(store):
    return store.bytes("tube.nrrd")
