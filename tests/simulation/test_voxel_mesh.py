import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from qsrlang.errors import ValueRangeError
from qsrlang.maps.voxels import VoxelGrid
from qsrlang.simulation.engine import NOTHING, Engine
from qsrlang.simulation.mesh import clear_boxes, mesh_of, write_obj

SHAPES = st.tuples(st.integers(1, 5), st.integers(1, 5), st.integers(1, 5))
SOLIDS = SHAPES.flatmap(lambda shape: arrays(bool, shape)).filter(np.any)
RESOLUTION, ORIGIN = 0.05, np.array([-1.0, 2.0, 0.3])


def normals_and_areas(mesh):
    corner = mesh.vertices[mesh.quads]
    cross = np.cross(corner[:, 1] - corner[:, 0], corner[:, 3] - corner[:, 0])
    return cross, corner


def exposed(solid, axis, step):
    faces = 0
    for index in np.argwhere(solid):
        beside = index.copy()
        beside[axis] += step
        inside = 0 <= beside[axis] < solid.shape[axis]
        faces += not (inside and solid[tuple(beside)])
    return faces


@given(SOLIDS)
def test_the_area_looking_each_way_is_that_of_the_exposed_faces(solid):
    cross, _ = normals_and_areas(mesh_of(solid, RESOLUTION, ORIGIN))
    for axis in range(3):
        for step in (-1, 1):
            area = np.clip(step * cross[:, axis], 0.0, None).sum()
            assert area == pytest.approx(exposed(solid, axis, step) * RESOLUTION**2)


@given(SOLIDS)
def test_the_surface_encloses_the_volume_of_the_voxels(solid):
    """Gauss: the flux of x / 3 through the outward surface is the volume."""
    cross, corner = normals_and_areas(mesh_of(solid, RESOLUTION, ORIGIN))
    flux = np.einsum("qi,qi->", corner.mean(axis=1), cross) / 3.0
    assert flux == pytest.approx(solid.sum() * RESOLUTION**3)


@given(SOLIDS)
def test_merged_faces_do_not_overlap(solid):
    mesh = mesh_of(solid, RESOLUTION, ORIGIN)
    steps = np.rint((mesh.vertices[mesh.quads] - ORIGIN) / RESOLUTION).astype(int)
    covered = set()
    for quad in steps:
        axis = int(np.argmin(np.ptp(quad, axis=0)))
        normal = np.sign(np.cross(quad[1] - quad[0], quad[3] - quad[0])[axis])
        low, high = quad.min(axis=0), quad.max(axis=0)
        spans = [range(a, b) if a < b else [a] for a, b in zip(low, high, strict=True)]
        for i in spans[0]:
            for j in spans[1]:
                for k in spans[2]:
                    assert (axis, normal, i, j, k) not in covered
                    covered.add((axis, normal, i, j, k))


def test_a_solid_block_needs_six_quads():
    mesh = mesh_of(np.ones((4, 3, 2), dtype=bool), RESOLUTION, ORIGIN)
    assert len(mesh.quads) == 6 and len(mesh.vertices) == 8
    assert mesh.vertices.max(axis=0) == pytest.approx([-0.8, 2.15, 0.4])


def test_nothing_occupied_is_an_error():
    with pytest.raises(ValueRangeError, match="the number of occupied voxels of a map is 0"):
        mesh_of(np.zeros((2, 2, 2), dtype=bool), RESOLUTION, ORIGIN)


def test_the_file_holds_two_triangles_a_quad(tmp_path):
    mesh = mesh_of(np.ones((1, 1, 1), dtype=bool), RESOLUTION, ORIGIN)
    write_obj(mesh, tmp_path / "cube.obj")
    lines = (tmp_path / "cube.obj").read_text(encoding="ascii").splitlines()
    assert sum(line.startswith("v ") for line in lines) == 8
    assert sum(line.startswith("f ") for line in lines) == 12


def test_rays_meet_the_mesh_where_the_voxels_are(tmp_path):
    solid = np.random.default_rng(3).random((8, 8, 8)) < 0.2
    write_obj(mesh_of(solid, 0.1, np.zeros(3)), tmp_path / "solid.obj")
    columns = np.argwhere(np.ones((8, 8), dtype=bool))
    starts = np.column_stack([(columns + 0.43) * 0.1, np.full(64, 2.0)])
    with Engine() as engine:
        engine.add_mesh(tmp_path / "solid.obj", (1.0, 1.0, 1.0))
        hits = engine.rays(starts, starts * [1.0, 1.0, -1.0])
    highest = np.array([max(np.flatnonzero(solid[i, j]), default=-1) for i, j in columns])
    assert ((hits.bodies == NOTHING) == (highest < 0)).all()
    met = highest >= 0
    assert hits.points[met, 2] == pytest.approx((highest[met] + 1) * 0.1, abs=1e-6)


def test_a_file_that_was_written_anew_is_read_anew(tmp_path):
    top = []
    with Engine() as engine:
        for height in (1, 3):
            solid = np.ones((2, 2, height), dtype=bool)
            write_obj(mesh_of(solid, 0.1, np.zeros(3)), tmp_path / "solid.obj")
            engine.add_mesh(tmp_path / "solid.obj", (1.0, 1.0, 1.0))
            hits = engine.rays(np.array([[0.07, 0.11, 2.0]]), np.array([[0.07, 0.11, -1.0]]))
            top.append(hits.points[0, 2])
    assert top == pytest.approx([0.1, 0.3], abs=1e-6)


def test_boxes_are_cut_out():
    grid = VoxelGrid(np.full((10, 10, 10), 2, dtype=np.uint8), 0.1, np.zeros(3), "full")
    left = clear_boxes(grid, [[[0.42, 0.42, 0.52], [0.58, 0.58, 0.68]]])
    gone = np.argwhere(~left)
    assert gone.min(axis=0).tolist() == [4, 4, 5] and gone.max(axis=0).tolist() == [5, 5, 6]
    assert clear_boxes(grid, [[[5.0, 5.0, 5.0], [6.0, 6.0, 6.0]], [[-9.0, 0.0, 0.0], [-8.0, 1.0, 1.0]]]).all()
