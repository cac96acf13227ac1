"""The page that tells of a run: what is on it, and that it loads nothing from anywhere."""

import html.parser
import re

import pytest

from .recordings import a_run, by_rosbags, file_of, rewrite, run, stamp


@pytest.fixture(scope='module')
def good(tmp_path_factory):
    return a_run(tmp_path_factory.mktemp('recorded') / 'run')


class Page(html.parser.HTMLParser):
    """What is in a page."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.addresses, self.words, self.open = [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        if tag not in ('meta', 'img', 'use', 'path', 'br'):
            self.open.append(tag)
        self.addresses += [
            value
            for name, value in attributes
            if name in ('src', 'href', 'xlink:href', 'srcset', 'data', 'action')
        ]

    def handle_endtag(self, tag):
        if tag not in ('meta', 'img', 'use', 'path', 'br'):
            assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)


def test_a_report_is_one_page_that_loads_nothing(tmp_path, good):
    code, said = run('report', good, '--out', tmp_path / 'pages' / 'run.html')
    assert code == 0, said
    assert f'written: {tmp_path}/pages/run.html' in said
    text = (tmp_path / 'pages' / 'run.html').read_text()
    found = Page(text)
    assert found.open == []
    assert all(one.startswith(('#', 'data:image/png;base64,')) for one in found.addresses)
    assert not {'script', 'link', 'iframe', 'object', 'embed'} & set(found.tags)
    assert 'url(' not in re.sub(r'url\(#\w+', '', text)
    assert '@import' not in text
    assert found.tags.count('svg') == 6
    assert 'prefers-color-scheme: dark' in text
    words = ' '.join(found.words)
    for word in (
        'three_gimbal: ',
        'Closest to lock',
        'Limits at work',
        'Following the command.',
        'Ready: no motion is commanded.',
        'change of rate',
        'joint_rate_limits',
    ):
        assert word in words, word


def test_its_numbers_are_those_that_were_recorded(tmp_path, good):
    assert run('report', good, '--out', tmp_path / 'run.html')[0] == 0
    words = ' '.join(Page((tmp_path / 'run.html').read_text()).words)
    read = by_rosbags(good)
    stamps = {stamp(one) for _, _, one in read['/step_inputs']}
    statuses = [one for _, _, one in read['/wrist_status'] if stamp(one) in stamps]
    closest = min(statuses, key=lambda one: one.margin)
    at = 1e-9 * (stamp(closest) - stamp(statuses[0]))
    assert f' smallest margin, at 0:{at:04.1f} {closest.margin:.3f} ' in words
    lost = statuses[-1].time_lost - statuses[0].time_lost
    assert lost > 0.05
    assert f' lost by slowing down {lost:.2f} s ' in words
    turns = [one.commanded.angular for one in statuses]
    asked = [one for one, w in zip(statuses, turns, strict=True) if any((w.x, w.y, w.z))]
    share = 100.0 * sum(one.scale_factor for one in asked) / len(asked)
    assert f' of the commanded rates was followed {share:.0f} % ' in words
    told = [one.message for one in statuses]
    assert {'Ready: no motion is commanded.', 'Following the command.'} <= set(told)


def test_nobody_s_words_become_part_of_a_page(tmp_path, good):
    """A recording may come from anybody."""

    def other(_, data):
        return data.replace(b'Following the command.', b'<script>alert(1)</scri')

    rewrite(file_of(good), tmp_path / 'run_0.mcap', other, '/wrist_status')
    assert run('report', tmp_path, '--out', tmp_path / 'run.html')[0] == 0
    text = (tmp_path / 'run.html').read_text()
    assert '<script' not in text
    assert '&lt;script&gt;alert(1)' in text


def test_where_no_page_can_be_written_it_says_so(tmp_path, good):
    (tmp_path / 'file').touch()
    code, said = run('report', good, '--out', tmp_path / 'file' / 'run.html')
    assert code == 2
    assert 'run.html cannot be written (' in said
    assert 'say another place with --out.' in said
