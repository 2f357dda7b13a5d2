// The page's data, unpacked: stitches, rounds, and the tiles that the yarn goes through.

function bytes(base64) {
  const text = atob(base64);
  const out = new Uint8Array(text.length);
  for (let i = 0; i < out.length; i++) out[i] = text.charCodeAt(i);
  return out;
}

/** The data of the page; `scene` is null where there is nothing to see. */
export function read(text) {
  const raw = JSON.parse(text);
  const data = { name: raw.name, hash: raw.hash, parts: raw.parts, text: raw.text, scene: null };
  if (raw.tiles) data.scene = unpack(raw);
  return data;
}

function unpack(raw) {
  const packed = bytes(raw.stitches);
  const view = new DataView(packed.buffer);
  const count = packed.length / 7;
  const scene = {
    gauge: raw.gauge,
    predicted: raw.predicted ?? null,
    yarn: raw.yarn,
    thickness: raw.thickness,
    colors: raw.colors,
    kinds: raw.kinds,
    ways: raw.ways,
    pieces: raw.pieces,
    count,
    kind: new Uint8Array(count),
    color: new Uint8Array(count),
    course: new Float32Array(count),
    wale: new Float32Array(count),
    skew: new Float32Array(count),
    round: new Int32Array(count),
    place: new Int32Array(count),
    rounds: raw.rounds.map(([piece, number, row, first, size]) => ({ piece, number, row, first, size })),
  };
  for (let i = 0; i < count; i++) {
    scene.kind[i] = packed[7 * i];
    scene.color[i] = packed[7 * i + 1];
    scene.course[i] = view.getInt16(7 * i + 2, true) / 10000;
    scene.wale[i] = view.getInt16(7 * i + 4, true) / 10000;
    scene.skew[i] = packed[7 * i + 6] / 255;
  }
  scene.rounds.forEach((round, index) => {
    let place = 0;
    for (let i = round.first; i < round.first + round.size; i++) {
      scene.round[i] = index;
      scene.place[i] = raw.kinds[scene.kind[i]].group === "turn" ? 0 : ++place;
    }
  });
  // Steps of the pattern, by part and step, which charts and text speak of.
  scene.steps = raw.pieces.map((piece) => {
    const steps = [];
    for (let i = piece.first; i < piece.first + piece.count; i++) {
      if (raw.kinds[scene.kind[i]].step) steps.push(i);
    }
    return steps;
  });
  tiles(raw, scene);
  return scene;
}

function tiles(raw, scene) {
  const points = bytes(raw.points);
  const view = new DataView(points.buffer);
  const table = points.length / 9;
  const at = new Float32Array(table * 3);
  const out = new Float32Array(table * 3);
  // Everything is drawn around the middle of its box.
  let high = [0, 0, 0];
  for (let i = 0; i < table; i++) {
    for (let k = 0; k < 3; k++) {
      at[3 * i + k] = (view.getUint16(9 * i + 2 * k, true) / 65535) * raw.size;
      out[3 * i + k] = view.getInt8(9 * i + 6 + k) / 127;
      high[k] = Math.max(high[k], at[3 * i + k]);
    }
  }
  for (let i = 0; i < table; i++) for (let k = 0; k < 3; k++) at[3 * i + k] -= high[k] / 2;
  const packed = bytes(raw.tiles);
  const count = packed.length / 14;
  const corner = new Uint32Array(count * 4);
  const way = new Uint8Array(count);
  const stitch = new Uint32Array(count);
  let before = 0;
  for (let i = 0; i < count; i++) {
    for (let k = 0; k < 4; k++) {
      const o = 14 * i + 3 * k;
      corner[4 * i + k] = packed[o] | (packed[o + 1] << 8) | (packed[o + 2] << 16);
    }
    way[i] = packed[14 * i + 12];
    before += packed[14 * i + 13];
    stitch[i] = before;
  }
  Object.assign(scene, { at, out, nodes: table, corner, way, stitch, tiles: count, box: high, middle: raw.low.map((x, k) => x + high[k] / 2) });
}

/** The point of a tile at (x, y, z) of the unit cube: trilinear, as `Stitch::map` has it. */
export function map(scene, tile, x, y, z, into, o) {
  const shift = scene.thickness * (z - 0.5);
  const { at, out, corner } = scene;
  const [a, b] = [3 * corner[4 * tile], 3 * corner[4 * tile + 1]];
  const [c, d] = [3 * corner[4 * tile + 2], 3 * corner[4 * tile + 3]];
  for (let k = 0; k < 3; k++) {
    const low = (at[a + k] + shift * out[a + k]) * (1 - x) + (at[b + k] + shift * out[b + k]) * x;
    const high = (at[c + k] + shift * out[c + k]) * (1 - x) + (at[d + k] + shift * out[d + k]) * x;
    into[o + k] = low + (high - low) * y;
  }
}

/**
 * The yarn: points that it goes through, in working order, each piece with its first and last point twice, so that
 * every curve has one before and behind. `stride` leaves points out.
 */
export function yarn(scene, stride) {
  let most = 2 * scene.pieces.length;
  for (let i = 0; i < scene.tiles; i++) most += scene.ways[scene.way[i]].length / 3;
  const at = new Float32Array(most * 3);
  const stitch = new Float32Array(most);
  const depth = new Float32Array(most);
  const segments = [];
  let n = 0;
  let tile = 0;
  const point = [0, 0, 0];
  const push = (id, z) => {
    at.set(point, 3 * n);
    stitch[n] = id;
    depth[n++] = z;
  };
  for (const piece of scene.pieces) {
    const begin = n;
    let key = 0;
    for (const end = tile + piece.strands; tile < end; tile++) {
      const way = scene.ways[scene.way[tile]];
      for (let k = 0; k < way.length; k += 3, key++) {
        if (key % stride) continue;
        map(scene, tile, way[k], way[k + 1], way[k + 2], point, 0);
        const o = 3 * (n - 1);
        const near = n > begin && Math.hypot(point[0] - at[o], point[1] - at[o + 1], point[2] - at[o + 2]) < 1e-3;
        if (near) continue;
        push(scene.stitch[tile], way[k + 2]);
        if (n === begin + 1) push(scene.stitch[tile], way[k + 2]);
      }
    }
    if (n === begin) continue;
    point[0] = at[3 * n - 3];
    point[1] = at[3 * n - 2];
    point[2] = at[3 * n - 1];
    push(stitch[n - 1], depth[n - 1]);
    for (let i = begin + 1; i < n - 2; i++) segments.push(i);
  }
  return { at, stitch, depth, count: n, segments: Float32Array.from(segments), side: sides(at, n) };
}

/** A side of the yarn at each point, carried along with the least twist (double reflection). */
function sides(at, n) {
  const side = new Float32Array(n * 3);
  const sub = (i, j) => [0, 1, 2].map((k) => at[3 * i + k] - at[3 * j + k]);
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const scaled = (a, s) => a.map((x) => x * s);
  const plus = (a, b, s) => a.map((x, k) => x + s * b[k]);
  const unit = (a) => {
    const l = Math.sqrt(dot(a, a));
    return l > 1e-9 ? scaled(a, 1 / l) : null;
  };
  let way = [1, 0, 0];
  let s = [0, 0, 1];
  for (let i = 0; i < n; i++) {
    const next = unit(sub(Math.min(i + 1, n - 1), Math.max(i - 1, 0))) || way;
    if (i > 0) {
      const step = sub(i, i - 1);
      const square = dot(step, step);
      if (square > 1e-12) {
        s = plus(s, step, (-2 / square) * dot(step, s));
        way = plus(way, step, (-2 / square) * dot(step, way));
      }
      const turn = plus(next, way, -1);
      const bend = dot(turn, turn);
      if (bend > 1e-12) s = plus(s, turn, (-2 / bend) * dot(turn, s));
    }
    s = unit(plus(s, next, -dot(s, next))) || unit([next[1], -next[0], 0]) || [1, 0, 0];
    way = next;
    side.set(s, 3 * i);
  }
  return side;
}
