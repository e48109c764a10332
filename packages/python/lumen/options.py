# SPDX-License-Identifier: Apache-2.0
"""Options in groups, each a TypedDict whose keys are the keywords of functions:

    from lumen.options import Fitting, Tracking
    case = lumen.convert("head.nii.gz", **Tracking(inlier_rate=0.6, rays=162), **Fitting(accuracy=0.2))

``help(lumen.options.Tracking)`` lists the options of a group with types, defaults and ranges.
"""
from ._options import groups as _groups

globals().update(_groups())
__all__ = list(_groups())
