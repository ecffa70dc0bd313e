"""Likely mistakes and matters of style: one small function a rule."""
