// Animated GIF (GIF89a): one palette for all frames by median cut (P. Heckbert, 1982), then LZW.

const COLORS = 256, BITS = 5; // of each channel, in the table from colour to palette
const cell = (r, g, b) => ((r >> 3) << 10) | ((g >> 3) << 5) | (b >> 3);

// Palette of so many colours, and the palette's index for each cell of the colour cube.
export function paletteOf(counts) {
  const used = [];
  counts.forEach((count, key) => count && used.push({ key, count, channels: [key >> 10, (key >> 5) & 31, key & 31] }));
  let boxes = [used];
  while (boxes.length < COLORS) {
    const spread = (box) => [0, 1, 2].map((k) => Math.max(...box.map((c) => c.channels[k])) - Math.min(...box.map((c) => c.channels[k])));
    const weights = boxes.map((box) => (box.length < 2 ? 0 : Math.max(...spread(box)) * Math.sqrt(box.reduce((sum, c) => sum + c.count, 0))));
    const index = weights.indexOf(Math.max(...weights));
    if (!weights[index]) break;
    const box = boxes[index], sizes = spread(box), axis = sizes.indexOf(Math.max(...sizes));
    box.sort((a, b) => a.channels[axis] - b.channels[axis]);
    const half = box.reduce((sum, c) => sum + c.count, 0) / 2;
    let at = 0, sum = 0;
    while (at < box.length - 1 && sum + box[at].count <= half) sum += box[at++].count;
    at = Math.max(1, at);
    boxes.splice(index, 1, box.slice(0, at), box.slice(at));
  }
  const palette = boxes.filter((box) => box.length).map((box) => {
    const total = box.reduce((sum, c) => sum + c.count, 0);
    return [0, 1, 2].map((k) => Math.round((box.reduce((sum, c) => sum + c.count * c.channels[k], 0) / total) * 8.2258));
  });
  const table = new Uint8Array(1 << (3 * BITS));
  boxes.forEach((box, index) => box.forEach(({ key }) => (table[key] = index)));
  return { palette, table };
}

function lzw(pixels, put) {
  const clear = 256, end = 257;
  let codes = new Map(), next = 258, width = 9, buffer = 0, held = 0;
  const bytes = [];
  const emit = (code) => {
    buffer |= code << held;
    held += width;
    while (held >= 8) {
      bytes.push(buffer & 255);
      buffer >>>= 8;
      held -= 8;
    }
  };
  emit(clear);
  let prefix = pixels[0];
  for (let i = 1; i < pixels.length; i++) {
    const key = (prefix << 8) | pixels[i], known = codes.get(key);
    if (known !== undefined) {
      prefix = known;
      continue;
    }
    emit(prefix);
    prefix = pixels[i];
    if (next === 4096) {
      emit(clear);
      [codes, next, width] = [new Map(), 258, 9];
      continue;
    }
    codes.set(key, next);
    if (next++ === 1 << width) width++;
  }
  emit(prefix);
  emit(end);
  if (held) bytes.push(buffer & 255);
  for (let at = 0; at < bytes.length; at += 255) {
    const block = bytes.slice(at, at + 255);
    put([block.length, ...block]);
  }
  put([0]);
}

// A film of frames: {count, at(index, width) → canvas}. Every second frame of it, with one palette for all.
export async function gifOf({ count, at }, { width, centiseconds, tell }) {
  const images = [], counts = new Uint32Array(1 << (3 * BITS));
  let height = 0;
  for (let index = 0; index < count; index += 2) {
    tell(`Frame ${index / 2 + 1} of ${Math.ceil(count / 2)}`);
    const made = await at(index, width);
    const { data } = made.getContext("2d").getImageData(0, 0, made.width, made.height);
    [width, height] = [made.width, made.height];
    const cells = new Uint16Array(made.width * made.height);
    for (let i = 0; i < cells.length; i++) {
      cells[i] = cell(data[4 * i], data[4 * i + 1], data[4 * i + 2]);
      counts[cells[i]]++;
    }
    images.push(cells);
  }
  const { palette, table } = paletteOf(counts);
  const parts = [];
  const put = (bytes) => parts.push(Uint8Array.from(bytes));
  const word = (value) => [value & 255, value >> 8];
  put([...new TextEncoder().encode("GIF89a"), ...word(width), ...word(height), 0xf7, 0, 0]);
  put([...palette.flat(), ...new Array(3 * (COLORS - palette.length)).fill(0)].map((value) => Math.min(value, 255)));
  put([0x21, 0xff, 11, ...new TextEncoder().encode("NETSCAPE2.0"), 3, 1, 0, 0, 0]);
  for (const cells of images) {
    put([0x21, 0xf9, 4, 0, ...word(centiseconds), 0, 0]);
    put([0x2c, 0, 0, 0, 0, ...word(width), ...word(height), 0, 8]);
    lzw(Uint8Array.from(cells, (key) => table[key]), put);
  }
  put([0x3b]);
  return new Blob(parts, { type: "image/gif" });
}
