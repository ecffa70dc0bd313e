import numpy as np
import pytest
from simulation_scenes import CAMERA

from qsrlang.geometry.pose import Pose2
from qsrlang.simulation.depth import depth_image
from qsrlang.simulation.engine import NOTHING


def test_the_points_of_a_depth_image_lie_where_rays_meet_surfaces(kitchen_world):
    kitchen_world.reset(Pose2(2.5, 3.0, 2.0))
    image = kitchen_world.depth_image(160, 120)
    kitchen_world.reset()
    assert image.hit.mean() > 0.9
    points = image.points[image.hit]
    ends = image.eye + 1.2 * (points - image.eye)
    hits = kitchen_world.scene.engine.rays(np.broadcast_to(image.eye, points.shape), ends)
    met = hits.bodies != NOTHING
    assert met.mean() > 0.99
    errors = np.linalg.norm(hits.points[met] - points[met], axis=1)
    assert np.percentile(errors, 98) < 1e-3
    assert (hits.bodies == image.bodies[image.hit]).mean() > 0.98


def test_pixels_without_a_surface_lie_beyond_the_far_plane(kitchen_world):
    up = type(CAMERA)(0.3, 4.0, 1.1, 0.85, 1.4, 1.2)
    image = depth_image(kitchen_world.scene.engine, up, Pose2(4.0, 8.0), 0.0, 32, 24)
    assert not image.hit.any() and (image.bodies == NOTHING).all()
    assert (np.linalg.norm(image.points - image.eye, axis=-1) >= 2 * up.far - 1e-9).all()


def test_the_floor_is_at_zero(table_world):
    image = table_world.depth_image(64, 48)
    floor = image.points[image.bodies == 0]
    assert len(floor) > 100
    assert floor[:, 2] == pytest.approx(0.0, abs=1e-3)
    assert image.eye == pytest.approx([0.5, 0.5, CAMERA.height])
