"""Draw docs/console/: the console as a browser shows it while a wrist is driven."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import NamedTuple

from playwright.sync_api import Page, sync_playwright

from wrist_control.web.served import BROWSER, FLAGS, MISSING, served

FOLDER = Path(__file__).resolve().parent.parent / 'docs' / 'console'


class Picture(NamedTuple):
    """One picture: of which wrists, how large, dark or light, and how long the stick is held."""

    name: str
    wrists: dict[str, str]
    size: tuple[int, int]
    scheme: str
    seconds: float


PICTURES = (
    Picture('console', {'start': 'omni_wrist'}, (1280, 720), 'dark', 4.2),
    Picture('two', {'start': 'three_gimbal', 'second': 'carpal'}, (1280, 720), 'light', 3.5),
    Picture('phone', {'start': 'double_hooke'}, (390, 844), 'dark', 2.5),
)


def hold(page: Page, seconds: float) -> None:
    """Hold the stick aside and upwards for a while; go on holding it."""
    page.locator('.pad').scroll_into_view_if_needed()
    box = page.locator('.pad').bounding_box()
    assert box is not None
    page.mouse.move(box['x'] + 0.5 * box['width'], box['y'] + 0.5 * box['height'])
    page.mouse.down()
    page.mouse.move(box['x'] + 0.56 * box['width'], box['y'] + 0.16 * box['height'])
    page.wait_for_timeout(1000.0 * seconds)


def main() -> int:
    """Draw every picture; the exit code is 1 where there is no browser."""
    if BROWSER is None:
        print(f'console_pictures: {MISSING}')
        return 1
    FOLDER.mkdir(exist_ok=True)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=BROWSER, args=FLAGS)
        for picture in PICTURES:
            with served(**picture.wrists) as address:
                width, height = picture.size
                page = browser.new_page(
                    viewport={'width': width, 'height': height},
                    color_scheme='dark' if picture.scheme == 'dark' else 'light',
                )
                page.goto(address)
                page.locator('.state[data-state=IDLE]').wait_for()
                page.wait_for_timeout(5000.0)
                hold(page, picture.seconds)
                page.evaluate('window.scrollTo(0, 0)')
                file = FOLDER / f'{picture.name}.png'
                page.screenshot(path=file)
                page.close()
                print(f'drawn: {file.relative_to(Path.cwd())}')
        browser.close()
    return 0


if __name__ == '__main__':
    sys.exit(main())
