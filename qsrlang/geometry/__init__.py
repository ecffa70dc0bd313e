"""Plane geometry in metres and radians, REP 103 axes: x forward, y left, headings counter-clockwise."""
