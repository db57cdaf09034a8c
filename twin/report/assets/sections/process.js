/* Program beside motion: a block that is chosen shows its place in time, in the plots and beside the part. */
"use strict";

(() => {
  const box = document.querySelector(".process");
  if (!box) return;
  const run = JSON.parse(box.querySelector("[data-process]").textContent);
  const lines = [...box.querySelectorAll(".line")];
  const facts = box.querySelector(".chosen-block");
  const svg = box.querySelector("#motion");
  const highlight = svg && document.createElementNS(svg.namespaceURI, "path");
  let chosen = null;

  if (svg) {
    highlight.setAttribute("class", "chosen-span");
    svg.append(highlight);
  }

  const fixed = (value, digits) => {
    const text = value.toFixed(digits);
    return (Number(text) === 0 ? text.replace("-", "") : text).replace("-", "−");
  };
  const cell = (tag, text) => {
    const made = document.createElement(tag);
    made.textContent = text;
    return made;
  };

  /* Where a span of time lies in every plot. */
  function mark(block) {
    if (!svg) return;
    const [start, end] = run.time;
    const pieces = [];
    for (const [left, top, width, height] of run.panels) {
      for (const [from, to] of block ? block.runs : []) {
        const x = left + ((from - start) / (end - start)) * width;
        const wide = Math.max(((to - from) / (end - start)) * width, 0.25);
        pieces.push(`M${x.toFixed(3)} ${top}h${wide.toFixed(3)}v${height}h${(-wide).toFixed(3)}Z`);
      }
    }
    highlight.setAttribute("d", pieces.join(""));
  }

  function tell(line, block) {
    if (!facts) return;
    const text = line.querySelector("code").textContent.trim();
    facts.replaceChildren(cell("p", text));
    facts.firstChild.className = "text";
    if (!block) {
      facts.append(cell("p", "This block moved nothing."));
      return;
    }
    const [from, to] = [block.runs[0][0], block.runs[block.runs.length - 1][1]];
    const often = block.count > 1 ? `, ran ${block.count} times` : "";
    const sync = block.sync ? "; gear box engaged" : "";
    facts.append(cell("p", `${fixed(from, 3)} … ${fixed(to, 3)} s: ${fixed(block.duration, 3)} s${often}${sync}`));
    const table = document.createElement("table");
    const head = table.createTHead().insertRow();
    for (const word of ["axis", "from", "to", "mean speed", "following error"]) head.append(cell("th", word));
    const body = table.createTBody();
    run.axes.forEach(({ name, turns }, k) => {
      const row = body.insertRow();
      const unit = turns ? "°" : " mm";
      const speed = block.duration > 0 ? block.way[k] / block.duration : 0;
      row.append(cell("th", name));
      row.append(cell("td", fixed(block.start[k], 3) + unit), cell("td", fixed(block.end[k], 3) + unit));
      row.append(cell("td", turns ? `${fixed(speed / 6, 2)} rpm` : `${fixed(speed * 60, 1)} mm/min`));
      row.append(cell("td", turns ? `${fixed(block.error[k] * 3600, 1)}″` : `${fixed(block.error[k] * 1000, 2)} µm`));
    });
    facts.append(table);
    const area = run.areas[line.dataset.block], all = run.areas.reduce((sum, one) => sum + one, 0);
    if (area > 0) {
      const share = (100 * area) / all;
      const part = share >= 99.95 ? "all" : `${share < 0.1 ? "less than 0.1" : fixed(share, 1)} %`;
      facts.append(cell("p", `It made ${fixed(area, 1)} mm² of the finished surface, ${part} of what was cut.`));
    } else if (all > 0) {
      facts.append(cell("p", "Nothing of the finished surface is its work."));
    }
  }

  function say() {
    const block = chosen && run.blocks[chosen.dataset.block];
    const tool = block && (run.tools[block.tool] ?? Object.values(run.tools)[0]);
    const number = Number(chosen?.dataset.block);
    const detail = block ? { number, path: block.path, axis: block.axis, radius: tool?.radius, half: tool?.half } : {};
    document.dispatchEvent(new CustomEvent("hobtwin:block", { detail }));
  }

  function choose(line) {
    if (!line) return;
    chosen?.removeAttribute("aria-selected");
    chosen = line;
    line.setAttribute("aria-selected", "true");
    const listing = line.closest(".listing");
    listing.setAttribute("aria-activedescendant", line.id);
    const above = line.offsetTop - listing.offsetTop;
    if (above < listing.scrollTop || above + line.offsetHeight > listing.scrollTop + listing.clientHeight) {
      listing.scrollTop = above - listing.clientHeight / 2;
    }
    const block = run.blocks[line.dataset.block];
    mark(block);
    tell(line, block);
    say();
  }

  for (const listing of box.querySelectorAll(".listing")) {
    const own = [...listing.querySelectorAll(".line")];
    listing.addEventListener("click", (event) => choose(event.target.closest(".line")));
    listing.addEventListener("keydown", (event) => {
      const at = own.indexOf(chosen);
      const to = {
        ArrowUp: at - 1, ArrowDown: at + 1, PageUp: at - 10, PageDown: at + 10, Home: 0, End: own.length - 1,
      }[event.key];
      if (to === undefined) return;
      event.preventDefault();
      choose(own[Math.max(0, Math.min(own.length - 1, to))]);
    });
  }

  svg?.addEventListener("click", (event) => {
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    const panel = run.panels.find(([left, top, width, height]) =>
      at.x >= left && at.x <= left + width && at.y >= top && at.y <= top + height);
    if (!panel) return;
    const time = run.time[0] + ((at.x - panel[0]) / panel[2]) * (run.time[1] - run.time[0]);
    choose(lines.find((line) => run.blocks[line.dataset.block]?.runs.some(([from, to]) => from <= time && time <= to)));
  });
  document.addEventListener("hobtwin:part", say);
  document.addEventListener("hobtwin:place", ({ detail }) =>
    choose(box.querySelector(`[data-block="${detail.block}"]`)));
  /* shown first is the block that made most of the part, else the longest that moved */
  const weight = (k) => [run.areas[k] ?? 0, run.blocks[k].duration];
  const first = Object.keys(run.blocks).reduce((best, k) => {
    const [a, b] = [weight(k), best === null ? [-1, -1] : weight(best)];
    return a[0] > b[0] || (a[0] === b[0] && a[1] > b[1]) ? k : best;
  }, null);
  if (first !== null) choose(box.querySelector(`[data-block="${first}"]`));
})();
