// Bars in lanes: one lane per agent, also for idle ones.
import { h, textWidth, FILLS } from "./dom.js";

const LANE = 62, BAR = 40, left = 44, AXIS = 26, LEAST = 64, WIDEST = 6000;

function ticks(end) {
	const rough = Math.max(end / 10, 1e-9), power = 10 ** Math.floor(Math.log10(rough));
	const size = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= rough);
	return Array.from({ length: Math.floor(end / size + 1e-9) + 1 }, (_, i) => i * size);
}

function cut(text, room) {
	if (textWidth(text) <= room) return text;
	let n = text.length - 1;
	while (n > 0 && textWidth(`${text.slice(0, n)}…`) > room) n--;
	return n > 1 ? `${text.slice(0, n)}…` : "";
}

// Returns an svg of bars {agent, action, args, start, end, outcome, asked}; `at` marks a time.
export function lanes({ agents, bars, unit, width, at, end }) {
	const names = bars.some((bar) => !bar.agent) ? [...agents, ""] : agents;
	const last = Math.max(end || 0, ...bars.map((bar) => bar.end), 1);
	const shortest = Math.min(...bars.map((bar) => bar.end - bar.start).filter((d) => d > 0), last);
	const perUnit = Math.min(WIDEST / last, Math.max((width - left - 12) / last, LEAST / shortest));
	const x = (t) => left + t * perUnit;
	const total = Math.ceil(x(last) + 12), height = names.length * LANE + AXIS;
	const colors = new Map();
	for (const bar of bars) if (!colors.has(bar.action)) colors.set(bar.action, FILLS[colors.size % FILLS.length]);
	const svg = h("svg", { width: total, height, viewBox: `0 0 ${total} ${height}`, role: "img", "aria-label": "actions over time" },
		h("defs", {}, h("pattern", { id: "failed", width: 8, height: 8, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" },
			h("rect", { width: 8, height: 8, fill: "#fff" }), h("line", { x1: 0, y1: 0, x2: 0, y2: 8, stroke: "#d55e00", "stroke-width": 3 }))));
	names.forEach((name, i) => svg.append(
		h("line", { x1: left, x2: total, y1: (i + 1) * LANE, y2: (i + 1) * LANE, class: "axis" }),
		h("text", { x: 2, y: i * LANE + 13, class: "name" }, name || "no agent")));
	for (const t of ticks(last)) svg.append(
		h("line", { x1: x(t), x2: x(t), y1: 0, y2: height - AXIS, class: "axis", "stroke-dasharray": "2 3" }),
		h("text", { x: x(t), y: height - 9, "text-anchor": "middle", class: "soft" }, `${+t.toFixed(3)}`));
	svg.append(h("text", { x: left - 10, y: height - 9, "text-anchor": "end", class: "soft" }, unit));
	for (const bar of bars) {
		const lane = names.indexOf(bar.agent), y = lane * LANE + 18, room = (bar.end - bar.start) * perUnit;
		const failed = bar.outcome === "failed";
		const words = (bar.args || []).join(" "), text = `${bar.action} ${words}`.trim();
		const group = h("g", { opacity: bar.outcome === "cancelled" ? 0.4 : 1 },
			h("title", {}, `${text}, ${+bar.start.toFixed(2)} to ${+bar.end.toFixed(2)} ${unit} ${bar.outcome}`),
			h("rect", { x: x(bar.start) + 1, y, width: Math.max(1, room - 2), height: BAR, rx: 4,
				fill: failed ? "url(#failed)" : colors.get(bar.action), stroke: failed ? "#d55e00" : bar.outcome ? "none" : "#1b2733",
				"stroke-width": 1.5, "stroke-dasharray": bar.outcome ? "none" : "4 3" }));
		const middle = x(bar.start) + room / 2, top = cut(bar.action, room - 6), below = cut(words, room - 6);
		const line = (dy, value) => h("text", { x: middle, y: y + dy, "text-anchor": "middle", class: "on" }, value);
		if (top) group.append(...(below ? [line(17, top), line(32, below)] : [line(25, top)]));
		svg.append(group);
	}
	if (at !== undefined) svg.append(h("line", { x1: x(at), x2: x(at), y1: 0, y2: height - AXIS, stroke: "#d55e00", "stroke-width": 2 }));
	return svg;
}

export const laneRows = (bars) => [["agent", "action", "start", "end", "outcome"],
	...bars.map((bar) => [bar.agent, [bar.action, ...(bar.args || [])].join(" "), bar.start, bar.end, bar.outcome || "running"])];
