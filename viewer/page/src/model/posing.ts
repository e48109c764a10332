// SPDX-License-Identifier: Apache-2.0
/** The time of a moving case: what the views show then, and the way back to the case at rest. */
import type { CursorPart, Part, View } from "./model";
import { namesTree } from "./performer";
import type { Tree } from "../case/tree";
import type { Operation } from "../base/types";
import { distance } from "../base/vec";

const kSame = 1e-4; // mm: a crosshair on a node

/** Operations that add to the tree or its walls, and name no part of them; those of the case at rest are meant. */
const kAtRest = new Set([
  "fit",
  "seed_add",
  "seed_move",
  "seed_delete",
  "track",
  "track_from",
  "find",
  "accept",
]);

/** Shows the case at a time of its motion, s. Tools act at rest: navigation takes the place of another. */
export function goToTime(app: Part<"document" | "motion" | "tools">, time: number): void {
  const { store } = app,
    {
      document: { tree },
      tools: { tool },
    } = store.get(),
    motion = tree?.motion ?? null;
  if (motion === null) return;
  store.set({
    motion: { time: motion.within(time) },
    tools: tool === "navigate" ? {} : { tool: "navigate", pending: [], brushLines: [], stroke: null },
  });
}

/** Shows the case at rest. A crosshair on a node stays on it. */
export function goToRest(app: CursorPart): void {
  const { store } = app,
    {
      document: { tree },
      motion: { posed },
      selection: { node },
      slices: { crosshair },
    } = store.get();
  const isOnNode = tree !== null && posed !== null && node >= 0 && node < posed.count;
  store.set({
    motion: { time: null, playing: false },
    slices:
      isOnNode && distance(posed.position(node), crosshair) < kSame ? { crosshair: tree.position(node) } : {},
  });
}

/** Whether an operation may be done now. At a time of the motion, one that changes vessels, more than their names, is not:
 * the views go back to the case at rest, which it acts on, and it waits to be asked for again. */
export function mayChange(app: CursorPart<never, "inform">, operation: Operation): boolean {
  const isAtRest = kAtRest.has(operation.op) || (namesTree(operation) && operation.op !== "rename");
  if (app.store.get().motion.time === null || !isAtRest) return true;
  goToRest(app);
  app.inform("Corrections act on the case at rest, which is shown now: once more does it.", "warning");
  return false;
}

/** Plays the motion, or stops it; false without a motion. */
export function playOrPause(app: Part<"document" | "motion" | "tools">): boolean {
  const {
      document: { tree },
      motion: { time, playing },
    } = app.store.get(),
    motion = tree?.motion ?? null;
  if (motion === null) return false;
  if (!playing && (time === null || (motion.period === null && time >= motion.end)))
    goToTime(app, motion.begin);
  app.store.set({ motion: { playing: !playing } });
  return true;
}

/** Moves tree and surface to the time of the view, and lets the time go on while it plays. */
export class Posing {
  private tree: Tree | null = null;
  private last = 0; // ms: when the time was set while it plays

  constructor(private readonly app: CursorPart<"tools", "inform">) {
    const { store } = app;
    store.watch(["document.tree"], ({ document: { tree } }) => {
      if (tree === this.tree) return;
      this.tree = tree;
      store.set({ motion: { time: null, playing: false } });
    });
    store.watch(["tools.tool"], ({ tools: { tool }, motion: { time } }) => {
      if (tool === "navigate" || time === null) return;
      goToRest(app);
      app.inform("Tools act on the case at rest, which is shown now.");
    });
    store.watch(["motion.time", "document.tree", "document.surface"], view => this.pose(view));
    store.watch(["motion.playing"], ({ motion: { playing } }) => {
      this.last = 0;
      if (playing) this.run();
    });
  }

  private pose({
    motion: { time, posed },
    document: { tree, surface },
  }: Pick<View, "document" | "motion">): void {
    const poses = time === null ? null : (tree?.motion?.at(time) ?? null);
    if (tree === null || poses === null) {
      surface?.rest();
      if (posed !== null) this.app.store.set({ motion: { posed: null } });
      return;
    }
    surface?.pose(poses, tree.centre);
    this.app.store.set({ motion: { posed: tree.posed(poses) } });
  }

  private run(): void {
    requestAnimationFrame(now => {
      const {
          motion: { playing, time },
          document: { tree },
        } = this.app.store.get(),
        motion = tree?.motion ?? null;
      if (!playing || time === null || motion === null) return;
      const passed = this.last === 0 ? 0 : (now - this.last) / 1000;
      this.last = now;
      goToTime(this.app, time + passed);
      if (motion.period === null && time + passed >= motion.end)
        this.app.store.set({ motion: { playing: false } });
      else this.run();
    });
  }
}
