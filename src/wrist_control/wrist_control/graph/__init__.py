"""A whole ROS graph driven from outside: processes, a clock in lockstep, recordings."""
