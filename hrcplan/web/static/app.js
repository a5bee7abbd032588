// The page: home, and collaborations side by side. What is shown is in the address after "#".
import { h, fill } from "./dom.js";
import { Session } from "./session.js";

const page = document.getElementById("page");
let stream = null;

async function api(method, path, body) {
  try {
    const answer = await fetch(`/api/${path}`, { method, headers: body && { "Content-Type": "application/json" }, body: body && JSON.stringify(body) });
    const text = await answer.text();
    return text.startsWith("{") ? JSON.parse(text) : { error: { code: "refused", message: text } };
  } catch {
    return { error: { code: "offline", message: "The server does not answer; the page goes on when it is back." } };
  }
}

async function home() {
  const { worlds, sessions, error } = await api("GET", "home");
  if (error) return fill(page, h("p", { class: "bad" }, error.message));
  const select = (name, pairs) => h("label", {}, name, h("select", { name }, pairs.map(([value, text]) => h("option", { value }, text))));
  const begin = async (event) => {
    event.preventDefault();
    const form = new FormData(event.target), { domain, goals } = worlds[form.get("world")];
    const answer = await api("POST", "sessions", { domain, goals, pace: form.get("pace"), method: form.get("robot"), human: form.get("human"), seed: Number(form.get("seed")) || 0 });
    if (answer.error) note.textContent = answer.error.message;
    else location.hash = `#/${answer.name}`;
  };
  const note = h("p", { class: "bad", role: "status" });
  const form = h("form", { class: "begin", onsubmit: begin },
    select("world", worlds.map((world, i) => [i, world.single ? `${world.label} (one goal: a plan is followed)` : world.label])),
    select("pace", [["turns", "in turns"], ["free", "at any time"]]),
    select("robot", ["hrcplan", "recursive", "recursive-best", "cdp", "infogain", "rhp"].map((name) => [name, name])),
    select("human", [["me", "I act for the people"], ["frontier", "simulated"], ["cc-htn", "simulated, by modules"]]),
    h("label", {}, "seed", h("input", { name: "seed", type: "number", min: 0, value: 0 })),
    h("div", {}, h("button", { class: "main" }, "begin")), note);
  const rows = sessions.map((one) => h("tr", {},
    h("td", {}, h("input", { type: "checkbox", value: one.name, "aria-label": `show ${one.name}` })),
    h("td", {}, h("a", { href: `#/${one.name}` }, `${one.goals || one.domain} · ${one.pace}`)), h("td", {}, one.human), h("td", {}, one.phase)));
  const table = h("table", {}, rows);
  const open = () => { location.hash = `#/${[...table.querySelectorAll(":checked")].map((box) => box.value).join("+")}`; };
  fill(page, h("div", { class: "top" }, h("h1", {}, "hrcplan")), h("div", { class: "cards" },
    h("section", { class: "card" }, h("h2", {}, "Work together with a robot"), h("p", { class: "soft" }, "It does not know your goal, infers it from what you do, and helps; you may change your mind."), form),
    h("section", { class: "card" }, h("h2", {}, "Collaborations here"), rows.length ? h("div", { class: "scroll" }, table) : h("p", { class: "soft" }, "none yet"), rows.length > 1 ? h("button", { onclick: open }, "show side by side") : null)));
}

function follow(names) {
  const sessions = new Map(names.map((name) => [name, new Session(name, api, { narrow: names.length > 1 })]));
  const state = h("span", { class: "soft", role: "status" });
  fill(page, h("div", { class: "top" }, h("a", { href: "#/" }, "← all"), h("span", { class: "grow" }), state),
    h("div", { class: names.length > 1 ? "many" : "" }, [...sessions.values()].map((session) => session.node)));
  const connect = () => {
    const own = new EventSource(`/api/stream?sessions=${names.join(",")}`);
    stream = own;
    own.addEventListener("news", (event) => {
      state.textContent = "";
      const news = JSON.parse(event.data), session = sessions.get(news.session);
      session.take(news);
      document.title = session.head ? `${session.head.domain} · hrcplan` : "hrcplan";
    });
    own.onerror = () => {
      state.textContent = "no connection; trying again …";
      if (own.readyState === EventSource.CLOSED) setTimeout(() => stream === own && connect(), 700);
    };
  };
  connect();
}

function show() {
  stream?.close();
  stream = null;
  const names = location.hash.replace(/^#\/?/, "").split("+").filter(Boolean);
  if (names.length) follow(names);
  else home();
}

window.addEventListener("hashchange", show);
show();
