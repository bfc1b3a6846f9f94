// SPDX-License-Identifier: Apache-2.0
// The scene without a canvas: shapes that come and go, what is visible, and where it is drawn.
import { create } from "@bufbuild/protobuf";
import { BoxGeometry, BufferGeometry, Material, Skeleton, SphereGeometry } from "three";
import { afterEach, describe, expect, it, vi } from "vitest";
import { GeometrySchema, MeshSchema, SkinSchema } from "../../../src/gen/phalanx/geometry_pb";
import type { Geometry, Mesh } from "../../../src/gen/phalanx/geometry_pb";
import { ContactSchema, TickSchema } from "../../../src/gen/phalanx/tick_pb";
import type { Tick } from "../../../src/gen/phalanx/tick_pb";
import { arrowLargestForce, arrowLength, arrowMetresPerNewton } from "../../../src/view3d/contact_marks";
import { HandScene } from "../../../src/view3d/hand_scene";
import { skinShape } from "../../../src/view3d/hand_shape";

const segments = 16;

function meshOf(shape: BufferGeometry): Mesh {
  return create(MeshSchema, { position: Array.from(shape.getAttribute("position").array), index: Array.from(shape.getIndex()!.array) });
}

/// Segments stand in a row along x, 2 cm apart, turned about z by `turn`.
function poses(turn: number, shift = 0): number[] {
  return Array.from({ length: segments }, (_, i) => [0.02 * i + shift, 0, 0.1, 0, 0, Math.sin(turn / 2), Math.cos(turn / 2)]).flat();
}

function geometry(withSkin: boolean, withObject = true): Geometry {
  const part = meshOf(new BoxGeometry(0.01, 0.01, 0.02));
  const ball = meshOf(new SphereGeometry(0.05, 12, 8));
  const skin = create(SkinSchema, {
    mesh: ball,
    segment: Array.from({ length: (ball.position.length / 3) * 4 }, (_, i) => (i % 4 === 0 ? 3 : i % 4 === 1 ? 4 : 0)),
    weight: Array.from({ length: (ball.position.length / 3) * 4 }, (_, i) => (i % 4 < 2 ? 0.5 : 0)),
    bindPose: poses(0.3),
  });
  const made = create(GeometrySchema, { segment: Array.from({ length: segments }, () => part) });
  if (withSkin) made.skin = skin;
  if (withObject) made.object = ball;
  return made;
}

function tick(force: number, factor = 1): Tick {
  const contact = create(ContactSchema, { segment: 5, touching: true, force, point: [0.1, 0, 0.1], normal: [0, 0, 2] });
  return create(TickSchema, { tick: 9n, factor, gdpPose: poses(0.5), hcpPose: poses(0.7, 0.003), contact: [contact] });
}

afterEach(() => vi.restoreAllMocks());

describe("where it is drawn", () => {
  for (const withSkin of [true, false]) {
    it(`each segment's origin comes back from the bones' matrices (${withSkin ? "skin" : "segments"})`, () => {
      const scene = new HandScene();
      scene.setGeometry(geometry(withSkin));
      scene.show(tick(1));
      const shown = scene.hands.shownOrigins();
      const ghost = scene.hands.ghostOrigins();
      expect(shown).toHaveLength(segments);
      for (let i = 0; i < segments; ++i) {
        expect(shown[i]![0]).toBeCloseTo(0.02 * i, 6);
        expect(ghost[i]![0]).toBeCloseTo(0.02 * i + 0.003, 6);
        expect(shown[i]![2]).toBeCloseTo(0.1, 6);
      }
    });
  }
  it("nothing before the first tick, and nothing moves by half a hand", () => {
    const scene = new HandScene();
    scene.setGeometry(geometry(true));
    expect(scene.hands.shownOrigins()).toEqual([]);
    scene.show(tick(1));
    const before = scene.hands.shownOrigins();
    scene.show({ ...tick(1), gdpPose: poses(1).slice(7) });
    expect(scene.hands.shownOrigins()).toEqual(before);
  });
  it("a measured hand that is not whole is no ghost", () => {
    const scene = new HandScene();
    scene.setGeometry(geometry(true));
    scene.show(tick(1));
    scene.show({ ...tick(1), hcpPose: [] });
    expect(scene.hands.shownOrigins()).toHaveLength(segments);
    expect(scene.hands.ghostOrigins()).toEqual([]);
    scene.hands.ghostGroup.children.forEach((mesh) => expect(mesh.visible).toBe(false));
  });
  it("stays where it is when the skin is switched off", () => {
    const scene = new HandScene();
    scene.setGeometry(geometry(true));
    scene.show(tick(1));
    const before = scene.hands.shownOrigins();
    scene.setParts({ skin: false, ghost: true, arrows: true, object: true });
    scene.hands.shownOrigins().forEach((origin, i) => origin.forEach((x, k) => expect(x).toBeCloseTo(before[i]![k]!, 6)));
  });
  it("a new hand is not seen in the old one's place", () => {
    const scene = new HandScene();
    scene.setGeometry(geometry(true));
    scene.show(tick(1));
    scene.setGeometry(geometry(true));
    expect(scene.hands.shownOrigins()).toEqual([]);
    expect(scene.hands.shownGroup.visible).toBe(false);
  });
});

describe("arrows", () => {
  it("are to scale, with the factor of the station", () => {
    const scene = new HandScene();
    scene.setGeometry(geometry(false));
    scene.show(tick(4, 0.5));
    const [arrow, ...others] = scene.marks.drawn();
    expect(others).toEqual([]);
    expect(arrow!.segment).toBe(5);
    expect(arrow!.length).toBeCloseTo(2 * arrowMetresPerNewton, 6);
  });
  it("do not grow beyond the largest force, and there is none without force", () => {
    expect(arrowLength(100)).toBe(arrowLargestForce * arrowMetresPerNewton);
    expect(arrowLength(0)).toBe(0);
    const scene = new HandScene();
    scene.setGeometry(geometry(false));
    for (const nothing of [tick(0), tick(5, 0), tick(NaN)]) {
      scene.show(nothing);
      expect(scene.marks.drawn()).toEqual([]);
    }
  });
  it("without a whole point or direction are left out", () => {
    const scene = new HandScene();
    scene.setGeometry(geometry(false));
    for (const bad of [{ point: [NaN, 0, 0] }, { point: [] }, { normal: [0, 0, 0] }, { segment: 16 }]) {
      const spoilt = tick(1);
      Object.assign(spoilt.contact[0]!, bad);
      scene.show(spoilt);
      expect(scene.marks.drawn()).toEqual([]);
    }
  });
});

describe("a lost connection", () => {
  it("takes ghost and arrows away at once, and gives them back", () => {
    const scene = new HandScene();
    scene.setGeometry(geometry(true));
    scene.show(tick(2));
    expect(scene.hands.ghostGroup.visible).toBe(true);
    scene.setLost(true);
    expect(scene.hands.ghostGroup.visible).toBe(false);
    expect(scene.marks.drawn()).toEqual([]);
    scene.setTheme("light"); // must not bring them back
    scene.setParts({ skin: true, ghost: true, arrows: true, object: true });
    expect(scene.hands.ghostGroup.visible).toBe(false);
    expect(scene.marks.drawn()).toEqual([]);
    scene.setLost(false);
    expect(scene.hands.ghostGroup.visible).toBe(true);
    expect(scene.marks.drawn()).toHaveLength(1);
  });
});

describe("memory", () => {
  it("geometries, materials and bones of a scene are all given back, however often its shapes change", () => {
    const geometries = new Set<BufferGeometry>();
    const materials = new Set<Material>();
    const live = { geometries: 0, bones: 0, materials: 0 };
    const setAttribute = BufferGeometry.prototype.setAttribute;
    const inputs = geometry(true);
    vi.spyOn(BufferGeometry.prototype, "setAttribute").mockImplementation(function (this: BufferGeometry, ...args) {
      geometries.add(this);
      return setAttribute.apply(this, args);
    });
    const disposeGeometry = vi.spyOn(BufferGeometry.prototype, "dispose");
    const disposeMaterial = vi.spyOn(Material.prototype, "dispose");
    const computeBones = vi.spyOn(Skeleton.prototype, "computeBoneTexture");
    const disposeBones = vi.spyOn(Skeleton.prototype, "dispose");
    const scene = new HandScene();
    const count = (): typeof live => ({
      geometries: geometries.size - new Set(disposeGeometry.mock.contexts).size,
      bones: computeBones.mock.calls.length - disposeBones.mock.calls.length,
      materials: new Set(disposeMaterial.mock.contexts).size,
    });
    scene.setGeometry(inputs);
    scene.show(tick(1));
    const once = count();
    expect(once.geometries).toBeGreaterThan(3);
    expect(once.bones).toBe(4);
    for (let i = 0; i < 20; ++i) {
      scene.setGeometry(inputs);
      scene.show(tick(1));
      scene.setParts({ skin: i % 2 === 0, ghost: true, arrows: true, object: true });
    }
    expect(count().geometries).toBe(once.geometries);
    expect(count().bones).toBe(once.bones);
    scene.scene.traverse((node) => collect(node, materials));
    scene.over.traverse((node) => collect(node, materials));
    scene.dispose();
    expect(count().geometries).toBe(0);
    expect(count().bones).toBe(0);
    const disposed = new Set<unknown>(disposeMaterial.mock.contexts);
    for (const material of materials) expect(disposed.has(material)).toBe(true);
  });
});

function collect(node: object, into: Set<Material>): void {
  if ("material" in node && node.material instanceof Material) into.add(node.material);
}

describe("skinShape", () => {
  it("refuses a skin that does not fit together, and the segments are shown instead", () => {
    for (const spoil of ["segment", "weight", "bindPose"] as const) {
      const made = geometry(true);
      made.skin![spoil] = made.skin![spoil].slice(1);
      expect(skinShape(made.skin)).toBeNull();
      const scene = new HandScene();
      scene.setGeometry(made);
      scene.show(tick(1));
      expect(scene.hands.shownOrigins()).toHaveLength(segments);
    }
  });
  it("keeps each vertex's weights at a sum of 1, also where it adds vertices", () => {
    const shape = skinShape(geometry(true).skin)!;
    const weight = shape.geometry.getAttribute("skinWeight");
    for (let i = 0; i < weight.count; ++i) expect(weight.getX(i) + weight.getY(i) + weight.getZ(i) + weight.getW(i)).toBeCloseTo(1, 6);
  });
});
