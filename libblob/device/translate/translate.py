#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""translate.py OUT: writes the query of blob_device.h in WGSL into the file OUT, from the C of the header alone (python3-pycparser)."""
import pathlib
import sys

from c_query import Query
from wgsl import Wgsl

pathlib.Path(sys.argv[1]).write_text(Wgsl(Query()).text(), encoding="utf-8")
