"""The Stewart platform's own mathematics: geometry, and forward kinematics with their proof."""
