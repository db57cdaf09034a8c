/* Runs viewer.js against a page and a WebGL that only write down what they are given. */
const fs = require("node:fs");
const [script, input, output] = process.argv.slice(2);
const { header, data } = JSON.parse(fs.readFileSync(input));

const uploads = [];
const gl = new Proxy({}, {
  get: (_, name) => {
    if (name === "bufferData") return (_target, array) => uploads.push(Array.from(array));
    if (/^[A-Z0-9_]+$/.test(name)) return name;
    return () => true;
  },
});
const element = () => new Proxy({ style: {}, dataset: {}, classList: { add: (name) => finish(name) } }, {
  get: (target, name) => (name in target ? target[name] : () => {}),
  set: (target, name, value) => { target[name] = value; return true; },
});
const reason = {};
const known = {
  canvas: Object.assign(element(), { getContext: () => gl }),
  "[data-header]": { textContent: JSON.stringify(header) },
  "[data-mesh]": { textContent: data },
  "[data-colour]": null,
  ".reason": reason,
};
const stage = Object.assign(element(), {
  querySelector: (selector) => (selector in known ? known[selector] : element()),
});
const box = Object.assign(element(), {
  querySelectorAll: () => [],
  querySelector: (selector) => (selector === ".stage" ? stage : selector in known ? known[selector] : element()),
});
function finish(name) {
  if (name !== "ready") {
    setTimeout(() => { console.error(reason.textContent); process.exit(1); });
    return;
  }
  const [positions, normals, colours, triangles] = uploads;
  fs.writeFileSync(output, JSON.stringify({ positions, normals, colours, triangles }));
}
globalThis.CustomEvent = class {};
globalThis.document = {
  dispatchEvent: () => {},
  querySelectorAll: () => [box], createElement: element, addEventListener: () => {}, getElementById: () => null,
};
globalThis.IntersectionObserver = class {
  constructor(seen) { this.seen = seen; }
  observe() { this.seen([{ isIntersecting: true }], this); }
  disconnect() {}
};
globalThis.ResizeObserver = class { observe() {} };
globalThis.requestAnimationFrame = () => 0;
globalThis.window = {};
require(script);
