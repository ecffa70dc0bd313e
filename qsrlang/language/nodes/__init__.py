"""From rules to nodes: one builder that the parser calls back, rule by rule."""
