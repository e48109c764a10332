# SPDX-License-Identifier: Apache-2.0
"""Libraries for docs/mistakes/libraries.md."""
import json
import shutil

from fixtures import fixture


@fixture("tubes/")
def library(store):
    store.path("case.lumen")
    store.lumen("library", "init", "tubes", "--title", "Tubes", "--licence", "CC0-1.0")
    store.lumen("library", "add", "tubes", "case.lumen", "--synthetic", "--id", "tube-1", "--no-surface", "--picture", "none")


@fixture("published/")
def published(store):
    """That library with its pages and a signature."""
    store.path("tubes/")
    shutil.copytree(store.folder / "tubes", store.folder / "published")
    store.lumen("library", "index", "published")
    (store.folder / "published" / "library.json.minisig").write_text("untrusted comment: any\n")


@fixture("about.json")
def about(store):
    return json.dumps({"title": "A tube", "laterality": "links"}).encode()
