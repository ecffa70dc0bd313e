"""A World of pybullet: rooms and voxel maps as bodies, a camera that recognises, and a robot that drives."""
