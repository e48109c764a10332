// SPDX-License-Identifier: Apache-2.0
/** The chosen vessel and the chosen place of the check: they stand out of the 3D view, and cost no picture of all. */
import { Group, type Camera, type Mesh, type Object3D, type Scene, type WebGLRenderer } from "three";
import { missingPlaces } from "../case/work_items";
import type { Drawn } from "../drawing/scene_picture";
import { colouring } from "../model/colouring";
import type { View } from "../model/model";
import type { PartMaterial } from "./part_material";
import { ball } from "./scene_parts";

const kVessels = 1, // layers of three.js, beside the layer 0 of all
  kPlace = 2,
  kPink: [number, number, number] = [1, 0.48, 0.56];

/** The length of a voxel, mm, or a length in its place. */
export const voxelOf = ({ document: { volume, tree } }: Pick<View, "document">): number =>
  Math.max(volume?.spacing[0] ?? 0, tree?.voxelSize ?? 0, 0.1);

export class Choice {
  /** Holds a ball at the missing vessel that was shown last. */
  readonly place = new Group();
  private meshes: readonly Object3D[] = [];

  /** Marks the vessels that are selected or chosen, of meshes whose `userData.branch` names theirs, and the place. */
  follow(view: Pick<View, "document" | "selection" | "scene">, meshes: readonly Mesh[]): void {
    const { selected, chosen } = view.selection,
      { tree } = view.document;
    this.meshes = meshes.filter(mesh => {
      const branch = mesh.userData.branch as number,
        isChosen = branch >= 0 && (branch === selected || chosen.has(tree?.branches[branch]?.label ?? ""));
      (mesh.material as PartMaterial).lit = isChosen;
      if (isChosen) mesh.layers.enable(kVessels);
      else mesh.layers.disable(kVessels);
      return isChosen;
    });
    this.followPlace(view);
  }

  private followPlace(view: Pick<View, "document" | "selection" | "scene">): void {
    for (const old of this.place.children as Mesh[]) {
      old.geometry.dispose();
      (old.material as PartMaterial).dispose();
    }
    this.place.clear();
    const found = missingPlaces(view.document.state).find(({ item }) => item === view.selection.place);
    if (found === undefined || !view.scene.layers.places) return;
    const { position, radius_mm: radius } = found.place,
      mark = ball(position, Math.max(2 * radius, 1.5 * voxelOf(view)), kPink, 0.75);
    mark.layers.set(kPlace);
    this.place.add(mark);
  }

  /** What a picture shows beside all. Where colours are numbers, or a mesh lies beside the case, nothing is faint. */
  drawn(
    renderer: WebGLRenderer,
    scene: Scene,
    camera: Camera,
    view: Pick<View, "document" | "scene">,
  ): Omit<Drawn, "all"> {
    // nothing lies over the colours of a mesh beside the case
    const isVessel = view.document.deviations.size === 0 && this.meshes.some(mesh => mesh.visible);
    return {
      chosen:
        isVessel || this.place.children.length > 0
          ? () => {
              camera.layers.set(kPlace);
              if (isVessel) camera.layers.enable(kVessels);
              renderer.render(scene, camera);
              camera.layers.set(0);
            }
          : null,
      isRestFaint: isVessel && !colouring(view).mapped && view.document.state.meshes.length === 0,
    };
  }
}
