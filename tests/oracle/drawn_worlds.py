"""Draws of whole scenes, world by world: landmarks first, then every object from the true density of a constraint."""

import math

import numpy as np
from naive_worlds import drawn_as, order_of_placing
from true_densities import Scenes, Table, densities, draws


def draw_world(graph, world, viewer, count, rng):
    """Scenes of a world, and the evidence (P,) of all constraints that only speak of what is placed already."""
    placings, roots = order_of_placing(graph, world)
    scenes = Scenes(graph, viewer, count, {}, {}, {})
    carriers = [one.carrier.name for one in placings if one.carrier]
    known = {one.name: one for one in graph.landmarks if one.name in carriers} | {
        landmark.name: landmark for _, landmark in world.landmarks
    }
    for name in sorted(known):
        _draw_landmark(scenes, known[name], rng)
    for name, _ in world.landmarks:
        _same(scenes, name, drawn_as(name, roots), roots[name])
    return scenes, _draw_objects(scenes, placings, roots, rng)


def _draw_landmark(scenes, landmark, rng):
    noise = rng.standard_normal((scenes.count, 3)) * landmark.deviation
    scenes.points[landmark.name] = np.array([landmark.x, landmark.y]) + noise[:, :2]
    scenes.headings[landmark.name] = None if landmark.heading is None else landmark.heading + noise[:, 2]
    scenes.roots[landmark.name] = landmark


def _same(scenes, name, drawn, root):
    scenes.points[name], scenes.headings[name] = scenes.points[drawn], scenes.headings[root.name]
    scenes.roots[name] = root


def _draw_objects(scenes, placings, roots, rng):
    """Place everything; a constraint on what is placed weighs by density, in units of 1 / (pi reach^2)."""
    evidence = np.ones(scenes.count)
    for one in placings:
        name, table = one.constraint.referent, table_of(scenes, one.carrier)
        if one.places:
            scenes.points[name] = draws(scenes, one.constraint, table, rng)
            scenes.headings[name] = scenes.headings[roots[name].name]
            scenes.roots[name] = roots[name]
        else:
            density = densities(scenes, one.constraint, table, scenes.points[name])
            evidence = evidence * density * (math.pi * scenes.graph.reach**2)
    return evidence


def table_of(scenes, carrier):
    if carrier is None:
        return None
    kind = scenes.graph.classes[carrier.kind]
    half = (0.5 * kind.depth, 0.5 * kind.width)
    yaw = scenes.headings[carrier.name]
    return Table(scenes.points[carrier.name], yaw, half, carrier.is_relatum)
