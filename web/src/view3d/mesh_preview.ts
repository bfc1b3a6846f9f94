// SPDX-License-Identifier: Apache-2.0
// The preview of a mesh: a frame is drawn only when something has changed.
import { PerspectiveCamera, Vector3 } from "three";
import type { WebGLRenderer } from "three";
import type { UpAxis } from "../state/up_axis";
import { strings } from "../strings";
import type { ThemeName } from "../theme";
import type { MeshPreview } from "../wire/import_report";
import { AxisCross } from "./axis_cross";
import { fitted, orbited, worldUp } from "./camera_presets";
import { Canvas, isSoftware, type ViewTrouble } from "./canvas";
import { PreviewScene } from "./preview_scene";
import { pixelRatioFor, qualityLevels } from "./quality";

const kFieldOfView = 30; // vertical [deg]
const kFirstDirection = new Vector3(0.45, -0.8, 0.42); // towards the camera
const kSoftwareQuality = 1; // where the processor draws
const kQuality = 2;
const kTurn = 2 * Math.PI; // of a drag over the picture's height [rad]

/// The content of the last frame, for tests and inspection.
export interface MeshPreviewProbe {
  readonly frames: number;
  readonly up: UpAxis;
  readonly extent: readonly [number, number, number]; // of the mesh as it stands [m]
  readonly bar: number; // [m]
  readonly direction: readonly [number, number, number]; // towards the camera, unit
}

export class MeshPreviewView {
  private readonly surface = document.createElement("div");
  private readonly drawn = document.createElement("div"); // holds the canvas
  private readonly label = document.createElement("span"); // of the bar
  private readonly cross = new AxisCross();
  private readonly content: PreviewScene;
  private readonly canvas: Canvas;
  private readonly camera = new PerspectiveCamera(kFieldOfView);
  private readonly resizing = new ResizeObserver(() => this.fit());
  private renderer: WebGLRenderer | null = null;
  private direction = kFirstDirection.clone().normalize();
  private up: UpAxis = "z";
  private size = { width: 0, height: 0 };
  private request = 0; // of the next frame, 0: none
  private frames = 0;

  /// @param host  an element with a size of its own; the preview fills it
  /// @param onTrouble  it cannot be drawn
  constructor(host: HTMLElement, mesh: MeshPreview, onTrouble: (what: ViewTrouble) => void) {
    this.content = new PreviewScene(mesh);
    this.camera.up.copy(worldUp);
    this.surface.className = "mesh-preview-surface";
    this.label.className = "mesh-preview-bar";
    this.label.ariaHidden = "true"; // the summary states the extents
    this.label.textContent = strings.object.extent((1000 * this.content.barLength).toFixed(0));
    this.surface.append(this.drawn, this.label, this.cross.element);
    host.append(this.surface);
    this.canvas = new Canvas(this.drawn, () => this.restored(), () => this.content.release(), onTrouble);
    this.renderer = this.canvas.use(true);
    this.surface.addEventListener("pointerdown", (event) => this.surface.setPointerCapture(event.pointerId));
    this.surface.addEventListener("pointermove", (event) => this.drag(event));
    this.resizing.observe(this.surface);
    this.applyQuality();
    this.fit();
  }

  setUp(up: UpAxis): void {
    this.up = up;
    this.content.setUp(up);
    this.redraw();
  }

  setTheme(theme: ThemeName): void {
    this.content.setTheme(theme);
    this.redraw();
  }

  /// @param right, up  way of the camera [rad]
  orbit(right: number, up: number): void {
    const target = new Vector3();
    this.direction = orbited({ target, position: this.direction }, right, up).position.normalize();
    this.demand();
  }

  probe(): MeshPreviewProbe {
    const { frames, up } = this;
    return { frames, up, extent: this.content.extent, bar: this.content.barLength, direction: this.direction.toArray() };
  }

  dispose(): void {
    cancelAnimationFrame(this.request);
    this.request = -1; // nothing asks for a frame any more
    this.resizing.disconnect();
    this.content.release();
    this.canvas.dispose();
    this.renderer = null;
    this.surface.remove();
  }

  private drag(event: PointerEvent): void {
    if (!this.surface.hasPointerCapture(event.pointerId) || this.size.height === 0) return;
    const turn = kTurn / this.size.height;
    this.orbit(-turn * event.movementX, turn * event.movementY);
  }

  private demand(): void {
    if (this.request !== 0 || !this.renderer) return;
    this.request = requestAnimationFrame(() => this.draw());
  }

  private redraw(): void {
    if (this.renderer) this.renderer.shadowMap.needsUpdate = true;
    this.demand();
  }

  private restored(): void {
    this.content.release();
    this.applyQuality();
    this.redraw();
  }

  private get quality() {
    return qualityLevels[this.renderer && isSoftware(this.renderer) ? kSoftwareQuality : kQuality]!;
  }

  private applyQuality(): void {
    if (this.renderer) this.content.setQuality(this.quality, this.renderer);
  }

  private fit(): void {
    const { clientWidth: width, clientHeight: height } = this.surface;
    this.size = { width, height };
    if (!this.renderer || width === 0 || height === 0) return;
    this.renderer.setPixelRatio(pixelRatioFor(this.quality, width, height, devicePixelRatio));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.redraw();
  }

  private draw(): void {
    this.request = 0;
    if (!this.canvas.usable || !this.renderer || this.size.width === 0) return;
    this.look();
    this.renderer.clear();
    this.renderer.render(this.content.scene, this.camera);
    this.cross.show(this.camera, this.up);
    const at = this.content.barAt.clone().project(this.camera);
    this.label.style.left = `${50 * (at.x + 1)}%`;
    this.label.style.top = `${50 * (1 - at.y)}%`;
    ++this.frames;
  }

  /// From the chosen direction, so that all is in the picture.
  private look(): void {
    const { camera } = this;
    const place = fitted(this.content.corners(), this.direction, (kFieldOfView * Math.PI) / 180, camera.aspect);
    const distance = place.position.distanceTo(place.target);
    camera.position.copy(place.position);
    camera.lookAt(place.target);
    camera.near = distance / 20;
    camera.far = 20 * distance;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    this.content.lights.follow(camera, place.target);
  }
}
