// SPDX-License-Identifier: Apache-2.0
// The boat of the river: a wooden hull, a mast, a sail that fills with the force, and its mirror image in the water.
import {
  BufferAttribute, BufferGeometry, CanvasTexture, Color, CylinderGeometry, DoubleSide, Group, Mesh, MeshLambertMaterial, PlaneGeometry, SRGBColorSpace, type Material,
} from "three";
import { picture } from "../../people/symbols";

const kLength = 2.5; // [m] of the picture, like all here
const kWidth = 0.92;
const kStations = 18; // along the hull
const kRibs = 9; // around it
const kMast = 2.5;
const kSailGrid = 10;
const kMirror = 0.24; // opacity

/// Half width and keel of the hull at s, 0 stern .. 1 bow.
const beam = (s: number) => (kWidth / 2) * Math.min(1, 0.62 + 1.1 * s) * Math.sqrt(Math.max(0, 1 - s ** 2.6));
const rim = (s: number) => 0.4 + 0.3 * (s - 0.35) ** 2 + 0.1 * s;
const keel = (s: number) => -0.12 + 0.38 * s ** 4;

/// A surface of ribs. @param at  of station s and rib angle share r, 0 .. 1
function loft(stations: number, ribs: number, at: (s: number, r: number) => readonly [number, number, number]): BufferGeometry {
  const positions: number[] = [];
  const index: number[] = [];
  for (let i = 0; i <= stations; ++i) {
    for (let j = 0; j <= ribs; ++j) {
      positions.push(...at(i / stations, j / ribs));
      if (i === stations || j === ribs) continue;
      const a = i * (ribs + 1) + j;
      index.push(a, a + ribs + 1, a + 1, a + 1, a + ribs + 1, a + ribs + 2);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  geometry.setIndex(index);
  geometry.computeVertexNormals();
  return geometry;
}

const along = (s: number) => kLength * (0.5 - s); // the bow points away from the camera
function hull(shrink: number): BufferGeometry {
  return loft(kStations, kRibs, (s, r) => {
    const angle = Math.PI * (r - 0.5);
    const width = shrink * beam(s);
    const depth = rim(s) - keel(s);
    return [width * Math.sin(angle) * (0.82 + 0.18 * Math.abs(Math.sin(angle))), rim(s) - depth * Math.cos(angle) ** 0.75 * shrink, along(s * (shrink < 1 ? 0.985 : 1))];
  });
}

/// The sail's cloth with the patient's symbol.
function cloth(symbol: string): CanvasTexture | undefined {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 256;
  const pen = canvas.getContext("2d");
  if (!pen) return undefined;
  const wash = pen.createLinearGradient(0, 0, 256, 256);
  wash.addColorStop(0, "#fffaf0");
  wash.addColorStop(1, "#f7e3c6");
  pen.fillStyle = wash;
  pen.fillRect(0, 0, 256, 256);
  pen.fillStyle = "#e58a63";
  pen.fillRect(0, 214, 256, 20);
  const path = symbol === "" ? null : picture(symbol).querySelector("path")?.getAttribute("d");
  if (path && typeof Path2D !== "undefined") {
    pen.save();
    pen.translate(30, 104);
    pen.scale(3.6, 3.6);
    pen.fillStyle = "#1f5069";
    pen.fill(new Path2D(path), "evenodd");
    pen.restore();
  }
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  return texture;
}

export class Boat {
  readonly group = new Group();
  private readonly tilt = new Group();
  private readonly mirror: Group;
  private readonly sail: BufferGeometry;
  private readonly materials: Material[] = [];
  private readonly texture: CanvasTexture | undefined;

  constructor(symbol: string) {
    const wood = this.made(new MeshLambertMaterial({ color: "#9a5f3b", side: DoubleSide }));
    const inside = this.made(new MeshLambertMaterial({ color: "#d9a774", side: DoubleSide }));
    const light = this.made(new MeshLambertMaterial({ color: "#f1d3a4" }));
    this.texture = cloth(symbol);
    const canvas = this.made(
      new MeshLambertMaterial({ color: "#ffffff", ...(this.texture ? { map: this.texture } : {}), side: DoubleSide, emissive: new Color("#ffe3b8"), ...(this.texture ? { emissiveMap: this.texture } : {}), emissiveIntensity: 0.4 }),
    );
    const outer = new Mesh(hull(1), wood);
    const inner = new Mesh(hull(0.9), inside);
    inner.position.y = 0.01;
    const gunwale = [-1, 1].map((side) => {
      const edge = loft(kStations, 5, (s, r) => {
        const angle = 2 * Math.PI * r;
        return [side * (beam(s) + 0.035 * Math.cos(angle)), rim(s) + 0.045 * Math.sin(angle), along(s)];
      });
      return new Mesh(edge, light);
    });
    const transom = new Mesh(loft(1, kRibs, (s, r) => {
      const angle = Math.PI * (r - 0.5);
      const [width, depth] = [beam(0), rim(0) - keel(0)];
      const y = rim(0) - depth * Math.cos(angle) ** 0.75;
      return [width * Math.sin(angle) * (0.82 + 0.18 * Math.abs(Math.sin(angle))), s === 0 ? y : rim(0), along(0) + 0.01];
    }), wood);
    const bench = new Mesh(new PlaneGeometry(0.78, 0.26).rotateX(-Math.PI / 2), light);
    bench.position.set(0, 0.3, 0.42);
    const mast = new Mesh(new CylinderGeometry(0.028, 0.045, kMast, 8), light);
    mast.position.set(0, kMast / 2 + 0.05, -0.2);
    const boom = new Mesh(new CylinderGeometry(0.022, 0.022, 1.45, 6).rotateZ(Math.PI / 2), light);
    boom.position.set(0.66, 0.72, -0.16);
    this.sail = new PlaneGeometry(1, 1, kSailGrid, kSailGrid);
    const sail = new Mesh(this.sail, canvas);
    sail.position.set(0.03, 0.78, -0.16);
    this.tilt.add(outer, inner, transom, ...gunwale, bench, mast, boom, sail);
    this.mirror = new Group();
    this.mirror.add(outer.clone(), transom.clone(), mast.clone(), sail.clone()); // what is seen of it from above the water
    this.mirror.traverse((part) => {
      if (!(part instanceof Mesh)) return;
      const faint = this.made((part.material as MeshLambertMaterial).clone());
      Object.assign(faint, { transparent: true, opacity: kMirror, depthWrite: false, side: DoubleSide });
      part.material = faint;
      part.renderOrder = 2;
    });
    const flipped = new Group();
    flipped.scale.y = -1;
    flipped.add(this.mirror);
    this.group.add(this.tilt, flipped);
    this.fill(0.3, 0);
  }

  private made<T extends Material>(material: T): T {
    this.materials.push(material);
    return material;
  }

  /// @param wind  how full the sail is, 0 .. 1  @param flutter  phase of its edge [rad]
  fill(wind: number, flutter: number): void {
    const position = this.sail.getAttribute("position") as BufferAttribute;
    const belly = 0.1 + 0.42 * wind;
    for (let i = 0; i <= kSailGrid; ++i) {
      for (let j = 0; j <= kSailGrid; ++j) {
        const [x, y] = [j / kSailGrid, 1 - i / kSailGrid];
        const span = 1.32 * (1 - y * 0.9);
        const bulge = belly * Math.sin(Math.PI * x) * Math.sin(Math.PI * (0.15 + 0.8 * y)) * 0.9;
        const edge = (1 - wind) * 0.035 * x * Math.sin(5 * y + flutter);
        position.setXYZ(i * (kSailGrid + 1) + j, x * span, y * (kMast - 0.9) - 0.03 * Math.sin(Math.PI * x), -bulge + edge);
      }
    }
    position.needsUpdate = true;
    this.sail.computeVertexNormals();
  }

  /// @param x  sideways  @param z  along the river, negative is ahead  @param y  of the water  [m]; the angles [rad]
  place(x: number, y: number, z: number, heel: number, turn: number, pitch: number): void {
    this.group.position.set(x, 0, z);
    for (const one of [this.tilt, this.mirror]) {
      one.position.y = y;
      one.rotation.set(pitch, turn, heel, "YXZ");
    }
  }

  dispose(): void {
    this.group.traverse((part) => part instanceof Mesh && part.geometry.dispose());
    for (const material of this.materials) material.dispose();
    this.texture?.dispose();
  }
}
