"""A guided calibration session: what to measure next (no ROS), and the laboratory to measure it in."""
