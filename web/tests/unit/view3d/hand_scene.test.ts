// SPDX-License-Identifier: Apache-2.0
// The scene without a canvas: shapes that come and go, what is visible, and where it is drawn.
import { create } from "@bufbuild/protobuf";
import {
  BoxGeometry, BufferGeometry, InstancedMesh, Material, Matrix4, Mesh, MeshDepthMaterial, ShaderLib, ShaderMaterial, Skeleton, SkinnedMesh,
  SphereGeometry, Vector3,
} from "three";
import type { EventDispatcher, WebGLProgramParametersWithUniforms, WebGLRenderer } from "three";
import { afterEach, describe, expect, it, vi } from "vitest";
import { GeometrySchema, MeshSchema, SkinSchema } from "../../../src/gen/phalanx/geometry_pb";
import type { Geometry, Mesh as MeshMessage } from "../../../src/gen/phalanx/geometry_pb";
import { ContactPointSchema, ContactSchema, TickSchema } from "../../../src/gen/phalanx/tick_pb";
import type { Tick } from "../../../src/gen/phalanx/tick_pb";
import { arrowLength, forceScale } from "../../../src/view3d/force_scale";
import { HandScene } from "../../../src/view3d/hand_scene";
import type { DrawnVertex } from "../../../src/view3d/posed_hand";
import { qualityLevels } from "../../../src/view3d/quality";
import { strings } from "../../../src/strings";
import { shapesOf } from "../../../src/view3d/shapes";

const segments = 16;

function meshOf(shape: BufferGeometry): MeshMessage {
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

/// Slides, or sticks, with two contact points of one segment, the second of which slips.
function sliding(slips: boolean): Tick {
  const made = tick(2);
  made.contact[0]!.slips = slips;
  made.contactPoint = [0, 1].map((i) =>
    create(ContactPointSchema, { segment: 5, point: [0.1, 0.01 * i, 0.1], normal: [0, 0, 1], force: 1, coefficient: 0.75, slips: i === 1 }),
  );
  return made;
}

/// Vertices of the skin at poses of the shown hand.
function drawnAt(input: Geometry, gdpPose: number[]): DrawnVertex[] {
  const scene = new HandScene();
  scene.setGeometry(shapesOf(input));
  scene.show({ ...tick(1), gdpPose });
  const drawn = scene.hands.shownSkin();
  expect(drawn.length).toBe(64);
  return drawn;
}

afterEach(() => vi.restoreAllMocks());

describe("where it is drawn", () => {
  for (const withSkin of [true, false]) {
    it(`each segment's origin comes back from the bones' matrices (${withSkin ? "skin" : "segments"})`, () => {
      const scene = new HandScene();
      scene.setGeometry(shapesOf(geometry(withSkin)));
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
  it("the skin is where its bones take it, by hand: turned by 0.2 about each of two bones, half of each", () => {
    const input = geometry(true);
    const scene = new HandScene();
    scene.setGeometry(shapesOf(input));
    scene.show(tick(1));
    const drawn = scene.hands.shownSkin();
    expect(drawn.length).toBe(64);
    const [cos, sin] = [Math.cos(0.5 - 0.3), Math.sin(0.5 - 0.3)]; // shown at 0.5, bound at 0.3
    for (const { vertex, at } of drawn) {
      const [x, y, z] = input.skin!.mesh!.position.slice(3 * vertex, 3 * vertex + 3) as [number, number, number];
      const middle = 0.02 * 3.5; // of the origins of bones 3 and 4
      expect(at[0]).toBeCloseTo(middle + cos * (x - middle) - sin * y, 6);
      expect(at[1]).toBeCloseTo(sin * (x - middle) + cos * y, 6);
      expect(at[2]).toBeCloseTo(z, 6); // bound and shown at the same height
    }
  });
  it("the skin keeps its distance from a bent joint, by hand: half of each of two bones, at a right angle", () => {
    const input = geometry(true);
    const straight = input.skin!.bindPose = poses(0);
    const bent = [...straight];
    bent.splice(7 * 4 + 3, 4, 0, 0, Math.SQRT1_2, Math.SQRT1_2); // bone 4 turns by 90 degrees about its origin
    for (const { vertex, at } of drawnAt(input, bent)) {
      const [x, y, z] = input.skin!.mesh!.position.slice(3 * vertex, 3 * vertex + 3) as [number, number, number];
      const arm = x - 0.02 * 3.5; // from the centre, half way between the bones' axes, which are along z
      // The centre is 0.01 from bone 4's origin, along -x; turned, it is there along -y: half way is the mean of both.
      expect(at[0]).toBeCloseTo(0.02 * 4 - 0.005 + Math.SQRT1_2 * (arm - y), 6); // half of the turn
      expect(at[1]).toBeCloseTo(-0.005 + Math.SQRT1_2 * (arm + y), 6);
      expect(at[2]).toBeCloseTo(z, 6); // the turn is about z
    }
  });
  it("a finger bent by more than half a turn blends the way it was bent", () => {
    const input = geometry(true);
    input.skin!.segment = input.skin!.segment.map((segment) => (segment === 4 ? 5 : segment)); // half of bone 3, half of bone 5
    const straight = input.skin!.bindPose = poses(0);
    const bent = [...straight];
    const turn = (bone: number, degrees: number): void => {
      const half = (degrees * Math.PI) / 360;
      bent.splice(7 * bone + 3, 4, 0, 0, Math.sin(half), Math.cos(half));
    };
    turn(4, 100);
    turn(5, 200 - 360); // the quaternion with the other sign of 200 degrees: the same pose
    const [cos, sin] = [Math.cos((100 * Math.PI) / 180), Math.sin((100 * Math.PI) / 180)];
    const [far, across] = [Math.cos((200 * Math.PI) / 180), Math.sin((200 * Math.PI) / 180)];
    for (const { vertex, at } of drawnAt(input, bent)) {
      const [x, y] = input.skin!.mesh!.position.slice(3 * vertex, 3 * vertex + 2) as [number, number];
      const arm = x - 0.02 * 4; // the centre, between bones 3 and 5, 0.02 from bone 5
      expect(at[0]).toBeCloseTo((0.02 * 4 + 0.02 * 5 - 0.02 * far) / 2 + cos * arm - sin * y, 6);
      expect(at[1]).toBeCloseTo((-0.02 * across) / 2 + sin * arm + cos * y, 6);
    }
  });
  it("every material of the hand, its shadow's too, is skinned about the centres of rotation", () => {
    const scene = new HandScene();
    scene.setGeometry(shapesOf(geometry(true)));
    const drawn: Material[] = [];
    for (const part of [scene.scene, scene.over]) {
      part.traverse((node) => {
        if (node instanceof SkinnedMesh) drawn.push(node.material as Material);
        if (node instanceof SkinnedMesh && node.castShadow) drawn.push(node.customDepthMaterial!);
      });
    }
    expect(drawn.length).toBeGreaterThan(3);
    for (const material of drawn) {
      const own = material instanceof ShaderMaterial ? material.vertexShader : ShaderLib[material instanceof MeshDepthMaterial ? "depth" : "standard"].vertexShader;
      const shader = { vertexShader: own, fragmentShader: "", uniforms: {} };
      material.onBeforeCompile(shader as unknown as WebGLProgramParametersWithUniforms, null as unknown as WebGLRenderer);
      expect(shader.vertexShader).toContain("movedBy(skinMotion, transformed)");
      expect(shader.vertexShader).not.toMatch(/#include <skin/);
    }
  });
  it("nothing before the first tick, and nothing moves by half a hand, which is grey until a whole one comes", () => {
    const scene = new HandScene();
    scene.setGeometry(shapesOf(geometry(true)));
    expect(scene.hands.shownOrigins()).toEqual([]);
    scene.show(tick(1));
    const before = scene.hands.shownOrigins();
    expect(scene.dead).toBe(false);
    expect(scene.show({ ...tick(1), gdpPose: poses(1).slice(7) })).toBe(false);
    expect(scene.hands.shownOrigins()).toEqual(before);
    expect(scene.dead).toBe(true);
    expect(scene.marks.drawn()).toEqual([]);
    expect(scene.hands.ghostGroup.visible).toBe(false);
    expect(scene.show(tick(1))).toBe(true);
    expect(scene.dead).toBe(false);
    expect(scene.marks.drawn()).toHaveLength(1);
  });
  it("a measured hand that is not whole is no ghost", () => {
    const scene = new HandScene();
    scene.setGeometry(shapesOf(geometry(true)));
    scene.show(tick(1));
    scene.show({ ...tick(1), hcpPose: [] });
    expect(scene.hands.shownOrigins()).toHaveLength(segments);
    expect(scene.hands.ghostOrigins()).toEqual([]);
    scene.hands.ghostGroup.children.forEach((mesh) => expect(mesh.visible).toBe(false));
  });
  it("stays where it is when the skin is switched off", () => {
    const scene = new HandScene();
    scene.setGeometry(shapesOf(geometry(true)));
    scene.show(tick(1));
    const before = scene.hands.shownOrigins();
    scene.setParts({ skin: false, ghost: true, arrows: true, object: true, cones: false });
    scene.hands.shownOrigins().forEach((origin, i) => origin.forEach((x, k) => expect(x).toBeCloseTo(before[i]![k]!, 6)));
  });
  it("a new hand is not seen in the old one's place", () => {
    const scene = new HandScene();
    scene.setGeometry(shapesOf(geometry(true)));
    scene.show(tick(1));
    scene.setGeometry(shapesOf(geometry(true)));
    expect(scene.hands.shownOrigins()).toEqual([]);
    expect(scene.hands.shownGroup.visible).toBe(false);
  });
});

describe("arrows", () => {
  it("are to scale, with the factor of the station", () => {
    const scene = new HandScene();
    scene.setGeometry(shapesOf(geometry(false)));
    scene.show(tick(4, 0.5));
    const [arrow, ...others] = scene.marks.drawn();
    expect(others).toEqual([]);
    expect(arrow!.segment).toBe(5);
    expect(arrow!.length).toBeCloseTo(arrowLength(forceScale(Infinity), 2), 6);
  });
  it("there is none without force", () => {
    const scene = new HandScene();
    scene.setGeometry(shapesOf(geometry(false)));
    for (const nothing of [tick(0), tick(5, 0), tick(NaN)]) {
      scene.show(nothing);
      expect(scene.marks.drawn()).toEqual([]);
    }
  });
  it("end at the limit of a digit, whose words are at the tip of the strongest; a force that is not felt is hollow", () => {
    const scene = new HandScene();
    scene.setGeometry(shapesOf(geometry(false)));
    scene.show(tick(4));
    expect(scene.labels().map(({ text, felt }) => [text, felt])).toEqual([["4.0 N", true]]);
    const full = arrowLength(forceScale(4), 4);
    scene.setForces(forceScale(4), [true, false, true, true, true]);
    expect(scene.marks.drawn()[0]!.length).toBeCloseTo(full, 6);
    expect(scene.marks.drawn()[0]!.felt).toBe(false); // segment 5 is the index finger's
    expect(scene.labels().map(({ text, felt }) => [text, felt])).toEqual([["4.0 N", false]]);
    scene.setForces(forceScale(4), []);
    expect(scene.labels().map(({ text, felt }) => [text, felt])).toEqual([[strings.atLimitOf("4.0 N"), true]]);
    scene.labels()[0]!.tip.forEach((x, k) => expect(x).toBeCloseTo([0.1, 0, 0.1 + full][k]!, 6));
    scene.setLost(true);
    expect(scene.labels()).toEqual([]);
  });
  it("without a whole point or direction are left out", () => {
    const scene = new HandScene();
    scene.setGeometry(shapesOf(geometry(false)));
    for (const bad of [{ point: [NaN, 0, 0] }, { point: [] }, { normal: [0, 0, 0] }, { segment: 16 }]) {
      const spoilt = tick(1);
      Object.assign(spoilt.contact[0]!, bad);
      scene.show(spoilt);
      expect(scene.marks.drawn()).toEqual([]);
    }
  });
});

describe("contact points", () => {
  it("each has a ring, and one that slips a dashed ring around it", () => {
    const scene = new HandScene();
    scene.setGeometry(shapesOf(geometry(false)));
    scene.show(tick(2));
    expect(scene.marks.counts()).toEqual({ rings: 1, cones: 0 });
    for (const slips of [true, false]) {
      scene.show(sliding(slips));
      expect(scene.marks.counts().rings).toBe(3); // two points, one of which slips
      expect(scene.marks.drawn().map((arrow) => arrow.slips)).toEqual([slips]);
    }
  });
  it("have cones on demand, as wide as friction allows, whether or not there are arrows", () => {
    const scene = new HandScene();
    scene.setGeometry(shapesOf(geometry(false)));
    scene.show(sliding(true));
    expect(scene.marks.counts().cones).toBe(0);
    scene.setParts({ skin: true, ghost: true, arrows: false, object: true, cones: true });
    expect(scene.marks.counts()).toEqual({ rings: 0, cones: 2 });
    const [surface, rim] = scene.marks.cones.children as [InstancedMesh, InstancedMesh];
    for (const [i, y] of [0, 0.01].entries()) {
      const placed = new Matrix4();
      surface.getMatrixAt(i, placed);
      // The tip is at the point. On the rim, across divided by along the normal is the coefficient.
      expect(new Vector3(0, 0, 0).applyMatrix4(placed).toArray().map((x) => +x.toFixed(6))).toEqual([0.1, y, 0.1]);
      const edge = new Vector3(1, 0, 1).applyMatrix4(placed);
      expect(Math.hypot(edge.x - 0.1, edge.y - y) / (edge.z - 0.1)).toBeCloseTo(0.75, 3);
      rim.getMatrixAt(i, placed);
      expect(new Vector3(1, 0, 1).applyMatrix4(placed).distanceTo(edge)).toBeLessThan(1e-9);
    }
    scene.setLost(true);
    expect(scene.marks.counts().cones).toBe(0);
  });
  it("that are not whole are left out, and a coefficient that is no number is none", () => {
    const scene = new HandScene();
    scene.setGeometry(shapesOf(geometry(false)));
    scene.setParts({ skin: true, ghost: true, arrows: true, object: true, cones: true });
    for (const bad of [{ point: [NaN, 0, 0] }, { point: [] }, { normal: [0, 0, 0] }, { normal: [Infinity, 0, 0] }, { segment: 16 }]) {
      const spoilt = sliding(false);
      Object.assign(spoilt.contactPoint[1]!, bad);
      scene.show(spoilt);
      expect(scene.marks.counts()).toEqual({ rings: 1, cones: 1 });
    }
    const many = sliding(false);
    many.contactPoint = Array.from({ length: 500 }, () => many.contactPoint[0]!);
    many.contactPoint[3] = { ...many.contactPoint[3]!, coefficient: NaN };
    scene.show(many);
    expect(scene.marks.counts().cones).toBe(80);
    const placed = new Matrix4();
    (scene.marks.cones.children[0] as InstancedMesh).getMatrixAt(3, placed);
    expect(placed.elements.every((x) => Number.isFinite(x))).toBe(true);
  });
});

describe("a lost connection", () => {
  it("takes ghost and arrows away at once, and gives them back", () => {
    const scene = new HandScene();
    scene.setGeometry(shapesOf(geometry(true)));
    scene.show(tick(2));
    expect(scene.hands.ghostGroup.visible).toBe(true);
    scene.setLost(true);
    expect(scene.hands.ghostGroup.visible).toBe(false);
    expect(scene.marks.drawn()).toEqual([]);
    scene.setTheme("light"); // must not bring them back
    scene.setParts({ skin: true, ghost: true, arrows: true, object: true, cones: false });
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
    const inputs = shapesOf(geometry(true));
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
      scene.setParts({ skin: i % 2 === 0, ghost: true, arrows: true, object: true, cones: false });
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
  if (node instanceof Mesh && node.customDepthMaterial) into.add(node.customDepthMaterial);
}

describe("a skin that does not fit together", () => {
  it("is not shown, but the segments are", () => {
    for (const spoil of ["segment", "weight", "bindPose"] as const) {
      const made = geometry(true);
      made.skin![spoil] = made.skin![spoil].slice(1);
      const scene = new HandScene();
      scene.setGeometry(shapesOf(made));
      scene.show(tick(1));
      expect(scene.hands.shownOrigins()).toHaveLength(segments);
      expect(scene.hands.shownSkin()).toEqual([]);
    }
  });
});

describe("the fingers' shade on the object", () => {
  it("is that of the right finger where a segment has no surface", () => {
    const made = geometry(false);
    made.segment[1] = create(MeshSchema, {});
    const scene = new HandScene();
    scene.setGeometry(shapesOf(made));
    scene.show(tick(1));
    // Each capsule's middle is its segment's origin: a box around it, 2 cm from the next.
    const middles = scene.hands.capsules().map(({ from, to }) => (from[0] + to[0]) / 2);
    const expected = Array.from({ length: 15 }, (_, segment) => 0.02 * segment).filter((_, segment) => segment !== 1);
    expect(middles.length).toBe(14);
    middles.forEach((x, i) => expect(x).toBeCloseTo(expected[i]!, 6));
  });
});

describe("a renderer that goes", () => {
  it("is held by nothing that it has drawn: shapes, materials, bones, arrows and shadow, of both looks", () => {
    const scene = new HandScene();
    scene.setGeometry(shapesOf(geometry(true)));
    scene.show(tick(1));
    const drawn = new Set<EventDispatcher<{ dispose: object }>>();
    const collectAll = () => [scene.scene, scene.over].forEach((part) => part.traverse((node) => drawnOf(node).forEach((one) => drawn.add(one))));
    for (const skin of [true, false]) {
      scene.setParts({ skin, ghost: true, arrows: true, object: true, cones: false });
      for (const settings of qualityLevels) {
        scene.setQuality(settings, null);
        collectAll();
      }
    }
    expect(drawn.size).toBeGreaterThan(15);
    const held = new Set(drawn);
    drawn.forEach((one) => one.addEventListener("dispose", () => held.delete(one))); // as a renderer does
    scene.release();
    expect([...held].map((one) => one.constructor.name)).toEqual([]);
    scene.show(tick(1)); // and all is still there to be drawn by the next
    expect(scene.hands.shownOrigins()).toHaveLength(segments);
    expect(scene.marks.drawn()).toHaveLength(1);
  });
});

/// What of a node a renderer keeps things for, and listens to until it is disposed of.
function drawnOf(node: object): EventDispatcher<{ dispose: object }>[] {
  const found: unknown[] = [];
  if (node instanceof Mesh) found.push(node.geometry, node.material);
  if (node instanceof InstancedMesh) found.push(node);
  if (node instanceof SkinnedMesh) found.push(node.skeleton.boneTexture, node.customDepthMaterial ?? null);
  return found.filter((one) => one !== null) as EventDispatcher<{ dispose: object }>[];
}
