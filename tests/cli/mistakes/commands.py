# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/commands.md."""
from fixtures import fixture


@fixture("options.toml")
def options(store):
    """A misspelt option."""
    return b"threads = 1\n[convert]\ninlier-rat = 0.6\n"
