// The page of live collaborations: one stream of news for all of them.
import { h, fill } from "./dom.js";
import { Session } from "./session.js";

const page = document.getElementById("page"), { sessions, api, plain } = page.dataset;
const names = sessions.split("+");

async function ask(method, path, body) {
	try {
		const answer = await fetch(api + path, { method, body: body && JSON.stringify(body) });
		const text = await answer.text();
		return text.startsWith("{") ? JSON.parse(text) : { error: { message: text } };
	} catch {
		return { error: { message: "The server does not answer." } };
	}
}

const all = new Map(names.map((name) => [name, new Session(name, ask, { narrow: names.length > 1, plain })]));
const state = h("p", { class: "soft", role: "status" });
fill(page, state, h("div", { class: names.length > 1 ? "cards" : "" }, [...all.values()].map((one) => one.node)));

function connect() {
	const stream = new EventSource(`${api}stream?sessions=${names.join(",")}`);
	stream.addEventListener("news", (event) => {
		state.textContent = "";
		const news = JSON.parse(event.data);
		all.get(news.session).take(news);
		if (news.now.phase === "over") document.getElementById("next")?.removeAttribute("hidden");
	});
	stream.onerror = () => {
		state.textContent = "No connection; trying again …";
		if (stream.readyState === EventSource.CLOSED) setTimeout(connect, 700);
	};
}

connect();
