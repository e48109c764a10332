// SPDX-License-Identifier: Apache-2.0
// The gallery of a library: search, facets, sorting, pages. Without this script the page lists all cases, page by page.
// Texts of cases become text, never markup.
"use strict";
(() => {
  const { cases, facets, ranges, orders, emptyState, parse, format, find, valuesOf, numberOr } = globalThis.lumenFacets;
  const root = document.body.dataset.root, kPerPage = Number(document.body.dataset.size), kFirstPage = Number(document.body.dataset.page);
  const kShownValues = 8; // of a facet, before somebody asks for more
  const kMostValues = 200; // and then: free texts can be as many as cases, and are searched for instead
  const kWriteAfter = 250; // ms without a change, so that typing writes one address
  let state = parse(location.hash, kFirstPage);
  const boxes = []; // of facets: {key, value, input, count, row}

  /** An element with attributes and children; texts become text. */
  function make(name, attributes = {}, ...children) {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes))
      if (value === true) element.setAttribute(key, "");
      else if (value !== false) element.setAttribute(key, value);
    element.append(...children);
    return element;
  }
  const own = text => make("bdi", {}, text); // a text that runs from right to left leaves what is around it alone
  const figure = value => value.toFixed(Math.abs(value) >= 99.95 ? 0 : Math.abs(value) >= 9.995 ? 1 : 2);
  const counted = n => `${n.toLocaleString("en")} ${n === 1 ? "case" : "cases"}`;
  const addressOf = path => path.split("/").map(encodeURIComponent).join("/");

  function card(c) {
    const shot = c.picture === "" ? make("span", { class: "none" }, "no picture")
      : make("img", { src: `${root}data/${c.id}/${addressOf(c.picture)}`, alt: "", loading: "lazy", decoding: "async", width: "500", height: "400" });
    const what = make("p", { class: "what" });
    if (c.anatomy !== "") what.append(own(c.anatomy), " · ");
    what.append(`${c.side === "not stated" ? "side not stated" : c.side} · ${c.modality === "other" ? "other source" : c.modality}`);
    const tags = make("p", { class: "tags" });
    if (c.aneurysms > 0) tags.append(make("span", { class: "tag mark" }, "aneurysm"), " ");
    tags.append(make("span", { class: "tag" }, c.synthetic ? "synthetic" : "patient"), " ", make("span", { class: "tag" }, own(c.licence)));
    return make("li", { class: "card" }, make("div", { class: "shot" }, shot),
      make("h2", {}, make("a", { href: `${root}site/case/${c.id}.html` }, own(c.title))), what,
      make("p", { class: "figures" }, make("span", {}, `${c.vessels} ${c.vessels === 1 ? "vessel" : "vessels"}`), " · ", make("span", {}, `${figure(c.length)} mm`), " · ",
        make("span", {}, `radius ${figure(c.narrowest)}–${figure(c.widest)} mm`)), tags);
  }

  // ---- pages

  function pageLink(page, text, attributes = {}) {
    const fragment = format({ ...state, page }, kFirstPage);
    return make("a", { href: `#${fragment === "" ? `page=${page}` : fragment}`, "data-page": String(page), ...attributes }, text);
  }
  function drawPages(pages) {
    const nav = document.getElementById("pages"), links = [];
    if (pages > 1) {
      if (state.page > 1) links.push(pageLink(state.page - 1, "Previous", { rel: "prev" }));
      let last = 0;
      for (let page = 1; page <= pages; ++page) {
        if (page !== 1 && page !== pages && Math.abs(page - state.page) > 2) continue;
        if (page > last + 1) links.push(make("span", { "aria-hidden": "true" }, "…"));
        links.push(pageLink(page, String(page), page === state.page ? { "aria-current": "page" } : {}));
        last = page;
      }
      if (state.page < pages) links.push(pageLink(state.page + 1, "Next", { rel: "next" }));
    }
    nav.replaceChildren(...links);
  }

  // ---- what is found

  function draw() {
    const { found, counts } = find(state), pages = Math.max(1, Math.ceil(found.length / kPerPage));
    state.page = Math.min(state.page, pages);
    const first = (state.page - 1) * kPerPage, shown = found.slice(first, first + kPerPage);
    document.getElementById("cards").replaceChildren(...shown.map(card));
    document.getElementById("count").textContent = found.length === cases.length ? counted(found.length) : `${found.length.toLocaleString("en")} of ${counted(cases.length)}`;
    document.getElementById("nothing").hidden = found.length > 0;
    document.getElementById("clear").hidden = format({ ...state, page: 1, order: "title" }, 1) === "";
    drawPages(pages);
    for (const { key, value, input, count, row } of boxes) {
      const n = counts.get(key).get(value) ?? 0;
      count.textContent = n.toLocaleString("en");
      input.checked = state.chosen.get(key).has(value);
      row.classList.toggle("empty", n === 0 && !input.checked);
    }
  }

  let writing = 0;
  /** The state has changed by hand: the first page of it is shown, and its address follows. */
  function changed({ keepPage = false } = {}) {
    if (!keepPage) state.page = 1;
    draw();
    clearTimeout(writing);
    writing = setTimeout(write, kWriteAfter);
  }
  /** Writes the state into the address, to which the way back leads. */
  function write() {
    clearTimeout(writing);
    const fragment = format(state, kFirstPage);
    try { sessionStorage.setItem("lumen-gallery", fragment); } catch { /* a browser may forbid it: then the way back is to all cases */ }
    if (fragment === location.hash.replace(/^#/, "")) return;
    history.replaceState(null, "", fragment === "" ? location.pathname + location.search : `#${fragment}`);
  }

  // ---- what is asked for

  function drawFacet(facet) {
    const values = valuesOf(facet), list = make("ul", { class: "values" }), shut = [];
    for (const value of state.chosen.get(facet.key)) if (!values.includes(value)) values.push(value); // of an address: nothing has it
    for (const [i, value] of values.slice(0, kMostValues).entries()) {
      const input = make("input", { type: "checkbox" }), count = make("span", { class: "n" });
      const row = make("li", {}, make("label", {}, input, make("span", {}, own(value)), count));
      input.addEventListener("change", () => {
        const chosen = state.chosen.get(facet.key);
        if (input.checked) chosen.add(value); else chosen.delete(value);
        changed();
      });
      if (i >= kShownValues && !state.chosen.get(facet.key).has(value)) shut.push(row);
      boxes.push({ key: facet.key, value, input, count, row });
      list.append(row);
    }
    const group = make("fieldset", { "data-facet": facet.key }, make("legend", {}, facet.title), list);
    for (const row of shut) row.hidden = true;
    if (shut.length > 0) {
      const more = make("button", { type: "button", class: "more" }, `${shut.length} more`);
      more.addEventListener("click", () => { for (const row of shut) row.hidden = false; more.remove(); shut[0].querySelector("input").focus(); });
      group.append(more);
    }
    return group;
  }

  function drawRange(range) {
    const all = cases.map(range.of).filter(value => value !== null), ends = [Math.min(...all), Math.max(...all)];
    const unit = range.unit === "" ? "" : `, ${range.unit}`;
    const inputs = ["least", "most"].map((end, i) => {
      const input = make("input", { type: "number", min: "0", step: "any", inputmode: "decimal", placeholder: all.length === 0 ? "" : figure(ends[i]), "aria-label": `${range.title}: ${end}${unit}` });
      const value = state.ranges.get(range.key)[i];
      if (value !== null) input.value = String(value);
      input.addEventListener("input", () => { state.ranges.get(range.key)[i] = numberOr(input.value); changed(); });
      return input;
    });
    return make("fieldset", { class: "range", "data-range": range.key }, make("legend", {}, `${range.title}${unit}`), inputs[0], make("span", {}, "to"), inputs[1]);
  }

  function drawSearch() {
    const search = make("input", { type: "search", id: "words", placeholder: "Title, anatomy, label, id", autocomplete: "off", spellcheck: "false" });
    search.value = state.words;
    search.addEventListener("input", () => { state.words = search.value; changed(); });
    const clear = make("button", { type: "button", id: "clear", class: "button" }, "Clear all");
    clear.addEventListener("click", () => { const { order } = state; state = { ...emptyState(1), order }; build(); changed(); document.getElementById("words").focus(); });
    const filters = make("details", { id: "filters" }, make("summary", {}, "Filter"), ...facets.map(drawFacet), ...ranges.filter(range => cases.length === 0 || cases.some(c => range.of(c) !== null)).map(drawRange));
    filters.open = matchMedia("(min-width: 52rem)").matches;
    const place = document.getElementById("find");
    place.replaceChildren(make("label", { for: "words" }, "Search"), search, clear, filters);
    place.hidden = false;
  }

  function drawBar() {
    const select = make("select", { id: "order" }, ...orders.map(o => make("option", { value: o.key }, o.title)));
    select.value = state.order;
    select.addEventListener("change", () => { state.order = select.value; changed(); });
    document.querySelector(".bar").replaceChildren(document.getElementById("count"), make("label", { for: "order" }, "Sort"), select);
    if (document.getElementById("nothing") === null)
      document.getElementById("cards").after(make("p", { id: "nothing", hidden: true }, "No case has all of this. Take a filter away, or search for fewer words."));
  }

  /** All controls, as the state is. */
  function build() {
    boxes.length = 0;
    drawSearch();
    drawBar();
  }

  document.getElementById("pages").addEventListener("click", event => {
    const link = event.target.closest("a[data-page]");
    if (link === null || event.ctrlKey || event.metaKey || event.shiftKey) return;
    event.preventDefault();
    write();
    history.pushState(null, "", link.getAttribute("href"));
    state = parse(location.hash, kFirstPage);
    draw();
    document.getElementById("cases").focus({ preventScroll: true });
    document.getElementById("cases").scrollIntoView();
  });
  const follow = () => {
    if (location.hash !== "" && !location.hash.includes("=")) return; // a place on the page
    state = parse(location.hash, kFirstPage);
    build();
    draw();
  };
  addEventListener("hashchange", follow);
  addEventListener("popstate", follow);
  addEventListener("pagehide", write);

  build();
  draw();
  document.body.dataset.ready = "";
})();
