// A canvas with a camera: draws when something changed and not otherwise, turns with the mouse and the keys, can be
// linked with another one, and tells where it looks from in a few numbers that fit into an address.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { h } from "../ui/dom";

const kFieldOfView = 30;
const kAir = 1.07; // around a model that is framed

let graphicsCard: boolean | undefined;

/** Smooth edges take software three and a half times as long to draw. */
function hasGraphicsCard(): boolean {
  if (graphicsCard === undefined) {
    const probe = h("canvas", { width: 1, height: 1 }).getContext("webgl2", { failIfMajorPerformanceCaveat: true });
    graphicsCard = probe !== null && !/swiftshader|llvmpipe|software/i.test(rendererOf(probe));
    probe?.getExtension("WEBGL_lose_context")?.loseContext();
  }
  return graphicsCard;
}

function rendererOf(gl: WebGL2RenderingContext): string {
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  return String(gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}

export class Stage {
  readonly root = h("div", { class: "scene" });
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(kFieldOfView, 1, 0.01, 100);
  readonly renderer: THREE.WebGLRenderer;
  readonly controls: OrbitControls;
  /** Of what is looked at; the camera's distances are in these. */
  radius = 1;
  /** Points that a frame has to hold. */
  outline: Float32Array = new Float32Array();
  /** Where it is usually looked at from. */
  usual = new THREE.Vector3(0.35, -1, 0.22);
  onMoved: () => void = () => {};
  onDrawn: () => void = () => {};
  private asked = false;
  private width = 0; // kept: to ask the browser between changes of labels makes it lay the page out anew for each
  private height = 0;
  private readonly observer: ResizeObserver;
  private readonly themed = () => this.background();

  constructor(label: string) {
    this.renderer = new THREE.WebGLRenderer({ antialias: hasGraphicsCard(), alpha: false });
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio || 1));
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", label);
    this.root.appendChild(canvas);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.zoomSpeed = 1.4;
    this.controls.addEventListener("change", () => {
      this.clip();
      this.redraw();
      this.onMoved();
    });
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.root);
    addEventListener("themechange", this.themed);
    canvas.addEventListener("webglcontextrestored", () => this.redraw());
    this.background();
  }

  dispose(): void {
    this.observer.disconnect();
    removeEventListener("themechange", this.themed);
    this.controls.dispose();
    this.clear();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  /** Empties the scene and gives its memory back. */
  clear(): void {
    this.scene.traverse((object) => {
      if (!(object instanceof THREE.Mesh || object instanceof THREE.LineSegments)) return;
      (object.geometry as THREE.BufferGeometry).dispose();
      for (const material of [object.material as THREE.Material].flat()) material.dispose();
    });
    this.scene.clear();
  }

  redraw(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.draw();
    });
  }

  private draw(): void {
    this.renderer.render(this.scene, this.camera);
    this.onDrawn();
  }

  private background(): void {
    // Without a change of colour space, as all colours here.
    const text = getComputedStyle(document.documentElement).getPropertyValue("--scene").trim();
    this.renderer.setClearColor(new THREE.Color(text), 1);
    this.redraw();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (!(width > 0 && height > 0)) return;
    [this.width, this.height] = [width, height];
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.redraw();
  }

  private clip(): void {
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(distance - 4 * this.radius, distance * 0.01);
    this.camera.far = distance + 4 * this.radius;
    this.camera.updateProjectionMatrix();
  }

  /** Looks from `direction` (the usual one, if none is given) at all of `outline`, as near as it fits. */
  frame(direction = this.usual): void {
    const { clientWidth: width, clientHeight: height } = this.root;
    const towards = direction.clone().normalize();
    const right = new THREE.Vector3().crossVectors(this.camera.up, towards).normalize();
    const up = new THREE.Vector3().crossVectors(towards, right);
    const [tanUp, at] = [Math.tan((kFieldOfView * Math.PI) / 360), new THREE.Vector3()];
    const tanRight = tanUp * (width > 0 && height > 0 ? width / height : 1);
    const box = new THREE.Box3();
    for (let i = 0; i < this.outline.length; i += 3) {
      at.fromArray(this.outline, i);
      box.expandByPoint(new THREE.Vector3(at.dot(right), at.dot(up), at.dot(towards)));
    }
    const middle = box.isEmpty() ? new THREE.Vector3() : box.getCenter(new THREE.Vector3());
    let distance = box.isEmpty() ? this.radius / tanUp : 0;
    for (let i = 0; i < this.outline.length; i += 3) {
      at.fromArray(this.outline, i);
      const [x, y, z] = [at.dot(right) - middle.x, at.dot(up) - middle.y, at.dot(towards) - middle.z];
      distance = Math.max(distance, z + Math.abs(x) / tanRight, z + Math.abs(y) / tanUp);
    }
    this.controls.target.copy(right).multiplyScalar(middle.x).addScaledVector(up, middle.y).addScaledVector(towards, middle.z);
    this.camera.position.copy(this.controls.target).addScaledVector(towards, distance * kAir);
    this.controls.update();
    this.clip();
    this.redraw();
  }

  /** Position and target, in radii, as text. */
  get looking(): string {
    const numbers = [...this.camera.position.toArray(), ...this.controls.target.toArray()];
    return numbers.map((x) => (x / this.radius).toFixed(3)).join(",");
  }

  set looking(text: string) {
    const numbers = text.split(",").map(Number);
    if (numbers.length !== 6 || !numbers.every(Number.isFinite)) return;
    this.camera.position.fromArray(numbers).multiplyScalar(this.radius);
    this.controls.target.fromArray(numbers, 3).multiplyScalar(this.radius);
    this.controls.update();
    this.clip();
    this.redraw();
  }

  key(event: KeyboardEvent): boolean {
    const turn = Math.PI / 24;
    const views: [number, number, number][] = [[0, -1, 0], [0, 1, 0], [-1, 0, 0], [1, 0, 0], [0, -1e-4, 1], [0, -1e-4, -1]];
    const view = views[Number(event.key) - 1];
    const arrows: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const arrow = arrows[event.key];
    if (view) this.frame(new THREE.Vector3(...view));
    else if (event.key === "0") this.frame();
    else if (event.key === "+" || event.key === "=") this.zoom(1 / 1.15);
    else if (event.key === "-") this.zoom(1.15);
    else if (arrow && event.shiftKey) this.shift(...arrow);
    else if (arrow) this.turn(arrow[0] * turn, arrow[1] * turn);
    else return false;
    event.preventDefault();
    return true;
  }

  private zoom(factor: number): void {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
  }

  private turn(around: number, over: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const ball = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
    ball.theta += around;
    ball.phi = Math.max(0.01, Math.min(Math.PI - 0.01, ball.phi + over));
    const turned = new THREE.Vector3().setFromSpherical(ball);
    this.camera.position.set(turned.x, -turned.z, turned.y).add(this.controls.target);
    this.controls.update();
  }

  private shift(right: number, down: number): void {
    const step = this.camera.position.distanceTo(this.controls.target) * 0.04;
    const move = new THREE.Vector3().setFromMatrixColumn(this.camera.matrix, 0).multiplyScalar(right * step);
    move.addScaledVector(new THREE.Vector3().setFromMatrixColumn(this.camera.matrix, 1), -down * step);
    this.camera.position.add(move);
    this.controls.target.add(move);
    this.controls.update();
  }

  /** Where a point of the model is on the canvas, in pixels; null behind the camera. */
  project(point: THREE.Vector3): { x: number; y: number } | null {
    const at = point.clone().project(this.camera);
    if (at.z > 1 || at.z < -1) return null;
    return { x: ((at.x + 1) / 2) * this.width, y: ((1 - at.y) / 2) * this.height };
  }

  ray(x: number, y: number): THREE.Raycaster {
    const caster = new THREE.Raycaster();
    const at = new THREE.Vector2((x / this.root.clientWidth) * 2 - 1, 1 - (y / this.root.clientHeight) * 2);
    caster.setFromCamera(at, this.camera);
    return caster;
  }

  /** Calls `clicked` for clicks, not for drags. */
  onClick(clicked: (x: number, y: number) => void): void {
    const canvas = this.renderer.domElement;
    let down: PointerEvent | null = null;
    canvas.addEventListener("pointerdown", (event) => (down = event.button === 0 ? event : null));
    canvas.addEventListener("pointerup", (event) => {
      if (down && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) < 4) clicked(event.offsetX, event.offsetY);
      down = null;
    });
  }

  /** What is shown, drawn anew at `scale` times the size. */
  picture(scale: number): HTMLCanvasElement {
    const { clientWidth: width, clientHeight: height } = this.root;
    const ratio = this.renderer.getPixelRatio();
    this.renderer.setPixelRatio(scale);
    this.renderer.setSize(width, height);
    this.renderer.render(this.scene, this.camera);
    const copy = h("canvas", { width: width * scale, height: height * scale });
    copy.getContext("2d")!.drawImage(this.renderer.domElement, 0, 0);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height);
    this.redraw();
    return copy;
  }
}
