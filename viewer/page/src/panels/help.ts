// SPDX-License-Identifier: Apache-2.0
/** The help page: what keys and pointer do. */
import { h } from "../base/ui";

type Group = [string, [string, string][], "live"?];

const kGroups: Group[] = [
  [
    "Everywhere",
    [
      ["?", "This page"],
      ["Ctrl+Z, Ctrl+Shift+Z", "Undo, redo"],
      ["Ctrl+S", "Save"],
      ["Ctrl+O", "Open files, or drop them on the page; files and folders of DICOM, too"],
      ["Ctrl+P", "Save a picture of the views"],
      ["1 to 6", "Layout: four, 3D and slices, 3D, axial, coronal, sagittal"],
      ["Shift+L", "Light or dark"],
      ["B", "Strip under the views"],
      ["\\", "Fold or open both panels"],
      ["J", "Go to a place by its coordinates"],
      ["Esc", "Give up what was begun; end a flight; cancel work"],
      ["Tab", "To the next view, list or button"],
    ],
  ],
  [
    "Tools",
    [
      ["N", "Navigate"],
      ["S", "Seed"],
      ["V", "Move a node, or drag its outline to another radius"],
      ["E", "Brush: push or pull the wall; Shift+wheel makes it wider"],
      ["P", "Probe"],
      ["D", "Distance"],
      ["A", "Angle"],
      ["X", "Cross-section"],
      ["G", "Gap to the nearest vessel"],
    ],
  ],
  [
    "Slices",
    [
      ["Click, drag", "Crosshair, or what the tool does"],
      ["Wheel, Page up and down", "Through the slices"],
      ["Ctrl+wheel, + and -", "Zoom"],
      ["Shift+drag, middle", "Move"],
      ["Right drag", "Window and level"],
      ["Ctrl+drag, Ctrl+← →", "Turn the planes"],
      ["Arrows", "Crosshair by a voxel, with Shift by five"],
      ["Space, Enter", "Click at the crosshair"],
      ["7", "Plane, or slab: maximum, minimum, mean; of this slice, or of all"],
      ["8 and 9", "Slab thinner, thicker"],
      ["0, double click", "Fit"],
    ],
  ],
  [
    "3D view",
    [
      ["Drag, arrows", "Turn"],
      ["Shift+drag, Shift+arrows", "Move"],
      ["Wheel, + and -", "Nearer, farther"],
      ["Click, Enter", "Select the vessel there, or the tool"],
      ["Double click", "Turn about this point"],
      ["C", "Clip at the crosshair"],
      ["M", "Projection, volume, or neither"],
      ["Space", "Play the motion of a case that has one, or stop it"],
      ["Colour by deviation", "A mesh by its distance from the wall (Meshes)"],
      ["0", "Fit"],
    ],
  ],
  [
    "Vessels",
    [
      ["/", "Search; Enter takes the first that is found"],
      ["↑ ↓", "Select in the list"],
      ["Shift+click, Ctrl+click, Ctrl+A", "Several vessels: to there, one more or less, all that are listed"],
      ["Space", "Show or hide"],
      ["H", "Show or hide the selected, or hide those that are chosen"],
      ["O", "The selected alone"],
      ["Shift+H", "Show all"],
      ["L", "Names in the views"],
      ["F2", "Rename"],
      ["[ and ]", "Cursor along the vessel"],
      ["Q", "Slices across the vessel, or patient axes"],
      ["F", "Flight through the vessel: ↑ ↓ go, Space stops, + and - speed"],
    ],
  ],
  [
    "Work",
    [
      ["T", "Track all seeds that are placed"],
      ["Shift+F", "Find the vessels that the case lacks"],
      ["K", "Check against the volume"],
      [". and ,", "Next place of the list, and the one before"],
      ["Y", "Do what the list proposes there: track, cut, join or delete; accept a proposed vessel"],
      ["I", "Ignore the place, with a reason; reject a proposed vessel"],
      ["Enter", "Finish a vessel of several clicks; Space clicks until then"],
      ["Delete", "Delete the selected vessel, or those that are chosen"],
      ["R", "Radius of the vessel at the cursor"],
      ["Shift+X", "Cut it at the cursor"],
      ["Shift+T", "Track it on from the crosshair, or beyond its end"],
      ["Shift+A, Shift+D", "Add a node behind the cursor, delete the cursor's"],
      ["Shift+Delete", "Delete it with all that leave it"],
      ["Ctrl+Enter", "Fit all models anew"],
    ],
    "live",
  ],
];

export function openHelp(live: boolean): void {
  if (document.getElementById("help-page") !== null) return;
  const dialog = h(
    "dialog",
    { class: "dialog help", id: "help-page", "aria-label": "Help" },
    h(
      "div",
      { class: "paneltop" },
      h("h2", {}, "Help"),
      h(
        "button",
        { type: "button", class: "button", "aria-label": "Close the help", onclick: () => dialog.close() },
        "×",
      ),
    ),
    h(
      "p",
      {},
      "Positions are in millimetres, LPS: L left, R right, A front, P back, S head, I feet, of the patient. Slices are seen from the feet, from the front and from the left. Distances to the wall are negative in the lumen.",
    ),
    h(
      "div",
      { class: "columns" },
      ...kGroups
        .filter(g => live || g[2] !== "live")
        .map(([title, keys]) =>
          h(
            "section",
            {},
            h("h3", {}, title),
            h(
              "dl",
              {},
              ...keys.flatMap(([key, text]) => [h("dt", {}, h("kbd", {}, key)), h("dd", {}, text)]),
            ),
          ),
        ),
    ),
    h(
      "p",
      {},
      "The confidence of a vessel is the mean of its nodes' inlier rates, from 0 to 1: the share of the wall points measured around a node that lie on its cylinder.",
    ),
    h("p", { class: "hint" }, "Not a medical device: not for clinical use."),
  );
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}
