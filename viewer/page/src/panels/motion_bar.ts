// SPDX-License-Identifier: Apache-2.0
/** The bar of a case that moves, in the 3D view: play, a slider over the time, its number, and the case at rest. */
import type { CursorPart } from "../model/model";
import { goToRest, goToTime, playOrPause } from "../model/posing";
import { button, h, icon, slider } from "../base/ui";

const kSteps = 500, // of the slider
  kDigits = 3; // of a time in s

export function motionBar(app: CursorPart<"tools">): HTMLElement {
  const { store } = app;
  const play = button({ id: "motion-play", label: "Play the motion", key: "Space", icon: "play" }, () =>
      playOrPause(app),
    ),
    at = slider("motion-slider", "Time of the motion, s", [0, 1, 0.001], 0, value => set(value)),
    number = h("input", {
      type: "number",
      id: "motion-time",
      "aria-label": "Time, s",
      title: "Time of the motion, s",
      placeholder: "rest",
    }),
    rest = button(
      {
        id: "motion-rest",
        text: "Rest",
        label: "Show the case at rest, on which tools and corrections act",
        pressed: true,
        class: "button text",
      },
      () => goToRest(app),
    ),
    hint = h("span", { class: "hint", id: "motion-hint" });
  const set = (time: number): void => {
    store.set({ motion: { playing: false } });
    goToTime(app, time);
  };
  number.addEventListener("change", () => {
    if (number.value.trim() === "") goToRest(app);
    else if (Number.isFinite(Number(number.value))) set(Number(number.value));
  });
  const bar = h(
    "div",
    { class: "motion", id: "motion", role: "group", "aria-label": "Motion of the case" },
    h("div", { class: "row" }, play, at, h("label", {}, number, " s"), rest),
    hint,
  );
  store.watch(["document.tree"], ({ document: { tree } }) => {
    const motion = tree?.motion ?? null;
    bar.hidden = motion === null;
    if (motion === null) return;
    at.min = String(motion.begin);
    at.max = String(motion.end);
    at.step = String((motion.end - motion.begin) / kSteps || 1);
    number.step = String(Number(((motion.end - motion.begin) / 100).toPrecision(1)) || 1);
  });
  store.watch(["motion.playing"], ({ motion: { playing } }) => {
    const label = playing ? "Stop the motion" : "Play the motion";
    play.replaceChildren(icon(playing ? "pause" : "play"));
    play.setAttribute("aria-label", label);
    play.title = `${label}  (Space)`;
  });
  store.watch(
    ["motion.time", "document.tree", "document.volume"],
    ({ motion: { time }, document: { tree, volume } }) => {
      const motion = tree?.motion ?? null;
      if (motion === null) return;
      at.value = String(time ?? motion.begin);
      at.setAttribute("aria-valuetext", time === null ? "at rest" : `${time.toFixed(kDigits)} s`);
      if (document.activeElement !== number || time === null)
        number.value = time === null ? "" : time.toFixed(kDigits);
      rest.setAttribute("aria-pressed", String(time === null));
      hint.textContent =
        time === null ? "" : `Tools act at rest${volume === null ? "" : "; the volume does not move"}.`;
    },
  );
  return bar;
}
