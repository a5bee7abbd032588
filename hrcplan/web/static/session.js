// One collaboration: what a person can do now, and what has come of it.
import { h, fill, keyed } from "./dom.js";
import { beginning, step } from "./story.js";
import { RunView } from "./view.js";

export class Session {
	constructor(name, api, options = {}) {
		this.name = name;
		this.api = api;
		this.options = options;
		this.entries = [];
		this.now = { phase: "starting" };
		this.node = h("article", {}, "Getting ready …");
	}

	take({ head, entries, now }) {
		if (head && !this.head) {
			this.head = head;
			this.view = beginning(head);
			this.build();
		}
		for (const entry of entries) if (entry.n > this.view.n) step(this.view, entry);
		this.now = now;
		if (this.head) this.draw();
		else if (now.phase === "error") fill(this.node, h("p", { class: "bad", role: "alert" }, now.message, now.hint ? ` (${now.hint})` : ""));
	}

	build() {
		const { head } = this;
		this.run = new RunView(head, `${head.domain}-${this.name}`);
		this.say = h("input", { type: "text", maxlength: 2000, "aria-label": "say what you do", placeholder: "what you do, or a number; Enter: wait" });
		this.task = h("h2");
		this.ask = h("div", { class: "ask", role: "group", hidden: true });
		this.note = h("p", { class: "bad", role: "status" });
		this.groups = h("div", { class: "groups" });
		this.groupBy = h("select", { "aria-label": "group steps by", onchange: () => this.draw() }, ["object", "place", "action"].map((key) => h("option", { value: key }, `by ${key}`)));
		const button = (text, onclick, title) => h("button", { onclick, title }, text);
		this.undo = button("undo", () => this.send({ kind: "undone" }), "it was not done");
		this.failed = button("failed", () => this.send({ kind: "failed" }), "it failed");
		this.pause = button("pause", () => this.send({ kind: this.now.paused ? "continued" : "paused" }));
		this.why = h("div");
		this.act = h("section", { class: "card" }, h("h2", {}, "Your turn"), this.task, this.ask,
			h("form", { class: "row", onsubmit: (event) => { event.preventDefault(); this.line(this.say.value.trim()); } }, this.say, h("button", { class: "main", type: "submit" }, "say")),
			this.note,
			h("div", { class: "row" }, button("wait", () => this.send({ kind: "passed" }), "do nothing"), this.undo, this.options.plain ? null : this.failed,
				this.options.plain ? null : button("why?", () => this.tellWhy(), "reasons"), this.pause,
				button("end", () => this.send({ kind: "stop" }), "give up"), this.groupBy),
			this.why, this.groups);
		this.over = h("section", { class: "card", hidden: true, role: "status" });
		const { run } = this;
		fill(this.node, h("div", { class: this.options.narrow ? "panel" : "panel wide" },
			h("div", { class: "side" }, this.over, this.act, run.logCard, this.sliders()),
			h("div", { class: "side" }, run.sceneCard, run.lanesCard, this.options.plain ? null : run.beliefCard)));
		if (!this.options.narrow) this.say.focus({ preventScroll: true });
	}

	sliders() {
		const keys = Object.entries(this.head.states);
		if (!keys.length || this.options.plain) return null;
		this.inputs = new Map();
		const rows = (some) => h("div", { class: "states" }, some.flatMap(([key, state]) => {
			const value = h("span", { class: "soft" });
			const input = h("input", { type: "range", min: state.range[0], max: state.range[1], step: "any", "aria-label": key, value: state.value,
				onchange: () => this.send({ kind: "state", key: key.split(" "), value: Math.round(10 * input.value) / 10 }) });
			this.inputs.set(key, [input, value]);
			return [h("span", {}, key), input, value];
		}));
		const long = keys.filter(([key]) => key.split(" ").length > 2);
		const fold = (title, ...rest) => h("details", {}, h("summary", {}, title), ...rest);
		return h("section", { class: "card" }, fold("How the agents are", rows(keys.filter((one) => !long.includes(one))), long.length && fold(`${long.length} more`, rows(long))));
	}

	words(action) {
		const { people, robots } = this.head, only = new Set([people, robots].filter((some) => some.length === 1).flat());
		return action.filter((word, i) => i === 0 || !only.has(word)).join(" ");
	}

	draw() {
		const { now } = this, isOver = now.phase === "over" || now.phase === "error" || now.phase === "stopped";
		this.run.draw(this.view);
		this.node.dataset.n = now.n;
		this.act.hidden = isOver;
		this.over.hidden = !isOver;
		if (isOver) fill(this.over, h("h2", {}, now.phase === "over" ? now.outcome.ending : now.phase), h("p", {}, this.summary(now)));
		if (now.phase !== "waiting") return;
		this.pause.textContent = now.paused ? "go" : "pause";
		this.undo.disabled = this.failed.disabled = !now.can_undo;
		this.act.firstChild.textContent = now.agents.length === 1 && this.head.people.length > 1 ? `Turn of ${now.agents[0]}` : "Your turn";
		this.drawQuestion(now.question);
		this.task.textContent = now.task;
		this.drawSteps(now.steps);
		for (const [key, [input, value]] of this.inputs || []) {
			if (document.activeElement !== input) input.value = this.view.values[key];
			value.textContent = this.view.values[key];
		}
	}

	summary(now) {
		if (now.phase === "error") return now.message;
		if (now.phase !== "over") return "The server has gone.";
		const { reached, why, done_human, done_robot, failed, duration_s } = now.outcome;
		return `${reached.join(", ") || why}: ${done_human} human and ${done_robot} robot actions, ${failed} failed, ${duration_s} ${this.head.unit}`;
	}

	drawQuestion(question) {
		this.ask.hidden = !question;
		if (!question) return this.ask.replaceChildren();
		const answer = (choice) => h("button", { class: "main", onclick: () => this.send({ kind: "answered", choice }) },
			choice.startsWith("(") ? this.words(choice.slice(1, -1).split(" ")) : choice);
		fill(this.ask, h("p", {}, question.text), h("div", { class: "row" }, (question.kind === "done" ? ["yes", "no"] : question.options).map(answer)));
	}

	drawSteps(steps) {
		const groups = new Map(), by = this.groupBy.value;
		this.steps = steps;
		steps.forEach((one, i) => {
			const rest = this.words(one.action).split(" ");
			const name = (by === "action" ? rest[0] : by === "place" ? rest.at(-1) : rest[1]) || rest[0];
			groups.set(name, [...(groups.get(name) || []), { ...one, number: i + 1, text: rest.join(" ") }]);
		});
		keyed(this.groups, [...groups], ([name]) => name,
			([name]) => h("div", { class: "group" }, h("b", {}, name), h("div", { class: "row" })),
			(node, [, items]) => keyed(node.lastChild, items, (item) => item.action.join(" "),
				(item) => h("button", { onclick: () => this.send({ kind: "begun", action: item.action }) }, item.text),
				(button, item) => {
					button.className = item.asked ? "asked" : "";
					button.title = item.asked ? "the plan asks you to do this" : item.number;
				}));
	}

	// A line of the text box: words, a number, or a command.
	line(text) {
		this.say.value = "";
		const kinds = { "": "passed", undo: "undone", failed: "failed", pause: "paused", go: "continued", quit: "stop" };
		const word = text.toLowerCase(), { question } = this.now;
		if (word === "why" || word === "why?") return this.tellWhy();
		if (question?.kind === "done" && ["yes", "no", "y", "n"].includes(word)) return this.send({ kind: "answered", choice: word[0] === "y" ? "yes" : "no" });
		const options = question?.kind !== "done" && question?.options, place = /^\d+$/.test(word) ? word - 1 : -1;
		if (options?.[place]) return this.send({ kind: "answered", choice: options[place] });
		if (this.steps?.[place]) return this.send({ kind: "begun", action: this.steps[place].action });
		return this.send(word in kinds ? { kind: kinds[word] } : { kind: "said", text });
	}

	async send(event) {
		this.note.textContent = "";
		this.why.replaceChildren();
		const answer = await this.api("POST", `sessions/${this.name}/events`, { ...event, after: this.now.n });
		if (answer.error) this.note.textContent = answer.error.code === "stale" ? "Look: something has happened." : answer.error.message;
		if (!this.node.contains(document.activeElement) && !this.options.narrow) this.say.focus({ preventScroll: true });
	}

	async tellWhy() {
		const why = await this.api("GET", `sessions/${this.name}/why`);
		if (!why.candidates) return fill(this.why, h("p", {}, why.text || why.error.message));
		return fill(this.why, h("table", {}, h("tr", {}, h("th", {}, "the robot could"), h("th", { class: "n" }, "value"), h("th", { class: "n" }, "saves"), h("th", {}, "for")),
			why.candidates.map((c) => h("tr", {}, h("td", {}, c.action), h("td", { class: "n" }, c.value), h("td", { class: "n" }, c.saves), h("td", {}, c.helps.join(", "))))));
	}
}
