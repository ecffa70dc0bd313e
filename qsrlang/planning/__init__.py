"""Where to look next: voxel weights, views, planners, and the loop that moves a robot through a World."""
