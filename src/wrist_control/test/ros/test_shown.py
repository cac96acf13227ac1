import pytest

from wrist_control.ros.shown import NAME, shown


def test_an_honest_name_is_shown_as_it_is():
    assert shown('left_θ_2') == 'left_θ_2'
    assert shown('a' * NAME) == 'a' * NAME


@pytest.mark.parametrize(
    ('forged', 'expected'),
    [
        ('hand\n[FATAL] E-stop released', 'hand\\n[FATAL] E-stop released'),
        ('\x1b[2J', '\\x1b[2J'),
        ('\u202edlrow', '\\u202edlrow'),
        ('\udcff', '\\udcff'),
        ('\u2028x', '\\u2028x'),
    ],
)
def test_what_moves_the_cursor_or_breaks_the_line_is_spelled_out(forged, expected):
    assert shown(forged) == expected


@pytest.mark.parametrize('text', ['x' * 10**6, '\n' * 10**6, 'x' * (NAME + 1)])
def test_a_long_name_is_cut_and_says_so(text):
    assert len(shown(text)) == NAME
    assert shown(text).endswith('…')
    assert shown(shown(text)) == shown(text)


def test_a_sentence_may_be_longer():
    assert len(shown('x' * 1000, 400)) == 400
