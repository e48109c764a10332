# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/cases.md."""
from fixtures import fixture


@fixture("half.lumen")
def half(store):
    """The case, of which only half was copied."""
    whole = store.bytes("case.lumen")
    return whole[:len(whole) // 2]
