#include "limcycle/reports/page/parts.hpp"

namespace limcycle {

std::string_view script_saving() {
  return R"js(
// A file name that every system takes, of words of the page.
function slug(text) {
  const plain = text.normalize("NFKD").toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-+|-+$/g, "");
  return plain.slice(0, 60).replace(/-+$/, "") || "limcycle";
}
const fileName = (part, ending) => slug(document.querySelector("h1").textContent) + "-" + slug(part) + "." + ending;

function save(name, content, type) {
  const url = URL.createObjectURL(new Blob([content], {type}));
  const link = element("a", {href: url, download: name, hidden: true});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 60000);
}

function bytesOf(dataUrl) {
  const [head, body] = [dataUrl.slice(0, dataUrl.indexOf(",")), dataUrl.slice(dataUrl.indexOf(",") + 1)];
  return head.endsWith(";base64") ? Uint8Array.from(atob(body), (c) => c.charCodeAt(0)) : decodeURIComponent(body);
}

// In the colours of paper, whatever those of the screen.
function onPaper(work) {
  const before = root.classList.contains("print");
  root.classList.add("print");
  try { return work(); } finally { root.classList.toggle("print", before); }
}

// The figure as it is seen, its heading above, black on white.
async function savePlot(plot, format) {
  const heading = plot.closest("figure").querySelector("h2, h3, h4")?.textContent ?? plot.dataset.figure;
  const [data, shape] = onPaper(() => draw[plot.dataset.figure](dataOf(plot), plot));
  const layout = {...seenBy(plot, shape), title: {text: heading, x: 0.02, font: {size: 17}}, margin: {...shape.margin, t: 48}};
  const url = await Plotly.toImage({data, layout}, {format, width: 1000, height: 680, scale: format === "png" ? 2 : 1});
  save(fileName(plot.dataset.figure, format), bytesOf(url), format === "png" ? "image/png" : "image/svg+xml");
}

function textOfPicture(svg) {
  const copy = svg.cloneNode(true), ns = svg.namespaceURI;
  const [, , width, height] = (svg.getAttribute("viewBox") ?? "0 0 760 400").split(/[ ,]+/).map(Number);
  for (const [key, value] of Object.entries({xmlns: ns, width, height})) copy.setAttribute(key, value);
  const ground = document.createElementNS(ns, "rect");
  for (const [key, value] of Object.entries({x: 0, y: 0, width, height, style: "fill:#ffffff;stroke:none"})) ground.setAttribute(key, value);
  copy.insertBefore(ground, copy.firstChild);
  return {text: new XMLSerializer().serializeToString(copy), width, height};
}

async function savePicture(svg, name, format) {
  const {text, width, height} = textOfPicture(svg);
  if (format === "svg") { save(fileName(name, "svg"), text, "image/svg+xml"); return; }
  const url = URL.createObjectURL(new Blob([text], {type: "image/svg+xml"}));
  const image = new Image();
  image.src = url;
  await image.decode();
  const scale = Math.max(2, 1200 / width);  // a small picture is to be legible too
  const canvas = element("canvas", {width: Math.ceil(scale * width), height: Math.ceil(scale * height)});
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  URL.revokeObjectURL(url);
  save(fileName(name, "png"), await new Promise((done) => canvas.toBlob(done, "image/png")), "image/png");
}

function button(label, words, act) {
  const made = element("button", {type: "button", textContent: label, onclick: async () => {
    try { await act(); } catch (error) { failed(error); made.textContent = label + " failed"; }
  }});
  made.setAttribute("aria-label", words);
  return made;
}

function tools(words, ...buttons) {
  const made = element("div", {className: "tools"}, ...buttons);
  made.setAttribute("role", "group");
  made.setAttribute("aria-label", words);
  return made;
}

function addSaving() {
  document.querySelectorAll(".plot").forEach((plot) => {
    const name = plot.closest("figure").querySelector("h2, h3, h4")?.textContent ?? plot.dataset.figure;
    const id = plot.dataset.figure;
    plot.after(tools("Figure: " + name,
      button("+", "Zoom in: " + name, () => change(plot, 0.8, [0, 0])), button("−", "Zoom out: " + name, () => change(plot, 1.25, [0, 0])),
      button("All", "Show all: " + name, () => showAll(plot)), button("Reset", "Reset the view: " + name, () => firstView(plot)),
      button("SVG", "Save as SVG: " + name, () => savePlot(plot, "svg")), button("PNG", "Save as PNG: " + name, () => savePlot(plot, "png")),
      button("CSV", "Save the data as CSV: " + name, () => save(fileName(id, "csv"), csv(rowsOfFigure(id, dataOf(plot))), "text/csv"))));
    const controls = id === "nyquist" ? nyquistControls(plot) : null;
    if (controls) plot.after(controls);
  });
  document.querySelectorAll("main svg[role=img]").forEach((svg, i) => {
    if (svg.closest(".plot")) return;
    const name = svg.closest("figure")?.querySelector("svg .title, h2, h3, h4")?.textContent ?? svg.getAttribute("aria-label") ?? "figure " + (i + 1);
    const own = tools("Figure: " + name, button("SVG", "Save as SVG: " + name, () => savePicture(svg, name, "svg")),
      button("PNG", "Save as PNG: " + name, () => savePicture(svg, name, "png")));
    const held = svg.closest("figure")?.querySelector("script.rows");
    if (held) own.append(button("CSV", "Save the data as CSV: " + name, () => save(fileName(name, "csv"), JSON.parse(held.textContent), "text/csv")));
    (svg.closest(".scroll, .picture") ?? svg).after(own);
  });
  document.querySelectorAll("main table").forEach((table) => {
    const name = table.caption?.textContent ?? "table";
    (table.closest(".scroll") ?? table).after(tools("Table: " + name,
      button("CSV", "Save as CSV: " + name, () => save(fileName(name, "csv"), csv(rowsOfTable(table)), "text/csv"))));
  });
  const result = document.getElementById("result");
  if (result) document.querySelector("header").append(tools("Result", button("JSON", "Save the result as JSON",
    () => save(fileName("result", "json"), result.textContent.trim() + "\n", "application/json"))));
}
)js";
}

}  // namespace limcycle
