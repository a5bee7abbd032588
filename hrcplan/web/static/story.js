// What has happened up to some entry: a fold, so that live pages and replays show the same.
export function beginning(head) {
	const values = Object.fromEntries(Object.entries(head.states).map(([key, state]) => [key, state.value]));
	return { n: 0, t: 0, bars: new Map(), notes: [], beliefs: [], changes: [], facts: new Set(head.scene.facts), fresh: new Set(), values };
}

export function step(view, entry) {
	view.n = entry.n;
	view.t = Math.max(view.t, entry.t);
	for (const bar of entry.bars || []) view.bars.set(bar.number, bar);
	if (entry.undone !== undefined) view.bars.delete(entry.undone);
	for (const note of entry.notes || []) {
		view.notes.push({ ...note, n: entry.n, t: entry.t });
		if (note.kind === "change") view.changes.push(view.beliefs.length);
	}
	if (entry.belief) view.beliefs.push({ n: entry.n, t: entry.t, goals: new Map(entry.belief) });
	if (entry.plus || entry.minus) {
		for (const fact of entry.minus || []) view.facts.delete(fact);
		for (const fact of entry.plus || []) view.facts.add(fact);
		view.fresh = new Set(entry.plus || []);
	}
	Object.assign(view.values, entry.values || {});
	return view;
}

export const viewAt = (head, entries, n) =>
	entries.filter((entry) => entry.n <= n).reduce(step, beginning(head));
