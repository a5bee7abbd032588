// A run that is over, in one file: a slider over time, and play.
import { h, fill } from "./dom.js";
import { viewAt } from "./story.js";
import { RunView } from "./view.js";

const { head, entries, title } = JSON.parse(document.getElementById("run").textContent);
const run = new RunView(head, head.domain);
const last = entries.length ? Math.max(...viewAt(head, entries, Infinity).bars.values().map((bar) => bar.end)) : 0;
const when = h("output", { class: "soft" });
const slider = h("input", { type: "range", min: 0, max: entries.length, value: entries.length, "aria-label": "time", oninput: draw });
const play = h("button", { onclick: toggle }, "play");
let timer = null;

function draw() {
	const n = Number(slider.value), view = viewAt(head, entries.slice(0, n), Infinity);
	when.textContent = `${n} of ${entries.length}, at ${view.t} ${head.unit}`;
	run.draw(view, { at: view.t, end: last });
}

function toggle() {
	if (timer) timer = clearInterval(timer);
	else {
		if (Number(slider.value) === entries.length) slider.value = 0;
		timer = setInterval(() => {
			slider.value = Number(slider.value) + 1;
			draw();
			if (Number(slider.value) >= entries.length) toggle();
		}, 700);
	}
	play.textContent = timer ? "stop" : "play";
}

fill(document.getElementById("page"), h("h1", {}, title),
	h("section", { class: "card" }, h("div", { class: "row" }, play, slider, when)),
	h("div", { class: "panel wide" }, h("div", { class: "side" }, run.sceneCard, run.logCard), h("div", { class: "side" }, run.lanesCard, run.beliefCard)));
draw();
