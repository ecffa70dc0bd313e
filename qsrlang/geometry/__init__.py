"""Plane geometry in metres and radians, REP 103 axes: x forward, y left, headings counter-clockwise.

What is compiled is imported when it is first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(__name__, submodules=["clipping"])
