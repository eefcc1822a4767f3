// SPDX-License-Identifier: Apache-2.0
// Pixels of PNG and JPEG files as they are stored: neither multiplied by alpha nor brought to the screen's colours, as a
// canvas would.

/** As many as the library takes of one image. */
const mostPixels = 2 ** 28;
function check(width: number, height: number): void {
  if (width * height > mostPixels) throw new Error(`${width} x ${height} pixels are too many`);
}

export interface Pixels { width: number; height: number; rgba: Uint8Array<ArrayBuffer> }

const kinds: [number[], string][] = [[[0x89, 0x50, 0x4e, 0x47], "image/png"], [[0xff, 0xd8, 0xff], "image/jpeg"]];

export async function decodeImage(file: Uint8Array<ArrayBuffer>): Promise<Pixels> {
  const type = kinds.find(([begin]) => begin.every((byte, i) => file[i] === byte))?.[1];
  if (!type) throw new Error("neither PNG nor JPEG");
  return "ImageDecoder" in self ? byDecoder(file, type) : byWebGL(file, type);
}

async function byDecoder(data: Uint8Array<ArrayBuffer>, type: string): Promise<Pixels> {
  const decoder = new ImageDecoder({ data, type, colorSpaceConversion: "none" });
  try {
    const { image } = await decoder.decode();
    const { width, height } = image.visibleRect!;
    check(width, height);
    const rgba = new Uint8Array(image.allocationSize({ format: "RGBA" }));
    await image.copyTo(rgba, { format: "RGBA" });
    image.close();
    return { width, height, rgba };
  } finally {
    decoder.close();
  }
}

/** Where there is no decoder a texture gives back what it was given. */
async function byWebGL(data: Uint8Array<ArrayBuffer>, type: string): Promise<Pixels> {
  const bitmap = await createImageBitmap(new Blob([data], { type }), { premultiplyAlpha: "none", colorSpaceConversion: "none" });
  const { width, height } = bitmap;
  check(width, height);
  const gl = new OffscreenCanvas(1, 1).getContext("webgl2");
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
