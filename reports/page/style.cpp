#include "limcycle/reports/page/page.hpp"

namespace limcycle {

std::string_view page_style() {
  return R"css(
:root { color-scheme: light; --paper: #ffffff; --ink: #1c2024; --soft: #565e66; --line: #d4d9de; --box: #f4f6f8;
  --one: #0b62a8; --two: #b84a00; --three: #6b7680; --good: #1b6e37; --fair: #855400; --bad: #b3261e; --focus: #0b62a8; }
@media (prefers-color-scheme: dark) { :root:not(.print) { color-scheme: dark; --paper: #14171a; --ink: #e6e9ec;
  --soft: #a8b0b8; --line: #3a4148; --box: #1d2226; --one: #6cb6f5; --two: #ff9d57; --three: #98a2ab; --good: #6fcf8c;
  --fair: #e3b341; --bad: #ff8a80; --focus: #6cb6f5; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 1rem/1.5 system-ui, "DejaVu Sans", sans-serif; }
main, header, footer { max-width: 70rem; margin: 0 auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; line-height: 1.25; margin: 1.5rem 0 0.5rem; overflow-wrap: anywhere; }
h2 { font-size: 1.15rem; margin: 2rem 0 0.5rem; }
.answer { font-size: 1.15rem; margin: 0.5rem 0; }
.worth { margin: 0.25rem 0; color: var(--ink); }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--soft); padding-bottom: 0.25rem; }
th, td { padding: 0.25rem 0.55rem; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th.left, td.left { text-align: left; }
td.wide { white-space: normal; min-width: 13rem; text-align: left; }
th { color: var(--soft); font-weight: 600; }
.confirmed { color: var(--good); font-weight: 600; } .biased { color: var(--fair); font-weight: 600; }
.false { color: var(--bad); font-weight: 600; }
figure { margin: 1rem 0 2rem; }
.plot { width: 100%; height: 26rem; border: 1px solid var(--line); }
.plot.tall { height: 34rem; }
figcaption { color: var(--soft); margin-top: 0.4rem; }
pre { background: var(--box); border: 1px solid var(--line); padding: 0.75rem; overflow-x: auto; font-size: 0.85rem;
  font-family: ui-monospace, "DejaVu Sans Mono", monospace; }
summary { cursor: pointer; font-weight: 600; padding: 0.25rem 0; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 0.15rem 1rem; } dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; }
:focus-visible { outline: 3px solid var(--focus); outline-offset: 2px; }
.hint { color: var(--soft); font-size: 0.9rem; }
footer { padding-bottom: 3rem; }
@media (max-width: 40rem) { .plot { height: 22rem; } .plot.tall { height: 30rem; } .plot[data-figure="loop"] { height: 32rem; } dl { grid-template-columns: 1fr; } }
@media print { .hint { display: none; } figure, table { break-inside: avoid; } .scroll { overflow: visible; }
  .plot { width: 17cm; } .modebar { display: none; } pre { white-space: pre-wrap; } a { color: inherit; } }
)css";
}

}  // namespace limcycle
