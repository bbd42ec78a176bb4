// The same mathematics as articad.kinematics, in double precision: T_child = T_parent · C_p · J(q) · F · C_c⁻¹.
// Lengths in mm, angles in rad. A pose is 12 numbers: the rows of [R | t].

export const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];

export function multiply(A, B) {
  const C = new Array(12);
  for (let i = 0; i < 3; i++) {
    const a = A[4 * i], b = A[4 * i + 1], c = A[4 * i + 2];
    for (let j = 0; j < 4; j++) C[4 * i + j] = a * B[j] + b * B[4 + j] + c * B[8 + j];
    C[4 * i + 3] += A[4 * i + 3];
  }
  return C;
}

export function inverse(A) {
  const C = new Array(12);
  for (let i = 0; i < 3; i++) {
    for (let j = 0; j < 3; j++) C[4 * i + j] = A[4 * j + i];
    C[4 * i + 3] = -(A[i] * A[3] + A[4 + i] * A[7] + A[8 + i] * A[11]);
  }
  return C;
}

export function apply(A, [x, y, z]) {
  return [0, 4, 8].map((i) => A[i] * x + A[i + 1] * y + A[i + 2] * z + A[i + 3]);
}

// From tx ty tz qx qy qz qw.
export function fromPose([tx, ty, tz, x, y, z, w]) {
  return [
    1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), tx,
    2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), ty,
    2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), tz,
  ];
}

const rotZ = (a, x = 0, y = 0, z = 0) => [Math.cos(a), -Math.sin(a), 0, x, Math.sin(a), Math.cos(a), 0, y, 0, 0, 1, z];
const rotX = (a) => [1, 0, 0, 0, 0, Math.cos(a), -Math.sin(a), 0, 0, Math.sin(a), Math.cos(a), 0];
const rotY = (a) => [Math.cos(a), 0, Math.sin(a), 0, 0, 1, 0, 0, -Math.sin(a), 0, Math.cos(a), 0];
const FLIP = [1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0];

// Place among a joint's coordinates of the first of a quaternion's four; -1 where there is none.
export function quaternionAt(joint) {
  return { ball: 0, free: 3 }[joint.type] ?? -1;
}

// J(q) of a joint whose coordinates begin at Q[joint.column].
export function motion(joint, Q) {
  const i = joint.column;
  switch (joint.type) {
    case "revolute": return rotZ(Q[i]);
    case "slider": return rotZ(0, 0, 0, Q[i]);
    case "cylindrical": return rotZ(Q[i + 1], 0, 0, Q[i]);
    case "screw": return rotZ(Q[i], 0, 0, (joint.lead / (2 * Math.PI)) * Q[i]);
    case "planar": return rotZ(Q[i + 2], Q[i], Q[i + 1], 0);
    case "universal": return multiply(rotX(Q[i]), rotY(Q[i + 1]));
    case "ball": return fromPose([0, 0, 0, Q[i], Q[i + 1], Q[i + 2], Q[i + 3]]);
    case "free": return fromPose(Q.slice(i, i + 7));
    default: return IDENTITY;
  }
}

export function quaternionProduct([ax, ay, az, aw], [bx, by, bz, bw]) {
  return [
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

export function quaternionFromVector([x, y, z]) {
  const angle = Math.hypot(x, y, z);
  const s = angle < 1e-8 ? 0.5 : Math.sin(angle / 2) / angle;
  return [x * s, y * s, z * s, Math.cos(angle / 2)];
}

function rotationLog(R) {
  const w = [R[9] - R[6], R[2] - R[8], R[4] - R[1]];
  const sine = Math.hypot(...w) / 2;
  const cosine = (R[0] + R[5] + R[10] - 1) / 2;
  const angle = Math.atan2(sine, cosine);
  if (sine > 1e-6) return w.map((value) => (value * angle) / (2 * sine));
  if (cosine > 0) return w.map((value) => value / 2);
  const axis = [0, 5, 10].map((k) => Math.sqrt(Math.max(0, (R[k] + 1) / 2))); // half a turn: no loop is closed near it
  return axis.map((value) => value * angle);
}

// A mechanism as the page holds it: see articad/report/model.py for the form.
export class Mechanism {
  constructor(model) {
    this.model = model;
    this.parts = model.parts.map((part) => part.name);
    this.joints = model.joints.map((joint) => ({ ...joint, Cp: fromPose(joint.parent_frame), Cc: fromPose(joint.child_frame) }));
    for (const joint of this.joints) {
      joint.flipped = joint.opposed ? multiply(joint.Cc, FLIP) : joint.Cc;
      joint.toChild = inverse(joint.flipped);
      joint.toParent = inverse(joint.Cp);
    }
    this.ground = fromPose(model.ground_pose);
    this.rest = model.rest.slice();
    this.columns = model.coordinates;
    // freedoms: one for each column, but three for the four of a quaternion
    this.freedoms = [];
    for (const joint of this.joints) {
      const at = quaternionAt(joint);
      for (let k = 0; k < (at < 0 ? joint.coordinates : at); k++) this.freedoms.push({ column: joint.column + k });
      if (at >= 0) for (let k = 0; k < 3; k++) this.freedoms.push({ ball: joint.column + at, axis: k });
    }
    this.scale = this.freedoms.map((f) => (f.column !== undefined && this.columns[f.column].unit === "mm" ? model.length : 1));
  }

  // Poses of all parts, in order of the parts.
  poses(Q) {
    const T = new Array(this.parts.length);
    T[this.model.ground] = this.ground;
    for (const { joint: index, from, to, reversed } of this.model.tree) {
      const joint = this.joints[index];
      const J = motion(joint, Q);
      T[to] = reversed
        ? multiply(multiply(T[from], joint.flipped), multiply(inverse(J), joint.toParent))
        : multiply(multiply(T[from], joint.Cp), multiply(J, joint.toChild));
    }
    return T;
  }

  // How far loops are from closed, lengths in units of `length`, and couplings from kept.
  residual(Q) {
    const T = this.poses(Q);
    const rows = [];
    for (const index of this.model.loops) {
      const joint = this.joints[index];
      const ghost = multiply(multiply(T[joint.parent], joint.Cp), motion(joint, Q));
      const M = multiply(inverse(ghost), multiply(T[joint.child], joint.flipped));
      rows.push(M[3] / this.model.length, M[7] / this.model.length, M[11] / this.model.length, ...rotationLog(M));
    }
    for (const { a, b, ratio, offset, unit } of this.model.couplings) {
      rows.push((Q[b] - ratio * Q[a] - offset) / (unit === "mm" ? this.model.length : 1));
    }
    return rows;
  }

  // Q after a step of some freedoms, given in scaled units.
  moved(Q, freedoms, step) {
    const out = Q.slice();
    const turns = new Map();
    freedoms.forEach((index, k) => {
      const freedom = this.freedoms[index];
      if (freedom.column !== undefined) out[freedom.column] += step[k] * this.scale[index];
      else {
        if (!turns.has(freedom.ball)) turns.set(freedom.ball, [0, 0, 0]);
        turns.get(freedom.ball)[freedom.axis] = step[k];
      }
    });
    for (const [column, vector] of turns) {
      const turned = quaternionProduct(quaternionFromVector(vector), out.slice(column, column + 4));
      const norm = Math.hypot(...turned);
      turned.forEach((value, k) => (out[column + k] = value / norm));
    }
    return out;
  }
}
