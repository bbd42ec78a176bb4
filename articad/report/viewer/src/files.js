// Files made in the page from what it holds: nothing is fetched.
import { apply, fromPose, multiply } from "./kinematics.js";

export function save(name, content, type = "application/octet-stream") {
  const url = URL.createObjectURL(new Blob([content], { type }));
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

// Binary STL of shapes {points, triangles, T}, millimetres.
export function stl(shapes) {
  const count = shapes.reduce((sum, shape) => sum + shape.triangles.length / 3, 0);
  const data = new DataView(new ArrayBuffer(84 + 50 * count));
  data.setUint32(80, count, true);
  let at = 84;
  for (const { points, triangles, T } of shapes) {
    for (let i = 0; i < triangles.length; i += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => apply(T, points.subarray(3 * triangles[i + k], 3 * triangles[i + k] + 3)));
      const u = b.map((value, k) => value - a[k]), v = c.map((value, k) => value - a[k]);
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      const length = Math.hypot(...n) || 1;
      for (const value of [...n.map((value) => value / length), ...a, ...b, ...c]) {
        data.setFloat32(at, value, true);
        at += 4;
      }
      at += 2;
    }
  }
  return data.buffer;
}

export function shapesOf(model, meshes, poses, only = null) {
  return model.parts.flatMap((part, index) =>
    only !== null && only !== index
      ? []
      : part.shapes.map((shape) => ({ ...meshes[shape.mesh], T: multiply(poses[index], fromPose(shape.pose)) })));
}
