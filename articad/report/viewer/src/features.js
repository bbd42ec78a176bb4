// What of a part is under the pointer: a corner, a straight edge, a flat face, or a round one with its axis; and what lies between two of these.
import { Vector3 } from "three";

const FLAT = 1e-3; // largest 1 − cos between the normals of a flat face
const ROUND = 2e-2; // largest sine between the normals of a round face and the plane across its axis
const PARALLEL = 1e-3; // rad

function pointAt(points, index) {
  return new Vector3(points[3 * index], points[3 * index + 1], points[3 * index + 2]);
}

// The feature of a mesh at a point of one of its triangles; `pixels` tells how far a point is seen from the pointer.
export function featureAt({ geometry, edges, points, starts }, triangle, point, pixels, { corner, edge }) {
  const segments = edges.index.array;
  let nearest = null, best = edge, ends = null, nearestEnd = corner;
  for (let k = 0; k < segments.length; k += 2) {
    const a = pointAt(points, segments[k]), b = pointAt(points, segments[k + 1]);
    const [ax, ay] = pixels(a), [bx, by] = pixels(b);
    const dx = bx - ax, dy = by - ay, square = dx * dx + dy * dy;
    const share = square ? Math.min(Math.max(-(ax * dx + ay * dy) / square, 0), 1) : 0;
    const distance = Math.hypot(ax + share * dx, ay + share * dy);
    const on = a.clone().lerp(b, share);
    if (distance > corner + edge || on.distanceTo(point) > 40 * perPixel(point, pixels)) continue; // seen there, but far before or behind
    if (distance < best) [best, nearest] = [distance, [a, b, on]];
    for (const [end, far] of [[a, Math.hypot(ax, ay)], [b, Math.hypot(bx, by)]]) if (far < nearestEnd) [nearestEnd, ends] = [far, end];
  }
  if (ends) return { kind: "corner", local: ends };
  if (nearest) {
    const [a, b] = straight(points, segments, nearest);
    return { kind: "edge", local: a.clone().lerp(b, 0.5), direction: b.clone().sub(a).normalize(), length: a.distanceTo(b) };
  }
  return faceAt(geometry, starts, triangle, point);
}

// mm that a pixel covers at a point.
function perPixel(point, pixels) {
  const [x0, y0] = pixels(point);
  const away = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => {
    const [x, y] = pixels(point.clone().add(new Vector3(...axis)));
    return Math.hypot(x - x0, y - y0);
  });
  return 1 / Math.max(...away, 1e-9);
}

// The ends of the straight line that an edge is a piece of.
function straight(points, segments, [a, b]) {
  const way = b.clone().sub(a).normalize();
  let low = 0, high = a.distanceTo(b), grew = true;
  const inLine = [];
  for (let k = 0; k < segments.length; k += 2) {
    const ends = [pointAt(points, segments[k]).sub(a), pointAt(points, segments[k + 1]).sub(a)];
    if (ends.every((end) => end.clone().addScaledVector(way, -end.dot(way)).length() < 1e-3 * high)) inLine.push(ends.map((end) => end.dot(way)).sort((p, q) => p - q));
  }
  while (grew) {
    grew = false;
    for (const [from, to] of inLine) {
      if (from <= high + 1e-3 && to > high + 1e-6) [high, grew] = [to, true];
      if (to >= low - 1e-3 && from < low - 1e-6) [low, grew] = [from, true];
    }
  }
  return [a.clone().addScaledVector(way, low), a.clone().addScaledVector(way, high)];
}

function faceAt(geometry, starts, triangle, point) {
  const face = starts.findIndex((start, k) => triangle >= start && triangle < starts[k + 1]);
  const index = geometry.index.array, positions = geometry.attributes.position.array;
  const normals = [], corners = [];
  for (let t = starts[face]; t < starts[face + 1]; t++) {
    const [a, b, c] = [0, 1, 2].map((k) => pointAt(positions, index[3 * t + k]));
    const normal = b.clone().sub(a).cross(c.clone().sub(a));
    if (normal.length() > 1e-9) normals.push(normal.normalize());
    corners.push(a, b, c);
  }
  const own = normals[triangle - starts[face]] ?? normals[0] ?? new Vector3(0, 0, 1);
  if (normals.every((normal) => 1 - normal.dot(own) < FLAT)) return { kind: "face", local: point, direction: own.clone() };
  const other = normals.reduce((far, normal) => (Math.abs(normal.dot(own)) < Math.abs(far.dot(own)) ? normal : far), own);
  const axis = own.clone().cross(other).normalize();
  const circle = normals.every((normal) => Math.abs(normal.dot(axis)) < ROUND) && circleOf(corners, axis);
  if (circle) return { kind: "round face", local: circle.center.addScaledVector(axis, point.clone().sub(circle.center).dot(axis)), direction: axis, radius: circle.radius };
  return { kind: "point", local: point };
}

// The circle through points seen along an axis, by least squares: |p|² = 2 c·p + (r² − |c|²) (I. Kåsa, 1976); null unless all lie on it.
function circleOf(corners, axis) {
  const u = (Math.abs(axis.x) < 0.9 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0)).cross(axis).normalize(), v = axis.clone().cross(u);
  const M = [[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]];
  const origin = corners[0];
  const seen = corners.map((corner) => [corner.clone().sub(origin).dot(u), corner.clone().sub(origin).dot(v)]);
  for (const [x, y] of seen) {
    const row = [x, y, 1], square = x * x + y * y;
    for (let i = 0; i < 3; i++) {
      for (let j = 0; j < 3; j++) M[i][j] += row[i] * row[j];
      M[i][3] += row[i] * square;
    }
  }
  for (let i = 0; i < 3; i++) {
    const pivot = [0, 1, 2].slice(i).reduce((best, row) => (Math.abs(M[row][i]) > Math.abs(M[best][i]) ? row : best), i);
    [M[i], M[pivot]] = [M[pivot], M[i]];
    if (Math.abs(M[i][i]) < 1e-12) return null;
    for (let row = 0; row < 3; row++) {
      if (row === i) continue;
      const factor = M[row][i] / M[i][i];
      for (let k = i; k < 4; k++) M[row][k] -= factor * M[i][k];
    }
  }
  const [x, y, rest] = [0, 1, 2].map((i) => M[i][3] / M[i][i]);
  const radius = Math.sqrt(Math.max(0, rest + (x * x + y * y) / 4));
  if (seen.some(([px, py]) => Math.abs(Math.hypot(px - x / 2, py - y / 2) - radius) > 0.01 * radius)) return null;
  return { center: origin.clone().addScaledVector(u, x / 2).addScaledVector(v, y / 2), radius };
}

export const described = ({ kind, length, radius }) =>
  kind === "edge" ? `edge, ${length.toFixed(3)} mm long` : kind === "round face" ? `round face ⌀ ${(2 * radius).toFixed(3)} mm` : kind;

// Distance, angle and the shortest line between two features with `at` and `way` in space; `flat` says that the way is a normal.
export function between(a, b) {
  const apart = b.at.clone().sub(a.at);
  const flat = (one) => one.kind === "face";
  if (!a.way && !b.way) return { distance: apart.length(), from: a.at, to: b.at, delta: apart };
  if (!a.way || !b.way) {
    const [point, other] = a.way ? [b, a] : [a, b];
    const along = point.at.clone().sub(other.at).dot(other.way);
    const foot = flat(other) ? point.at.clone().addScaledVector(other.way, -along) : other.at.clone().addScaledVector(other.way, along);
    return { distance: point.at.distanceTo(foot), from: point.at, to: foot };
  }
  const cosine = Math.min(1, Math.abs(a.way.dot(b.way)));
  const between_ways = Math.acos(cosine);
  const angle = flat(a) === flat(b) ? between_ways : Math.PI / 2 - between_ways; // a line and a plane: from the plane, not from its normal
  const parallel = angle < PARALLEL;
  if (flat(a) || flat(b)) {
    if (!parallel) return { angle };
    const [plane, other] = flat(a) ? [a, b] : [b, a];
    const along = other.at.clone().sub(plane.at).dot(plane.way);
    return { angle: 0, distance: Math.abs(along), from: other.at, to: other.at.clone().addScaledVector(plane.way, -along) };
  }
  if (parallel) {
    const foot = a.at.clone().addScaledVector(a.way, apart.dot(a.way));
    return { angle: 0, distance: foot.distanceTo(b.at), from: foot, to: b.at };
  }
  // Skew lines: the feet of their common normal.
  const across = a.way.clone().cross(b.way), square = across.lengthSq();
  const s = apart.clone().cross(b.way).dot(across) / square, t = apart.clone().cross(a.way).dot(across) / square;
  const from = a.at.clone().addScaledVector(a.way, s), to = b.at.clone().addScaledVector(b.way, t);
  return { angle, distance: from.distanceTo(to), from, to };
}
