// SPDX-License-Identifier: Apache-2.0
// Pixels of PNG, JPEG and WebP files as stored: neither multiplied by alpha nor converted to the screen's colours, as a
// canvas would.

/** Number of pixels in the header of a WebP (lossy, lossless or extended); 0 if the header states none. */
function pixelsOfWebp(view: DataView): number {
  if (view.byteLength < 30) return 0;
  const size24 = (at: number) => 1 + view.getUint16(at, true) + 65536 * view.getUint8(at + 2);
  const kind = view.getUint8(15);
  if (kind === 0x58) return size24(24) * size24(27); // "VP8X"
  const bits = view.getUint32(21, true);
  if (kind === 0x4c) return (1 + (bits & 0x3fff)) * (1 + ((bits >> 14) & 0x3fff)); // "VP8L"
  return (view.getUint16(26, true) & 0x3fff) * (view.getUint16(28, true) & 0x3fff);
}

/** Number of pixels in an image's header; 0 if the header states none. */
function pixelsOf(file: Uint8Array): number {
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  if (file[0] === 0x52) return pixelsOfWebp(view);
  if (file[0] === 0x89) return file.length < 24 ? 0 : view.getUint32(16) * view.getUint32(20);
  for (let at = 2; at + 9 < file.length && file[at] === 0xff; ) {
    const marker = file[at + 1];
    if (marker === 0xff) {
      ++at; // fill bytes
      continue;
    }
    // A start-of-frame marker, which has several kinds.
    if (marker >= 0xc0 && marker <= 0xcf && ![0xc4, 0xc8, 0xcc].includes(marker)) return view.getUint16(at + 5) * view.getUint16(at + 7);
    at += 2 + view.getUint16(at + 2);
  }
  return 0;
}

/** Limits the pixels of a model's textures to the library's limit, before any is decoded. */
export class PixelBudget {
  private left = 2 ** 26;
  take(file: Uint8Array): void {
    const pixels = pixelsOf(file);
    if (pixels === 0) throw new Error("its header states no size");
    this.left += 64 * file.length;
    if (pixels > this.left) throw new Error("the textures together have too many pixels");
    this.left -= pixels;
  }
}

export interface Pixels { width: number; height: number; rgba: Uint8Array<ArrayBuffer> }

const kinds: [number[], string][] = [
  [[0x89, 0x50, 0x4e, 0x47], "image/png"], [[0xff, 0xd8, 0xff], "image/jpeg"], [[0x52, 0x49, 0x46, 0x46], "image/webp"]];

export async function decodeImage(file: Uint8Array<ArrayBuffer>): Promise<Pixels> {
  const type = kinds.find(([begin]) => begin.every((byte, i) => file[i] === byte))?.[1];
  if (!type) throw new Error("neither PNG nor JPEG nor WebP");
  return "ImageDecoder" in self ? byDecoder(file, type) : byWebGL(file, type);
}

async function byDecoder(data: Uint8Array<ArrayBuffer>, type: string): Promise<Pixels> {
  const decoder = new ImageDecoder({ data, type, colorSpaceConversion: "none" });
  try {
    const { image } = await decoder.decode();
    const { width, height } = image.visibleRect!;
    const rgba = new Uint8Array(image.allocationSize({ format: "RGBA" }));
    await image.copyTo(rgba, { format: "RGBA" });
    image.close();
    return { width, height, rgba };
  } finally {
    decoder.close();
  }
}

/** Decodes through a WebGL texture, which returns the stored values, if there is no image decoder. */
async function byWebGL(data: Uint8Array<ArrayBuffer>, type: string): Promise<Pixels> {
  const bitmap = await createImageBitmap(new Blob([data], { type }), { premultiplyAlpha: "none", colorSpaceConversion: "none" });
  const { width, height } = bitmap, gl = new OffscreenCanvas(1, 1).getContext("webgl2");
  if (!gl) throw new Error("this browser decodes no textures without WebGL");
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, gl.getParameter(gl.TEXTURE_BINDING_2D), 0);
  const rgba = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
  bitmap.close();
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return { width, height, rgba };
}
