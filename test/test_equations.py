"""docs/equations.md computed: what its equations say is what the code does."""

import math
import re

import numpy as np
import pytest

from wrist_control import make_wrist
from wrist_control.rotations import turned

from .documents import ROOT

TEXT = (ROOT / 'docs' / 'equations.md').read_text()
FUNCTIONS = {
    'sin': math.sin,
    'cos': math.cos,
    'tan': math.tan,
    'sgn': lambda x: math.copysign(1.0, x),
    'atan2': math.atan2,
}
NAME = r'(?:\\dot )?[^\W\d_](?:_(?:\w|\{\w+\}))?\'?'
CALL = re.compile(rf'\\(sin|cos|tan)(?:\^(\d))? ?(\d?{NAME})')
TOKEN = re.compile(rf'<(\w+)>|({NAME}|\d+)|\^(\d)|(\S)')


def equations(heading):
    """Return the equations of a section: what stands on the left, and the right side in Python."""
    (text,) = re.findall(rf'^### {heading}.*?\n(.*?)(?=^##|\Z)', TEXT, re.MULTILINE | re.DOTALL)
    found = {}
    for block in re.findall(r'```math\n(.*?)```', text, re.DOTALL):
        plain = re.sub(r'\\tag\{.*?\}|\\(?:begin|end)\{.*?\}|[&]|\\[,;]', '', block)
        for line in re.split(r'\\\\\n|\n|\\qquad', plain):
            left, equals, right = line.partition('=')
            if equals and re.fullmatch(NAME, left.strip()):
                found[identifier(left.strip())] = python_of(re.split(r',? *\\text', right)[0])
    return found


def identifier(name):
    return re.sub(r'[{}]', '', name.replace('\\dot ', 'dot_').replace("'", '_prime'))


def python_of(latex):
    """Return an equation's side as Python, with the products that TeX leaves out."""
    latex = re.sub(r'\\frac\{(.*?)\}\{(.*?)\}', r'((\1) / (\2))', latex)
    latex = re.sub(r'\\operatorname\{(\w+)\}', r'<\1>', latex)
    latex = CALL.sub(lambda m: f'<{m[1]}>({m[3]})' + (f'^{m[2]}' if m[2] else ''), latex)
    python, after_operand = '', False
    for function, operand, exponent, sign in TOKEN.findall(latex.replace('[', '(')):
        begins = bool(function or operand or sign == '(')
        python += ' * ' if begins and after_operand else ''
        python += function or identifier(operand) or (f' ** {exponent}' if exponent else sign)
        after_operand = bool(operand or exponent or sign in (')', ']'))
    return python.replace(']', ')')


def values(heading, given, *names):
    """Compute equations of a section in order, and return what was asked for."""
    known = {**FUNCTIONS, **given}
    for name, python in equations(heading).items():
        if name not in given:
            try:
                known[name] = eval(python, {}, known)
            except (NameError, SyntaxError):
                continue  # of the other direction, or of matrices and vectors
    return [known[name] for name in names]


WRISTS = {
    'three_gimbal': ('Three-gimbal', 'ψ θ φ'),
    'four_gimbal': ('Four-gimbal', 'ψ θ φ α'),
    'roll_pitch_roll': ('Conventional', 'θ_4 θ_5 θ_6'),
    'single_hooke': ('Single Hooke', 'φ θ ψ'),
    'double_hooke': ('Double Hooke', 'φ θ ψ'),
    'omni_wrist': ('Omni', 'φ θ_a ψ_a'),
}
PLACES = np.random.default_rng(1).uniform(0.2, 0.7, (5, 10)).tolist()


def place(name, numbers):
    """Return a wrist, its section, positions, and what the text says beside the equations."""
    heading, joints = WRISTS[name]
    wrist = make_wrist(name)
    positions = numbers[: len(joints.split())]
    given = dict(zip(joints.split(), positions, strict=True))
    if name == 'four_gimbal':
        given['K'] = wrist.gain
    if name == 'omni_wrist':
        u, v = math.tan(given['ψ_a']), math.tan(given['θ_a'])
        given |= {'u': u, 'v': v, 'n': 1.0 + u * u + v * v}
    return wrist, heading, positions, given, [f'dot_{joint}' for joint in joints.split()]


@pytest.mark.parametrize('numbers', PLACES, ids=range(5))
@pytest.mark.parametrize('name', WRISTS)
def test_the_joint_rates_of_a_twist_are_those_of_the_code(name, numbers):
    wrist, heading, positions, given, rates = place(name, numbers)
    p, q, r = numbers[-3:]
    given |= {'p': p, 'q': q, 'r': r}
    if name == 'omni_wrist':
        s, c = math.sin(given['φ']), math.cos(given['φ'])
        given |= {'q_prime': q * c - r * s, 'r_prime': q * s + r * c}
    computed = values(heading, given, *rates)
    assert computed == pytest.approx(wrist.rates(positions, (p, q, r)), rel=1e-12)


@pytest.mark.parametrize('numbers', PLACES, ids=range(5))
@pytest.mark.parametrize('name', [name for name in WRISTS if name != 'four_gimbal'])
def test_the_twist_of_joint_rates_is_that_of_the_code(name, numbers):
    wrist, heading, positions, given, rates = place(name, numbers)
    given |= dict(zip(rates, numbers[-3:], strict=True))
    if name == 'omni_wrist':
        given |= {
            f'{axis}_prime': eval(f'2 * (1 + {tangent}**2) * {rate} / n', {}, given)
            for axis, tangent, rate in (('q', 'v', 'dot_θ_a'), ('r', 'u', 'dot_ψ_a'))
        }
    computed = values(heading, given, 'p', 'q', 'r')
    assert computed == pytest.approx(wrist.jacobian(positions) @ numbers[-3:], rel=1e-12)


@pytest.mark.parametrize('numbers', PLACES, ids=range(5))
@pytest.mark.parametrize('name', ['three_gimbal', 'four_gimbal'])
def test_the_gimbal_angles_come_out_of_their_direction_cosines(name, numbers):
    wrist, heading, positions, given, _ = place(name, numbers)
    cosines = wrist.forward(positions).rotation
    given = {f'c_{i + 1}{j + 1}': cosines[i, j] for i in range(3) for j in range(3)} | {
        'α': given.get('α', 0.0)
    }
    assert values(heading, given, 'φ', 'ψ', 'θ') == pytest.approx(
        [positions[2], positions[0], positions[1]], rel=1e-12
    )


@pytest.mark.parametrize('numbers', PLACES, ids=range(5))
def test_a_step_of_the_quaternion_is_that_of_the_code(numbers):
    a, (p, q, r), h = np.array(numbers[:4]), numbers[4:7], numbers[7]
    a /= np.linalg.norm(a)
    omega = math.hypot(p, q, r)
    rho, c2 = 0.5 * omega * h, math.sin(0.5 * omega * h) / omega
    given = {f'a_{i + 1}': a[i] for i in range(4)} | {'p': p, 'q': q, 'r': r}
    given |= {'H': math.cos(rho), 'G': -c2 * r, 'J': c2 * q, 'K': c2 * p}
    after = values('Quaternions', given, *(f'a_{i}_prime' for i in (1, 2, 3, 4)))
    assert after == pytest.approx(turned(tuple(a), (p, q, r), h), rel=1e-12)
    rates = values('Quaternions', given, *(f'dot_a_{i}' for i in (1, 2, 3, 4)))
    tiny = 1e-7
    there = np.array(turned(tuple(a), (p, q, r), tiny))
    assert rates == pytest.approx((there - a) / tiny, abs=1e-6)


@pytest.mark.parametrize('numbers', PLACES, ids=range(5))
def test_the_shaft_of_the_double_hooke_wrist_moves_as_equation_20_says(numbers):
    wrist, heading, positions, given, rates = place('double_hooke', numbers)
    given |= dict(zip(rates, numbers[-3:], strict=True)) | {'l': wrist.shaft_length}
    computed = values(heading, given, 'v_x', 'v_y', 'v_z')
    tiny = 1e-6
    ways = [
        np.array(wrist.forward(np.add(positions, sign * tiny * np.array(numbers[-3:]))).position)
        for sign in (1.0, -1.0)
    ]
    assert computed == pytest.approx((ways[0] - ways[1]) / (2.0 * tiny), rel=1e-7)
