// The page's style sheet: light and dark, readable on paper, no colour that a colour-blind eye cannot tell. Private.
#pragma once

namespace binpick::html {

inline constexpr const char* kStyle = R"css(
:root { color-scheme: light dark; --ink: #1c2430; --soft: #5b6676; --line: #d9dee6; --page: #f6f7f9; --card: #fff;
  --good: #0b6bcb; --band: #9cc7f2; --bad: #d3560b; --paper: #1c2430; }
@media (prefers-color-scheme: dark) { :root { --ink: #e7ebf1; --soft: #9aa6b6; --line: #323b48; --page: #14181e;
  --card: #1c222a; --good: #58a6ff; --band: #254d77; --bad: #ff9a4d; --paper: #e7ebf1; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 15px/1.5 system-ui, sans-serif; }
main { max-width: 1080px; margin: 0 auto; padding: 32px 20px 64px; }
h1 { margin: 0; font-size: 26px; overflow-wrap: anywhere; }
h2 { margin: 40px 0 12px; font-size: 18px; }
.verdict { margin: 8px 0 24px; font-size: 18px; }
.note, figcaption { color: var(--soft); font-size: 13px; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(230px, 1fr)); gap: 14px; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 14px 16px; }
.card b { display: block; font-size: 26px; font-variant-numeric: tabular-nums; }
.card span { color: var(--soft); font-size: 13px; }
svg { display: block; width: 100%; height: auto; }
.scroll { overflow-x: auto; background: var(--card); border: 1px solid var(--line); border-radius: 10px; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: 7px 12px; text-align: left; border-bottom: 1px solid var(--line); vertical-align: top; }
tr:last-child td { border-bottom: 0; }
th { color: var(--soft); font-weight: 600; font-size: 13px; }
td.n, th.n { text-align: right; white-space: nowrap; }
td.wide { width: 40%; min-width: 140px; }
.bar { height: 14px; border-radius: 3px; background: var(--bad); min-width: 2px; }
.bar.ok { background: var(--good); }
code { font: 13px/1.4 ui-monospace, monospace; user-select: all; white-space: nowrap; }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(320px, 1fr)); gap: 14px; }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(240px, 1fr)); gap: 12px; }
.opening { margin: 0 0 24px; align-items: end; }
figure { margin: 0; }
img { width: 100%; border-radius: 8px; border: 1px solid var(--line); background: var(--line); }
a { color: var(--good); }
)css";

}  // namespace binpick::html
