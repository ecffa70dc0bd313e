"""What the robot is told of a place: occupancy grids, voxel grids, supports and paths."""
