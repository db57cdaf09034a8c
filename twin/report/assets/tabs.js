/* Pages of the report on a screen: one at a time, by mouse, by keys, by address. In print all follow one another. */
"use strict";

(() => {
  const tabs = [...document.querySelectorAll('[role="tab"]')];
  const panels = [...document.querySelectorAll('[role="tabpanel"]')];
  if (!tabs.length) return;

  function show(id, { focus = false } = {}) {
    for (const tab of tabs) {
      const on = tab.getAttribute("aria-controls") === id;
      tab.setAttribute("aria-selected", String(on));
      tab.tabIndex = on ? 0 : -1;
      if (on && focus) tab.focus();
    }
    for (const panel of panels) panel.classList.toggle("shown", panel.id === id);
    document.dispatchEvent(new CustomEvent("hobtwin:tab", { detail: { panel: document.getElementById(id) } }));
  }

  /* The page of the element that the address names; the first one otherwise. */
  function byAddress() {
    const named = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    const panel = (named && named.closest('[role="tabpanel"]')) || panels[0];
    show(panel.id);
    if (named && named !== panel) named.scrollIntoView();
  }

  tabs.forEach((tab, k) => {
    const id = tab.getAttribute("aria-controls");
    tab.addEventListener("click", (event) => {
      event.preventDefault();
      show(id);
      history.replaceState(null, "", `#${id}`);
    });
    tab.addEventListener("keydown", (event) => {
      const to = { ArrowLeft: k - 1, ArrowRight: k + 1, Home: 0, End: tabs.length - 1, " ": k }[event.key];
      if (to === undefined) return;
      event.preventDefault();
      const next = tabs[(to + tabs.length) % tabs.length].getAttribute("aria-controls");
      show(next, { focus: true });
      history.replaceState(null, "", `#${next}`);
    });
  });
  window.addEventListener("hashchange", byAddress);
  document.body.classList.add("tabbed");
  byAddress();
})();
