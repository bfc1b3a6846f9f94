// SPDX-License-Identifier: Apache-2.0
// One key light with a soft shadow, a faint light from the eye so that nothing is black from any side, and light from all around: from the
// surroundings, or from sky and ground where they would take too long.
import { DirectionalLight, Group, HemisphereLight, Vector3 } from "three";
import type { Box3, Camera } from "three";

const kKeyDirection = new Vector3(-0.45, -0.35, 1).normalize(); // towards the light, W
const kAround = 1.15; // the shadow's reach over the boxes' own

export class Lights {
  readonly group = new Group();
  private readonly sky = new HemisphereLight();
  private readonly key = new DirectionalLight();
  private readonly eye = new DirectionalLight();

  private dark = true;
  private surrounded = false;

  constructor() {
    this.sky.position.set(0, 0, 1); // z is up
    this.key.shadow.bias = -0.0002;
    this.key.shadow.normalBias = 0.0012;
    this.key.shadow.radius = 4;
    this.group.add(this.sky, this.key, this.key.target, this.eye, this.eye.target);
  }

  setTheme(dark: boolean): void {
    this.dark = dark;
    this.apply();
  }

  /// @param on  surroundings light the scene, in place of sky and ground
  setSurrounded(on: boolean): void {
    this.surrounded = on;
    this.apply();
  }

  /// Of the surroundings.
  get intensity(): number {
    return this.dark ? 0.58 : 0.62;
  }

  private apply(): void {
    const { dark, surrounded } = this;
    this.sky.color.set(dark ? "#dfeaff" : "#ffffff");
    this.sky.groundColor.set(dark ? "#6a625a" : "#b8aea4");
    this.sky.intensity = surrounded ? 0.25 : dark ? 1.5 : 1.95;
    this.key.color.set("#fff2e2");
    this.key.intensity = dark ? 2.5 : 2.1;
    this.eye.intensity = (surrounded ? 0.8 : 1) * (dark ? 1.0 : 0.6);
  }

  /// The key light's shadow covers this box.
  cover(box: Box3): void {
    if (box.isEmpty()) return;
    const centre = box.getCenter(new Vector3());
    const reach = (kAround * box.getSize(new Vector3()).length()) / 2;
    this.key.target.position.copy(centre);
    this.key.position.copy(centre).addScaledVector(kKeyDirection, 2 * reach);
    const camera = this.key.shadow.camera;
    camera.left = camera.bottom = -reach;
    camera.right = camera.top = reach;
    camera.near = 0.5 * reach;
    camera.far = 4 * reach;
    camera.updateProjectionMatrix();
  }

  /// @param edge  of the shadow map [pixels], 0: no shadow
  setShadow(edge: number): void {
    this.key.castShadow = edge > 0;
    if (edge === 0 || this.key.shadow.mapSize.x === edge) return;
    this.key.shadow.mapSize.set(edge, edge);
    this.key.shadow.map?.dispose();
    this.key.shadow.map = null;
  }

  follow(camera: Camera, target: Vector3): void {
    this.eye.position.copy(camera.position);
    this.eye.target.position.copy(target);
  }

  dispose(): void {
    this.key.dispose();
    this.eye.dispose();
    this.sky.dispose();
  }
}
