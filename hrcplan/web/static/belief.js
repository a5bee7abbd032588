// The belief over goals, over time: the likeliest goals have colors and names.
import { h, LINES, percent } from "./dom.js";

const HEIGHT = 150, LEFT = 40, FOOT = 22;

// The goals that get a color: those with the most probability over time.
export function likeliest(beliefs) {
	const sums = new Map();
	beliefs.forEach(({ goals }, i) => {
		for (const [name, p] of goals) sums.set(name, (sums.get(name) || 0) + p * (i === beliefs.length - 1 ? 100 : 1));
	});
	return [...sums].sort((a, b) => b[1] - a[1]).slice(0, LINES.length).map(([name]) => name);
}

export function beliefChart({ beliefs, changes, width, names }) {
	const n = Math.max(1, beliefs.length - 1), right = width - 12;
	const x = (i) => LEFT + ((right - LEFT) * i) / n, y = (p) => 6 + (HEIGHT - FOOT - 12) * (1 - p);
	const svg = h("svg", { width, height: HEIGHT, viewBox: `0 0 ${width} ${HEIGHT}`, role: "img", "aria-label": "belief over time" });
	for (const p of [0, 0.5, 1]) svg.append(
		h("line", { x1: LEFT, x2: right, y1: y(p), y2: y(p), class: "axis" }),
		h("text", { x: LEFT - 6, y: y(p) + 4, "text-anchor": "end", class: "soft" }, `${100 * p}%`));
	svg.append(h("text", { x: right, y: HEIGHT - 5, "text-anchor": "end", class: "soft" }, "steps of the robot"));
	for (const i of changes) svg.append(h("line", { x1: x(i), x2: x(i), y1: 0, y2: HEIGHT - FOOT, stroke: "#cc79a7", "stroke-width": 2, "stroke-dasharray": "5 3" }));
	const all = new Set(beliefs.flatMap(({ goals }) => [...goals.keys()]));
	const points = (name) => (beliefs.length > 1 ? beliefs : [...beliefs, ...beliefs]).map(({ goals }, i) => `${x(i).toFixed(1)},${y(goals.get(name) || 0).toFixed(1)}`).join(" ");
	for (const name of all) if (!names.includes(name)) svg.append(h("polyline", { points: points(name), fill: "none", stroke: "#999", "stroke-width": 0.6 }));
	names.forEach((name, i) => {
		svg.append(h("polyline", { points: points(name), fill: "none", stroke: LINES[i], "stroke-width": 3 - 0.3 * i, "stroke-dasharray": i % 2 ? "7 3" : "none" }, h("title", {}, name)));
	});
	return svg;
}

// The likeliest goals now, with bars in the colors of the chart.
export function goalList(belief, names) {
	if (!belief) return [];
	const rows = [...belief.goals].sort((a, b) => b[1] - a[1]).slice(0, 5);
	return rows.flatMap(([name, p]) => {
		const at = names.indexOf(name), bar = h("i"), color = at < 0 ? "#999" : LINES[at];
		bar.style.width = `${100 * p}%`;
		bar.style.color = color;
		return [h("span", {}, name), h("span", { class: "bar" }, bar), h("span", { class: "soft" }, percent(p))];
	});
}

export const beliefRows = (beliefs) => {
	const names = [...new Set(beliefs.flatMap(({ goals }) => [...goals.keys()]))];
	return [["line", "time", ...names], ...beliefs.map(({ n, t, goals }) => [n, t, ...names.map((name) => goals.get(name) || 0)])];
};
