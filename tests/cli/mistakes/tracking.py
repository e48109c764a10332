# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/tracking.md."""
