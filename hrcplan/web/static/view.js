// The pictures and words of one run, live or replayed.
import { h, fill, keyed, saveButtons } from "./dom.js";
import { lanes, laneRows } from "./lanes.js";
import { beliefChart, goalList, beliefRows, likeliest } from "./belief.js";
import { Scene, sceneRows } from "./scene.js";

const card = (title, ...rest) => h("section", { class: "card" }, h("h2", {}, title), ...rest);

export class RunView {
	constructor(head, name) {
		this.head = head;
		this.scene = new Scene(head.scene);
		this.lanesBox = h("div", { class: "scroll", tabindex: 0 });
		this.beliefBox = h("div");
		this.goals = h("div", { class: "goals", "aria-live": "polite" });
		this.sceneBox = h("div", { class: "scroll" }, this.scene.svg);
		this.log = h("ul", { class: "log", "aria-live": "polite" });
		this.states = h("div", { class: "soft" });
		const save = (what, svg, rows) => saveButtons(`${name}-${what}`, svg, rows);
		this.sceneCard = card("World", this.sceneBox, save("world", () => this.scene.svg, () => sceneRows(head.scene, this.view.facts)));
		this.lanesCard = card("Who does what", this.lanesBox, save("lanes", () => this.lanesBox.firstChild, () => laneRows([...this.view.bars.values()])));
		this.beliefCard = card("What the robot believes", this.goals, this.beliefBox, save("belief", () => this.beliefBox.firstChild, () => beliefRows(this.view.beliefs)));
		this.logCard = card("What happened", this.log, this.states);
		this.beliefCard.hidden = true;
		new ResizeObserver(() => this.view && this.draw(this.view)).observe(this.sceneBox);
	}

	draw(view, options = {}) {
		this.view = view;
		const atEnd = this.lanesBox.scrollLeft + this.lanesBox.clientWidth >= this.lanesBox.scrollWidth - 8;
		fill(this.lanesBox, lanes({
			agents: this.head.scene.agents.map((agent) => agent.name), bars: [...view.bars.values()],
			unit: this.head.unit, width: Math.max(280, this.lanesBox.clientWidth), at: options.at, end: options.end,
		}));
		const box = this.lanesBox, { scrollWidth, clientWidth } = box, names = box.querySelectorAll(".name");
		box.onscroll = () => names.forEach((name) => name.setAttribute("x", box.scrollLeft + 2));
		if (options.at !== undefined) this.lanesBox.scrollLeft = (scrollWidth * options.at) / (options.end || 1) - clientWidth / 2;
		else if (atEnd) box.scrollLeft = scrollWidth;
		box.onscroll();
		this.scene.draw(view.facts, view.fresh, Math.max(260, this.sceneBox.clientWidth));
		this.beliefCard.hidden = !view.beliefs.length;
		if (view.beliefs.length) {
			const names = likeliest(view.beliefs);
			fill(this.goals, goalList(view.beliefs.at(-1), names));
			fill(this.beliefBox, beliefChart({ beliefs: view.beliefs, changes: view.changes, names, width: Math.max(260, this.beliefBox.clientWidth || this.sceneBox.clientWidth) }));
		}
		const isLow = this.log.scrollTop + this.log.clientHeight >= this.log.scrollHeight - 8;
		keyed(this.log, view.notes.map((note, i) => ({ ...note, i })), (note) => note.i, (note) => h("li", { class: note.kind }, note.text), (node, note) => {
			node.className = note.kind;
			node.textContent = note.text;
		});
		if (isLow) this.log.scrollTop = 1e6;
		const told = Object.entries(view.values).filter(([key, value]) => value !== this.head.states[key]?.value);
		this.states.textContent = told.map(([key, value]) => `${key} ${value}`).join(", ");
	}
}
