# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/volumes.md."""
from fixtures import fixture


@fixture("half.nrrd")
def half(store):
    """The tube, of which only half was copied."""
    whole = store.bytes("tube.nrrd")
    return whole[:len(whole) // 2]
