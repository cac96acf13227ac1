"""Quality of service, as in docs/interfaces.md."""

from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

# What is published reaches every kind of subscriber.
OUTPUT = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
# Of a late burst only the newest counts; and publishers of either kind are heard.
NEWEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
# Positions may come in a burst: each is where to be at its own stamp.
EVERY = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
# Said once, and heard by whoever comes later.
LASTING = QoSProfile(
    depth=1,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)
# What must not be lost is asked for again.
EVERY_RELIABLE = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
# As tf2's own broadcasters: frames of many publishers share one topic, and none may be lost.
FRAMES = QoSProfile(depth=100, reliability=ReliabilityPolicy.RELIABLE)
