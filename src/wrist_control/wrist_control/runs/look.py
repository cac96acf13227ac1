"""How a report looks: on paper, on a telephone, by day and by night."""

STYLE = """\
:root {
  --paper: #f6f6f4; --card: #ffffff; --ink: #1b1f24; --muted: #626a74; --grid: #dcdfe3;
  --line-1: #0b67b2; --line-2: #c4470a; --line-3: #0a8059; --line-4: #8b3fa8; --line-5: #9a7400;
  --line-6: #54606e; --held: #b3261e; --slow: #8a5a00; --free: #0a6b4a;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #101214; --card: #191c20; --ink: #e9ebee; --muted: #a0a8b2; --grid: #343a41;
    --line-1: #6db6ff; --line-2: #ff9a62; --line-3: #4fd1a1; --line-4: #d79bf0; --line-5: #e3c25a;
    --line-6: #b3bdc8; --held: #ff8a80; --slow: #f0c060; --free: #63d3a6;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; max-width: 76rem; padding: 1rem clamp(0.75rem, 3vw, 2rem) 3rem;
  background: var(--paper); color: var(--ink);
  font: 1rem/1.5 system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif;
}
h1 { font-size: clamp(1.4rem, 4vw, 2rem); line-height: 1.2; margin: 0.5rem 0 0.2rem; }
h2 { font-size: 1.05rem; margin: 0 0 0.5rem; }
.where, footer, figcaption { color: var(--muted); font-size: 0.9rem; }
.where { margin: 0 0 1rem; overflow-wrap: anywhere; }
.notice { border-left: 4px solid var(--held); padding: 0.5rem 0.75rem; background: var(--card); }
.numbers {
  display: grid; gap: 0.75rem; margin: 0 0 1rem;
  grid-template-columns: repeat(auto-fit, minmax(9.5rem, 1fr));
}
.numbers div {
  display: flex; flex-direction: column-reverse; justify-content: flex-end;
  background: var(--card); border-radius: 0.6rem; padding: 0.7rem 0.9rem;
}
.numbers dd {
  margin: 0; font-size: 1.6rem; font-weight: 650; line-height: 1.2;
  font-variant-numeric: tabular-nums;
}
.numbers dt { color: var(--muted); font-size: 0.85rem; line-height: 1.3; }
.figures { columns: 21rem 3; column-gap: 0.75rem; margin-bottom: 0.75rem; }
figure { break-inside: avoid; }
figure, section {
  margin: 0 0 0.75rem; background: var(--card); border-radius: 0.6rem; padding: 0.9rem;
}
figure svg, figure img {
  display: block; width: 100%; height: auto; max-width: 34rem; margin: auto;
}
figure img { max-width: 22rem; }
figure svg text {
  font-family: system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif !important;
}
figcaption { margin-top: 0.5rem; line-height: 1.35; }
.none { color: var(--muted); margin: 0; }
.told { list-style: none; margin: 0; padding: 0; }
.told li {
  display: grid; grid-template-columns: 4rem 6rem 1fr; gap: 0.1rem 0.5rem; align-items: baseline;
  padding: 0.4rem 0; border-top: 1px solid var(--grid);
}
.told li:first-child { border-top: 0; }
.told time { color: var(--muted); font-variant-numeric: tabular-nums; }
.told i { color: var(--muted); font-style: normal; font-size: 0.85rem; white-space: nowrap; }
.state { font-size: 0.78rem; letter-spacing: 0.03em; }
.held { color: var(--held); }
.slow { color: var(--slow); }
.free { color: var(--free); }
summary { cursor: pointer; padding: 0.3rem 0; color: var(--muted); }
table { border-collapse: collapse; font-size: 0.9rem; }
th, td { text-align: left; padding: 0.2rem 1rem 0.2rem 0; vertical-align: top; }
th { font-weight: 500; color: var(--muted); }
td { overflow-wrap: anywhere; font-variant-numeric: tabular-nums; }
footer { margin-top: 1rem; }
@media (max-width: 34rem) {
  .told li { grid-template-columns: 4rem 1fr; }
  .told span { grid-column: 1 / -1; }
}
@media print { body { max-width: none; } figure, section { break-inside: avoid; } }
"""
