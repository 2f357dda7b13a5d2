// The yarn as a binary STL file: a closed tube a piece, as `picot build -o x.stl --set detail=3` writes it.
import { yarn } from "./data.js";

const STEPS = 2;
const SIDES = 5;

const sub = (a, b) => a.map((x, k) => x - b[k]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const plus = (a, b, s) => a.map((x, k) => x + s * b[k]);
const length = (a) => Math.sqrt(dot(a, a));
function unit(a, other) {
  const l = length(a);
  return l > 1e-9 ? a.map((x) => x / l) : other;
}

/** The direction at a point: between the ways to and from it, nearer to that of the shorter. */
function way(before, at, after) {
  const [to, from] = [sub(at, before), sub(after, at)];
  const zero = [0, 0, 0];
  const mixed = plus(unit(to, zero).map((x) => x * length(from)), unit(from, zero), length(to));
  return unit(mixed, unit(from, unit(to, [1, 0, 0])));
}

/** Rings of points around a piece of yarn, and its two ends. */
function rings(strand, begin, end, radius, middle) {
  const point = (i) => [0, 1, 2].map((k) => strand.at[3 * i + k] + middle[k]);
  const made = [];
  let side = [strand.side[3 * begin], strand.side[3 * begin + 1], strand.side[3 * begin + 2]];
  let last = null;
  const ring = (at, tangent) => {
    if (last) {
      // Carried along with the least twist.
      const step = sub(at, last.at);
      const square = dot(step, step);
      let tangentThere = last.tangent;
      if (square > 1e-12) {
        side = plus(side, step, (-2 / square) * dot(step, side));
        tangentThere = plus(tangentThere, step, (-2 / square) * dot(step, tangentThere));
      }
      const turn = sub(tangent, tangentThere);
      const bend = dot(turn, turn);
      if (bend > 1e-12) side = plus(side, turn, (-2 / bend) * dot(turn, side));
    }
    const other = Math.abs(tangent[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
    side = unit(plus(side, tangent, -dot(side, tangent)), unit(cross(tangent, other), other));
    last = { at, tangent };
    const across = cross(tangent, side);
    made.push(
      Array.from({ length: SIDES }, (_, k) => {
        const angle = (2 * Math.PI * k) / SIDES;
        return plus(plus(at, side, radius * Math.cos(angle)), across, radius * Math.sin(angle));
      }),
    );
  };
  ring(point(begin), way(point(begin - 1), point(begin), point(begin + 1)));
  for (let i = begin; i < end; i++) {
    const [a, d] = [point(i), point(i + 1)];
    const third = length(sub(d, a)) / 3;
    const b = plus(a, way(point(i - 1), a, d), third);
    const c = plus(d, way(a, d, point(i + 2)), -third);
    for (let k = 1; k <= STEPS; k++) {
      const t = k / STEPS;
      const s = 1 - t;
      const at = [0, 1, 2].map((n) => a[n] * s ** 3 + 3 * b[n] * s * s * t + 3 * c[n] * s * t * t + d[n] * t ** 3);
      const slope = [0, 1, 2].map((n) => (b[n] - a[n]) * s * s + 2 * (c[n] - b[n]) * s * t + (d[n] - c[n]) * t * t);
      ring(at, unit(slope, unit(sub(d, a), [1, 0, 0])));
    }
  }
  return { made, first: point(begin), last: point(end) };
}

/** Bytes of the file. */
export function stl(scene) {
  const strand = yarn(scene, 1);
  const tubes = [];
  // Segments of a piece follow each other; between pieces there is a gap.
  for (let k = 0; k < strand.segments.length; ) {
    const begin = strand.segments[k];
    let end = begin;
    while (k < strand.segments.length && strand.segments[k] === end) {
      end++;
      k++;
    }
    tubes.push(rings(strand, begin, end, scene.yarn / 2, scene.middle));
  }
  const count = tubes.reduce((sum, { made }) => sum + 2 * SIDES * made.length, 0);
  const view = new DataView(new ArrayBuffer(84 + 50 * count));
  [..."Picot, binary STL, mm"].forEach((c, k) => view.setUint8(k, c.charCodeAt(0)));
  view.setUint32(80, count, true);
  let offset = 84;
  const facet = (a, b, c) => {
    const normal = unit(cross(sub(b, a), sub(c, a)), [0, 0, 0]);
    for (const value of [...normal, ...a, ...b, ...c]) {
      view.setFloat32(offset, value, true);
      offset += 4;
    }
    offset += 2;
  };
  for (const { made, first, last } of tubes) {
    for (let k = 0; k < SIDES; k++) {
      const next = (k + 1) % SIDES;
      facet(first, made[0][next], made[0][k]);
      for (let r = 1; r < made.length; r++) {
        facet(made[r - 1][k], made[r - 1][next], made[r][next]);
        facet(made[r - 1][k], made[r][next], made[r][k]);
      }
      facet(last, made[made.length - 1][k], made[made.length - 1][next]);
    }
  }
  return view.buffer;
}
