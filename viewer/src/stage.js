// The view: yarn, tiles and lines in space, drawn when something changed and not otherwise.
import {
  BufferAttribute, BufferGeometry, Color, DataTexture, DoubleSide, FloatType, GLSL3, InstancedBufferAttribute,
  InstancedBufferGeometry, LineSegments, Mesh, NearestFilter, PerspectiveCamera, RGBAFormat, Scene, ShaderMaterial,
  UnsignedByteType, Vector3, WebGLRenderer, WebGLRenderTarget, ColorManagement, LinearSRGBColorSpace,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { yarn as strand } from "./data.js";
import * as glsl from "./shaders.js";

ColorManagement.enabled = false;

const COURSE = [0.72, 0.31, 0.06];
const WALE = [0.12, 0.36, 0.72];

/** Segments and sides of a piece of yarn, and how many of its points are left out, by the number of stitches. */
function detail(stitches) {
  if (stitches <= 1500) return { steps: 1, sides: 5, stride: 1 };
  if (stitches <= 6000) return { steps: 1, sides: 4, stride: 1 };
  if (stitches <= 20000) return { steps: 1, sides: 4, stride: 2 };
  return { steps: 1, sides: 3, stride: 3 };
}

function texture(data, width, height, type) {
  const made = new DataTexture(data, width, height, RGBAFormat, type);
  made.minFilter = made.magFilter = NearestFilter;
  made.generateMipmaps = false;
  made.needsUpdate = true;
  return made;
}

export class Stage {
  constructor(canvas, scene, changed) {
    this.scene = scene;
    this.changed = changed;
    this.canvas = canvas;
    this.frames = 0;
    const options = { canvas, antialias: true, alpha: true, preserveDrawingBuffer: false };
    this.renderer = new WebGLRenderer(options);
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
    this.world = new Scene();
    let reach = 0;
    for (let i = 0; i < scene.at.length; i += 3) reach = Math.max(reach, Math.hypot(scene.at[i], scene.at[i + 1], scene.at[i + 2]));
    this.radius = reach + scene.thickness;
    this.camera = new PerspectiveCamera(32, 1, this.radius / 50, this.radius * 40);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.request());
    this.states();
    this.yarn();
    this.quads();
    this.lines();
    this.target = new WebGLRenderTarget(1, 1);
    this.mode = "yarn";
    this.upto = scene.count;
    this.look("iso");
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
    this.show(this.mode, this.upto);
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => this.request());
  }

  /** Color of each stitch, and its mark in the fourth channel. */
  states() {
    const width = 1024;
    const height = Math.max(1, Math.ceil(this.scene.count / width));
    this.state = new Uint8Array(width * height * 4);
    this.stateTexture = texture(this.state, width, height, UnsignedByteType);
    this.shared = { uState: { value: this.stateTexture }, uWidth: { value: width }, uDim: { value: 0 } };
  }

  yarn() {
    const { steps, sides, stride } = detail(this.scene.count);
    const yarn = strand(this.scene, stride);
    const height = Math.max(1, Math.ceil((2 * yarn.count) / 1024));
    const texels = new Float32Array(1024 * height * 4);
    for (let i = 0; i < yarn.count; i++) {
      texels.set(yarn.at.subarray(3 * i, 3 * i + 3), 8 * i);
      texels[8 * i + 3] = yarn.stitch[i];
      texels.set(yarn.side.subarray(3 * i, 3 * i + 3), 8 * i + 4);
      texels[8 * i + 7] = yarn.depth[i];
    }
    const shape = [];
    const ring = (k) => [Math.cos((2 * Math.PI * k) / sides), Math.sin((2 * Math.PI * k) / sides)];
    const index = [];
    for (let s = 0; s <= steps; s++) {
      for (let k = 0; k < sides; k++) {
        shape.push(s / steps, ...ring(k));
        if (s === steps) continue;
        const [a, b] = [s * sides + k, s * sides + ((k + 1) % sides)];
        index.push(a, a + sides, b + sides, a, b + sides, b);
      }
    }
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(shape), 3));
    geometry.setIndex(index);
    geometry.setAttribute("aSegment", new InstancedBufferAttribute(yarn.segments, 1));
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: glsl.yarnVertex,
      fragmentShader: glsl.yarnFragment,
      side: DoubleSide,
      uniforms: {
        ...this.shared,
        uPoints: { value: texture(texels, 1024, height, FloatType) },
        uRadius: { value: this.scene.yarn / 2 },
      },
    });
    this.perInstance = (steps * sides * 2) | 0;
    // How much yarn there is once each stitch is worked.
    this.segmentsTo = new Uint32Array(this.scene.count + 1);
    for (const i of yarn.segments) this.segmentsTo[yarn.stitch[i] + 1]++;
    for (let i = 0; i < this.scene.count; i++) this.segmentsTo[i + 1] += this.segmentsTo[i];
    this.yarnMesh = new Mesh(geometry, material);
    this.yarnMesh.frustumCulled = false;
    this.world.add(this.yarnMesh);
  }

  quads() {
    const { scene } = this;
    const at = new Float32Array(scene.tiles * 18);
    const out = new Float32Array(scene.tiles * 18);
    const stitch = new Float32Array(scene.tiles * 6);
    this.tilesTo = new Uint32Array(scene.count + 1);
    for (let tile = 0; tile < scene.tiles; tile++) {
      [0, 1, 3, 0, 3, 2].forEach((k, n) => {
        const from = 3 * scene.corner[4 * tile + k];
        at.set(scene.at.subarray(from, from + 3), 18 * tile + 3 * n);
        out.set(scene.out.subarray(from, from + 3), 18 * tile + 3 * n);
        stitch[6 * tile + n] = scene.stitch[tile];
      });
      this.tilesTo[scene.stitch[tile] + 1]++;
    }
    for (let i = 0; i < scene.count; i++) this.tilesTo[i + 1] += this.tilesTo[i];
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(at, 3));
    geometry.setAttribute("aOut", new BufferAttribute(out, 3));
    geometry.setAttribute("aStitch", new BufferAttribute(stitch, 1));
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: glsl.tileVertex,
      fragmentShader: glsl.tileFragment,
      side: DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
      uniforms: { ...this.shared, uLift: { value: 0 }, uPick: { value: false } },
    });
    this.quadMesh = new Mesh(geometry, material);
    this.quadMesh.frustumCulled = false;
    this.world.add(this.quadMesh);
  }

  lines() {
    const { scene } = this;
    const at = new Float32Array(scene.tiles * 18);
    const out = new Float32Array(scene.tiles * 18);
    const colors = new Float32Array(scene.tiles * 18);
    for (let tile = 0; tile < scene.tiles; tile++) {
      [[2, COURSE], [3, COURSE], [0, WALE], [2, WALE], [1, WALE], [3, WALE]].forEach(([k, color], n) => {
        const from = 3 * scene.corner[4 * tile + k];
        at.set(scene.at.subarray(from, from + 3), 18 * tile + 3 * n);
        out.set(scene.out.subarray(from, from + 3), 18 * tile + 3 * n);
        colors.set(color, 18 * tile + 3 * n);
      });
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(at, 3));
    geometry.setAttribute("aOut", new BufferAttribute(out, 3));
    geometry.setAttribute("aColor", new BufferAttribute(colors, 3));
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: glsl.lineVertex,
      fragmentShader: glsl.lineFragment,
      uniforms: { uLift: { value: 0.01 * this.scene.thickness } },
    });
    this.lineMesh = new LineSegments(geometry, material);
    this.lineMesh.frustumCulled = false;
    this.world.add(this.lineMesh);
  }

  /** Shows a form, and what is worked before stitch `upto`. */
  show(mode, upto) {
    this.mode = mode;
    this.upto = upto;
    const wire = mode === "wire";
    this.yarnMesh.visible = !wire;
    this.quadMesh.visible = this.lineMesh.visible = wire;
    this.yarnMesh.geometry.instanceCount = this.segmentsTo[upto];
    this.quadMesh.geometry.setDrawRange(0, 6 * this.tilesTo[upto]);
    this.lineMesh.geometry.setDrawRange(0, 6 * this.tilesTo[upto]);
    this.request();
  }

  paint(of) {
    for (let i = 0; i < this.scene.count; i++) {
      const color = of(i);
      for (let k = 0; k < 3; k++) this.state[4 * i + k] = Math.round(255 * color[k]);
    }
    this.stateTexture.needsUpdate = true;
    this.request();
  }

  /** Lights stitches; the others step back. */
  light(stitches) {
    for (let i = 0; i < this.scene.count; i++) this.state[4 * i + 3] = 0;
    for (const i of stitches) this.state[4 * i + 3] = 255;
    this.shared.uDim.value = stitches.length ? 0.75 : 0;
    this.stateTexture.needsUpdate = true;
    this.request();
  }

  thick(factor) {
    this.yarnMesh.material.uniforms.uRadius.value = (this.scene.yarn / 2) * factor;
    this.request();
  }

  look(view) {
    const ways = { front: [0, -1, 0.05], side: [1, 0, 0.05], top: [0, -0.02, 1], iso: [0.55, -1, 0.5] };
    const way = new Vector3(...(ways[view] || ways.iso)).normalize();
    const narrow = Math.min(1, this.camera.aspect || 1);
    const far = (this.radius * 1.06) / (Math.sin((this.camera.fov * Math.PI) / 360) * narrow);
    this.camera.position.copy(way.multiplyScalar(far));
    this.controls.target.set(0, 0, 0);
    this.controls.update();
    this.view = view;
    this.request();
  }

  turn(around, over) {
    const at = this.camera.position.clone().sub(this.controls.target);
    const far = at.length();
    const a = Math.atan2(at.y, at.x) + around;
    const e = Math.max(-1.5, Math.min(1.5, Math.asin(at.z / far) + over));
    at.set(Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)).multiplyScalar(far);
    this.camera.position.copy(at.add(this.controls.target));
    this.controls.update();
    this.request();
  }

  zoom(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.request();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (!clientWidth || !clientHeight) return;
    const before = this.camera.aspect;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    if (this.view && Math.abs(before - this.camera.aspect) > 0.02) this.look(this.view);
    this.request();
  }

  request() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.render();
    });
  }

  render() {
    this.renderer.setRenderTarget(null);
    this.renderer.setClearColor(new Color(0), 0);
    this.renderer.render(this.world, this.camera);
    this.frames++;
    const { calls, triangles } = this.renderer.info.render;
    this.figures = { drawCalls: calls, triangles };
    this.changed();
  }

  /** The stitch at a place of the canvas in CSS pixels, or -1: its number is drawn into a picture of one pixel. */
  pick(x, y) {
    const { clientWidth, clientHeight } = this.canvas;
    const shown = [this.yarnMesh.visible, this.quadMesh.visible, this.lineMesh.visible];
    const uniforms = this.quadMesh.material.uniforms;
    this.yarnMesh.visible = this.lineMesh.visible = false;
    this.quadMesh.visible = true;
    uniforms.uPick.value = true;
    uniforms.uLift.value = this.mode === "wire" ? 0 : this.scene.thickness * 0.4;
    this.camera.setViewOffset(clientWidth, clientHeight, x, y, 1, 1);
    this.renderer.setRenderTarget(this.target);
    this.renderer.setClearColor(new Color(0), 0);
    this.renderer.clear();
    this.renderer.render(this.world, this.camera);
    const pixel = new Uint8Array(4);
    this.renderer.readRenderTargetPixels(this.target, 0, 0, 1, 1, pixel);
    this.renderer.setRenderTarget(null);
    this.camera.clearViewOffset();
    uniforms.uPick.value = false;
    uniforms.uLift.value = 0;
    [this.yarnMesh.visible, this.quadMesh.visible, this.lineMesh.visible] = shown;
    const id = pixel[0] + 256 * pixel[1] + 65536 * pixel[2];
    return pixel[3] === 255 && id > 0 && id <= this.scene.count ? id - 1 : -1;
  }

  /** The view as a PNG in a data URL. */
  photo() {
    this.render();
    return this.canvas.toDataURL("image/png");
  }
}
