// The world as a picture: objects where they are, agents, and what they hold.
import { h, keyed, set, textWidth, COLORS } from "./dom.js";

const CHIP = 26, GAP = 6, TITLE = 20;

// Returns where every object is, which badges it has, and the facts of no object.
export function arrange(scene, facts) {
	const place = new Map(), rank = new Map(), badges = new Map(), world = [];
	const put = (name, at, level) => {
		if ((rank.get(name) || 0) < level) { rank.set(name, level); place.set(name, at); }
	};
	for (const fact of facts) {
		const [predicate, ...args] = fact.split(" "), view = scene.views[predicate] || { show: "badge", of: 0 };
		if (view.show === "hide") continue;
		if (!args.length) { world.push(predicate); continue; }
		const name = args[view.of];
		if (view.show === "hold") put(name, args[view.at], 3);
		else if (view.show === "place") put(name, args[view.at], 2);
		else if (view.show === "zone") put(name, `:${predicate}`, 1);
		else {
			const rest = args.filter((_, i) => i !== view.of);
			badges.set(name, [...(badges.get(name) || []), [predicate, ...rest.filter((arg) => arg !== place.get(name))].join(" ")]);
		}
	}
	return { place, badges, world };
}

export class Scene {
	constructor(scene) {
		this.scene = scene;
		this.agents = new Map(scene.agents.map((agent) => [agent.name, agent]));
		this.boxes = h("g");
		this.chips = h("g");
		this.svg = h("svg", { role: "img", "aria-label": "the world" }, this.boxes, this.chips);
	}

	label(name) {
		const icon = this.scene.objects[name]?.icon;
		return icon ? `${icon} ${name}` : name;
	}

	// Draws the state in which these facts hold, in a given width.
	draw(facts, fresh, width) {
		const { place, badges, world } = arrange(this.scene, facts);
		const shown = new Set([...place.keys(), ...badges.keys(), ...this.agents.keys()]);
		const inside = new Map(); // by container: what is drawn in it
		const holds = (name, at, n = 9) => at === name || (n && place.has(at) && holds(name, place.get(at), n - 1));
		for (const name of shown) {
			const at = place.get(name);
			const box = at === undefined ? (this.agents.has(name) ? ":agents" : ":things") : holds(name, at) ? ":things" : at;
			inside.set(box, [...(inside.get(box) || []), name]);
		}
		const map = this.scene.map;
		if (map) for (const name of Object.keys(map.places)) if (!inside.has(name)) inside.set(name, []);
		const holders = [...inside.keys()].filter((box) => box.startsWith(":") || !shown.has(box) || map?.places[box]);
		const frames = holders.map((box) => this.frame(box, inside, badges, map ? 230 : 320));
		const height = map ? this.onMap(frames, width) : this.inRows(frames, width);
		const news = new Set([...fresh].flatMap((fact) => fact.split(" ")));
		const spots = frames.flatMap((frame) => frame.spots.map((spot) => ({ ...spot, x: spot.x + frame.x, y: spot.y + frame.y, fresh: news.has(spot.name) })));
		this.ways(map, frames);
		this.drawBoxes(frames);
		this.drawChips(spots);
		const bottom = world.length ? height + 18 : height;
		set(this.svg, { width, height: bottom, viewBox: `0 0 ${width} ${bottom}` });
		this.note ||= this.svg.appendChild(h("text", { x: 4, class: "soft" }));
		this.note.setAttribute("y", height + 12);
		this.note.textContent = world.join(", ");
	}

	// A frame around a place, with spots for what is in it; things in things stand behind them.
	frame(box, inside, badges, most) {
		const spots = [];
		let x = GAP, y = TITLE + GAP, wide = textWidth(box.replace(":", "")) + 3 * GAP;
		const visit = (name, depth) => {
			const text = this.label(name), marks = (badges.get(name) || []).join(", ");
			const w = Math.max(textWidth(text), textWidth(marks) * 0.85) + 14;
			if (x > GAP && x + w > most && !depth) { x = GAP; y += CHIP + (this.tall ? 12 : 0) + GAP; this.tall = false; }
			spots.push({ name, text, marks, x, y, w, depth });
			if (marks) this.tall = true;
			x += w + (depth ? 3 : GAP);
			wide = Math.max(wide, x);
			for (const other of (inside.get(name) || []).sort()) if (depth < 4) visit(other, depth + 1);
		};
		this.tall = false;
		for (const name of (inside.get(box) || []).sort((a, b) => this.agents.has(b) - this.agents.has(a) || a.localeCompare(b))) visit(name, 0);
		const tall = y + (spots.length ? CHIP + (this.tall ? 12 : 0) + GAP : 0);
		return { box, spots, w: wide + GAP, h: tall, x: 0, y: 0 };
	}

	inRows(frames, width) {
		frames.sort((a, b) => a.box.startsWith(":") - b.box.startsWith(":") || a.box.localeCompare(b.box));
		let x = 0, y = 0, tall = 0;
		for (const frame of frames) {
			if (x && x + frame.w > width) { x = 0; y += tall + GAP; tall = 0; }
			Object.assign(frame, { x, y });
			x += frame.w + GAP;
			tall = Math.max(tall, frame.h);
		}
		return y + tall + 2;
	}

	onMap(frames, width) {
		const places = this.scene.map.places, rest = frames.filter((frame) => !places[frame.box]);
		const own = frames.filter((frame) => places[frame.box]);
		const wide = Math.max(...own.map((frame) => frame.w)), tall = Math.max(...own.map((frame) => frame.h));
		const columns = Math.max(1, Math.floor(width / (wide + GAP)));
		if (columns < 2) return this.inRows(frames, width);
		const height = Math.max(260, Math.ceil(own.length / columns + 1) * (tall + 16));
		for (const frame of own) {
			const [px, py] = places[frame.box];
			frame.x = px * (width - frame.w - 4) + 2;
			frame.y = py * (height - frame.h - 4) + 2;
		}
		this.part(own, width);
		const low = Math.max(...own.map((frame) => frame.y + frame.h));
		const more = this.inRows(rest, width);
		for (const frame of rest) frame.y += low + GAP;
		return low + (rest.length ? more + GAP : 4);
	}

	// Moves frames apart that would cover one another.
	part(frames, width) {
		for (let round = 0; round < 60; round++) {
			let moved = false;
			for (const a of frames) for (const b of frames) {
				if (a === b || a.y > b.y || (a.y === b.y && a.box > b.box)) continue;
				const over = Math.min(a.x + a.w, b.x + b.w) - Math.max(a.x, b.x) + GAP, under = a.y + a.h + GAP - b.y;
				if (over > 0 && under > 0) { b.y += Math.min(under, 12); moved = true; }
			}
			if (!moved) return;
		}
	}

	ways(map, frames) {
		const middle = new Map(frames.map((frame) => [frame.box, [frame.x + frame.w / 2, frame.y + frame.h / 2]]));
		this.boxes.replaceChildren(...(map ? map.ways : []).filter(([a, b]) => middle.has(a) && middle.has(b)).map(([a, b]) =>
			h("line", { class: "way", x1: middle.get(a)[0], y1: middle.get(a)[1], x2: middle.get(b)[0], y2: middle.get(b)[1] })));
	}

	drawBoxes(frames) {
		for (const frame of frames) this.boxes.append(
			h("rect", { class: "box", x: frame.x + 1, y: frame.y + 1, width: frame.w - 2, height: frame.h - 2, rx: 8 }),
			h("text", { x: frame.x + GAP + 2, y: frame.y + 15, class: "soft" }, frame.box.replace(":", "")));
	}

	drawChips(spots) {
		const kind = (name) => (this.agents.has(name) ? (this.agents.get(name).robot ? "robot" : "human") : "");
		keyed(this.chips, spots, (spot) => spot.name,
			(spot) => h("g", {}, h("rect", { height: CHIP, rx: 7 }), h("text", { x: 7, y: 17 }), h("text", { x: 7, y: CHIP + 10, class: "soft", "font-size": 10 }), h("title")),
			(node, spot) => {
				const [rect, text, marks, title] = node.children, { color, type } = this.scene.objects[spot.name] || {};
				node.setAttribute("class", `chip ${kind(spot.name)} ${spot.fresh ? "new" : ""}`);
				node.style.transform = `translate(${spot.x.toFixed(1)}px, ${spot.y.toFixed(1)}px)`;
				rect.setAttribute("width", spot.w);
				if (color) rect.style.stroke = COLORS[color];
				text.textContent = spot.text;
				marks.textContent = spot.marks;
				title.textContent = `${spot.name} · ${type} ${spot.marks}`;
			});
	}
}

export const sceneRows = (scene, facts) => {
	const { place, badges } = arrange(scene, facts);
	return [["object", "where", "what"], ...Object.keys(scene.objects).map((name) => [name, (place.get(name) || "").replace(":", ""), (badges.get(name) || []).join("; ")])];
};
