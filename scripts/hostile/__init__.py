"""The hostile campaign, `make campaign`: what attacks, and what judges; never part of a robot."""
