#include "limcycle/reports/page/page.hpp"

namespace limcycle {

std::string_view page_style() {
  return R"css(
:root { color-scheme: light; --paper: #ffffff; --ink: #1c2024; --soft: #565e66; --line: #d4d9de; --box: #f4f6f8;
  --one: #0b62a8; --two: #b84a00; --three: #6b7680; --good: #1b6e37; --fair: #855400; --bad: #b3261e; --focus: #0b62a8; }
@media screen and (prefers-color-scheme: dark) { :root:not(.print) { color-scheme: dark; --paper: #14171a; --ink: #e6e9ec;
  --soft: #a8b0b8; --line: #3a4148; --box: #1d2226; --one: #6cb6f5; --two: #ff9d57; --three: #98a2ab; --good: #6fcf8c;
  --fair: #e3b341; --bad: #ff8a80; --focus: #6cb6f5; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 1rem/1.5 system-ui, "DejaVu Sans", sans-serif; }
main, header, footer { max-width: 70rem; margin: 0 auto; padding: 0 1rem; }
main:focus { outline: none; }
h1 { font-size: 1.5rem; line-height: 1.25; margin: 1.5rem 0 0.5rem; overflow-wrap: anywhere; }
h2 { font-size: 1.15rem; margin: 2rem 0 0.5rem; }
h3 { font-size: 1rem; margin: 1.25rem 0 0.4rem; }
p, li, summary, figcaption { overflow-wrap: anywhere; }
.answer { font-size: 1.15rem; margin: 0.5rem 0; max-width: 52rem; }
.worth { margin: 0.25rem 0; color: var(--ink); max-width: 52rem; }
.scroll { overflow-x: auto; }
nav ul { display: flex; flex-wrap: wrap; gap: 0.25rem 1.25rem; list-style: none; padding: 0; } nav a { display: inline-block; color: var(--one); }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; margin-top: 0.5rem; }
caption { text-align: left; color: var(--soft); padding-bottom: 0.25rem; }
caption span { position: sticky; left: 0; display: inline-block; max-width: min(52rem, 100vw - 2rem); }
th, td { padding: 0.25rem 0.55rem; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th.left, td.left { text-align: left; }
td.wide { white-space: normal; min-width: 13rem; text-align: left; }
th { color: var(--soft); font-weight: 600; }
.confirmed { color: var(--good); font-weight: 600; } .biased { color: var(--fair); font-weight: 600; }
.false { color: var(--bad); font-weight: 600; }
figure { margin: 1rem 0 2rem; }
.plot { width: 100%; height: 26rem; border: 1px solid var(--line); overflow: hidden; }
.plot.tall { height: 34rem; }
.picture { width: fit-content; max-width: 100%; background: #ffffff; color-scheme: light; padding: 0.25rem; }
.picture svg { display: block; }
figcaption { color: var(--soft); margin-top: 0.4rem; max-width: 52rem; }
pre { background: var(--box); border: 1px solid var(--line); padding: 0.75rem; overflow-x: auto; font-size: 0.85rem;
  font-family: ui-monospace, "DejaVu Sans Mono", monospace; }
summary { cursor: pointer; font-weight: 600; padding: 0.4rem 0; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 0.15rem 1rem; } dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; }
a { color: var(--focus); }
.tools { display: flex; flex-wrap: wrap; gap: 0.4rem; margin: 0.4rem 0; }
button { font: inherit; font-size: 0.9rem; min-height: 2rem; min-width: 2.25rem; padding: 0 0.6rem; cursor: pointer;
  color: var(--ink); background: var(--box); border: 1px solid var(--three); border-radius: 0.25rem; }
button[aria-pressed="true"] { background: var(--ink); color: var(--paper); }
.sliders { border: 1px solid var(--line); margin: 0.5rem 0 0; padding: 0.25rem 0.75rem 0.5rem; min-width: 0; }
.sliders legend { color: var(--soft); padding: 0 0.3rem; }
.slider { display: flex; flex-wrap: wrap; align-items: center; gap: 0 0.75rem; margin: 0; }
.slider label { width: 7.5rem; }
.slider input { flex: 1 1 12rem; min-width: 0; height: 2rem; margin: 0; accent-color: var(--focus); }
.readout { margin: 0.25rem 0; min-height: 3em; font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
.unseen { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); white-space: nowrap; }
.skip { position: absolute; left: 0; top: -10rem; padding: 0.75rem 1rem; background: var(--paper); color: var(--focus); z-index: 10; }
.skip:focus { top: 0; }
:focus-visible { outline: 3px solid var(--focus); outline-offset: 2px; }
.plot:focus-visible, .scroll:focus-visible { outline-offset: -3px; }
.hint { color: var(--soft); font-size: 0.9rem; }
footer { padding-bottom: 3rem; }
@media (pointer: coarse), (max-width: 40rem) { button { min-height: 2.75rem; min-width: 2.75rem; }
  .slider input { height: 2.75rem; } summary { min-height: 2.75rem; padding: 0.6rem 0; } .skip { min-height: 2.75rem; }
  nav a { min-height: 2.75rem; min-width: 2.75rem; padding: 0.6rem 0; } }
@media (max-width: 40rem) { .plot { height: 22rem; } .plot.tall { height: 30rem; } .plot[data-figure="loop"] { height: 32rem; }
  dl { grid-template-columns: 1fr; } main, header, footer { padding: 0 0.75rem; } }
@media (prefers-reduced-motion: reduce) { * { scroll-behavior: auto !important; transition: none !important; animation: none !important; } }
:root.print .plot { width: 17cm; height: 8.5cm; } :root.print .plot.tall { height: 10cm; }
@media print { nav, .hint, .tools, .sliders .slider, .sliders legend, .skip { display: none; } :focus-visible { outline: none; }
  figure, table, tr, pre, dl { break-inside: avoid; }
  pre { white-space: pre-wrap; overflow-wrap: anywhere; } h1, h2, h3, caption, summary { break-after: avoid; }
  .scroll { overflow: visible; } .picture svg { max-width: 100%; height: auto; } table { max-width: 100%; font-size: 0.8rem; }
  th, td { white-space: normal; padding: 0.15rem 0.35rem; } td.wide { min-width: 7rem; } main, header, footer { max-width: none; padding: 0; }
  a[href^="http"]::after { content: " (" attr(href) ")"; } a { color: inherit; } @page { margin: 1.5cm; } }
)css";
}

}  // namespace limcycle
