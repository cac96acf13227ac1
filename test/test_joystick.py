"""A joystick on the topic joy moves the hand, while its enable button is held."""

from geometry_msgs.msg import TwistStamped
from sensor_msgs.msg import Joy

from wrist_control.nodes.operator import Operator


def test_the_hand_is_asked_for_rates_only_while_the_button_is_held(graph):
    graph.start(Operator, maneuver='joystick', enable_button=0, joy_axes=[0, 1, 2])
    commands = graph.listen(TwistStamped, 'cmd_vel')
    publisher = graph.publisher(Joy, 'joy')

    def asked(pressed, stick=1.0):
        publisher.publish(Joy(axes=[0.0, stick, 0.0], buttons=[pressed]))
        return commands and commands[-1].twist.angular.y != 0.0

    def let_go():
        asked(1, stick=0.0)
        graph.spin(0.2)

    let_go()
    graph.until(lambda: asked(1))
    graph.until(lambda: not asked(0))
    let_go()
    graph.until(lambda: asked(1))
    graph.until(lambda: commands[-1].twist.angular.y == 0.0)  # silence counts as released
