/* The part in the page: unpacks the mesh (format: twin/report/payload.py) and turns it with mouse or fingers. */
"use strict";

(() => {
  /* ---------- unpacking ---------- */

  async function inflate(base64) {
    const text = atob(base64);
    const bytes = new Uint8Array(text.length);
    for (let k = 0; k < text.length; k++) bytes[k] = text.charCodeAt(k);
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  function joinPlanes(bytes, start, count) {
    const values = new Uint32Array(count);
    for (let plane = 0; plane < 4; plane++) {
      const from = start + plane * count;
      for (let k = 0; k < count; k++) values[k] |= bytes[from + k] << (8 * plane);
    }
    return values;
  }

  function unpack(bytes, header) {
    const n = header.vertices, corners = 3 * header.triangles;
    const steps = joinPlanes(bytes, 0, 3 * n);
    const positions = new Float32Array(3 * n);
    for (let axis = 0; axis < 3; axis++) {
      for (let k = 0, at = 0; k < n; k++) {
        const zigzag = steps[axis * n + k];
        at += (zigzag >>> 1) ^ -(zigzag & 1);
        positions[3 * k + axis] = header.originMm[axis] + at * header.stepMm;
      }
    }
    const below = joinPlanes(bytes, 12 * n, corners);
    const triangles = new Uint32Array(corners);
    let next = 0;
    for (let k = 0; k < corners; k++) {
      triangles[k] = next - below[k];
      if (below[k] === 0) next++;
    }
    const first = 12 * n + 4 * corners, colours = bytes.subarray(first, first + n);
    const low = bytes.subarray(first + n), high = low.subarray(header.triangles);
    const blocks = Uint16Array.from({ length: header.triangles }, (_, t) => low[t] | (high[t] << 8));
    return { positions, triangles, colours, blocks };
  }

  /* Mean of the adjoining facets by their angle at the vertex. */
  function vertexNormals(positions, triangles) {
    const normals = new Float32Array(positions.length);
    const p = [0, 0, 0], e = [new Float64Array(3), new Float64Array(3), new Float64Array(3)], m = new Float64Array(3);
    for (let t = 0; t < triangles.length; t += 3) {
      for (let k = 0; k < 3; k++) p[k] = 3 * triangles[t + k];
      for (let k = 0; k < 3; k++) {
        for (let i = 0; i < 3; i++) e[k][i] = positions[p[(k + 1) % 3] + i] - positions[p[k] + i];
      }
      for (let i = 0; i < 3; i++) {
        m[i] = e[0][(i + 1) % 3] * e[1][(i + 2) % 3] - e[0][(i + 2) % 3] * e[1][(i + 1) % 3];
      }
      const area = Math.hypot(m[0], m[1], m[2]);
      if (!(area > 0)) continue;
      for (let k = 0; k < 3; k++) {
        const a = e[k], b = e[(k + 2) % 3];
        const angle = Math.atan2(area, -(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]));
        for (let i = 0; i < 3; i++) normals[p[k] + i] += (m[i] / area) * angle;
      }
    }
    for (let k = 0; k < normals.length; k += 3) {
      const length = Math.hypot(normals[k], normals[k + 1], normals[k + 2]) || 1;
      for (let i = 0; i < 3; i++) normals[k + i] /= length;
    }
    return normals;
  }

  /* Give a corner its own vertex where its facet meets others at a sharp edge, or is not measured as they are. */
  function splitEdges({ positions, triangles, colours, blocks }) {
    const normals = vertexNormals(positions, triangles);
    const n = colours.length, corners = Uint32Array.from(triangles);
    const extra = { positions: [], normals: [], colours: [] };
    const a = [0, 0, 0], b = [0, 0, 0], m = [0, 0, 0];
    for (let t = 0; t < triangles.length; t += 3) {
      const [p, q, r] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
      for (let i = 0; i < 3; i++) {
        a[i] = positions[q + i] - positions[p + i];
        b[i] = positions[r + i] - positions[p + i];
      }
      for (let i = 0; i < 3; i++) m[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
      const area = Math.hypot(m[0], m[1], m[2]) || 1;
      const measured = colours[p / 3] && colours[q / 3] && colours[r / 3];
      for (let k = 0; k < 3; k++) {
        const v = triangles[t + k];
        const cosine = (m[0] * normals[3 * v] + m[1] * normals[3 * v + 1] + m[2] * normals[3 * v + 2]) / area;
        const sharp = cosine < 0.966, unlike = !measured && colours[v] > 0;
        if (!sharp && !unlike) continue;
        corners[t + k] = n + extra.colours.length;
        for (let i = 0; i < 3; i++) {
          extra.positions.push(positions[3 * v + i]);
          extra.normals.push(sharp ? m[i] / area : normals[3 * v + i]);
        }
        extra.colours.push(unlike ? 0 : colours[v]);
      }
    }
    const join = (Kind, first, second) => {
      const all = new Kind(first.length + second.length);
      all.set(first);
      all.set(second, first.length);
      return all;
    };
    return {
      positions: join(Float32Array, positions, extra.positions),
      normals: join(Float32Array, normals, extra.normals),
      colours: join(Uint8Array, colours, extra.colours),
      triangles: corners,
      blocks,
    };
  }

  /* ---------- drawing ---------- */

  const VERTEX = `#version 300 es
    layout(location = 0) in vec3 position;
    layout(location = 1) in vec3 normal;
    layout(location = 2) in float colour;
    uniform mat3 turn;
    uniform vec3 centre;
    uniform vec3 scale;
    uniform vec2 shift;
    out vec3 turned;
    out vec2 onScreen;
    out float index;
    void main() {
      vec3 p = turn * (position - centre);
      gl_Position = vec4(p.xy * scale.xy + shift, -p.z * scale.z, 1.0);
      turned = turn * normal;
      onScreen = gl_Position.xy;
      index = colour;
    }`;

  const FRAGMENT = `#version 300 es
    precision highp float;
    in vec3 turned;
    in vec2 onScreen;
    in float index;
    uniform sampler2D palette;
    uniform bool coloured;
    uniform bool reading;
    uniform vec4 paint; /* over everything, where it is not transparent */
    out vec4 colour;

    /* turned steel under two soft boxes: the function "steel" of twin/report/pictures.py */
    float steel(vec3 n) {
      float key = clamp(dot(n, vec3(-0.45, 0.65, 0.61)), 0.0, 1.0);
      float fill = clamp(dot(n, vec3(0.87, 0.05, 0.49)), 0.0, 1.0);
      float strip = exp(-pow((n.y - 0.40 + 0.3 * n.x) / 0.20, 2.0));
      return 0.42 + 0.46 * key + 0.34 * fill * fill + 0.26 * strip + 0.45 * pow(key, 12.0);
    }

    void main() {
      if (reading) {
        colour = vec4(index / 255.0, 1.0, 0.0, 1.0);
        return;
      }
      bool shown = coloured && index > 0.5;
      vec3 base = texture(palette, vec2(((shown ? index : 0.0) + 0.5) / 256.0, 0.5)).rgb;
      if (paint.a > 0.0) { shown = true; base = paint.rgb; }
      float shade = steel(normalize(turned)) * (1.0 + 0.08 * (onScreen.y - onScreen.x));
      colour = vec4(min(base * (shown ? 0.35 + 0.65 * shade : shade), 1.0), 1.0);
    }`;

  /* the tool's way and outline beside the part: lines of one colour */
  const LINE_VERTEX = `#version 300 es
    layout(location = 0) in vec3 position;
    uniform mat3 turn;
    uniform vec3 centre;
    uniform vec3 scale;
    uniform vec2 shift;
    void main() {
      vec3 p = turn * (position - centre);
      gl_Position = vec4(p.xy * scale.xy + shift, -p.z * scale.z, 1.0);
    }`;

  const LINE_FRAGMENT = `#version 300 es
    precision mediump float;
    uniform vec4 ink;
    out vec4 colour;
    void main() { colour = ink; }`;

  function program(gl, vertex, fragment) {
    const built = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(built, shader);
    }
    gl.linkProgram(built);
    if (!gl.getProgramParameter(built, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(built));
    return built;
  }

  function fill(gl, target, data) {
    const buffer = gl.createBuffer();
    gl.bindBuffer(target, buffer);
    gl.bufferData(target, data, gl.STATIC_DRAW);
    return buffer;
  }

  function upload(gl, mesh, paletteBytes) {
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    const attributes = [
      [mesh.positions, 3, gl.FLOAT],
      [mesh.normals, 3, gl.FLOAT],
      [mesh.colours, 1, gl.UNSIGNED_BYTE],
    ];
    attributes.forEach(([data, size, type], location) => {
      fill(gl, gl.ARRAY_BUFFER, data);
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, size, type, false, 0, 0);
    });
    const whole = fill(gl, gl.ELEMENT_ARRAY_BUFFER, mesh.triangles);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, 256, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, paletteBytes);
    for (const [name, value] of [
      [gl.TEXTURE_MIN_FILTER, gl.NEAREST], [gl.TEXTURE_MAG_FILTER, gl.NEAREST],
      [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE],
    ]) gl.texParameteri(gl.TEXTURE_2D, name, value);
    return { array, whole };
  }

  const PATCH = [0.2, 0.68, 0.42, 1], UNPAINTED = [0, 0, 0, 0];

  /* The triangles that one block cut, drawn once more over the part. */
  function painter(gl, mesh) {
    const buffer = gl.createBuffer();
    let count = 0;
    return {
      /* number of the block in the payload; 0 = none */
      set(number) {
        const chosen = [];
        if (number) mesh.blocks.forEach((block, t) => { if (block === number) chosen.push(t); });
        const corners = new Uint32Array(3 * chosen.length);
        chosen.forEach((t, k) => corners.set(mesh.triangles.subarray(3 * t, 3 * t + 3), 3 * k));
        count = corners.length;
        gl.bindVertexArray(null);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, gl.DYNAMIC_DRAW);
      },
      /* after the part, with its vertices and program in use */
      draw(paint) {
        if (!count) return;
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
        gl.uniform4fv(paint, PATCH);
        gl.depthFunc(gl.LEQUAL);
        gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0);
        gl.depthFunc(gl.LESS);
        gl.uniform4fv(paint, UNPAINTED);
      },
    };
  }

  /* Triangle under a place of the canvas [-1 … 1], nearest to the eye; -1 = none. */
  function pick({ positions, triangles }, x, y, turn, centre, scale, shift) {
    const n = positions.length / 3, seen = new Float32Array(3 * n);
    for (let k = 0; k < n; k++) {
      const p = [0, 1, 2].map((i) => positions[3 * k + i] - centre[i]);
      seen[3 * k] = (turn[0] * p[0] + turn[3] * p[1] + turn[6] * p[2]) * scale[0] + shift[0] - x;
      seen[3 * k + 1] = (turn[1] * p[0] + turn[4] * p[1] + turn[7] * p[2]) * scale[1] + shift[1] - y;
      seen[3 * k + 2] = turn[2] * p[0] + turn[5] * p[1] + turn[8] * p[2];
    }
    let found = -1, nearest = -Infinity;
    for (let t = 0; t < triangles.length; t += 3) {
      const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
      /* shares of the corners in the point, times the area */
      const u = seen[b] * seen[c + 1] - seen[c] * seen[b + 1];
      const v = seen[c] * seen[a + 1] - seen[a] * seen[c + 1];
      const w = seen[a] * seen[b + 1] - seen[b] * seen[a + 1];
      if (u < 0 || v < 0 || w < 0 || !(u + v + w > 0)) continue;
      const depth = (u * seen[a + 2] + v * seen[b + 2] + w * seen[c + 2]) / (u + v + w);
      if (depth > nearest) [nearest, found] = [depth, t / 3];
    }
    return found;
  }

  /* Draws what `set` was given last: strips of points [x, y, z], each with its colour. */
  function lines(gl, centre) {
    const built = program(gl, LINE_VERTEX, LINE_FRAGMENT);
    const uniform = (name) => gl.getUniformLocation(built, name);
    const places = Object.fromEntries(["turn", "centre", "scale", "shift", "ink"].map((name) => [name, uniform(name)]));
    const array = gl.createVertexArray(), buffer = gl.createBuffer();
    let strips = [];
    return {
      set(given) {
        strips = given.filter(({ points }) => points.length > 1);
        gl.bindVertexArray(array);
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(strips.flatMap(({ points }) => points.flat())), gl.STATIC_DRAW);
        gl.enableVertexAttribArray(0);
        gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
      },
      draw(turn, scale, shift) {
        if (!strips.length) return;
        gl.useProgram(built);
        gl.bindVertexArray(array);
        gl.uniformMatrix3fv(places.turn, false, turn);
        gl.uniform3fv(places.centre, centre);
        gl.uniform3fv(places.scale, scale);
        gl.uniform2fv(places.shift, shift);
        let first = 0;
        for (const { points, ink } of strips) {
          gl.uniform4fv(places.ink, ink);
          gl.drawArrays(gl.LINE_STRIP, first, points.length);
          first += points.length;
        }
      },
    };
  }

  function bounds(positions) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let k = 0; k < positions.length; k++) {
      const axis = k % 3;
      if (positions[k] < low[axis]) low[axis] = positions[k];
      if (positions[k] > high[axis]) high[axis] = positions[k];
    }
    const centre = low.map((value, k) => (value + high[k]) / 2);
    let radius = 0;
    for (let k = 0; k < positions.length; k += 3) {
      radius = Math.max(radius, Math.hypot(positions[k] - centre[0], positions[k + 1] - centre[1], positions[k + 2] - centre[2]));
    }
    return { centre, radius: radius || 1 };
  }

  /* ---------- the view: azimuth and elevation of the eye, part axis upright ---------- */

  const VIEWS = {
    isometric: { azimuth: -51.3, elevation: 32 },
    front: { azimuth: -90, elevation: 90 },
    side: { azimuth: -90, elevation: 0 },
  };

  function turnMatrix({ azimuth, elevation }) {
    const a = (azimuth * Math.PI) / 180, e = (elevation * Math.PI) / 180;
    const [ca, sa, ce, se] = [Math.cos(a), Math.sin(a), Math.cos(e), Math.sin(e)];
    /* columns, as WebGL reads them: rows are right, up, towards the eye */
    return [-sa, -se * ca, ce * ca, ca, -se * sa, ce * sa, 0, ce, se];
  }

  const LEGIBLE = 5; /* pixels a mm below which numbers would run into one another */

  /* Numbers on the front face, there while it is turned to the eye. */
  function numbering(box, labels) {
    const spans = labels.map(([text]) => {
      const span = document.createElement("span");
      span.textContent = text;
      box.append(span);
      return span;
    });
    return (turn, centre, scale, shift, width, height) => {
      box.hidden = turn[8] < 0.15 || (scale[0] * width) / 2 < LEGIBLE;
      labels.forEach(([, ...at], k) => {
        const p = at.map((value, i) => value - centre[i]);
        const x = (turn[0] * p[0] + turn[3] * p[1] + turn[6] * p[2]) * scale[0] + shift[0];
        const y = (turn[1] * p[0] + turn[4] * p[1] + turn[7] * p[2]) * scale[1] + shift[1];
        spans[k].style.transform =
          `translate(${((x + 1) * width) / 2}px, ${((1 - y) * height) / 2}px) translate(-50%, -50%)`;
      });
    };
  }

  function start(gl, canvas, mesh, scale, tip, number) {
    const built = program(gl, VERTEX, FRAGMENT);
    const { centre, radius } = bounds(mesh.positions);
    const uniform = (name) => gl.getUniformLocation(built, name);
    const places = Object.fromEntries(
      ["turn", "centre", "scale", "shift", "coloured", "reading", "paint"].map((name) => [name, uniform(name)]));
    const view = { ...VIEWS.isometric, zoom: 1, x: 0, y: 0, coloured: true, beside: false };
    let waiting = false, reach = radius, aside = [0, 0, 0];

    const { array, whole } = upload(gl, mesh, scale.palette);
    const beside = lines(gl, centre), patch = painter(gl, mesh);
    gl.useProgram(built);
    gl.enable(gl.DEPTH_TEST);

    const probe = gl.createFramebuffer();
    const texel = gl.createRenderbuffer(), texelDepth = gl.createRenderbuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, probe);
    for (const [buffer, format, slot] of [
      [texel, gl.RGBA8, gl.COLOR_ATTACHMENT0], [texelDepth, gl.DEPTH_COMPONENT16, gl.DEPTH_ATTACHMENT],
    ]) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, 1, 1);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, slot, gl.RENDERBUFFER, buffer);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);

    /* with the tool beside the part there is room for both, but the part stays to be seen */
    const fitted = () => (view.beside ? Math.min(0.5 * (radius + reach), 1.7 * radius) : radius);
    const perMm = () => (0.92 * view.zoom * Math.min(canvas.width, canvas.height)) / (2 * fitted());

    /* How the part stands before the eye: turned, scaled, moved. */
    function stance() {
      const k = perMm(), turn = turnMatrix(view), zoom = [(2 * k) / canvas.width, (2 * k) / canvas.height];
      /* what lies between part and tool stands in the middle */
      const across = [0, 1].map((i) => turn[i] * aside[0] + turn[3 + i] * aside[1] + turn[6 + i] * aside[2]);
      const shift = [view.x, view.y].map((by, i) => (view.beside ? by - across[i] * zoom[i] : by));
      return { turn, zoom, shift };
    }

    function render(reading) {
      const { turn, zoom, shift } = stance();
      const deep = 0.99 / (view.beside ? Math.max(radius, reach) : radius);
      gl.useProgram(built);
      gl.bindVertexArray(array);
      gl.uniform3fv(places.centre, centre);
      gl.uniformMatrix3fv(places.turn, false, turn);
      gl.uniform3f(places.scale, ...zoom, deep);
      gl.uniform2fv(places.shift, shift);
      gl.uniform1i(places.coloured, view.coloured && !view.beside ? 1 : 0);
      gl.uniform1i(places.reading, reading ? 1 : 0);
      gl.clearColor(0, 0, 0, 0);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, whole);
      gl.drawElements(gl.TRIANGLES, mesh.triangles.length, gl.UNSIGNED_INT, 0);
      if (view.beside && !reading) patch.draw(places.paint);
      if (view.beside && !reading) beside.draw(turn, [...zoom, deep], shift);
      if (!reading) number(turn, centre, zoom, shift, canvas.clientWidth, canvas.clientHeight);
    }

    function draw() {
      waiting = false;
      if (!canvas.clientWidth) return; /* on a page that is not shown */
      const ratio = Math.min(window.devicePixelRatio || 1, 2);
      const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
      const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
      if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
      gl.viewport(0, 0, width, height);
      render(false);
      canvas.dataset.drawn = "yes";
    }

    function redraw() {
      if (!waiting) requestAnimationFrame(draw);
      waiting = true;
    }

    /* Deviation under the pointer: that one pixel is drawn once more, with the index as its colour. */
    function read(x, y) {
      const ratio = canvas.width / canvas.clientWidth;
      const pixel = new Uint8Array(4);
      gl.bindFramebuffer(gl.FRAMEBUFFER, probe);
      gl.viewport(-Math.floor(x * ratio), -Math.floor(canvas.height - y * ratio), canvas.width, canvas.height);
      render(true);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
      return pixel;
    }

    function show(x, y) {
      const [index, hit] = scale.limitUm ? read(x, y) : [0, 0];
      tip.hidden = !(hit && index);
      if (tip.hidden) return;
      const um = ((index - 128) / 127) * scale.limitUm;
      const ends = index === 1 ? "≤ " : index === 255 ? "≥ " : "";
      const text = Math.abs(um).toFixed(scale.limitUm < 20 ? 1 : 0);
      tip.textContent = `${ends}${um < 0 ? "−" : "+"}${text} µm`;
      tip.style.transform = `translate(${x + 14}px, ${y - 10}px)`;
    }

    /* Beside the program a click chooses the block that cut there. */
    function choose(x, y) {
      if (!view.beside) return;
      const { turn, zoom, shift } = stance();
      const place = [(2 * x) / canvas.clientWidth - 1, 1 - (2 * y) / canvas.clientHeight];
      const number = mesh.blocks[pick(mesh, ...place, turn, centre, zoom, shift)];
      if (number) document.dispatchEvent(new CustomEvent("hobtwin:place", { detail: { block: number - 1 } }));
    }

    control(canvas, view, redraw, { show, hide: () => { tip.hidden = true; }, choose });
    new ResizeObserver(redraw).observe(canvas);
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    redraw();

    /* Strips of points beside the part, whose reach decides the room they get, and the block that is painted. */
    function put(strips, block) {
      beside.set(strips);
      patch.set(block);
      reach = radius;
      aside = [0, 0, 0];
      const at = strips.at(-1)?.points.at(-1);
      if (at) {
        const off = at.map((x, i) => x - centre[i]), far = Math.hypot(...off) || 1;
        aside = off.map((x) => (x / far) * Math.min(0.5 * far, 0.8 * radius));
      }
      for (const { points } of strips) {
        for (const p of points) reach = Math.max(reach, Math.hypot(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]));
      }
      redraw();
    }
    return { view, redraw, put };
  }

  /* ---------- mouse, fingers, keys ---------- */

  const STILL = 4; /* pixels that a pointer may move while it clicks */

  function control(canvas, view, redraw, { show, hide, choose }) {
    const pointers = new Map();
    let pending = 0, pressed = null;

    const turn = (dx, dy) => {
      view.azimuth -= 0.4 * dx;
      view.elevation = Math.max(-90, Math.min(90, view.elevation + 0.4 * dy));
    };
    const pan = (dx, dy) => {
      view.x += (2 * dx) / canvas.clientWidth;
      view.y -= (2 * dy) / canvas.clientHeight;
    };
    const zoomAt = (x, y, factor) => {
      const to = Math.max(0.3, Math.min(200, view.zoom * factor)), by = to / view.zoom;
      const at = [(2 * x) / canvas.clientWidth - 1, 1 - (2 * y) / canvas.clientHeight];
      view.x = at[0] + (view.x - at[0]) * by;
      view.y = at[1] + (view.y - at[1]) * by;
      view.zoom = to;
    };
    const spot = (event) => {
      const box = canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    const span = ([a, b]) => ({
      x: (a[0] + b[0]) / 2, y: (a[1] + b[1]) / 2, reach: Math.hypot(a[0] - b[0], a[1] - b[1]) || 1,
    });

    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, spot(event));
      pressed = pointers.size === 1 && event.button === 0 ? spot(event) : null;
      hide();
    });
    canvas.addEventListener("pointermove", (event) => {
      const now = spot(event);
      if (!pointers.has(event.pointerId)) {
        cancelAnimationFrame(pending);
        pending = requestAnimationFrame(() => show(...now));
        return;
      }
      const before = pointers.get(event.pointerId);
      if (pointers.size === 2) {
        const was = span([...pointers.values()]);
        pointers.set(event.pointerId, now);
        const is = span([...pointers.values()]);
        pan(is.x - was.x, is.y - was.y);
        zoomAt(is.x, is.y, is.reach / was.reach);
      } else {
        pointers.set(event.pointerId, now);
        (event.buttons & 2 || event.shiftKey ? pan : turn)(now[0] - before[0], now[1] - before[1]);
      }
      redraw();
    });
    canvas.addEventListener("pointerup", (event) => {
      const at = spot(event);
      if (pressed && Math.hypot(at[0] - pressed[0], at[1] - pressed[1]) < STILL) choose(...at);
      pressed = null;
    });
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
    }
    canvas.addEventListener("pointerleave", () => { cancelAnimationFrame(pending); hide(); });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      hide();
      zoomAt(...spot(event), Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015)));
      redraw();
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const middle = [canvas.clientWidth / 2, canvas.clientHeight / 2];
      const act = {
        ArrowLeft: () => turn(-20, 0), ArrowRight: () => turn(20, 0),
        ArrowUp: () => turn(0, -20), ArrowDown: () => turn(0, 20),
        "+": () => zoomAt(...middle, 1.25), "-": () => zoomAt(...middle, 0.8),
      }[event.key];
      if (!act) return;
      event.preventDefault();
      act();
      redraw();
    });
  }

  /* ---------- the page ---------- */

  /* Circles about the tool at both its ends, and its way; null in the way is a gap. */
  function toolStrips({ path, axis, radius, half }) {
    const way = [[]];
    for (const point of path) point ? way[way.length - 1].push(point) : way.push([]);
    const strips = way.map((points) => ({ points, ink: [0.11, 0.53, 0.3, 1] }));
    const at = path[path.length - 1];
    if (!at || !radius) return strips;
    const u = Math.abs(axis[2]) < 0.9 ? [axis[1], -axis[0], 0] : [0, axis[2], -axis[1]];
    const size = Math.hypot(...u);
    const e = u.map((x) => x / size);
    const f = [axis[1] * e[2] - axis[2] * e[1], axis[2] * e[0] - axis[0] * e[2], axis[0] * e[1] - axis[1] * e[0]];
    const circle = (along) => Array.from({ length: 73 }, (_, k) => {
      const c = Math.cos((k * Math.PI) / 36) * radius, s = Math.sin((k * Math.PI) / 36) * radius;
      return at.map((x, i) => x + axis[i] * along + e[i] * c + f[i] * s);
    });
    const ends = half ? [circle(-half), circle(half)] : [circle(0)];
    for (const points of ends) strips.push({ points, ink: [0.35, 0.42, 0.5, 1] });
    if (half) for (let k = 0; k < 72; k += 9) strips.push({ points: [ends[0][k], ends[1][k]], ink: [0.35, 0.42, 0.5, 0.6] });
    return strips;
  }

  function connect(box, canvas, { view, redraw, put }) {
    for (const button of box.querySelectorAll("[data-view]")) {
      button.addEventListener("click", () => {
        Object.assign(view, VIEWS[button.dataset.view], { zoom: 1, x: 0, y: 0 });
        redraw();
      });
    }
    const colour = box.querySelector("[data-colour]");
    colour?.addEventListener("change", () => {
      view.coloured = colour.checked;
      redraw();
    });
    /* a flank that was chosen among the maps is turned to the eye */
    document.addEventListener("hobtwin:flank", ({ detail }) => {
      Object.assign(view, { azimuth: detail.direction, elevation: 25, x: 0, y: 0 });
      redraw();
    });
    document.addEventListener("hobtwin:block", ({ detail }) =>
      put(detail.path ? toolStrips(detail) : [], detail.path ? detail.number + 1 : 0));
    const stand = () => {
      view.beside = canvas.closest(".process") !== null;
      redraw();
    };
    document.addEventListener("hobtwin:tab", stand);
    stand();
    /* what was chosen before the part was there is said again */
    document.dispatchEvent(new CustomEvent("hobtwin:part"));
  }

  /* The stage stands on the page that is shown, where that has a place for it. */
  function follow(stage) {
    document.addEventListener("hobtwin:tab", ({ detail }) => {
      const slot = detail.panel.querySelector(".slot");
      if (slot && !slot.contains(stage)) slot.append(stage);
    });
  }

  async function open(box, stage) {
    const canvas = stage.querySelector("canvas");
    const header = JSON.parse(box.querySelector("[data-header]").textContent);
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true });
    if (!gl || typeof DecompressionStream === "undefined") throw new Error("this browser has no WebGL 2");
    const mesh = splitEdges(unpack(await inflate(box.querySelector("[data-mesh]").textContent.trim()), header));
    const paletteBytes = Uint8Array.from(atob(header.palette), (letter) => letter.charCodeAt(0));
    const number = numbering(stage.querySelector(".numbers"), header.labels);
    const scale = { palette: paletteBytes, limitUm: header.limitUm };
    connect(box, canvas, start(gl, canvas, mesh, scale, stage.querySelector(".tip"), number));
    box.classList.add("ready");
  }

  function fail(box, stage, error) {
    box.classList.add("failed");
    stage.classList.add("failed");
    const still = document.getElementById("still");
    if (still) stage.querySelector(".fallback").src = still.src;
    box.querySelector(".reason").textContent = `The part cannot be turned here: ${error.message}. A still picture stands in its place.`;
  }

  for (const box of document.querySelectorAll(".viewer")) {
    const stage = box.querySelector(".stage");
    /* taken apart when it is first seen, not before */
    new IntersectionObserver(([entry], observer) => {
      if (!entry.isIntersecting) return;
      observer.disconnect();
      open(box, stage).catch((error) => fail(box, stage, error));
    }).observe(stage);
    follow(stage);
  }
})();
