// Motion to look at: joints over their ranges and back to where they rest, by a sine, so that no joint starts or stops abruptly.

const PERIOD = 4000; // ms for one joint
const SHARE = 0.35; // of a joint's period after which the next one starts, where joints cannot hinder each other

// A joint's value at a share of its period: from rest to the upper end, to the lower end and back, at the same speed through rest.
function valueOf({ lower, upper, endless, rest }, share) {
  if (endless) return rest + 2 * Math.PI * share;
  const above = (upper - rest) / (upper - lower || 1);
  if (share < above) return rest + (upper - rest) * Math.sin((Math.PI * share) / above);
  return rest - (rest - lower) * Math.sin((Math.PI * (share - above)) / (1 - above || 1));
}

// How long the whole takes, in periods of one joint.
const length = (count, together) => (together ? 1 + (count - 1) * SHARE : count);

// Put all joints where they are at a share of the whole motion.
export function cycle(movers, share, { together }) {
  const at = share * length(movers.length, together);
  movers.forEach((mover, index) => {
    const own = at - index * (together ? SHARE : 1);
    if (own >= 0 && own < 1) mover.write(valueOf(mover, own));
    else if (mover.read() !== mover.rest) mover.write(mover.rest);
  });
}

export class Player {
  // Play from the present value if only one joint moves, and from the beginning otherwise.
  start(movers, { from, together, write }) {
    const whole = PERIOD * length(movers.length, together);
    let elapsed = from === null ? 0 : PERIOD * shareOf(movers[0], from), before = performance.now();
    const step = (now) => {
      elapsed += Math.min(now - before, 100); // a page that was hidden goes on where it was
      before = now;
      write(() => cycle(movers, (elapsed / whole) % 1, { together }));
      this.asked = requestAnimationFrame(step);
    };
    this.asked = requestAnimationFrame(step);
  }

  stop() {
    cancelAnimationFrame(this.asked);
  }
}

// The share of the period in which a joint has a value, on its way from rest.
function shareOf({ lower, upper, endless, rest }, value) {
  if (endless) return (((value - rest) / (2 * Math.PI)) % 1 + 1) % 1;
  const above = (upper - rest) / (upper - lower || 1);
  const part = (way, whole) => Math.asin(Math.min(Math.max(way / (whole || 1), 0), 1)) / Math.PI;
  return value >= rest ? above * part(value - rest, upper - rest) : above + (1 - above) * part(rest - value, rest - lower);
}
