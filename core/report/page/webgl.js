// The scene by WebGL2: lines as quads of a width in pixels, many lines as thin ones, the machine as faces and edges.

P.webgl = {};

P.webgl.LINE = `#version 300 es
precision highp float;
in vec3 aFrom,aTo;in vec4 aLook;
uniform mat4 uClip;uniform vec2 uSize,uBrush;uniform float uWidth,uPerMm,uDense,uNear;uniform bool uThin;
flat out float vPlace,vFlag,vOut;out float vAlong;
void main() {
vPlace=aLook.x;vFlag=aLook.y;vAlong=aLook.w*uPerMm;
vOut=aLook.z<uBrush.x||aLook.z>uBrush.y?1.0:0.0;
vec4 b=uClip*vec4(aTo,1.0);
if(uThin) { gl_Position=b;gl_Position.z+=vOut*0.3-uNear;return;}
float end=float(gl_VertexID>>1),side=float(gl_VertexID&1)*2.0-1.0;
vec4 a=uClip*vec4(aFrom,1.0);
vec2 way=(b.xy-a.xy)*uSize*0.5;
float len=length(way);
vec2 along=len>1e-5?way/len:vec2(1.0,0.0);
float wide=uWidth*(vPlace>191.5&&vOut<0.5?1.7:1.0);
vec4 p=mix(a,b,end);
if(vFlag==1.0) vAlong-=(1.0-end)*len/uDense;
p.xy+=(vec2(-along.y,along.x)*side+along*(end*2.0-1.0)*0.4)*wide/uSize;
p.z+=vOut*0.3-uNear;
gl_Position=aLook.y>1.5?vec4(2.0,2.0,2.0,1.0):p;
}`;

P.webgl.LINE_COLOUR = `#version 300 es
precision highp float;
flat in float vPlace,vFlag,vOut;in float vAlong;
uniform sampler2D uRamp;uniform vec3 uPlain,uRapid,uGround;
out vec4 colour;
void main() {
if(vFlag>1.5) discard;
vec3 c=vPlace<0.0?uPlain:texture(uRamp,vec2((vPlace+0.5)/256.0,0.5)).rgb;
if(vFlag>0.5) { if(fract(vAlong/11.0)>0.55) discard;c=uRapid;}
colour=vec4(mix(c,uGround,vOut*0.84),1.0);
}`;

P.webgl.BODY = `#version 300 es
precision highp float;
in vec3 aAt,aNormal;in vec2 aBody;
uniform mat4 uBodies[10],uClip;uniform vec3 uBack,uPlain,uTool,uHolder,uTable,uGouge,uRest;uniform bool uLit;
out float vLight;flat out vec3 vColour;
void main() {
mat4 body=uBodies[int(aBody.x+0.5)];
gl_Position=uClip*(body*vec4(aAt,1.0));
float kind=floor(aBody.y/10.0);
vColour=!uLit||kind<0.5?uPlain:kind<1.5?uTool:kind<2.5?uHolder:kind<3.5?uTable:kind<4.5?uGouge:uRest;
vLight=uLit?(aBody.y-kind*10.0)*(0.62+0.38*abs(dot(mat3(body)*aNormal,uBack))):1.0;
}`;

P.webgl.BODY_COLOUR = `#version 300 es
precision highp float;
in float vLight;flat in vec3 vColour;
uniform float uAlpha;
out vec4 colour;
void main() { colour=vec4(min(vColour*vLight,vec3(1.0)),uAlpha);}`;

// A renderer on a canvas, or null where WebGL2 is not to be had.
P.webgl.start = (canvas, restored) => {
  const gl = canvas.getContext("webgl2", { antialias: true, alpha: false, powerPreference: "high-performance" });
  if (!gl) return null;
  const made = { lines: {}, lost: false };
  const program = (vertex, fragment, names) => {
    const built = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(built, shader);
    }
    names.forEach((name, at) => gl.bindAttribLocation(built, at, name));
    gl.linkProgram(built);
    if (!gl.getProgramParameter(built, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(gl.getProgramInfoLog(built));
    return built;
  };
  // Values into the uniforms of a program, each by its kind.
  const put = (built, values) => {
    gl.useProgram(built);
    for (const [name, value] of Object.entries(values)) {
      const at = gl.getUniformLocation(built, name);
      if (typeof value === "number") gl.uniform1f(at, value);
      else if (typeof value === "boolean") gl.uniform1i(at, value);
      else if (value.length > 4) gl.uniformMatrix4fv(at, false, value);
      else gl[`uniform${value.length}fv`](at, value);
    }
  };
  const buffer = (values, kept) => {
    const filled = kept || gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, filled);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    return filled;
  };
  const attribute = (place, filled, size, stride, offset, divisor) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, filled);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, gl.FLOAT, false, stride, offset);
    gl.vertexAttribDivisor(place, divisor);
  };
  const setup = () => {
    made.line = program(P.webgl.LINE, P.webgl.LINE_COLOUR, ["aFrom", "aTo", "aLook"]);
    made.body = program(P.webgl.BODY, P.webgl.BODY_COLOUR, ["aAt", "aNormal", "aBody"]);
    made.ramp = gl.createTexture();
    made.lines = {};
    made.meshes = null;
  };
  // A line of the scene in buffers: as quads between neighbours (or pairs), and as a strip of thin lines.
  const upload = (name, line, pairs) => {
    const old = made.lines[name] || {};
    const kept = { count: line.count, pairs, pos: buffer(line.pos, old.pos), look: buffer(line.look, old.look) };
    kept.wide = old.wide || gl.createVertexArray();
    kept.thin = old.thin || gl.createVertexArray();
    gl.bindVertexArray(kept.wide);
    const stride = pairs ? 24 : 12;
    attribute(0, kept.pos, 3, stride, 0, 1);
    attribute(1, kept.pos, 3, stride, 12, 1);
    attribute(2, kept.look, 4, 16, pairs ? 0 : 16, 1);
    gl.bindVertexArray(kept.thin);
    attribute(1, kept.pos, 3, 12, 0, 0);
    attribute(2, kept.look, 4, 16, 0, 0);
    gl.bindVertexArray(null);
    made.lines[name] = kept;
  };
  const ramp = () => {
    gl.bindTexture(gl.TEXTURE_2D, made.ramp);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, P.colour.ramp);
    for (const [name, value] of [[gl.TEXTURE_MIN_FILTER, gl.NEAREST], [gl.TEXTURE_MAG_FILTER, gl.NEAREST], [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE]]) gl.texParameteri(gl.TEXTURE_2D, name, value);
  };
  const mesh = () => {
    const { faces, edges, boxes } = P.parts.made;
    const load = (values, sizes) => {
      const vao = gl.createVertexArray();
      const filled = buffer(values);
      const stride = sizes.reduce((sum, [, size]) => sum + size * 4, 0);
      gl.bindVertexArray(vao);
      let offset = 0;
      for (const [place, size] of sizes) {
        attribute(place, filled, size, stride, offset, 0);
        offset += size * 4;
      }
      gl.bindVertexArray(null);
      return { vao, count: (values.length * 4) / stride };
    };
    made.meshes = { faces: load(faces, [[0, 3], [1, 3], [2, 2]]), edges: load(edges, [[0, 3], [2, 1]]), boxes: load(boxes, [[0, 3], [2, 1]]) };
  };
  const stats = { draws: 0, vertices: 0 };
  const count = (vertices) => {
    stats.draws += 1;
    stats.vertices += vertices;
  };
  const line = (name, matrix, { width = 1, plain, thin = false, near = 0 }) => {
    const kept = made.lines[name];
    const segments = kept ? kept.count - (kept.pairs ? 0 : 1) : 0;
    if (segments <= 0) return;
    const { width: w, height: h, dense } = P.camera;
    put(made.line, { uClip: matrix, uSize: [w * dense, h * dense], uWidth: width * dense, uPerMm: P.camera.per_mm(), uDense: dense, uBrush: P.state.brush || [-1, 1e9], uThin: thin, uNear: near, uPlain: plain, uRapid: P.colour.rapid.rgb, uGround: P.colour.scene.rgb });
    gl.bindVertexArray(thin ? kept.thin : kept.wide);
    if (thin) {
      gl.drawArrays(gl.LINE_STRIP, 0, kept.count);
      count(kept.count);
    } else {
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, segments);
      count(segments * 4);
    }
  };
  const body = (mesh_name, mode, bodies, clip, { plain, alpha, lit = false }) => {
    const { vao, count: vertices } = made.meshes[mesh_name];
    if (!vertices) return;
    put(made.body, { uBodies: bodies.flat(), uClip: clip, uBack: P.camera.rows()[2], uLit: lit, uPlain: plain, uTool: P.colour.tool.rgb, uHolder: P.colour.holder.rgb, uTable: P.colour.table.rgb, uGouge: P.colour.bad.rgb, uRest: P.colour.rest.rgb, uAlpha: alpha });
    gl.bindVertexArray(vao);
    gl.drawArrays(mode, 0, vertices);
    count(vertices);
  };
  const draw = ({ clip, matrix, bodies, moving }) => {
    if (made.lost) return stats;
    const { scene, colour } = P;
    stats.draws = stats.vertices = 0;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...colour.scene.rgb, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, made.ramp);
    const many = !moving && scene.path.count > 250000;
    if (scene.cl) line(moving ? "cl_moving" : "cl", matrix, { plain: colour.cl.rgb, thin: true });
    line(moving ? "path_moving" : "path", matrix, { width: 2, plain: colour.quiet.rgb, thin: many, near: 0.0004 });
    if (scene.vectors && P.state.scale) line(moving ? "vectors_moving" : "vectors", matrix, { width: 1.2, plain: colour.mark.rgb, near: 0.0006 });
    line("chosen", matrix, { width: 5, plain: colour.select.rgb, near: 0.002 });
    if (bodies && made.meshes) {
      body("boxes", gl.LINES, bodies, clip, { plain: colour.strong.rgb, alpha: 1 });
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
      gl.depthMask(false);
      body("faces", gl.TRIANGLES, bodies, clip, { plain: colour.machine.rgb, alpha: 0.34, lit: true });
      body("edges", gl.LINES, bodies, clip, { plain: colour.edge.rgb, alpha: 0.5 });
      gl.depthMask(true);
      gl.disable(gl.BLEND);
    }
    gl.bindVertexArray(null);
    return stats;
  };
  setup();
  canvas.addEventListener("webglcontextlost", (event) => {
    event.preventDefault();
    made.lost = true;
  });
  canvas.addEventListener("webglcontextrestored", () => {
    made.lost = false;
    setup();
    restored();
  });
  return { kind: "WebGL2", upload, ramp, mesh, draw, stats, lost: () => made.lost, gl };
};
