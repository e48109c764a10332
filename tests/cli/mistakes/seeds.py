# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/seeds.md."""
import json

from fixtures import fixture


@fixture("unknown-key.json")
def unknown_key(store):
    """The seeds with a misspelt key."""
    seeds = json.loads(store.bytes("seeds.json"))
    seeds["branches"][0]["lable"] = seeds["branches"][0].pop("label")
    return json.dumps(seeds).encode()
