/* One tooth or face of the small multiples enlarged: chosen by click, by arrow keys, by the buttons. */
"use strict";

(() => {
  const chart = document.getElementById("maps-chart");
  if (!chart) return;
  const svg = chart.querySelector("svg");
  const tiles = JSON.parse(chart.querySelector("[data-tiles]").textContent);
  const lenses = [...document.querySelectorAll(".lens")];
  const names = [...new Set(tiles.map((tile) => tile.name))];
  const marks = lenses.map(() => {
    const mark = document.createElementNS(svg.namespaceURI, "rect");
    mark.setAttribute("class", "chosen");
    svg.append(mark);
    return mark;
  });
  const TALL = 300; /* of the enlarged map [pixels] */
  let chosen = 0;

  const images = [...svg.querySelectorAll("image")];
  const holding = ([left, top, width, height]) => images.find((image) => {
    const [x, y, w, h] = ["x", "y", "width", "height"].map((name) => Number(image.getAttribute(name)));
    return left >= x - 0.01 && left + width <= x + w + 0.01 && top >= y - 0.01 && top + height <= y + h + 0.01;
  });

  function choose(k) {
    chosen = (k + names.length) % names.length;
    document.querySelector(".lens-head [data-name]").textContent = names[chosen];
    lenses.forEach((lens, n) => {
      const tile = tiles.find((each) => each.row === lens.dataset.row && each.name === names[chosen]);
      const [left, top, width, height] = tile.box;
      const view = lens.querySelector("svg");
      view.setAttribute("viewBox", `${left} ${top} ${width} ${height}`);
      view.style.aspectRatio = `${width} / ${height}`;
      view.style.width = `${Math.max((TALL * width) / height, 120)}px`;
      view.replaceChildren(holding(tile.box).cloneNode());
      ["x", "y", "width", "height"].forEach((name, i) => marks[n].setAttribute(name, tile.box[i]));
    });
    chart.dataset.chosen = names[chosen];
  }

  svg.addEventListener("click", (event) => {
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    const hit = tiles.find(({ box: [left, top, width, height] }) =>
      at.x >= left && at.x <= left + width && at.y >= top && at.y <= top + height);
    if (!hit) return;
    choose(names.indexOf(hit.name));
    document.dispatchEvent(new CustomEvent("hobtwin:flank", { detail: hit }));
  });
  chart.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    choose(chosen + step);
  });
  for (const button of document.querySelectorAll(".lens-head [data-step]")) {
    button.addEventListener("click", () => choose(chosen + Number(button.dataset.step)));
  }
  choose(0);
})();
