// Draws variants with WebGL 2: programs, maps, meshes and cameras, each made when first needed.
// Clip space is taken as Vulkan's, y down: row 0 of a picture is its top row, and a picture here
// has the samples of one that `intaglio run` draws (src/vulkan/camera.cpp, src/vulkan/mesh.cpp).
"use strict";
window.intaglio = (() => {

const radians = degrees => degrees * Math.PI / 180;
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const times = (a, s) => a.map(x => x * s);

// Elevation 90 is straight above, azimuth 0 is along +x, 90 along +y.
function direction(elevation, azimuth) {
  const e = radians(elevation), a = radians(azimuth);
  return [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
}

// What the shapes are seen from: as `intaglio run --mesh quad` and `--mesh torus`.
const shapes = {
  quad: {target: [0.5, 0.5, 0], distance: 1.7, least: 1},
  torus: {target: [0, 0, 0], distance: 4.2, least: -89},
};
const tube = Math.fround(0.45);

// Eye and view_projection; WebGL's depth runs from -1 to 1.
function camera(state) {
  const shape = shapes[state.shape], distance = shape.distance * state.zoom;
  const forward = times(direction(state.elevation, state.azimuth), -1);
  const eye = shape.target.map((x, i) => Math.fround(x - distance * forward[i]));
  // Straight down the world's up is along the view: +y is upwards then.
  let right = cross(forward, [0, 0, 1]);
  if (Math.hypot(...right) < 1e-6) right = cross(forward, [0, 1, 0]);
  right = times(right, 1 / Math.hypot(...right));
  const down = cross(forward, right), zoom = 1 / Math.tan(radians(45) / 2);
  const near = distance / 100, far = distance * 4, deep = (far + near) / (far - near);
  const row = (axis, offset) => [...axis, -dot(axis, eye) + offset];
  return {eye, rows: [...row(times(right, zoom), 0), ...row(times(down, zoom), 0),
                      ...row(times(forward, deep), -2 * far * near / (far - near)), ...row(forward, 0)]};
}

// Position, normal, tangent with handedness and uv of each vertex: 12 floats.
function quad() {
  const corner = (x, y) => [x, y, 0, 0, 0, 1, 1, 0, 0, 1, x, y];
  return {vertices: [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)].flat(),
          indices: [0, 1, 3, 0, 3, 2]};
}

function torus(segments, repeatU, repeatV) {
  const vertices = [], indices = [];
  for (let j = 0; j <= segments; ++j) {
    const v = j / segments, w = -2 * Math.PI * v;
    for (let i = 0; i <= segments; ++i) {
      const u = i / segments, a = 2 * Math.PI * u, radius = 1 + tube * Math.cos(w);
      vertices.push(radius * Math.cos(a), radius * Math.sin(a), tube * Math.sin(w),
                    Math.cos(w) * Math.cos(a), Math.cos(w) * Math.sin(a), Math.sin(w),
                    -Math.sin(a), Math.cos(a), 0, -1, repeatU * u, repeatV * v);
    }
  }
  for (let j = 0; j < segments; ++j) {
    for (let i = 0; i < segments; ++i) {
      const left = j * (segments + 1) + i, below = left + segments + 1;
      indices.push(left, below + 1, left + 1, left, below, below + 1);
    }
  }
  return {vertices, indices};
}

const whole_screen = `#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }`;

// Shows a picture, or how far two differ: the largest difference of a channel, as the screen has it.
const present = `#version 300 es
precision highp float;
uniform sampler2D first, second;
uniform vec4 pane;        // left, bottom, width, height in pixels
uniform vec3 background;  // of the pictures, linear
uniform float amplify;    // of a difference; 0: the first picture itself
uniform vec3 ramp[17];
out vec4 colour;
vec3 shown(vec3 x) {
  return mix(12.92 * x, 1.055 * pow(max(x, 0.0031308), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x));
}
void main() {
  vec2 at = (gl_FragCoord.xy - pane.xy) / pane.zw;
  at.y = 1.0 - at.y;
  vec4 a = texture(first, at);
  if (amplify > 0.0) {
    vec3 apart = abs(shown(a.rgb) - shown(texture(second, at).rgb)) * amplify;
    float place = min(max(apart.r, max(apart.g, apart.b)), 1.0) * 16.0;
    int below = min(int(place), 15);
    colour = vec4(mix(ramp[below], ramp[below + 1], place - float(below)) * a.a, a.a);
  } else {
    // Without the background's share, which the page's own takes.
    vec3 surface = max(a.rgb - (1.0 - a.a) * background, 0.0) / max(a.a, 1e-3);
    colour = vec4(shown(surface) * a.a, a.a);
  }
}`;

class Renderer {
  constructor(canvas, data) {
    this.canvas = canvas;
    this.data = data;
    const gl = this.gl = canvas.getContext("webgl2", {antialias: false, depth: false});
    if (!gl) throw new Error("no WebGL 2");
    this.parallel = gl.getExtension("KHR_parallel_shader_compile");
    this.programs = new Map();
    this.textures = new Map();
    this.meshes = new Map();
    this.targets = [];
    this.samplers = new Map();  // name to texture unit
    this.present = this.link(whole_screen, present);
    this.nothing = gl.createVertexArray();
  }

  link(vertex, pixel) {
    const gl = this.gl, program = gl.createProgram();
    const shaders = [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, pixel]].map(([kind, text]) => {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      return shader;
    });
    gl.linkProgram(program);
    return {program, shaders, uniforms: null, draws: 0};
  }

  text(key, stage) {
    return this.data.programs[key][stage].map(i => this.data.lines[i]).join("\n") + "\n";
  }

  program(key) {
    if (!this.programs.has(key)) this.programs.set(key, this.link(this.text(key, "vertex"), this.text(key, "pixel")));
    return this.programs.get(key);
  }

  // False while the driver compiles in the background.
  compiled(key) {
    const {program} = this.program(key);
    return !this.parallel || this.gl.getProgramParameter(program, this.parallel.COMPLETION_STATUS_KHR);
  }

  // How often all of these were drawn.
  draws(keys) {
    return Math.min(...keys.map(key => this.program(key).draws));
  }

  use(linked) {
    const gl = this.gl, {program, shaders} = linked;
    if (!linked.uniforms) {
      if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost())
        throw new Error(gl.getProgramInfoLog(program) + shaders.map(s => gl.getShaderInfoLog(s)).join(""));
      linked.uniforms = [];
      for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); ++i) {
        const {name, type} = gl.getActiveUniform(program, i);
        linked.uniforms.push({name: name.replace("[0]", ""), type, place: gl.getUniformLocation(program, name)});
      }
    }
    gl.useProgram(program);
    return linked;
  }

  // Sets what the program wants, each from `values` or a texture unit of its own.
  set(linked, values, textures) {
    const gl = this.gl;
    const setters = {[gl.FLOAT]: gl.uniform1fv, [gl.FLOAT_VEC2]: gl.uniform2fv, [gl.FLOAT_VEC3]: gl.uniform3fv,
                     [gl.FLOAT_VEC4]: gl.uniform4fv};
    for (const {name, type, place} of linked.uniforms) {
      if (setters[type]) {
        setters[type].call(gl, place, values[name]);
        continue;
      }
      if (!this.samplers.has(name)) this.samplers.set(name, this.samplers.size);
      const unit = this.samplers.get(name);
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(type === gl.SAMPLER_3D ? gl.TEXTURE_3D : gl.TEXTURE_2D, textures[name]);
      gl.uniform1i(place, unit);
    }
  }

  // The textures of a map, by sampler, once their pictures are decoded.
  map(name) {
    if (!this.textures.has(name)) {
      const map = this.data.maps.find(m => m.name === name);
      this.textures.set(name, Promise.all(Object.entries(map.textures).map(
        async ([sampler, texture]) => [sampler, await this.upload(texture)])).then(Object.fromEntries));
    }
    return this.textures.get(name);
  }

  async upload(texture) {
    const levels = await Promise.all(texture.levels.map(png => {
      const bytes = Uint8Array.from(atob(png), c => c.charCodeAt(0));
      // The numbers as they are: no colour profile, and no product with alpha.
      return createImageBitmap(new Blob([bytes], {type: "image/png"}),
                               {premultiplyAlpha: "none", colorSpaceConversion: "none"});
    }));
    const gl = this.gl, made = gl.createTexture();
    const kind = texture.depth ? gl.TEXTURE_3D : gl.TEXTURE_2D;
    const set = (parameter, value) => gl.texParameteri(kind, parameter, value);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(kind, made);
    if (texture.depth) {
      gl.texStorage3D(kind, 1, gl.RGBA8, texture.width, texture.height, texture.depth);
      for (let slice = 0; slice < texture.depth; ++slice) {
        gl.pixelStorei(gl.UNPACK_SKIP_ROWS, slice * texture.height);
        gl.texSubImage3D(kind, 0, 0, 0, slice, texture.width, texture.height, 1, gl.RGBA, gl.UNSIGNED_BYTE, levels[0]);
      }
      gl.pixelStorei(gl.UNPACK_SKIP_ROWS, 0);
    } else {
      levels.forEach((image, level) =>
        gl.texImage2D(kind, level, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, image));
      if (texture.mipmaps) gl.generateMipmap(kind);
    }
    levels.forEach(image => image.close());
    const chain = texture.mipmaps || levels.length > 1;
    if (!texture.mipmaps) set(gl.TEXTURE_MAX_LEVEL, levels.length - 1);
    set(gl.TEXTURE_MAG_FILTER, texture.nearest ? gl.NEAREST : gl.LINEAR);
    set(gl.TEXTURE_MIN_FILTER, texture.nearest ? (chain ? gl.NEAREST_MIPMAP_NEAREST : gl.NEAREST)
                                               : (chain ? gl.LINEAR_MIPMAP_LINEAR : gl.LINEAR));
    return made;
  }

  mesh(shape) {
    if (!this.meshes.has(shape)) {
      const gl = this.gl, {vertices, indices} = shape === "quad" ? quad() : torus(128, 6, 2);
      const array = gl.createVertexArray();
      gl.bindVertexArray(array);
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(vertices), gl.STATIC_DRAW);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(indices), gl.STATIC_DRAW);
      [[3, 0], [3, 12], [4, 24], [2, 40]].forEach(([width, offset], location) => {
        gl.enableVertexAttribArray(location);
        gl.vertexAttribPointer(location, width, gl.FLOAT, false, 48, offset);
      });
      this.meshes.set(shape, {array, count: indices.length});
    }
    return this.meshes.get(shape);
  }

  // A picture to draw to and to read: sRGB of 8 bits.  Several samples are resolved into it.
  target(index, size, samples) {
    const gl = this.gl, old = this.targets[index];
    if (old && old.size === size && old.samples === samples) return old;
    if (old) {
      for (const buffer of old.buffers) gl.deleteRenderbuffer(buffer);
      for (const frame of [old.drawn, old.read]) gl.deleteFramebuffer(frame);
      gl.deleteTexture(old.texture);
    }
    const buffer = (format, attachment) => {
      const made = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, made);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples > 1 ? samples : 0, format, size, size);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, made);
      return made;
    };
    const texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.SRGB8_ALPHA8, size, size);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.LINEAR);
    for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, wrap, gl.CLAMP_TO_EDGE);
    const read = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, read);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    const drawn = samples > 1 ? gl.createFramebuffer() : read;
    gl.bindFramebuffer(gl.FRAMEBUFFER, drawn);
    const buffers = [buffer(gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT)];
    if (samples > 1) buffers.push(buffer(gl.SRGB8_ALPHA8, gl.COLOR_ATTACHMENT0));
    return this.targets[index] = {size, samples, texture, read, drawn, buffers};
  }

  // Draws a program as the state says into picture `index`, size x size pixels.
  draw(index, key, state, textures, size, samples) {
    const gl = this.gl, target = this.target(index, size, samples), mesh = this.mesh(state.shape);
    const map = this.data.maps.find(m => m.name === state.map), {eye, rows} = camera(state);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.drawn);
    gl.viewport(0, 0, size, size);
    gl.enable(gl.DEPTH_TEST);
    // Far sides are hidden anyway, and their rays, which never leave the relief, are the dearest.  Seen from
    // their normal's side triangles turn to the left, which y down makes a turn to the right.
    gl.enable(gl.CULL_FACE);
    gl.frontFace(gl.CW);
    const [r, g, b] = this.data.background;
    gl.clearColor(r, g, b, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.set(this.use(this.program(key)),
             {...this.data.uniforms, view_projection: rows, eye: [...eye, 1],
              light: [...direction(state.lightElevation, state.lightAzimuth), 0],
              scale: [state.depth], map_size: [map.width, map.height]}, textures);
    gl.bindVertexArray(mesh.array);
    gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
    ++this.program(key).draws;
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.CULL_FACE);
    if (target.drawn === target.read) return;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, target.drawn);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, target.read);
    gl.blitFramebuffer(0, 0, size, size, 0, 0, size, size, gl.COLOR_BUFFER_BIT, gl.NEAREST);
  }

  // RGBA bytes of a picture, its top row first; alpha 0 where there is no surface.
  pixels(index, size = this.targets[index].size) {
    const gl = this.gl, bytes = new Uint8Array(size * size * 4);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.targets[index].read);
    gl.readPixels(0, 0, size, size, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return bytes;
  }

  // Shows picture `index`, or with `amplify` how far the two differ, in a rectangle of the canvas.
  show(pane, index, amplify) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(...pane);
    this.set(this.use(this.present),
             {pane, amplify: [amplify], ramp: this.data.ramp.flat(), background: this.data.background.slice(0, 3)},
             {first: this.targets[index].texture, second: this.targets[1].texture});
    gl.bindVertexArray(this.nothing);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  clear() {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }
}

return {Renderer, shapes};
})();
