# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/viewer.md."""
from fixtures import fixture


@fixture("picture.png")
def picture(store):
    """The beginning of a picture."""
    return b"\x89PNG\r\n\x1a\n"
