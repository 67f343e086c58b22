// The images: half floats as analysis/report/pictures.py packs them, unpacked when they are first looked at.
class Halves {
  constructor(gallery, index, width, height) {
    Object.assign(this, {id: `${gallery}-${index}`, width, height, values: null});
  }

  async load() { return this.values ??= await (this.promise ??= this.unpack()); }

  async unpack() {
    const text = document.querySelector(`script[data-picture="${this.id}"]`).textContent;
    const letters = atob(text), packed = new Uint8Array(letters.length);
    for (let i = 0; i < packed.length; ++i) packed[i] = letters.charCodeAt(i);
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
    const count = bytes.length / 2;
    for (let i = 1; i < bytes.length; ++i) bytes[i] += bytes[i - 1];
    const values = new Uint16Array(count);
    for (let i = 0; i < count; ++i) values[i] = bytes[i] | bytes[count + i] << 8;
    return values;
  }

  // Of a pixel; only once loaded.
  bits(x, y) {
    const at = y * this.width + x, plane = this.width * this.height;
    return [this.values[at], this.values[plane + at], this.values[2 * plane + at]];
  }

  rgb(x, y) { return this.bits(x, y).map(bits => floatOfHalf[bits]); }
}

// Every half float there is, by its bits: IEEE 754 binary16.
const floatOfHalf = Float32Array.from({length: 65536}, (_, bits) => {
  const exponent = bits >> 10 & 31, fraction = bits & 1023, sign = bits & 0x8000 ? -1 : 1;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (exponent === 0 ? fraction * 2 ** -24 : (1 + fraction / 1024) * 2 ** (exponent - 15));
});

// Brightness on the screen of every half float at an exposure in stops: sRGB, IEC 61966-2-1.
function screenTable(stops) {
  const gain = 2 ** stops;
  return Uint8ClampedArray.from(floatOfHalf, value => {
    const linear = Math.min(1, Math.max(0, value * gain));
    return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);
  });
}

// Puts the geometric mean of all values above zero to 0.18, to a quarter of a stop: Reinhard et al. 2002, equation 1.
function autoStops({values}) {
  let sum = 0, count = 0;
  for (const bits of values ?? []) {
    const value = floatOfHalf[bits];
    if (value > 0 && value < Infinity) [sum, count] = [sum + Math.log2(value), count + 1];
  }
  return count === 0 ? 0 : Math.min(8, Math.max(-8, Math.round(4 * (Math.log2(0.18) - sum / count)) / 4));
}

// The table of the last exposure is kept.
function screenTableNow(stops) {
  if (screenTableNow.stops !== stops) Object.assign(screenTableNow, {stops, table: screenTable(stops)});
  return screenTableNow.table;
}

// As it is seen, non-finite pixels in magenta.
function paintImage(halves, stops) {
  const table = screenTableNow(stops);
  const {values, width, height} = halves, count = width * height, pixels = new Uint8ClampedArray(4 * count);
  for (let i = 0; i < count; ++i) {
    const [r, g, b] = [values[i], values[count + i], values[2 * count + i]];
    pixels[4 * i] = table[r];
    pixels[4 * i + 1] = table[g];
    pixels[4 * i + 2] = table[b];
    pixels[4 * i + 3] = 255;
    if ((r & 0x7c00) === 0x7c00 || (g & 0x7c00) === 0x7c00 || (b & 0x7c00) === 0x7c00) pixels.set([255, 0, 255], 4 * i);
  }
  return new ImageData(pixels, width, height);
}

// (a - r)^2 / (r^2 + 0.01), the mean over channels: a pixel's share of relMSE.
function pixelError(a, r) {
  return [0, 1, 2].reduce((sum, c) => sum + (a[c] - r[c]) ** 2 / (r[c] ** 2 + 0.01), 0) / 3;
}

const errorLow = 1e-4, errorHigh = 1e2;  // ends of the error map's scale

// Into the 256 colours; -1 for what is not finite.
function errorShade(error) {
  if (!Number.isFinite(error)) return -1;
  const share = Math.log(Math.max(error, 1e-30) / errorLow) / Math.log(errorHigh / errorLow);
  return Math.round(255 * Math.min(1, Math.max(0, share)));
}

function paintError(halves, reference) {
  const {values, width, height} = halves, count = width * height, pixels = new Uint8ClampedArray(4 * count);
  for (let i = 0; i < count; ++i) {
    let error = 0;
    for (let at = i; at < values.length; at += count) {
      const r = floatOfHalf[reference.values[at]];
      error += (floatOfHalf[values[at]] - r) ** 2 / (r * r + 0.01) / 3;
    }
    const shade = errorShade(error);
    pixels.set(shade < 0 ? [255, 0, 255] : data.magma[shade], 4 * i);
    pixels[4 * i + 3] = 255;
  }
  return new ImageData(pixels, width, height);
}
