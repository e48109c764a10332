# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/trust.md."""
from fixtures import fixture

# of a key that was made for this page, signs nothing, and is thrown away
PUBLIC = b"untrusted comment: minisign public key 4399E96D31EC718D\nRWSNcewxbemZQ25UeTL5oHtBrhmRV2EuLdlY1eRmmzTCIaWAcV1UKXaI\n"


def library(store, name):
    (store.folder / "licence.txt").write_text("Do what you like.\n")
    store.path("case.lumen")
    store.lumen("library", "init", name, "--title", "Tubes", "--licence", "CC0-1.0", "--date", "2026-11-22",
                "--id", "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4")
    store.lumen("library", "add", name, "case.lumen", "--id", "tube", "--synthetic", "--no-surface", "--picture", "none",
                "--file", "licence.txt", "--date", "2026-11-22")
    return store.folder / name


@fixture("shared/")
def shared(store): library(store, "shared")


@fixture("edited/")
def edited(store):
    """A library in which somebody changed a file, removed another and left a note."""
    folder = library(store, "edited") / "data/tube"
    next(folder.rglob("licence.txt")).write_text("Ask first.\n")
    (folder / "case.lumen").unlink()
    (folder / "to do.txt").write_text("ask for consent\n")


@fixture("publisher.pub")
def public(store): return PUBLIC
