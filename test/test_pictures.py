"""What resolvers show of their mechanisms: every body, where it is, in frames of its own."""

import math

import numpy as np
import pytest
from geometry_msgs.msg import Twist
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from wrist_control import WRISTS, make_wrist
from wrist_control.nodes.resolver import Resolver
from wrist_control.rotations import Pose, from_xyzw
from wrist_control.wrists.body import Rod
from wrist_interfaces.msg import WristStatus


def pose_of(where, turn):
    return Pose(from_xyzw((turn.x, turn.y, turn.z, turn.w)), (where.x, where.y, where.z))


def numbers(marker):
    points = [(point.x, point.y, point.z) for point in marker.points]
    scale, where, turn = marker.scale, marker.pose.position, marker.pose.orientation
    colour = marker.color
    return [
        *np.ravel(points),
        *(scale.x, scale.y, scale.z),
        *(where.x, where.y, where.z),
        *(turn.x, turn.y, turn.z, turn.w),
        *(colour.r, colour.g, colour.b, colour.a),
    ]


def sizes(marker):
    """Return what of a marker's scale its type uses."""
    scale = marker.scale
    if marker.type == Marker.TEXT_VIEW_FACING:
        return [scale.z]
    return [scale.x] if marker.type == Marker.LINE_STRIP else [scale.x, scale.y, scale.z]


@pytest.mark.parametrize('name', WRISTS)
def test_every_body_and_every_joint_is_drawn_once_in_the_forearm_frame(graph, name):
    wrist = make_wrist(name)
    graph.start(Resolver, name, namespace='/left')
    heard = graph.listen(MarkerArray, '/left/markers')
    graph.until(lambda: heard)
    markers = heard[-1].markers
    assert len({(marker.ns, marker.id) for marker in markers}) == len(markers)
    assert {marker.header.frame_id for marker in markers} == {'left/forearm'}
    bodies = wrist.bodies(wrist.home)
    for body in bodies:
        drawn = [marker for marker in markers if marker.ns == body.name]
        assert [marker.id for marker in drawn] == list(range(len(body.shapes)))
    pins = {pin.name for body in bodies for pin in body.pins}
    assert {m.ns for m in markers if m.ns.startswith('joint ')} == {
        f'joint {joint.name}' for joint in wrist.joints if joint.name in pins
    }
    for marker in markers:
        assert np.isfinite(numbers(marker)).all(), marker
        assert all(size > 0.0 for size in sizes(marker)), marker
        if marker.type != Marker.ARROW:  # that of the lost axis is as faint as lock is far
            assert marker.color.a == 1.0
        turn = marker.pose.orientation
        assert math.hypot(turn.x, turn.y, turn.z, turn.w) == pytest.approx(1.0)


@pytest.mark.parametrize('name', WRISTS)
def test_a_bar_is_drawn_from_its_beginning_to_its_end(graph, name):
    wrist = make_wrist(name)
    graph.start(Resolver, name)
    heard = graph.listen(MarkerArray, 'markers')
    graph.until(lambda: heard)
    drawn = {(marker.ns, marker.id): marker for marker in heard[-1].markers}
    for body in wrist.bodies(wrist.home):
        for number, shape in enumerate(body.shapes):
            if isinstance(shape, Rod):
                marker = drawn[body.name, number]
                assert marker.type == Marker.CYLINDER
                assert marker.scale.x == marker.scale.y == pytest.approx(2.0 * shape.radius)
                pose = pose_of(marker.pose.position, marker.pose.orientation)
                half = 0.5 * marker.scale.z
                for end, at in ((shape.begin, -half), (shape.end, half)):
                    np.testing.assert_allclose(
                        pose.point((0.0, 0.0, at)), body.pose.point(end), atol=1e-12
                    )


@pytest.mark.parametrize('name', WRISTS)
def test_frames_lead_from_the_forearm_to_every_body_and_the_hand(graph, name):
    wrist = make_wrist(name)
    graph.start(Resolver, name)
    heard = graph.listen(TFMessage, '/tf')
    graph.until(lambda: heard)
    found = {one.child_frame_id: one for one in heard[-1].transforms}
    expected = {body.name: body.pose for body in wrist.bodies(wrist.home)[1:]}
    assert set(found) == set(expected)
    for frame, pose in expected.items():
        assert found[frame].header.frame_id == 'forearm'
        transform = found[frame].transform
        shown = pose_of(transform.translation, transform.rotation)
        np.testing.assert_allclose(shown.rotation, pose.rotation, atol=1e-12)
        np.testing.assert_allclose(shown.position, pose.position, atol=1e-12)


def test_two_wrists_side_by_side_do_not_collide(graph):
    for side in ('left', 'right'):
        graph.start(Resolver, 'omni_wrist', namespace=f'/{side}')
    heard = graph.listen(TFMessage, '/tf')

    def frames():
        return {one.child_frame_id for message in heard for one in message.transforms}

    graph.until(lambda: len(frames()) >= 14)
    names = [body.name for body in make_wrist('omni_wrist').bodies((0.0, 0.0, 0.0))[1:]]
    assert frames() == {f'{side}/{name}' for side in ('left', 'right') for name in names}
    parents = {
        one.child_frame_id: one.header.frame_id for message in heard for one in message.transforms
    }
    assert all(
        parent == f'{child[: child.index("/")]}/forearm' for child, parent in parents.items()
    )


def test_frames_of_other_names_are_used(graph):
    graph.start(Resolver, 'pitch_yaw', forearm_frame='arm/tool0', hand_frame='own/palm')
    heard = graph.listen(TFMessage, '/tf')
    graph.until(lambda: heard)
    assert {one.header.frame_id for one in heard[-1].transforms} == {'arm/tool0'}
    assert {one.child_frame_id for one in heard[-1].transforms} == {'own/ring', 'own/palm'}


def test_the_joint_nearest_to_its_limit_is_coloured_and_the_tip_leaves_a_trail(graph):
    """φ alone moves, at half of its speed; then nothing does, and nothing is coloured."""
    graph.start(
        Resolver,
        'three_gimbal',
        initial_positions=[0.0, 0.0, 0.0],
        joint_rate_limits=[1.0],
        command_timeout=10.0,
    )
    heard = graph.listen(MarkerArray, 'markers')
    publisher = graph.publisher(Twist, 'cmd_vel_unstamped')

    def shown():
        return {marker.ns: marker for marker in heard[-1].markers} if heard else {}

    def coloured():
        joints = {k: m.color for k, m in shown().items() if k.startswith('joint ')}
        return {k for k, colour in joints.items() if colour.r > 0.9}

    def send(q):
        twist = Twist()
        twist.angular.y = q
        publisher.publish(twist)

    graph.until(lambda: heard)
    assert coloured() == set()

    def half():
        send(0.5)
        colour = shown()['joint theta'].color
        return coloured() == {'joint theta'} and colour.g == pytest.approx(0.4, abs=1e-6)

    graph.until(half)
    graph.until(lambda: 'trail' in shown() and len(shown()['trail'].points) > 5)
    trail = np.array([(point.x, point.y, point.z) for point in shown()['trail'].points])
    np.testing.assert_allclose(np.linalg.norm(trail, axis=1), 0.1524, atol=1e-12)
    assert (np.diff(trail[:, 2]) < 0.0).all()  # a pitch lowers the probe

    def at_rest():
        send(0.0)
        return coloured() == set()

    graph.until(at_rest)


def test_a_drawing_that_fails_does_not_stop_the_hand(graph, monkeypatch):
    node = graph.start(Resolver, 'three_gimbal')

    def fails(self, positions):
        raise RuntimeError('no pencil')

    monkeypatch.setattr(type(node._outputs._pictures._wrist), 'bodies', fails)
    told = graph.listen(WristStatus, 'wrist_status')
    heard = graph.listen(TFMessage, '/tf')
    graph.until(lambda: node._outputs._pictures._broken)
    assert not heard
    before = len(told)
    graph.until(lambda: len(told) > before + 10)
    assert told[-1].state == WristStatus.IDLE


def test_nothing_is_drawn_while_nobody_looks(graph, monkeypatch):
    node = graph.start(Resolver, 'three_gimbal')
    asked = []
    kind = type(node._outputs._pictures._wrist)
    bodies = kind.bodies

    def counted(self, positions):
        asked.append(positions)
        return bodies(self, positions)

    monkeypatch.setattr(kind, 'bodies', counted)
    told = graph.listen(WristStatus, 'wrist_status')
    graph.until(lambda: len(told) > 20)
    assert not asked
    heard = graph.listen(MarkerArray, 'markers')
    graph.until(lambda: len(heard) > 2)
    assert asked
