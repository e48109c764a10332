// SPDX-License-Identifier: Apache-2.0
/** Keys that hold everywhere on the page; views and lists have their own. */
import type { Actions } from "./panels/actions";
import { kTools } from "./panels/bar";
import { trackOn } from "./tools/track_on";
import type { Hand } from "./tools/hand";
import { kLayouts, type App, type Part } from "./model/model";
import { askPosition } from "./panels/probe_line";
import { atCursor, followVessel, showAll, stepAlong, toggleHidden, toggleSolo } from "./model/selection";
import { slabKey } from "./slices/slice_controls";
import { deleteSet, hideSet } from "./model/vessel_set";
import { resetPlanes } from "./tools/slice_input";
import { renameBranch } from "./panels/vessel_detail";
import type { WorkList } from "./panels/work_list";

function typing(e: KeyboardEvent): boolean {
  const t = e.target as HTMLElement;
  return (
    t.closest("dialog") !== null ||
    t.isContentEditable ||
    t instanceof HTMLTextAreaElement ||
    t instanceof HTMLSelectElement ||
    (t instanceof HTMLInputElement && !["checkbox", "range", "color", "button"].includes(t.type))
  );
}

export function listenToKeys(app: App, actions: Actions, hand: Hand, work: WorkList): void {
  document.addEventListener("keydown", e => {
    if (e.defaultPrevented) return;
    const handled =
      e.ctrlKey || e.metaKey
        ? withControl(e, app, actions)
        : !e.altKey && !typing(e) && plain(e, app, actions, hand, work);
    if (handled) e.preventDefault();
  });
}

function withControl(e: KeyboardEvent, app: Pick<App, "source" | "perform">, actions: Actions): boolean {
  const { live } = app.source;
  switch (e.key.toLowerCase()) {
    case "z":
      if (typing(e)) return false;
      if (live) void app.perform({ op: e.shiftKey ? "redo" : "undo" });
      return live;
    case "y":
      if (typing(e)) return false;
      if (live) void app.perform({ op: "redo" });
      return live;
    case "s":
      if (live) void actions.save();
      return true;
    case "o":
      if (live) actions.open();
      return live;
    case "p":
      actions.picture();
      return true;
    case "enter":
      if (live) void app.perform({ op: "fit" });
      return live;
    default:
      return false;
  }
}

function plain(e: KeyboardEvent, app: App, actions: Actions, hand: Hand, work: WorkList): boolean {
  const { store, source } = app,
    { selected } = store.get().selection,
    key = e.shiftKey ? `Shift+${e.key.toUpperCase()}` : e.key.toLowerCase();
  const onVessel = (act: () => void): boolean => {
    if (selected >= 0) act();
    return selected >= 0;
  };
  const working = (act: () => void): boolean => {
    if (source.live) act();
    return source.live;
  };
  const tool = kTools.find(t => t.key.toLowerCase() === key && (source.live || t.live !== true));
  if (tool !== undefined) {
    actions.tool(tool.tool);
    return true;
  }
  const layout = /^[1-6]$/.test(key) ? kLayouts[Number(key) - 1] : undefined;
  if (layout !== undefined) {
    store.set({ page: { layout } });
    return true;
  }
  switch (key) {
    case "?":
    case "Shift+?":
      actions.help();
      return true;
    case "/":
      document.getElementById("tree-search")?.focus();
      return true;
    case "0":
      actions.fit();
      return true;
    case "b":
      store.set({ page: { strip: !store.get().page.strip } });
      return true;
    case "c":
      store.set({ scene: { clip: { ...store.get().scene.clip, on: !store.get().scene.clip.on } } });
      return true;
    case "\\": {
      const { left, right } = store.get().page.panels,
        open = !(left || right);
      store.set({ page: { panels: { left: open, right: open } } });
      return true;
    }
    case "l":
      store.set({
        scene: { layers: { ...store.get().scene.layers, names: !store.get().scene.layers.names } },
      });
      return true;
    case "m":
      store.set({
        scene: { cast: ({ off: "mip", mip: "volume", volume: "off" } as const)[store.get().scene.cast] },
      });
      return true;
    case "f":
      actions.fly();
      return true;
    case "h":
      return hideSet(app) || onVessel(() => toggleHidden(app, selected));
    case "o":
      return onVessel(() => toggleSolo(app, selected));
    case "Shift+H":
      showAll(app);
      return true;
    case "Shift+L":
      actions.theme();
      return true;
    case "q":
      if (store.get().slices.planes === "vessel") resetPlanes(app);
      else followVessel(app);
      return true;
    case "[":
    case "{":
    case "Shift+{":
      stepAlong(app, e.shiftKey ? -10 : -1);
      return true;
    case "]":
    case "}":
    case "Shift+}":
      stepAlong(app, e.shiftKey ? 10 : 1);
      return true;
    case "f2":
      return onVessel(() => void renameBranch(app, selected));
    case "t":
      return working(() => void app.perform({ op: "track", labels: null }));
    case "Shift+F":
      return working(() => void app.perform({ op: "find" }));
    case "k":
      return working(() => void app.perform({ op: "check" }));
    case "r":
      return working(() => void hand.askRadius());
    case "j":
      void askPosition(app);
      return true;
    case ".":
      return source.live && work.walk(1);
    case ",":
      return source.live && work.walk(-1);
    case "y":
      return source.live && (e.repeat || work.accept()); // each place is seen before a key settles it
    case "i":
      return source.live && (e.repeat || work.dismiss());
    case "delete":
      return working(
        () => deleteSet(app) || onVessel(() => void app.perform({ op: "delete", branch: selected })),
      );
    case "Shift+DELETE":
      return working(() =>
        onVessel(() => void app.perform({ op: "delete", branch: selected, hanging: "go" })),
      );
    case "Shift+X":
      return working(() => onVessel(() => atCursor(app, at => void app.perform({ op: "cut", node: at }))));
    case "enter": // without clicks that wait it presses the button that has the keys
      return store.get().tools.clicks.length > 0 && working(() => void hand.finish());
    case "escape":
      return giveUp(app, actions, hand);
    case "Shift+T":
      return working(() => void trackOn(app));
    case "Shift+A":
      return working(() => atCursor(app, node => void app.perform({ op: "node_add", node }), "adds a node"));
    case "Shift+D":
      return working(() =>
        atCursor(app, node => void app.perform({ op: "node_delete", node }), "deletes the node"),
      );
    default:
      return slabKey(app, null, key);
  }
}

function giveUp(app: Part<"document" | "tools">, actions: Actions, hand: Hand): boolean {
  const {
    tools: { pending, clicks, tool },
    document: { job },
  } = app.store.get();
  if (actions.flight.running) actions.flight.stop();
  else if (pending.length + clicks.length > 0) hand.giveUp();
  else if (job !== null) void actions.cancel();
  else if (tool !== "navigate") actions.tool("navigate");
  else return false;
  return true;
}
