// A headset (WebXR, `immersive-vr`). The headset's own pose moves the head of the machine, and its eyes see the machine's pictures at the
// size that the machine's display has: a flat picture whose width fills the display's field of view. Around the pictures, the edges of
// the world are drawn for the pose of this moment, so the delay of the machine is visible as a gap.

const VERTEX = "attribute vec3 place; attribute vec2 spot; uniform mat4 view; varying vec2 at; void main() { at = spot; gl_Position = view * vec4(place, 1.0); }";
const PICTURE = "precision mediump float; varying vec2 at; uniform sampler2D picture; void main() { gl_FragColor = texture2D(picture, at); }";
const LINE = "precision mediump float; void main() { gl_FragColor = vec4(1.0, 0.77, 0.24, 1.0); }";

/** Returns true if the browser can show pictures in a headset. */
export async function hasHeadset() {
  return (await navigator.xr?.isSessionSupported("immersive-vr").catch(() => false)) ?? false;
}

/** Returns the product of two matrices, which are lists of 16 numbers, column by column. */
function times(a, b) {
  return Float32Array.from({ length: 16 }, (_, n) => [0, 1, 2, 3].reduce((sum, k) => sum + a[(n % 4) + 4 * k] * b[4 * (n >> 2) + k], 0));
}

function program(gl, fragment) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.bindAttribLocation(made, 0, "place");
  gl.bindAttribLocation(made, 1, "spot");
  gl.linkProgram(made);
  return made;
}

export class Headset {
  /** Shows pictures in a session. `edges` has the ends of the world's edges (`WebMachine.edges`), `fieldOfView` the angle of a picture's width in
   *  degrees, and `pictures` returns the canvases of both eyes. `moved` is called with the position and orientation of each frame, in the
   *  axes of the first frame. `ended` is called at the end. */
  static async enter({ session, ...given }) {
    const canvas = document.createElement("canvas");
    const gl = canvas.getContext("webgl", { xrCompatible: true });
    await session.updateRenderState({ baseLayer: new XRWebGLLayer(session, gl) });
    const space = await session.requestReferenceSpace("local");
    return new Headset({ ...given, session, gl, space });
  }

  constructor(given) {
    Object.assign(this, given);
    const { gl, session, edges } = this;
    /** The origin of the poses, which is the first place and heading of the headset. */
    this.origin = null;
    /** Functions that wait for the next frame. */
    this.waiting = [];
    this.hasWire = true;
    this.programs = { picture: program(gl, PICTURE), line: program(gl, LINE) };
    this.lines = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.lines);
    gl.bufferData(gl.ARRAY_BUFFER, edges, gl.STATIC_DRAW);
    this.quad = gl.createBuffer();
    this.texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    for (const name of ["TEXTURE_WRAP_S", "TEXTURE_WRAP_T"]) gl.texParameteri(gl.TEXTURE_2D, gl[name], gl.CLAMP_TO_EDGE);
    for (const name of ["TEXTURE_MIN_FILTER", "TEXTURE_MAG_FILTER"]) gl.texParameteri(gl.TEXTURE_2D, gl[name], gl.LINEAR);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, true);
    // The trigger of a controller shows and hides the edges of the world.
    session.addEventListener("select", () => (this.hasWire = !this.hasWire));
    session.addEventListener("end", () => {
      this.session = null;
      this.waiting.splice(0).forEach((done) => done());
      this.ended();
    });
    session.requestAnimationFrame((now, frame) => this.frame(frame));
  }

  /** Waits for the next frame. A headset can have another rate than the page, whose own frames can stop meanwhile. */
  nextFrame() {
    return new Promise((done) => (this.session ? this.waiting.push(done) : done()));
  }

  leave() {
    return this.session?.end();
  }

  frame(frame) {
    if (!this.session) return;
    this.session.requestAnimationFrame((now, next) => this.frame(next));
    const first = frame.getViewerPose(this.space);
    if (first && !this.origin) {
      const { position, orientation: q } = first.transform;
      // The new origin has the heading of the first frame, and stays level.
      const half = Math.atan2(q.y, q.w);
      this.origin = this.space.getOffsetReferenceSpace(new XRRigidTransform(position, { x: 0, y: Math.sin(half), z: 0, w: Math.cos(half) }));
    }
    const viewer = this.origin && frame.getViewerPose(this.origin);
    if (viewer) {
      const { position: p, orientation: q } = viewer.transform;
      this.moved([p.x, p.y, p.z], [q.w, q.x, q.y, q.z]);
      this.draw(viewer);
    }
    this.waiting.splice(0).forEach((done) => done());
  }

  draw(viewer) {
    const { gl, session } = this;
    const layer = session.renderState.baseLayer;
    gl.bindFramebuffer(gl.FRAMEBUFFER, layer.framebuffer);
    gl.clearColor(0, 0, 0, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    const pictures = this.pictures();
    viewer.views.forEach((view, n) => {
      const { x, y, width, height } = layer.getViewport(view);
      gl.viewport(x, y, width, height);
      const project = times(view.projectionMatrix, view.transform.inverse.matrix);
      const picture = pictures[view.eye === "right" ? 1 : 0] ?? pictures[n];
      if (picture) this.drawPicture(picture, project, viewer.transform, view.transform.position);
      if (this.hasWire) this.drawLines(project);
    });
  }

  /** Draws a picture one metre before an eye, upright to the direction of the head. */
  drawPicture(picture, project, head, eye) {
    const { gl } = this;
    const half = Math.tan((this.fieldOfView * Math.PI) / 360);
    const high = (half * picture.height) / picture.width;
    const place = Float32Array.from(head.matrix);
    place.set([eye.x, eye.y, eye.z], 12);
    gl.useProgram(this.programs.picture);
    gl.uniformMatrix4fv(gl.getUniformLocation(this.programs.picture, "view"), false, times(project, place));
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.quad);
    const corners = [[-1, -1], [1, -1], [-1, 1], [1, 1]].flatMap(([a, b]) => [a * half, b * high, -1, (a + 1) / 2, (b + 1) / 2]);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(corners), gl.STREAM_DRAW);
    gl.enableVertexAttribArray(0);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 20, 0);
    gl.vertexAttribPointer(1, 2, gl.FLOAT, false, 20, 12);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  drawLines(project) {
    const { gl } = this;
    gl.useProgram(this.programs.line);
    gl.uniformMatrix4fv(gl.getUniformLocation(this.programs.line, "view"), false, project);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.lines);
    gl.enableVertexAttribArray(0);
    gl.disableVertexAttribArray(1);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 12, 0);
    gl.drawArrays(gl.LINES, 0, this.edges.length / 3);
  }
}
