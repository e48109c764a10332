// SPDX-License-Identifier: Apache-2.0
// The page of one case: the turntable, and buttons that copy. Without this script its pictures are links, and what is to be copied is text.
"use strict";
(() => {
  const kDegreesPerPixel = 0.5; // of dragging: half a turn for a hand's width

  function make(name, attributes, ...children) {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.append(...children);
    return element;
  }

  /** Frames that a slider, a pointer or the arrow keys go through. */
  function turntable() {
    const links = [...document.querySelectorAll("#turn a")], shot = document.querySelector("#shot img");
    if (links.length === 0 || shot === null) return;
    const still = shot.getAttribute("src"), frames = links.map(link => link.href);
    const slider = make("input", { type: "range", min: "0", max: String(frames.length), value: "0", "aria-label": "Turn the vessels" });
    const loaded = []; // so that turning waits for nothing
    function load() {
      if (loaded.length === 0) for (const address of frames) loaded.push(Object.assign(new Image(), { src: address }));
    }
    function turn(to) {
      load();
      const n = frames.length, at = ((Math.round(to) % n) + n) % n;
      slider.value = String(at);
      slider.setAttribute("aria-valuetext", `${Math.round((360 * at) / n)} degrees`);
      shot.src = frames[at];
      shot.dataset.frame = String(at);
    }
    slider.addEventListener("input", () => turn(Number(slider.value)));
    slider.addEventListener("pointerenter", load);
    const figure = document.getElementById("shot");
    let from = null;
    figure.addEventListener("pointerdown", event => {
      if (event.button !== 0) return;
      from = { x: event.clientX, at: Number(slider.value) };
      figure.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    figure.addEventListener("pointermove", event => {
      if (from !== null) turn(from.at + ((event.clientX - from.x) * kDegreesPerPixel * frames.length) / 360);
    });
    for (const end of ["pointerup", "pointercancel"]) figure.addEventListener(end, () => { from = null; });
    figure.classList.add("turns");
    const back = make("button", { type: "button", class: "button" }, "As it was");
    back.addEventListener("click", () => { shot.src = still; slider.value = "0"; delete shot.dataset.frame; });
    document.getElementById("turn").replaceWith(make("div", { class: "turner" }, make("span", { "aria-hidden": "true" }, "Turn"), slider, back));
  }

  /** The address of the library, where the page came from a server; quotation marks of a shell cannot end in it. */
  function fillInAddress() {
    if (!/^https?:$/.test(location.protocol)) return;
    const base = new URL(document.body.dataset.root, location.href).href.replace(/\/$/, "").replaceAll("'", "%27");
    for (const block of document.querySelectorAll(".copy pre")) {
      const text = block.textContent;
      if (text.includes("\nLIBRARY='ADDRESS OF THE LIBRARY'\n")) block.textContent = text.replace("\nLIBRARY='ADDRESS OF THE LIBRARY'\n", () => `\nLIBRARY='${base}'\n`);
    }
  }

  function select(element) {
    const range = document.createRange();
    range.selectNodeContents(element);
    getSelection().removeAllRanges();
    getSelection().addRange(range);
  }

  function copyButtons() {
    for (const block of document.querySelectorAll(".copy")) {
      const text = block.querySelector("pre"), button = make("button", { type: "button", class: "button", "aria-label": `Copy ${block.dataset.name}` }, "Copy");
      button.addEventListener("click", async () => {
        try {
          await navigator.clipboard.writeText(text.textContent);
          button.textContent = "Copied";
        } catch { // pages without https may not: it is selected, so that the keys do it
          select(text);
          button.textContent = "Selected";
        }
      });
      block.append(button);
    }
  }

  /** Back to the search that led here, in this tab. */
  function wayBack() {
    try {
      const fragment = sessionStorage.getItem("lumen-gallery") ?? "";
      if (fragment !== "") document.getElementById("back").hash = fragment;
    } catch { /* a browser may forbid it: then the way back is to all cases */ }
  }

  turntable();
  wayBack();
  fillInAddress();
  copyButtons();
  document.body.dataset.ready = "";
})();
