"""Values that hypothesis draws, shared by the tests of all layers."""

import math

from hypothesis import strategies as st

from qsrlang.geometry.pose import Pose2

metres = st.floats(-20.0, 20.0)
angles = st.floats(-4.0 * math.pi, 4.0 * math.pi)
poses = st.builds(Pose2, metres, metres, angles)
points = st.tuples(metres, metres)
