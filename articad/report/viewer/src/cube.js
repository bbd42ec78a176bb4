// A cube that shows from where the model is seen; a click on a face looks at that side. The axes start at its lowest corner.
const NAMESPACE = "http://www.w3.org/2000/svg";
const HALF = 19, MIDDLE = 50, AXIS = 45; // units of its picture, which is 100 wide
// Normal, and the directions of a face's text and of its upper edge.
const FACES = [
  ["front", [0, -1, 0], [1, 0, 0], [0, 0, 1]], ["back", [0, 1, 0], [-1, 0, 0], [0, 0, 1]],
  ["right", [1, 0, 0], [0, 1, 0], [0, 0, 1]], ["left", [-1, 0, 0], [0, -1, 0], [0, 0, 1]],
  ["top", [0, 0, 1], [1, 0, 0], [0, 1, 0]], ["bottom", [0, 0, -1], [1, 0, 0], [0, -1, 0]],
];

export class Cube {
  constructor(svg, look) {
    this.svg = svg;
    this.faces = FACES.map(([name, normal, right, up]) => {
      const group = document.createElementNS(NAMESPACE, "g"), side = document.createElementNS(NAMESPACE, "polygon");
      const text = document.createElementNS(NAMESPACE, "text");
      text.textContent = name;
      group.append(side, text);
      group.addEventListener("click", () => look(name));
      svg.append(group);
      return { group, side, text, normal, right, up };
    });
  }

  // Turn as the camera does; `e` are the elements of the matrix from the world to the camera, column by column.
  turn(e) {
    const key = e.slice(0, 11).join();
    if (key === this.key) return; // the page is laid out again for nothing else
    this.key = key;
    const seen = ([x, y, z]) => [0, 1, 2].map((k) => e[k] * x + e[4 + k] * y + e[8 + k] * z);
    const number = (value) => value.toFixed(2);
    for (const { group, side, text, normal, right, up } of this.faces) {
      const n = seen(normal), r = seen(right), u = seen(up);
      const visible = n[2] > 0.08;
      group.style.display = visible ? "" : "none";
      if (!visible) continue;
      const corner = (a, b) => [MIDDLE + HALF * (n[0] + a * r[0] + b * u[0]), MIDDLE - HALF * (n[1] + a * r[1] + b * u[1])].map(number).join(",");
      side.setAttribute("points", [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)].join(" "));
      text.setAttribute("transform", `matrix(${[r[0], -r[1], -u[0], u[1], MIDDLE + HALF * n[0], MIDDLE - HALF * n[1]].map(number).join(" ")})`);
    }
    const start = seen([-1, -1, -1]).map((value) => HALF * value);
    ["x", "y", "z"].forEach((axis, k) => {
      const way = seen([0, 1, 2].map((index) => Number(index === k)));
      const line = this.svg.querySelector(`#triad-${axis}`), text = this.svg.querySelector(`#triad-${axis}-name`);
      const at = (share) => [MIDDLE + start[0] + share * way[0], MIDDLE - start[1] - share * way[1]].map(number);
      [["x1", "y1", at(0)], ["x2", "y2", at(AXIS)]].forEach(([x, y, place]) => {
        line.setAttribute(x, place[0]);
        line.setAttribute(y, place[1]);
      });
      const [x, y] = at(AXIS + 7);
      text.setAttribute("x", x);
      text.setAttribute("y", Number(y) + 3.5);
    });
  }
}
