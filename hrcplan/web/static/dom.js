// Elements, keyed updates, and saving pictures. Text is always text, never markup.
const SVG = "http://www.w3.org/2000/svg";
const SVG_TAGS = new Set(["svg", "g", "rect", "text", "line", "path", "polyline", "circle", "title", "defs", "pattern"]);

export function h(tag, props = {}, ...children) {
  const isSvg = SVG_TAGS.has(tag);
  const node = isSvg ? document.createElementNS(SVG, tag) : document.createElement(tag);
  for (const [name, value] of Object.entries(props)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (name === "value" || name === "checked" || name === "disabled") node[name] = value;
    else node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return node;
}

export function fill(node, ...children) {
  node.replaceChildren(...children.flat().filter(Boolean));
  return node;
}

// Updates children by key: what stays is not detached, so focus and clicks are not lost.
export function keyed(parent, items, key, make, update) {
  const old = new Map([...parent.children].map((child) => [child.dataset.key, child]));
  let place = parent.firstElementChild;
  for (const item of items) {
    const name = String(key(item));
    let node = old.get(name);
    if (node) old.delete(name);
    else {
      node = make(item);
      node.dataset.key = name;
    }
    update?.(node, item);
    if (node === place) place = place.nextElementSibling;
    else parent.insertBefore(node, place);
  }
  for (const node of old.values()) node.remove();
}

const PAINT = ["fill", "stroke", "stroke-width", "stroke-dasharray", "opacity", "font-size", "font-weight", "font-family", "text-anchor"];

function standalone(svg) {
  const copy = svg.cloneNode(true);
  const from = [svg, ...svg.querySelectorAll("*")], to = [copy, ...copy.querySelectorAll("*")];
  from.forEach((node, i) => {
    const style = getComputedStyle(node);
    for (const name of PAINT) to[i].setAttribute(name, style.getPropertyValue(name));
    if (node.style.transform) to[i].setAttribute("transform", node.style.transform.replaceAll("px", ""));
  });
  copy.setAttribute("xmlns", SVG);
  const ground = getComputedStyle(document.documentElement).getPropertyValue("--paper");
  copy.prepend(h("rect", { width: "100%", height: "100%", fill: ground.trim() || "#fff" }));
  return new XMLSerializer().serializeToString(copy);
}

function download(name, blob) {
  const link = h("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 5000);
}

async function savePng(name, svg) {
  const image = new Image();
  const width = svg.width.baseVal.value, height = svg.height.baseVal.value;
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(standalone(svg))}`;
  await image.decode();
  const canvas = h("canvas", { width: 2 * width, height: 2 * height });
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  canvas.toBlob((blob) => download(name, blob));
}

const cell = (value) => (/[",\n]/.test(value) ? `"${String(value).replaceAll('"', '""')}"` : value);
export const csv = (rows) => rows.map((row) => row.map(cell).join(",")).join("\n") + "\n";

// Buttons that save a picture; `rows` returns what it shows as a table.
export function saveButtons(name, svgOf, rows) {
  const button = (text, action) => h("button", { type: "button", onclick: action, title: `save as ${text}` }, text);
  return h("div", { class: "save" },
    button("SVG", () => download(`${name}.svg`, new Blob([standalone(svgOf())], { type: "image/svg+xml" }))),
    button("PNG", () => savePng(`${name}.png`, svgOf())),
    button("CSV", () => download(`${name}.csv`, new Blob([csv(rows())], { type: "text/csv" }))));
}

export const COLORS = { sky: "#56b4e9", orange: "#e69f00", green: "#009e73", yellow: "#f0e442", purple: "#cc79a7", blue: "#0072b2", red: "#d55e00", gray: "#999999" };
export const FILLS = ["#8ccbf0", "#f2c066", "#66c5ab", "#f5ec85", "#dfaac9", "#7fb8d8", "#f0a06a", "#cfcfcf"];
export const LINES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00"];
export const percent = (p) => `${(100 * p).toFixed(p < 0.0995 && p > 0 ? 1 : 0)} %`;
