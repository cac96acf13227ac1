"""Chosen faults in what moves the hand: edges, locks, rates, and whoever holds the stick."""

SETTINGS = 'nodes/resolver_settings.py'
SUPERVISOR = 'resolving/supervisor.py'
STEP = 'resolving/step.py'
SEARCH = 'resolving/search.py'
WINDOWS = 'resolving/rate_windows.py'
FEASIBLE = 'resolving/feasible.py'
EASING = 'resolving/easing.py'
PLATFORM = 'wrists/platform.py'
STEWART = 'wrists/stewart.py'
FOUR = 'wrists/four_gimbal.py'
THREE = 'wrists/three_gimbal.py'
SPARE = 'wrists/spare_joint.py'
AXES = 'wrists/three_axes.py'
URDF = 'wrists/urdf.py'
CLOCK = 'nodes/resolver_clock.py'
FOLLOWED = 'scaled(result.step.scale_factor, result.commanded)'
LEASE = 'operating/lease.py'

# As in chosen_mutants.py: the file, its text, what replaces it, and what would go wrong.
MOTION = (
    # Edges and locks.
    ('wrists/wrist.py', 'stop: float = 0.02', 'stop: float = 0.2', 'workspace is lost'),
    ('wrists/wrist.py', 'stop: float = 0.02', 'stop: float = 0.002', 'too near to the edge'),
    ('wrists/wrist.py', 'horizon: float = 0.1', 'horizon: float = 1.0', 'the edge is glue'),
    ('wrists/wrist.py', 'horizon: float = 0.1', 'horizon: float = 0.01', 'the edge is a wall'),
    (PLATFORM, 'EDGE = 0.01', 'EDGE = 0.1', 'workspace is lost'),
    (PLATFORM, 'EDGE = 0.01', 'EDGE = 0.001', 'too near to lock'),
    (PLATFORM, 'HORIZON = 0.5', 'HORIZON = 5.0', 'lock is glue'),
    (PLATFORM, 'HORIZON = 0.5', 'HORIZON = 0.05', 'lock is a wall'),
    (STEWART, '[float] = 0.02', '[float] = 0.2', 'the platform is taken for another assembly'),
    ('stewart/measurement.py', 'SLACK = 1e-9', 'SLACK = 1e-3', 'impossible lengths pass'),
    (
        'stewart/forward_kinematics.py',
        'POSE_ERROR = 3.0',
        'POSE_ERROR = 1.0',
        'a proof that proves too much',
    ),
    (SPARE, 'CUSHION = 0.25', 'CUSHION = 2.5', 'the fourth gimbal gives up too soon'),
    (SPARE, 'CUSHION = 0.25', 'CUSHION = 0.025', 'the fourth gimbal runs into its limit'),
    (URDF, 'law = self.gain *', 'law = -self.gain *', 'the spare joint drives into lock'),
    (AXES, 'SEAM = 2e-3', 'SEAM = 0.2', 'the hand is not where it is said to be'),
    (FOUR, 'law = -self.gain', 'law = self.gain', 'the fourth gimbal drives into lock'),
    (THREE, 'LOCK = 1e-9', 'LOCK = 1e-3', 'the joints are not those of the pose'),
    (THREE, 'TIE = 1e-6', 'TIE = 0.1', 'the branch that is further away is taken'),
    ('wrists/double_hooke.py', 'LOCK = 1e-9', 'LOCK = 1e-3', 'joints not those of the pose'),
    (STEP, 'SINGULAR_MARGIN = 0.001', 'SINGULAR_MARGIN = 0.01', 'strays further than Barker'),
    (STEP, 'SINGULAR_MARGIN = 0.001', 'SINGULAR_MARGIN = 0.0001', 'rates without bounds'),
    (SEARCH, 'LEAP = 0.1', 'LEAP = 1e-9', 'held at a limit for good'),
    (SEARCH, 'GUESSES = 6', 'GUESSES = 60', 'stops where half of the command can be made'),
    (SEARCH, 'SMALLEST_FACTOR = 1e-6', 'SMALLEST_FACTOR = 1e-2', 'stops before the limit'),
    (SEARCH, 'RESOLUTION = 0.01', 'RESOLUTION = 1.0', 'creeps where it could go'),
    (
        STEP,
        'if len(wrist.followed_axes) == 3:',
        'if True:',
        'a pointer in lock spins the hand',
    ),
    (FOUR, 'math.copysign(1.0, cosine) * s < SIDE', 's < SIDE', 'beyond lock it chatters'),
    # How quickly a joint may change its rate.
    (WINDOWS, 'joint.deceleration_limit * dt', 'joint.acceleration_limit * dt', 'a late stop'),
    (WINDOWS, ' * (1.0 - rate / slowing_down)', '', 'a turn back with a jerk'),
    (FEASIBLE, 'half = 0.5 * time', 'half = 0.25 * time', 'a limit is met at speed'),
    (FEASIBLE, 'if time <= dt:', 'if time <= 9.0 * dt:', 'a limit is met at speed'),
    (EASING, 'if not any(way):', 'if True:', 'a stop without a ramp'),
    (EASING, '    if not held:', '    if True:', 'any rate at once'),
    (EASING, 'if along:', 'if False:', 'the hand leaves its direction without need'),
    ('resolving/ramp.py', 'PAUSE = 0.1', 'PAUSE = 9.0', 'a jerk after a freeze'),
    (SUPERVISOR, FOLLOWED, 'result.commanded', 'a stop speeds the hand up first'),
    (SUPERVISOR, ' and not any(result.step.joint_rates)', '', 'let go while it moves'),
    ('resolving/homing.py', 'part = min(reach, ', 'part = max(0.0, reach, ', 'home too fast'),
    (CLOCK, 'self.pause = convert', 'self.pause = 0.0 * convert', 'a jerk after a freeze'),
    (SETTINGS, '= 0.25, 0.1', '= 0.025, 0.01', 'ten times as quick as careful'),
    # Who holds the stick, and for how long.
    (LEASE, 'LASTS, OLDEST = 0.25, 0.45', 'LASTS, OLDEST = 2.5, 4.5', 'a frozen page drives on'),
    (LEASE, 'LASTS, OLDEST = 0.25, 0.45', 'LASTS, OLDEST = 0.25, 4.5', 'what comes late counts'),
    (LEASE, 'renewal.holder != held.holder', 'False', 'two pages drive at once'),
    (LEASE, '        self._ended[held.holder] = held.grip\n', '', 'a grip that has ended goes on'),
)
