// Elements, keyed updates, and saving pictures. Text is never markup.
const SVG = "http://www.w3.org/2000/svg";
const SVG_TAGS = new Set("svg g rect text line polyline title defs pattern".split(" "));

export function h(tag, props = {}, ...children) {
	const node = SVG_TAGS.has(tag) ? document.createElementNS(SVG, tag) : document.createElement(tag);
	node.append(...children.flat().filter((child) => child || child === 0));
	if (tag === "button") node.type = "button";
	return set(node, props);
}

export function set(node, props) {
	for (const [name, value] of Object.entries(props)) {
		if (value === undefined || value === null || value === false) continue;
		if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
		else if (name === "value") node.value = value;
		else node.setAttribute(name, value === true ? "" : value);
	}
	return node;
}

export function fill(node, ...children) {
	node.replaceChildren(...children.flat().filter(Boolean));
	return node;
}

// Updates children by key: what stays keeps focus and clicks.
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

const pen = document.createElement("canvas").getContext("2d");
pen.font = "12px " + getComputedStyle(document.body).fontFamily;
export const textWidth = (text) => pen.measureText(text).width;

const PAINT = "fill stroke stroke-width stroke-dasharray opacity font-size font-family text-anchor".split(" ");

function standalone(svg) {
	const copy = svg.cloneNode(true);
	const from = [svg, ...svg.querySelectorAll("*")], to = [copy, ...copy.querySelectorAll("*")];
	from.forEach((node, i) => {
		const style = getComputedStyle(node);
		for (const name of PAINT) to[i].setAttribute(name, style[name]);
		if (node.style.transform) to[i].setAttribute("transform", node.style.transform.replaceAll("px", ""));
	});
	copy.setAttribute("xmlns", SVG);
	const ground = getComputedStyle(svg).getPropertyValue("--paper");
	copy.prepend(h("rect", { width: "100%", height: "100%", fill: ground }));
	return new XMLSerializer().serializeToString(copy);
}

function download(name, blob) {
	const link = h("a", { href: URL.createObjectURL(blob), download: name });
	link.click();
	setTimeout(() => URL.revokeObjectURL(link.href), 5000);
}

async function savePng(name, svg) {
	const image = new Image();
	image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(standalone(svg))}`;
	await image.decode();
	const canvas = h("canvas", { width: 2 * svg.width.baseVal.value, height: 2 * svg.height.baseVal.value });
	canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
	canvas.toBlob((blob) => download(name, blob));
}

const cell = (value) => (/[",\n]/.test(value) ? `"${String(value).replaceAll('"', '""')}"` : value);
export const csv = (rows) => rows.map((row) => row.map(cell).join(",")).join("\n") + "\n";

// Buttons that save a picture, and its `rows` as a table.
export function saveButtons(name, svgOf, rows) {
	const kinds = { SVG: () => text("svg", standalone(svgOf())), PNG: () => savePng(`${name}.png`, svgOf()), CSV: () => text("csv", csv(rows())) };
	const text = (kind, content) => download(`${name}.${kind}`, new Blob([content]));
	return h("div", { class: "save" }, Object.keys(kinds).map((kind) => h("button", { onclick: kinds[kind], title: `save as ${kind}` }, kind)));
}

export const COLORS = { sky: "#56b4e9", orange: "#e69f00", green: "#009e73", yellow: "#f0e442", purple: "#cc79a7", blue: "#0072b2", red: "#d55e00", gray: "#999" };
export const FILLS = ["#8ccbf0", "#f2c066", "#66c5ab", "#f5ec85", "#dfaac9", "#7fb8d8", "#f0a06a", "#cfcfcf"];
export const LINES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00"];
export const percent = (p) => `${(100 * p).toFixed(p < 0.0995 && p > 0 ? 1 : 0)} %`;

// Pictures drawn by the server.
for (const svg of document.querySelectorAll("[data-rows]")) svg.parentNode.after(saveButtons(svg.id, () => svg, () => JSON.parse(svg.dataset.rows)));
