# SPDX-License-Identifier: Apache-2.0
"""Lets ParaView 5.11 load plugins in Python where its own Python is 3.11 or newer, as in Debian 12: it imports a function that Python
has removed. Needed on PYTHONPATH before ParaView starts; it changes nothing where the function is there."""
import inspect

if not hasattr(inspect, "getargspec"): inspect.getargspec = inspect.getfullargspec
