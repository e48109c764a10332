// SPDX-License-Identifier: Apache-2.0
/** 3D textures. 16 bits are uploaded as they are, two channels of 8: value = 256 g + r is linear, so the sampler's
 * interpolation of both channels is that of the value. Slices are uploaded as they arrive. */
import {
  Data3DTexture,
  LinearFilter,
  NearestFilter,
  RedFormat,
  UnsignedByteType,
  type WebGLRenderer,
} from "three";
import type { Reduced, Volume } from "../case/volume";

const kSlab = 8 << 20; // bytes of one upload: short enough to leave the page alive

export class VolumeTexture {
  readonly texture = new Data3DTexture();
  private readonly handle: WebGLTexture;
  private uploaded = 0;

  /** Throws if the graphics cannot hold a volume of that size. */
  constructor(
    private readonly renderer: WebGLRenderer,
    readonly volume: Volume,
  ) {
    const gl = renderer.getContext() as WebGL2RenderingContext,
      most = gl.getParameter(gl.MAX_3D_TEXTURE_SIZE) as number;
    if (Math.max(...volume.size) > most)
      throw new Error(`The graphics hold at most ${most} voxels along an axis.`);
    this.handle = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_3D, this.handle);
    gl.texStorage3D(gl.TEXTURE_3D, 1, volume.bytesPerVoxel === 1 ? gl.R8 : gl.RG8, ...volume.size);
    for (const axis of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R])
      gl.texParameteri(gl.TEXTURE_3D, axis, gl.CLAMP_TO_EDGE);
    this.interpolate(true);
    (renderer.properties.get(this.texture) as { __webglTexture?: WebGLTexture }).__webglTexture = this.handle;
    renderer.resetState();
  }

  interpolate(on: boolean): void {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    gl.bindTexture(gl.TEXTURE_3D, this.handle);
    for (const which of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_3D, which, on ? gl.LINEAR : gl.NEAREST);
    this.renderer.resetState();
  }

  /** Uploads slices that have become complete, at most kSlab bytes; true if there are more. */
  upload(): boolean {
    const { volume } = this,
      gl = this.renderer.getContext() as WebGL2RenderingContext,
      [nx, ny] = volume.size;
    const each = nx * ny * volume.bytesPerVoxel,
      count = Math.min(volume.complete - this.uploaded, Math.max(1, Math.floor(kSlab / each)));
    if (count <= 0) return false;
    const bytes = new Uint8Array(
      volume.voxel.buffer,
      volume.voxel.byteOffset + this.uploaded * each,
      count * each,
    );
    gl.bindTexture(gl.TEXTURE_3D, this.handle);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
    gl.texSubImage3D(
      gl.TEXTURE_3D,
      0,
      0,
      0,
      this.uploaded,
      nx,
      ny,
      count,
      volume.bytesPerVoxel === 1 ? gl.RED : gl.RG,
      gl.UNSIGNED_BYTE,
      bytes,
    );
    this.renderer.resetState();
    this.uploaded += count;
    return this.uploaded < volume.complete;
  }

  dispose(): void {
    (this.renderer.getContext() as WebGL2RenderingContext).deleteTexture(this.handle);
    this.renderer.properties.remove(this.texture);
  }
}

function bytesTexture(size: number[], data: Uint8Array, linear: boolean): Data3DTexture {
  const texture = new Data3DTexture(data as Uint8Array<ArrayBuffer>, size[0], size[1], size[2]);
  texture.format = RedFormat;
  texture.type = UnsignedByteType;
  texture.minFilter = texture.magFilter = linear ? LinearFilter : NearestFilter;
  texture.unpackAlignment = 1;
  texture.needsUpdate = true;
  return texture;
}

export const castTextures = (reduced: Reduced): { voxels: Data3DTexture; blocks: Data3DTexture } => ({
  voxels: bytesTexture(reduced.size, reduced.data, true),
  blocks: bytesTexture(reduced.blocks.size, reduced.blocks.data, false),
});
