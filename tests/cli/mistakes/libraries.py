# SPDX-License-Identifier: Apache-2.0
"""Libraries for docs/mistakes/libraries.md."""
import json

from fixtures import fixture


@fixture("tubes/")
def library(store):
    store.path("case.lumen")
    store.lumen("library", "init", "tubes", "--title", "Tubes", "--licence", "CC0-1.0")
    store.lumen("library", "add", "tubes", "case.lumen", "--synthetic", "--id", "tube-1", "--no-surface", "--picture", "none")


@fixture("about.json")
def about(store):
    return json.dumps({"title": "A tube", "laterality": "links"}).encode()
