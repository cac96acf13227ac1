"""How the console's page keeps up with a wrist of eleven strips, in a browser on this machine."""

import statistics
import sys
import time

from playwright.sync_api import sync_playwright
from rich.console import Console
from rich.table import Table

from wrist_control.web.served import BROWSER, FLAGS, MISSING, served

SECONDS = 10.0
GOAL = 30.0  # updates a second
# Counts what the strips are told, and how evenly pictures follow each other, ms.
COUNT = """
async (ms) => {
  let pictures = 0;
  const gaps = [];
  let last = performance.now();
  const next = (now) => {
    gaps.push(now - last);
    last = now;
    pictures += 1;
    requestAnimationFrame(next);
  };
  requestAnimationFrame(next);
  const strips = document.querySelector("section.strips > div");
  const chart = getElement(strips.id.slice(1));
  let drawn = 0;
  const observed = setInterval(() => {
    const newest = chart.rows.length ? chart.rows[chart.rows.length - 1][0] : 0;
    if (newest !== chart.seen) { chart.seen = newest; drawn += 1; }
  }, 4);
  await new Promise((resolve) => setTimeout(resolve, ms));
  clearInterval(observed);
  return {pictures, drawn, gaps};
}
"""


def main():
    """Print the table."""
    if BROWSER is None:
        print(f'bench_console: {MISSING}')
        return
    with sync_playwright() as playwright, served(start='stewart') as address:
        browser = playwright.chromium.launch(executable_path=BROWSER, args=FLAGS)
        page = browser.new_page(viewport={'width': 1280, 'height': 720})
        page.goto(address)
        page.locator('.state[data-state=IDLE]').wait_for()
        page.wait_for_timeout(3000.0)
        began = time.monotonic()
        found = page.evaluate(COUNT, 1000.0 * SECONDS)
        elapsed = time.monotonic() - began
        browser.close()
    table = Table(title='The console, Stewart platform: 11 strips and the mechanism')
    for heading in ('measured', 'per second', 'of the goal'):
        table.add_column(heading, justify='right')
    for name, count in (('updates drawn', found['drawn']), ('pictures', found['pictures'])):
        table.add_row(name, f'{count / elapsed:.1f}', f'{count / elapsed / GOAL:.2f}')
    console = Console()
    console.print(table)
    gaps = sorted(found['gaps'])
    console.print(
        f'Between pictures: median {statistics.median(gaps):.0f} ms, '
        f'p99 {gaps[int(0.99 * len(gaps))]:.0f} ms.  Goal: {GOAL:g} updates a second.'
    )


if __name__ == '__main__':
    sys.exit(main())
