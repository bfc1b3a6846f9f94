// SPDX-License-Identifier: Apache-2.0
// Search, menu and theme of the documents. Opened from disk, a page may not fetch: the index of the search is a script.
"use strict";
(() => {
  const root = document.documentElement;
  const kMost = 30; // results
  const kAround = 70; // characters of a result's text before and behind the word

  // ---- theme, before the first paint

  const kTheme = "phalanx.theme";
  const remembered = () => {
    try {
      return localStorage.getItem(kTheme);
    } catch {
      return null;
    }
  };
  const wish = matchMedia("(prefers-color-scheme: dark)");
  const theme = () => {
    const chosen = remembered();
    return chosen === "dark" || chosen === "light" ? chosen : wish.matches ? "dark" : "light";
  };
  const applyTheme = () => {
    root.dataset.theme = theme();
    const button = document.getElementById("theme");
    if (button) button.textContent = theme() === "dark" ? "Light" : "Dark";
  };
  applyTheme();
  wish.addEventListener("change", applyTheme);

  // ---- search

  const words = (text) => text.toLowerCase().split(/[^\p{L}\p{N}_.-]+/u).filter(Boolean);
  const escaped = (text) => text.replace(/[&<>"]/g, (sign) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[sign]);
  let lowered; // of each entry [title, heading, text] in lower case

  /// How well an entry fits; 0: a word is missing.
  function score([title, heading, text], wanted) {
    let sum = 0;
    for (const word of wanted) {
      const inHeading = heading.indexOf(word);
      const inTitle = title.indexOf(word);
      const inText = text.indexOf(word);
      if (inHeading < 0 && inTitle < 0 && inText < 0) return 0;
      if (heading === word) sum += 30;
      if (inHeading >= 0) sum += inHeading === 0 ? 16 : 12;
      if (inTitle >= 0) sum += title === word ? 12 : 5;
      if (inText >= 0) sum += 1 + 2 / (1 + inText / 200);
    }
    const phrase = wanted.join(" ");
    if (wanted.length > 1 && heading.includes(phrase)) sum += 15;
    if (wanted.length > 1 && text.includes(phrase)) sum += 6;
    return sum;
  }

  function find(query) {
    const wanted = words(query);
    const index = window.phalanxSearchIndex ?? [];
    lowered ??= index.map(([, title, , heading, text]) => [title, heading, text].map((one) => one.toLowerCase()));
    if (wanted.length === 0) return [];
    return lowered
      .map((entry, i) => ({ i, score: score(entry, wanted) }))
      .filter((one) => one.score > 0)
      .sort((a, b) => b.score - a.score || a.i - b.i)
      .slice(0, kMost)
      .map(({ i }) => ({ entry: index[i], wanted }));
  }

  const marked = (text, wanted) => {
    const pattern = new RegExp(wanted.map((word) => word.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")).join("|"), "giu");
    let html = "";
    let last = 0;
    for (const found of text.matchAll(pattern)) {
      html += escaped(text.slice(last, found.index)) + `<mark>${escaped(found[0])}</mark>`;
      last = found.index + found[0].length;
    }
    return html + escaped(text.slice(last));
  };

  function excerpt(text, wanted) {
    const low = text.toLowerCase();
    const at = Math.max(0, Math.min(...wanted.map((word) => low.indexOf(word)).filter((place) => place >= 0), text.length));
    if (at === text.length) return marked(text.slice(0, 2 * kAround), wanted);
    const from = at < kAround ? 0 : text.indexOf(" ", at - kAround) + 1;
    return (from > 0 ? "… " : "") + marked(text.slice(from, at + 2 * kAround), wanted) + (at + 2 * kAround < text.length ? " …" : "");
  }

  function resultOf({ entry: [page, title, anchor, heading, text], wanted }, number) {
    const link = document.createElement("a");
    link.href = `${root.dataset.root}${page}${anchor ? `#${anchor}` : ""}`;
    link.id = `result-${number}`;
    link.setAttribute("role", "option");
    link.innerHTML = `<b>${marked(heading, wanted)}</b>${heading === title ? "" : ` <span>${escaped(title)}</span>`}<small>${excerpt(text, wanted)}</small>`;
    return link;
  }

  function setUpSearch() {
    const field = document.getElementById("search");
    const list = document.getElementById("results");
    let chosen = -1;
    let loading = false;

    const close = () => {
      list.hidden = true;
      field.setAttribute("aria-expanded", "false");
    };
    function choose(next) {
      const all = [...list.querySelectorAll("a")];
      if (all.length === 0) return;
      chosen = (next + all.length) % all.length;
      all.forEach((one, i) => one.setAttribute("aria-selected", String(i === chosen)));
      all[chosen].scrollIntoView({ block: "nearest" });
      field.setAttribute("aria-activedescendant", all[chosen].id);
    }
    function say(text) {
      const line = document.createElement("p");
      line.textContent = text;
      list.replaceChildren(line);
    }
    function show() {
      if (field.value.trim() === "") return close();
      list.hidden = false;
      field.setAttribute("aria-expanded", "true");
      if (!window.phalanxSearchIndex) return say("Reading the index …");
      const results = find(field.value);
      if (results.length === 0) return say("No page has all of these words.");
      list.replaceChildren(...results.map(resultOf));
      choose(0);
    }
    function load() {
      if (loading) return;
      loading = true;
      const script = document.createElement("script");
      script.src = `${root.dataset.root}search_index.js`;
      script.onload = show;
      script.onerror = () => say("search_index.js is missing beside index.html.");
      document.head.append(script);
    }
    field.addEventListener("focus", load);
    field.addEventListener("input", show);
    field.addEventListener("keydown", (event) => {
      if (event.key === "ArrowDown") choose(chosen + 1);
      else if (event.key === "ArrowUp") choose(chosen - 1);
      else if (event.key === "Enter") list.querySelectorAll("a")[chosen]?.click();
      else if (event.key === "Escape") {
        field.value = "";
        close();
      } else return;
      event.preventDefault();
    });
    list.addEventListener("click", (event) => event.target.closest("a") && close());
    document.addEventListener("click", (event) => event.target.closest(".search") || close());
    document.addEventListener("keydown", (event) => {
      const typing = event.target instanceof HTMLElement && event.target.matches("input, textarea, [contenteditable]");
      if (event.key !== "/" || typing || event.ctrlKey || event.altKey || event.metaKey) return;
      field.focus();
      event.preventDefault();
    });
  }

  document.addEventListener("DOMContentLoaded", () => {
    applyTheme();
    document.getElementById("theme").addEventListener("click", () => {
      const next = theme() === "dark" ? "light" : "dark";
      try {
        localStorage.setItem(kTheme, next);
        applyTheme();
      } catch {
        root.dataset.theme = next;
      }
    });
    const menu = document.getElementById("menu");
    const button = document.getElementById("menu-button");
    const open = (on) => {
      menu.classList.toggle("open", on);
      button.setAttribute("aria-expanded", String(on));
    };
    button.addEventListener("click", () => open(!menu.classList.contains("open")));
    document.addEventListener("keydown", (event) => event.key === "Escape" && open(false));
    setUpSearch();
  });
})();
