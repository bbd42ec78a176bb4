// `articad watch` serves the page and says when it has changed, failed, or ended. What is seen survives a new page.

const ASK = 500; // ms
const KEY = "articad";

export function watch(version, { kept, restore, busy }) {
  const banner = document.getElementById("banner");
  const stored = sessionStorage.getItem(KEY);
  if (stored) {
    sessionStorage.removeItem(KEY);
    restore(JSON.parse(stored));
  }
  let missed = 0;
  const tell = (kind, lines) => {
    const key = JSON.stringify([kind, lines]);
    if (banner.dataset.said === key) return;
    banner.dataset.said = key;
    banner.hidden = !lines.length;
    banner.className = kind;
    banner.replaceChildren(...lines.map((line, index) => Object.assign(document.createElement(index ? "p" : "strong"), { textContent: line })));
  };
  const ask = async () => {
    const answer = await fetch("version", { cache: "no-store" }).catch(() => null);
    if (!answer?.ok) {
      if (++missed === 3) tell("failed", ["The server of articad watch has ended.", "This page shows its last build. Start articad watch again and open the address that it prints."]);
    } else {
      missed = 0;
      const state = await answer.json();
      if (state.error.length) tell("failed", state.error);
      else if (state.message) tell("busy", [state.message]);
      else tell("", []);
      // What is being dragged is not taken out of anybody's hand.
      if (state.version !== version && !busy()) {
        sessionStorage.setItem(KEY, JSON.stringify(kept()));
        location.reload();
        return;
      }
    }
    setTimeout(ask, ASK);
  };
  ask();
}
