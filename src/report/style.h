#pragma once

#include <string_view>

namespace kropla {

/// The page's style sheet: colours by name, once for light and once for dark; on paper it is light.
inline constexpr std::string_view page_style = R"css(
:root { color-scheme: light dark;
  --page: #f6f7f9; --card: #ffffff; --ink: #1b2530; --soft: #5c6875; --rule: #dde2e8;
  --s0: #2468b4; --s1: #e07b1a; --s2: #2f9e77; --limit: #c2303a;
  --good: #2f8f5b; --unfinished: #b7791f; --bad: #c2303a;
  --r0: #dbe9f7; --edge: #51637a; --r1: #f59a3c; --r2: #d9636b; --r3: #e8c14a; --r4: #b07cc0;
  --p0: #7cc4a4; }
@media (prefers-color-scheme: dark) { :root {
  --page: #12161b; --card: #1b2128; --ink: #e6ebf0; --soft: #98a4b1; --rule: #323b46;
  --s0: #6cb0f5; --s1: #f5a14b; --s2: #56c99d; --limit: #ff7b81;
  --good: #56c98a; --unfinished: #e0ab4f; --bad: #ff7b81;
  --r0: #263748; --edge: #7f95ab; --r1: #c8701c; --r2: #a8454d; --r3: #a8882a; --r4: #80549a;
  --p0: #2f7d62; } }
@media print { :root { color-scheme: light; --page: #fff; --card: #fff; --ink: #000; --soft: #444;
  --rule: #ccc;
  --s0: #2468b4; --s1: #e07b1a; --s2: #2f9e77; --limit: #c2303a; --good: #2f8f5b; --unfinished: #b7791f;
  --bad: #c2303a; --r0: #dbe9f7; --edge: #51637a; --r1: #f59a3c; --r2: #d9636b; --r3: #e8c14a;
  --r4: #b07cc0; --p0: #7cc4a4; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  figure, .tile { break-inside: avoid; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink);
  font: 15px/1.45 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
main { max-width: 1280px; margin: 0 auto; padding: 28px 20px 48px; }
h1 { font-size: 27px; margin: 0 0 14px; } h2 { font-size: 20px; margin: 34px 0 4px; }
h3 { font-size: 15px; margin: 18px 0 8px; }
.soft { color: var(--soft); } p { margin: 4px 0 12px; }
.verdict { padding: 12px 18px; border-left: 6px solid; background: var(--card); border-radius: 6px;
  font-size: 18px;
  font-weight: 600; }
.good { border-color: var(--good); } .unfinished { border-color: var(--unfinished); }
.bad { border-color: var(--bad); }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(190px, 1fr)); gap: 14px;
  margin-top: 14px; }
.tile, .card { background: var(--card); border: 1px solid var(--rule); border-radius: 8px;
  padding: 12px 14px; }
.tile b { display: block; font-size: 25px; line-height: 1.25; font-variant-numeric: tabular-nums; }
.charts { display: grid; grid-template-columns: repeat(auto-fill, minmax(370px, 1fr)); gap: 14px;
  margin-top: 12px; }
.pictures { display: grid; grid-template-columns: repeat(3, 1fr); gap: 14px; }
figure { margin: 0; } figcaption { font-weight: 600; margin: 2px 0 4px; } svg { display: block; width: 100%;
  height: auto; }
.legend { font-size: 13px; color: var(--soft); min-height: 20px; } .legend span { margin-right: 14px; }
.swatch { display: inline-block; width: 11px; height: 11px; border-radius: 3px; margin-right: 5px; }
.swatch.limit { height: 0; border-top: 2px dashed var(--limit); vertical-align: middle; border-radius: 0;
  width: 16px; }
.b0 { background: var(--s0); } .b1 { background: var(--s1); } .b2 { background: var(--s2); }
.tick { font-size: 11.5px; fill: var(--soft); } .grid { stroke: var(--rule); }
path.limit { stroke: var(--limit); stroke-width: 1.6; stroke-dasharray: 6 4; }
.line { fill: none; stroke-width: 2; stroke-linejoin: round; }
.line.s0 { stroke: var(--s0); } .line.s1 { stroke: var(--s1); } .line.s2 { stroke: var(--s2); }
.column.s0 { fill: var(--s0); } .column.s1 { fill: var(--s1); } .column.s2 { fill: var(--s2); }
.hints rect { fill: transparent; } .hints rect:hover { fill: var(--soft); fill-opacity: .16; }
.picture { border-radius: 4px; margin-bottom: 8px; } .cells path { stroke: var(--edge); stroke-width: .35;
  stroke-linejoin: round; }
.cells .axes { fill: none; stroke: var(--soft); stroke-width: 1.2; }
.mark { fill: none; stroke: var(--limit); stroke-width: 2.5; }
.field path { stroke-width: .5; stroke-linejoin: round; }
.field .outline { fill: none; stroke: #141c26; stroke-width: 2.6; }
.field .solid { fill: #9aa3ad; stroke: #9aa3ad; }
.field .shaft { fill: none; stroke: #141c26; stroke-width: .9; } .field .head { fill: #141c26; stroke: none; }
 .bar { max-width: 520px; margin-top: 8px; }
.r0 { fill: var(--r0); } .r1 { fill: var(--r1); } .r2 { fill: var(--r2); } .r3 { fill: var(--r3); }
.r4 { fill: var(--r4); } .p0 { fill: var(--p0); } .p1 { fill: var(--r1); fill-opacity: .55; }
.p2 { fill: var(--r2); fill-opacity: .55; } .p3 { fill: var(--r3); fill-opacity: .55; }
.p4 { fill: var(--r4); fill-opacity: .55; }
.wide { overflow-x: auto; } .wide td { white-space: nowrap; }
table { border-collapse: collapse; width: 100%; } td { padding: 5px 10px 5px 0;
  border-bottom: 1px solid var(--rule); }
th { padding: 5px 10px 5px 0; text-align: left; font-weight: 600; }
td:first-child { color: var(--soft); white-space: nowrap; width: 16em; }
pre { background: var(--card); border: 1px solid var(--rule); border-radius: 8px; padding: 14px 16px;
  overflow-x: auto;
  font: 13px/1.45 ui-monospace, "DejaVu Sans Mono", monospace; white-space: pre-wrap; }
@media (max-width: 760px) { .pictures { grid-template-columns: 1fr; } }
)css";

}  // namespace kropla
