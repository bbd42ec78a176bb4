// Loops follow their drivers: the way from one configuration to the next in small steps, each closed to rounding.

const CLOSED = 1e-10; // rad, or lengths L: as articad.kinematics.loops
const TARGET = 1e-13;
const LARGEST_STEP = 0.04; // rad, or lengths L, of a driver between two closings
const SMALLEST_STEP = 1e-7; // where a dead point is said to be
const LARGEST_JUMP = 8; // how much farther than the driver the others may go in a step that keeps to its branch…
const FREE_JUMP = 0.02; // …beyond a move this small
const DIFFERENCE = 1e-6; // of central differences: the error of J, 1e-10, only slows the last digits
const DROPPED = 1e-9; // σ/σ₁ of a direction that no constraint determines

// Singular values of a matrix given as rows, by one-sided Jacobi rotations: returns columns U·diag(s) and V.
function svd(rows, n) {
  const m = rows.length;
  const A = Array.from({ length: n }, (_, j) => rows.map((row) => row[j]));
  const V = Array.from({ length: n }, (_, j) => Array.from({ length: n }, (_, i) => (i === j ? 1 : 0)));
  for (let sweep = 0; sweep < 40; sweep++) {
    let turned = false;
    for (let p = 0; p < n; p++) {
      for (let q = p + 1; q < n; q++) {
        let alpha = 0, beta = 0, gamma = 0;
        for (let i = 0; i < m; i++) {
          alpha += A[p][i] * A[p][i];
          beta += A[q][i] * A[q][i];
          gamma += A[p][i] * A[q][i];
        }
        if (Math.abs(gamma) <= 1e-15 * Math.sqrt(alpha * beta) || gamma === 0) continue;
        turned = true;
        const zeta = (beta - alpha) / (2 * gamma);
        const t = Math.sign(zeta || 1) / (Math.abs(zeta) + Math.hypot(1, zeta));
        const c = 1 / Math.hypot(1, t), s = c * t;
        for (const [x, y] of [[A[p], A[q]], [V[p], V[q]]]) {
          for (let i = 0; i < x.length; i++) {
            const a = x[i], b = y[i];
            x[i] = c * a - s * b;
            y[i] = s * a + c * b;
          }
        }
      }
    }
    if (!turned) break;
  }
  return { A, V, s: A.map((column) => Math.hypot(...column)) };
}

// Least change that solves J y = −r, damped by `lambda`.
function step(J, r, n, lambda) {
  const { A, V, s } = svd(J, n);
  const floor = DROPPED * Math.max(0, ...s);
  const y = new Array(n).fill(0);
  for (let k = 0; k < n; k++) {
    if (s[k] <= floor) continue;
    let along = 0;
    for (let i = 0; i < r.length; i++) along += A[k][i] * r[i]; // = s · (u · r)
    const weight = -along / (s[k] * s[k] + lambda * lambda);
    for (let i = 0; i < n; i++) y[i] += weight * V[k][i];
  }
  return y;
}

const norm = (values) => Math.hypot(...values);

export class Solver {
  constructor(mechanism) {
    this.mechanism = mechanism;
    this.free = mechanism.model.dependent;
  }

  get needed() {
    return this.free.length > 0;
  }

  jacobian(Q) {
    const columns = this.free.map((freedom) => {
      const ahead = this.mechanism.residual(this.mechanism.moved(Q, [freedom], [DIFFERENCE]));
      const behind = this.mechanism.residual(this.mechanism.moved(Q, [freedom], [-DIFFERENCE]));
      return ahead.map((value, i) => (value - behind[i]) / (2 * DIFFERENCE));
    });
    return columns[0].map((_, i) => columns.map((column) => column[i]));
  }

  // Close all loops from near by; null where that cannot be done.
  close(Q) {
    let r = this.mechanism.residual(Q), size = norm(r), mu = 1e-3;
    for (let iteration = 0; iteration < 40 && size > TARGET; iteration++) {
      const J = this.jacobian(Q);
      let better = false;
      for (let attempt = 0; attempt < 12 && !better; attempt++) {
        const y = step(J, r, this.free.length, mu * Math.min(1, size));
        const trial = this.mechanism.moved(Q, this.free, y);
        const rTrial = this.mechanism.residual(trial), sizeTrial = norm(rTrial);
        if (sizeTrial < size) {
          [Q, r, size] = [trial, rTrial, sizeTrial];
          mu *= 0.2;
          better = true;
        } else mu *= 8;
      }
      if (!better) break;
    }
    return size <= CLOSED ? Q : null;
  }

  // Go from closed coordinates to where the drivers have the wanted values; stops where the branch ends.
  follow(Q, wanted) {
    const M = this.mechanism;
    if (!this.needed) return { Q: wanted, arrived: true };
    const drivers = M.freedoms.map((_, i) => i).filter((i) => !this.free.includes(i));
    const way = drivers.map((index) => {
      const freedom = M.freedoms[index];
      if (freedom.column !== undefined) return (wanted[freedom.column] - Q[freedom.column]) / M.scale[index];
      return 0; // a ball that drives is set at the end: its turn is rarely part of a loop
    });
    const length = Math.max(0, ...way.map(Math.abs));
    let at = Q, done = 0, size = Math.min(1, LARGEST_STEP / Math.max(length, 1e-300));
    let last = null; // the step before: where to look for the next solution
    while (done < 1) {
      const share = Math.min(size, 1 - done);
      let start = M.moved(at, drivers, way.map((value) => value * share));
      if (last) start = M.moved(start, this.free, last.map((value) => value * share));
      const closed = this.close(start);
      const moves = closed && this.difference(at, closed);
      if (closed && Math.max(0, ...moves.map(Math.abs)) <= Math.max(FREE_JUMP, LARGEST_JUMP * share * length)) {
        at = closed;
        last = moves.map((value) => value / share);
        done += share;
        size = Math.min(size * 1.5, LARGEST_STEP / Math.max(length, 1e-300));
      } else {
        last = null;
        size = share / 2;
        if (size * length < SMALLEST_STEP) return { Q: at, arrived: false };
      }
    }
    for (const index of drivers) { // the drivers' own columns to the last bit
      const { column, ball } = M.freedoms[index];
      if (column !== undefined) at[column] = wanted[column];
      else for (let k = 0; k < 4; k++) at[ball + k] = wanted[ball + k];
    }
    return { Q: this.close(at) ?? at, arrived: true };
  }

  difference(from, to) {
    return this.free.map((index) => {
      const { column, ball, axis } = this.mechanism.freedoms[index];
      if (column !== undefined) return (to[column] - from[column]) / this.mechanism.scale[index];
      const sign = from.slice(ball, ball + 4).reduce((sum, value, k) => sum + value * to[ball + k], 0) < 0 ? -1 : 1;
      return 2 * (sign * to[ball + axis] - from[ball + axis]); // of a small turn; good enough to look ahead and to see a jump
    });
  }
}
