"""One wrist: its resolver, and on request simulated joints, an operator, and RViz.

    ros2 launch wrist_control wrist.launch.py wrist:=carpal operator:=maneuver

Where ROS 2 comes from wheels there is no `ros2 launch`: what is said here was checked by Python
alone (test/test_launch.py), with stand-ins for `launch` and `launch_ros`, and has not been run.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import EqualsSubstitution, LaunchConfiguration, PythonExpression
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

from wrist_control.operating.maneuvers import MANEUVERS
from wrist_control.wrists import WRISTS

PACKAGE = 'wrist_control'
SHARE = FindPackageShare(PACKAGE)
WRIST = LaunchConfiguration('wrist')
NAMESPACE = LaunchConfiguration('namespace')
PARAMETERS = LaunchConfiguration('params_file')
# As the resolver names it: after the namespace, and without a slash before it.
FOREARM = PythonExpression(["'", NAMESPACE, "/forearm'.strip('/')"])

ARGUMENTS = [
    DeclareLaunchArgument(
        'wrist', default_value='three_gimbal', choices=list(WRISTS), description='Which wrist'
    ),
    DeclareLaunchArgument(
        'namespace', default_value='', description='Another one for each wrist of a robot'
    ),
    DeclareLaunchArgument(
        'joints',
        default_value='simulated',
        choices=['simulated', 'physics', 'real'],
        description='physics: a mechanism with loads, where mujoco is installed; real: the driver '
        'of the robot hears joint_command and says joint_states',
    ),
    DeclareLaunchArgument(
        'operator',
        default_value='none',
        choices=['none', 'joystick', 'maneuver'],
        description='none: whoever publishes cmd_vel',
    ),
    DeclareLaunchArgument(
        'maneuver',
        default_value='basic_test',
        choices=list(MANEUVERS),
        description='What the operator flies with operator:=maneuver',
    ),
    DeclareLaunchArgument(
        'params_file',
        default_value=[SHARE, '/config/', WRIST, '.yaml'],
        description='Parameters of all these nodes; by default those that come with the wrist',
    ),
    DeclareLaunchArgument(
        'rviz',
        default_value='false',
        choices=['true', 'false'],
        description='true: draw the wrist, where rviz2 is installed',
    ),
]


def when(argument, value):
    """Return the condition that an argument has a value."""
    return IfCondition(EqualsSubstitution(LaunchConfiguration(argument), value))


def node(executable, *parameters, package=PACKAGE, **more):
    """Return a node in the wrist's namespace that speaks on the terminal."""
    return Node(
        package=package,
        executable=executable,
        namespace=NAMESPACE,
        parameters=list(parameters),
        output='screen',
        **more,
    )


def generate_launch_description():
    """Return the arguments, and the nodes that they ask for."""
    drawn = ['-d', [SHARE, '/rviz/wrist.rviz'], '-f', FOREARM]
    maneuver = {'maneuver': LaunchConfiguration('maneuver')}
    joystick, flown = when('operator', 'joystick'), when('operator', 'maneuver')
    physical = when('joints', 'physics')
    return LaunchDescription(
        [
            *ARGUMENTS,
            node([WRIST, '_resolver'], PARAMETERS),
            node('joint_simulator', PARAMETERS, condition=when('joints', 'simulated')),
            node('physics_simulator', PARAMETERS, {'wrist': WRIST}, condition=physical),
            node('operator', PARAMETERS, maneuver, condition=flown),
            node('operator', PARAMETERS, {'maneuver': 'joystick'}, condition=joystick),
            node('joy_node', package='joy', condition=joystick),
            node('rviz2', package='rviz2', arguments=drawn, condition=when('rviz', 'true')),
        ]
    )
