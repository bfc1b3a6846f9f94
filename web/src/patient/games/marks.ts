// SPDX-License-Identifier: Apache-2.0
// What the goals are made of: hoops with beads, soft lights, mirror images in the water. A goal that is reached has large beads; the
// difference is seen without its colour.
import {
  BackSide,
  CanvasTexture,
  Color,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  SphereGeometry,
  Sprite,
  SpriteMaterial,
  TorusGeometry,
  type BufferGeometry,
  type Material,
  type Object3D,
  type Texture,
} from "three";

export const kInk = "#17344a"; // edges, on every sky but the dark one
export const kPaper = "#fff6e4";
export const kGold = "#f6b73c";

const kBeads = 12;
const kBeadRadius = 0.075;
const kSmallBead = 0.55; // of its size while the goal is not reached
const kGrowth = 1.25;
const kEase = 3.2; // [1/s]
/// Pace of soft lights, which are large: they follow more slowly than a sign.
export const kLightPace = 1; // [1/s]

/// Moves a number towards another one, evenly at any frame rate. No sign of a goal changes faster than by this pace.
export function eased(now: number, wanted: number, dt: number, pace = kEase): number {
  return now + (wanted - now) * (1 - Math.exp(-pace * Math.max(0, dt)));
}

export const bounded = (share: number) => Math.min(1, Math.max(0, share));
export const finite = (value: number | undefined, otherwise = 0) => (value !== undefined && Number.isFinite(value) ? value : otherwise);

/// The same numbers for the same seed, 0 .. 1.
export function sequence(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

export function solid(colour: string, glow = 0): MeshStandardMaterial {
  return new MeshStandardMaterial({ color: colour, roughness: 0.62, metalness: 0, emissive: new Color(colour), emissiveIntensity: glow });
}

/// A ball with a dark edge, which is seen on a bright and on a dark ground.
export function bead(radius: number, colour: string): Group {
  const group = new Group();
  const ball = new SphereGeometry(radius, 16, 12);
  const edge = new Mesh(ball, new MeshBasicMaterial({ color: kInk, side: BackSide, toneMapped: false }));
  edge.scale.setScalar(1.28);
  group.add(edge, new Mesh(ball, solid(colour, 0.45)));
  return group;
}

/// A soft light. @returns null where the browser has no canvas to paint it
export function glow(colour: string, size: number, opacity = 0.8): Sprite | null {
  const map = softSpot();
  if (!map) return null;
  const sprite = new Sprite(new SpriteMaterial({ map, color: colour, transparent: true, opacity, depthWrite: false, toneMapped: false }));
  sprite.scale.setScalar(size);
  sprite.renderOrder = 3;
  return sprite;
}

/// Fades a soft light towards an opacity: at most three flashes a second, also where a hand shakes.
export function shine(light: Sprite | null, opacity: number, dt: number): void {
  if (light) light.material.opacity = eased(light.material.opacity, opacity, dt, kLightPace);
}

function softSpot(): Texture | null {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const paint = canvas.getContext?.("2d");
  if (!paint) return null;
  const gradient = paint.createRadialGradient(32, 32, 0, 32, 32, 32);
  gradient.addColorStop(0, "rgba(255,255,255,1)");
  gradient.addColorStop(0.3, "rgba(255,255,255,0.5)");
  gradient.addColorStop(1, "rgba(255,255,255,0)");
  paint.fillStyle = gradient;
  paint.fillRect(0, 0, 64, 64);
  return new CanvasTexture(canvas);
}

/// A ring with beads. Its beads grow where the goal is reached, and the ring fades where there is no goal.
export class Hoop {
  readonly root = new Group();
  private readonly ring: Mesh;
  private readonly edge: Mesh;
  private readonly hoop: Group;
  private readonly beads: Group[] = [];
  private reached = 0;
  private present = 0;
  private size = 1;

  /// @param facing  true: it stands and faces the viewer; false: it lies
  constructor(radius: number, facing: boolean, colour = kPaper, beads = kBeads, thickness = 0.035) {
    this.ring = new Mesh(new TorusGeometry(radius, thickness, 10, 72), solid(colour, 0.5));
    this.edge = new Mesh(new TorusGeometry(radius, thickness * 1.75, 8, 72), new MeshBasicMaterial({ color: kInk, side: BackSide, toneMapped: false }));
    const hoop = new Group();
    hoop.add(this.edge, this.ring);
    for (let at = 0; at < beads; ++at) {
      const one = bead(kBeadRadius, kGold);
      const angle = (at / beads) * 2 * Math.PI + Math.PI / beads;
      one.position.set(radius * Math.cos(angle), radius * Math.sin(angle), 0);
      this.beads.push(one);
      hoop.add(one);
    }
    this.hoop = hoop;
    if (!facing) hoop.rotation.x = Math.PI / 2;
    this.root.add(hoop);
    this.root.visible = false;
  }

  /// Changes the radius; beads keep their size. @param size  1: as made
  resize(size: number): void {
    this.size = Math.max(0.01, size);
    this.hoop.scale.set(this.size, this.size, this.size);
  }

  /// @param reached  0 .. 1  @param filled  share of the beads that may grow, for a ring that fills with time
  step(present: boolean, reached: number, dt: number, filled = 1): void {
    this.present = eased(this.present, present ? 1 : 0, dt);
    this.reached = eased(this.reached, bounded(reached), dt);
    this.root.visible = this.present > 0.02;
    this.beads.forEach((one, at) => {
      const share = bounded(filled * this.beads.length - at) * this.reached;
      one.scale.setScalar(Math.max(0.001, this.present * (kSmallBead + kGrowth * share)) / this.size);
    });
    this.ring.scale.setScalar(Math.max(0.001, 0.7 + 0.3 * this.present));
    this.edge.scale.copy(this.ring.scale);
  }
}

/// Mirror image in the water at y = 0, drawn over the water. Call `follow` after the original has moved.
export class Mirrored {
  readonly root = new Group();
  private readonly image: Object3D;

  constructor(private readonly original: Object3D, opacity = 0.22) {
    this.image = original.clone(true);
    this.image.traverse((object) => {
      const mesh = object as Mesh;
      if (!mesh.material) return;
      const faded = (material: Material) => {
        const copy = material.clone();
        copy.transparent = true;
        copy.opacity *= opacity;
        copy.depthWrite = false;
        return copy;
      };
      mesh.material = Array.isArray(mesh.material) ? mesh.material.map(faded) : faded(mesh.material);
      mesh.renderOrder = 2;
    });
    this.root.scale.y = -1;
    this.root.add(this.image);
  }

  follow(): void {
    this.image.position.copy(this.original.position);
    this.image.quaternion.copy(this.original.quaternion);
    this.image.scale.copy(this.original.scale);
    this.image.visible = this.original.visible;
  }
}

/// Gives back what three.js keeps of a tree of objects on the graphics card.
export function dispose(root: Object3D): void {
  root.traverse((object) => {
    const { geometry, material } = object as { geometry?: BufferGeometry; material?: Material | Material[] };
    geometry?.dispose();
    for (const one of Array.isArray(material) ? material : material ? [material] : []) {
      (one as { map?: Texture | null }).map?.dispose();
      one.dispose();
    }
  });
}
