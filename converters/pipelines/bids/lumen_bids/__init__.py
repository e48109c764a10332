# SPDX-License-Identifier: Apache-2.0
"""Data sets of BIDS through lumen: cases of volumes, and a library of cases."""
