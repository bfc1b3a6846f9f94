// SPDX-License-Identifier: Apache-2.0
// The river's two banks with trees, bushes, reeds and water lilies. They repeat along the river and pass by slowly.
import {
  BufferAttribute, BufferGeometry, CircleGeometry, Color, ConeGeometry, CylinderGeometry, Group, IcosahedronGeometry, InstancedMesh, Matrix4, Mesh, MeshLambertMaterial,
  Quaternion, Vector3, type Material,
} from "three";

export const kHalfWidth = 5.4; // of the river [m] of the picture
const kPeriod = 72;
const kCopies = 3;
const kFarSide = 60;
const [kAcross, kAlong] = [14, 48];

/// Numbers that look random and are always the same.
function scatter(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

const turn = (z: number) => (2 * Math.PI * z) / kPeriod;
/// Where the bank begins at z, on either side.
const shore = (z: number, side: number) => kHalfWidth + 0.5 * Math.sin(3 * turn(z) + side) + 0.3 * Math.sin(7 * turn(z) + 2 * side);
/// Height of the ground at a distance from the shore.
function ground(distance: number, z: number, side: number): number {
  const rise = 1 - Math.exp(-Math.max(0, distance) / 16);
  const hills = 1.6 + 1.5 * Math.sin(2 * turn(z) + 3 * side) + 0.8 * Math.sin(5 * turn(z) + side);
  return -0.35 + 0.75 * (1 - Math.exp(-Math.max(0, distance) / 0.7)) + rise * (2.6 + hills);
}

function bank(side: number): BufferGeometry {
  const positions: number[] = [];
  const colours: number[] = [];
  const index: number[] = [];
  const [sand, meadow, wood] = [new Color("#cdbb8a"), new Color("#8fae6a"), new Color("#5d8466")];
  const mixed = new Color();
  for (let i = 0; i <= kAlong; ++i) {
    const z = -(i / kAlong) * kPeriod;
    for (let j = 0; j <= kAcross; ++j) {
      const distance = kFarSide * (j / kAcross) ** 2.4 - 0.5;
      const y = ground(distance, z, side);
      positions.push(side * (shore(z, side) + distance), y, z);
      mixed.copy(sand).lerp(meadow, Math.min(1, Math.max(0, (distance + 0.1) / 0.9))).lerp(wood, Math.min(1, Math.max(0, (distance - 3) / 18)));
      mixed.multiplyScalar(0.94 + 0.1 * Math.sin(9 * turn(z) + 3 * distance));
      colours.push(mixed.r, mixed.g, mixed.b);
      if (i === kAlong || j === kAcross) continue;
      const a = i * (kAcross + 1) + j;
      const b = a + kAcross + 1;
      index.push(...(side > 0 ? [a, a + 1, b, a + 1, b + 1, b] : [a, b, a + 1, a + 1, b, b + 1]));
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(colours), 3));
  geometry.setIndex(index);
  geometry.computeVertexNormals();
  return geometry;
}

interface Piece {
  readonly at: Vector3;
  readonly size: Vector3;
  readonly turn: number;
  readonly colour: Color;
}

export class Banks {
  readonly group = new Group();
  private readonly material: Material[] = [];

  constructor() {
    const next = scatter(20);
    const lambert = (settings: ConstructorParameters<typeof MeshLambertMaterial>[0]) => {
      const material = new MeshLambertMaterial(settings);
      this.material.push(material);
      return material;
    };
    const land = lambert({ vertexColors: true });
    for (const side of [-1, 1]) {
      const geometry = bank(side);
      for (let copy = 0; copy < kCopies; ++copy) {
        const mesh = new Mesh(geometry, land);
        mesh.position.z = -(copy - 0.35) * kPeriod;
        this.group.add(mesh);
      }
    }
    const [crowns, cones, trunks, reeds, lilies, flowers]: Piece[][] = [[], [], [], [], [], []];
    const put = (into: Piece[] | undefined, x: number, y: number, z: number, wide: number, high: number, colour: string, shade: number) =>
      into?.push({ at: new Vector3(x, y, z), size: new Vector3(wide, high, wide), turn: 6.28 * next(), colour: new Color(colour).multiplyScalar(shade) });
    for (const side of [-1, 1]) {
      for (let i = 0; i < 64; ++i) {
        const z = -kPeriod * next();
        const distance = 1.3 + 26 * next() ** 1.7;
        const [x, y] = [side * (shore(z, side) + distance), ground(distance, z, side)];
        const size = 0.75 + 0.75 * next();
        const shade = 0.82 + 0.3 * next();
        if (next() < 0.45) {
          put(trunks, x, y + 0.5 * size, z, 0.16 * size, 1.2 * size, "#6d4f3a", 1);
          for (let part = 0; part < 3; ++part) put(cones, x, y + size * (1.35 + 0.85 * part), z, size * (1.15 - 0.3 * part), 1.7 * size, "#4f7d62", shade * (1 + 0.09 * part));
        } else {
          const colour = next() < 0.16 ? "#d9a45c" : next() < 0.5 ? "#7fa65c" : "#6b9a6a";
          put(trunks, x, y + 0.6 * size, z, 0.17 * size, 1.5 * size, "#75543c", 1);
          put(crowns, x, y + 1.95 * size, z, 1.15 * size, 1.2 * size, colour, shade);
          put(crowns, x + 0.55 * size, y + 1.5 * size, z + 0.3 * size, 0.75 * size, 0.72 * size, colour, 0.93 * shade);
          put(crowns, x - 0.55 * size, y + 1.6 * size, z - 0.1 * size, 0.8 * size, 0.74 * size, colour, 0.97 * shade);
        }
      }
      for (let i = 0; i < 40; ++i) {
        const z = -kPeriod * next();
        const distance = 0.5 + 2.2 * next();
        put(crowns, side * (shore(z, side) + distance), ground(distance, z, side) + 0.12, z, 0.35 + 0.3 * next(), 0.3 + 0.22 * next(), "#86aa62", 0.85 + 0.3 * next());
      }
      for (let tuft = 0; tuft < 26; ++tuft) {
        const middle = -kPeriod * next();
        for (let blade = 0; blade < 9; ++blade) {
          const z = middle + 1.6 * (next() - 0.5);
          put(reeds, side * (shore(z, side) - 0.1 - 0.55 * next()), 0.3, z, 1, 0.75 + 0.6 * next(), "#9db268", 0.8 + 0.35 * next());
        }
      }
      for (let bed = 0; bed < 11; ++bed) {
        const [middle, across] = [-kPeriod * next(), 0.5 + 0.5 * next()];
        for (let leaf = 0; leaf < 6; ++leaf) {
          const [x, z] = [side * (kHalfWidth - across - 0.9 * next()), middle + 1.6 * (next() - 0.5)];
          put(lilies, x, 0.02, z, 0.16 + 0.14 * next(), 1, "#6f9e63", 0.85 + 0.25 * next());
          if (next() < 0.28) put(flowers, x, 0.07, z, 0.11, 0.11, next() < 0.5 ? "#ffffff" : "#f6b9c6", 1);
        }
      }
    }
    const plain = lambert({ color: "#ffffff" });
    const facets = lambert({ color: "#ffffff", flatShading: true });
    this.instances(new IcosahedronGeometry(1, 1), facets, crowns!);
    this.instances(new ConeGeometry(0.75, 1, 8), facets, cones!);
    this.instances(new CylinderGeometry(0.7, 1, 1, 6), plain, trunks!);
    this.instances(new ConeGeometry(0.035, 1, 3), plain, reeds!);
    this.instances(new CircleGeometry(1, 9, 0.4, 5.8).rotateX(-Math.PI / 2), plain, lilies!, 3);
    this.instances(new IcosahedronGeometry(1, 0), facets, flowers!, 3);
  }

  /// Every piece in each period.
  private instances(geometry: BufferGeometry, material: Material, pieces: readonly Piece[], order = 0): void {
    const mesh = new InstancedMesh(geometry, material, pieces.length * kCopies);
    const [matrix, rotation, up] = [new Matrix4(), new Quaternion(), new Vector3(0, 1, 0)];
    const at = new Vector3();
    for (let copy = 0; copy < kCopies; ++copy) {
      pieces.forEach((piece, i) => {
        at.copy(piece.at);
        at.z -= (copy - 0.35) * kPeriod;
        mesh.setMatrixAt(copy * pieces.length + i, matrix.compose(at, rotation.setFromAxisAngle(up, piece.turn), piece.size));
        mesh.setColorAt(copy * pieces.length + i, piece.colour);
      });
    }
    mesh.frustumCulled = false;
    mesh.renderOrder = order;
    this.group.add(mesh);
  }

  /// @param travel  how far the river has flowed [m]
  move(travel: number): void {
    this.group.position.z = travel % kPeriod;
  }

  dispose(): void {
    const seen = new Set<BufferGeometry>();
    this.group.traverse((part) => part instanceof Mesh && seen.add(part.geometry as BufferGeometry));
    for (const geometry of seen) geometry.dispose();
    for (const material of this.material) material.dispose();
  }
}
