// Names over the picture: each beside its place, clear of the others, with a line to the place where it had to go away.
const NAMESPACE = "http://www.w3.org/2000/svg";
const AROUND = [[0, 0], ...[26, 48, 74, 104, 140].flatMap((far) => [-90, -45, -135, 0, 180, 45, 135, 90].map((turn) => {
  const angle = (turn * Math.PI) / 180;
  return [far * 1.5 * Math.cos(angle), far * Math.sin(angle)];
}))]; // pixels from a place, in the order in which they are tried
const LED = 20; // pixels: a name that is farther away has a line

export class Labels {
  constructor(box, leaders) {
    this.box = box;
    this.leaders = leaders;
    this.made = new Map();
    this.wanted = [];
  }

  put(key, text, className, [x, y, before]) {
    if (!this.made.has(key)) {
      const span = this.box.appendChild(Object.assign(document.createElement("span"), { textContent: text, className }));
      const line = this.leaders.appendChild(document.createElementNS(NAMESPACE, "line"));
      this.made.set(key, { span, line, size: [span.offsetWidth + 4, span.offsetHeight + 2], slot: 0 });
    }
    if (before) this.wanted.push({ ...this.made.get(key), own: this.made.get(key), x, y });
  }

  // Place what was put since the last time. A name keeps its side as long as it is free there, so that names do not jump.
  arrange() {
    for (const { span, line } of this.made.values()) {
      span.hidden = true;
      line.style.display = "none";
    }
    const width = this.box.clientWidth, height = this.box.clientHeight, taken = [];
    for (const { span, line, size: [w, h], own, x, y } of this.wanted) {
      const free = (slot) => {
        const [left, top] = [x + AROUND[slot][0] - w / 2, y + AROUND[slot][1] - h / 2];
        const inside = left >= 0 && top >= 0 && left + w <= width && top + h <= height;
        return inside && taken.every(([l, t, r, b]) => left + w <= l || left >= r || top + h <= t || top >= b);
      };
      const slot = free(own.slot) ? own.slot : Math.max(0, AROUND.findIndex((_, index) => free(index)));
      own.slot = slot;
      const [dx, dy] = AROUND[slot];
      taken.push([x + dx - w / 2, y + dy - h / 2, x + dx + w / 2, y + dy + h / 2]);
      span.hidden = false;
      span.style.transform = `translate(${(x + dx).toFixed(1)}px, ${(y + dy).toFixed(1)}px) translate(-50%, -50%)`;
      if (Math.hypot(dx, dy) < LED) continue;
      line.style.display = "";
      for (const [name, value] of [["x1", x], ["y1", y], ["x2", x + dx], ["y2", y + dy]]) line.setAttribute(name, value.toFixed(1));
    }
    this.wanted = [];
  }
}
