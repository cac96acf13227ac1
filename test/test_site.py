"""The site of `make docs`: built without a warning, no dead link, nothing from elsewhere."""

import re
import subprocess
import sys
from html.parser import HTMLParser
from urllib.parse import unquote, urlsplit

import pytest

from .documents import ROOT

DOCS = ROOT / 'docs'
RECIPE = re.search(r'\./env python3 (-m sphinx .*) out/site', (ROOT / 'Makefile').read_text())
# Elements that fetch what they name while a page is looked at, and the attribute that names it.
FETCHED = {'script': 'src', 'img': 'src', 'iframe': 'src', 'source': 'src', 'link': 'href'}
PUBLIC = {
    'wrist_control': 'WRISTS make_wrist make_maneuver fly Flight errors.WristError',
    'rotations': 'rotations.Pose rotations.turned rotations.from_xyzw',
    'resolving': 'resolving.start resolving.step resolving.State resolving.Step',
    'wrists': 'wrists.wrist.Wrist wrists.wrist.Wrist.margin wrists.joint.Joint',
    'stewart': 'stewart.forward_kinematics.ForwardKinematics.solve',
    'dexterity': 'dexterity.principal dexterity.Uniformity.relative',
    'testing': 'testing.check_wrist',
}


class Page(HTMLParser):
    """What a page names, fetches and links to."""

    def __init__(self, file):
        super().__init__()
        self.anchors, self.links, self.fetched, self.tags = set(), set(), set(), []
        self.text = file.read_text(encoding='utf-8')
        self.feed(self.text)

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.tags.append(tag)
        self.anchors.add(given.get('id'))
        if tag == 'a' and 'href' in given:
            self.links.add(given['href'])
        if tag in FETCHED and FETCHED[tag] in given:
            self.fetched.add(given[FETCHED[tag]])


@pytest.fixture(scope='module')
def site(tmp_path_factory):
    """Build the site as the Makefile does, elsewhere."""
    out = tmp_path_factory.mktemp('site')
    path = [str(ROOT / 'src' / 'wrist_control'), *filter(None, sys.path)]
    done = subprocess.run(
        [sys.executable, *RECIPE[1].split(), str(out)],
        cwd=ROOT,
        env={'PYTHONPATH': ':'.join(path), 'PATH': '/usr/bin:/bin', 'LC_ALL': 'C.UTF-8'},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stderr == ''
    return out


@pytest.fixture(scope='module')
def pages(site):
    return {file.resolve(): Page(file) for file in site.rglob('*.html')}


def test_the_build_is_strict():
    assert {'-W', '-n'} <= set(RECIPE[1].split())


def test_every_document_is_a_page(site):
    documents = [file.relative_to(DOCS).with_suffix('.html') for file in DOCS.rglob('*.md')]
    assert len(documents) > 15
    assert [str(page) for page in documents if not (site / page).exists()] == []


def test_every_link_and_anchor_of_the_site_is_there(pages):
    dead = []
    for file, page in pages.items():
        for link in page.links | page.fetched:
            parts = urlsplit(link)
            if parts.scheme:
                continue
            target = (file.parent / unquote(parts.path)).resolve() if parts.path else file
            linked = pages.get(target)
            if not target.exists() or (
                linked and parts.fragment and unquote(parts.fragment) not in linked.anchors
            ):
                dead.append(f'{file.name}: {link}')
    assert dead == []


def test_nothing_is_loaded_from_elsewhere(site, pages):
    named = {link for page in pages.values() for link in page.fetched}
    for style in site.rglob('*.css'):
        named.update(re.findall(r'url\(["\']?([^"\')]+)|@import', style.read_text()))
    assert {name for name in named if re.match(r'(https?:)?//', name)} == set()


def test_equations_are_rendered(site):
    page = Page(site / 'equations.html')
    source = (DOCS / 'equations.md').read_text()
    assert page.text.count('display="block"') == source.count('```math') > 40
    assert page.tags.count('math') > 400
    rendered = re.sub(r'<math.*?</math>', '', page.text, flags=re.DOTALL)
    for left_over in ('$', r'\dot', r'\text', 'merror'):
        assert left_over not in rendered.split('<article', 1)[1].split('</article>')[0]
    assert '\\' not in ''.join(re.findall(r'<math.*?</math>', page.text, flags=re.DOTALL))


@pytest.mark.parametrize('page', PUBLIC)
def test_the_public_library_is_there_with_its_docstrings(site, page):
    anchors = Page(site / 'api' / f'{page}.html').anchors
    assert [name for name in PUBLIC[page].split() if f'wrist_control.{name}' not in anchors] == []


def test_the_pages_need_no_ros():
    """What the tests of the floors hold for the code holds for its pages: they import no more."""
    named = re.findall(
        r'wrist_control\.(\w+)', ''.join(file.read_text() for file in (DOCS / 'api').glob('*.md'))
    )
    assert set(named).isdisjoint({'ros', 'nodes', 'graph', 'demo'})
