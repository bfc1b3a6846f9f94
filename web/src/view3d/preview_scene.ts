// SPDX-License-Identifier: Apache-2.0
// The content of a mesh's preview: the mesh on a table, upright, and a bar of known length before it. It does not use the canvas.
import { BackSide, Box3, BoxGeometry, Color, DoubleSide, Euler, MathUtils, Matrix4, Mesh, MeshBasicMaterial, Scene, Vector3 } from "three";
import type { BufferGeometry, WebGLRenderer } from "three";
import { uprightRotation, type UpAxis } from "../state/up_axis";
import { themes, type ThemeName } from "../theme";
import type { MeshPreview } from "../wire/import_report";
import { creaseNormals } from "./crease_normals";
import { objectShape } from "./hand_shape";
import { Lights } from "./lights";
import { ObjectMaterial } from "./object_material";
import type { QualitySettings } from "./quality";
import { kObjectCrease } from "./shapes";
import { Surroundings } from "./surroundings";
import { Table } from "./table";
import { undersideOf } from "./underside";

const kLongBar = 0.1; // [m] about a palm's breadth
const kShortBar = 0.01; // before a mesh that is much smaller than a palm
const kSmall = 0.03; // [m] largest extent of such a mesh
const kBarThickness = 0.02; // of its length
const kGap = 0.12; // between bar and mesh, of the larger of both

export class PreviewScene {
  readonly scene = new Scene();
  readonly lights = new Lights();
  private readonly table = new Table();
  private readonly surroundings = new Surroundings();
  private readonly background = new Color();
  private readonly asInFile: BufferGeometry;
  private readonly object: Mesh<BufferGeometry, ObjectMaterial>;
  private readonly bar = new Mesh(new BoxGeometry(1, kBarThickness, kBarThickness), new MeshBasicMaterial());

  constructor({ position, index }: MeshPreview) {
    this.asInFile = objectShape(creaseNormals(position, index, kObjectCrease))!;
    const material = new ObjectMaterial();
    material.side = DoubleSide; // an open surface is seen from both sides
    material.shadowSide = BackSide;
    this.object = new Mesh(this.asInFile.clone(), material);
    this.object.castShadow = this.object.receiveShadow = true;
    this.scene.background = this.background;
    this.scene.add(this.lights.group, this.table.group, this.object, this.bar);
    this.bar.scale.setScalar(Math.max(...this.extent) < kSmall ? kShortBar : kLongBar);
    this.setUp("z");
    this.setTheme("dark");
  }

  setUp(up: UpAxis): void {
    this.object.geometry.dispose();
    this.object.geometry = this.asInFile.clone().applyMatrix4(rotationTo(up));
    const { box } = this;
    const side = Math.max(this.barLength, ...this.extent);
    const thick = kBarThickness * this.barLength;
    this.bar.position.set((box.min.x + box.max.x) / 2, box.min.y - kGap * side, box.min.z + thick / 2);
    const { position } = this.object.geometry.attributes;
    this.table.standUnder(box, undersideOf(position!.array, this.object.geometry.index!.array), new Box3());
    this.lights.cover(box);
  }

  setTheme(name: ThemeName): void {
    const theme = themes[name];
    this.background.set(theme.background);
    this.table.setTheme(theme, name === "dark");
    this.lights.setTheme(name === "dark");
    this.scene.environmentIntensity = this.lights.intensity;
    this.object.material.setSky(theme.sky, theme.table);
    this.bar.material.color.set(theme.text);
  }

  setQuality(settings: QualitySettings, renderer: WebGLRenderer): void {
    this.lights.setShadow(settings.shadow);
    this.object.material.setRich(settings.rich);
    this.table.setGrain(settings.grain);
    this.scene.environment = settings.rich ? this.surroundings.texture(renderer) : null;
    this.lights.setSurrounded(settings.rich);
  }

  /// Of the mesh as it stands [m].
  get extent(): readonly [number, number, number] {
    return this.box.getSize(new Vector3()).toArray();
  }

  get barLength(): number {
    return this.bar.scale.x;
  }

  /// The middle of the bar.
  get barAt(): Vector3 {
    return this.bar.position;
  }

  /// All of these have to be in the picture.
  corners(): Vector3[] {
    const { min, max } = this.box;
    const ends = [-1, 1].map((end) => this.bar.position.clone().setX(this.bar.position.x + (end * this.barLength) / 2));
    const box = Array.from({ length: 8 }, (_, i) => new Vector3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z));
    return [...ends, ...box];
  }

  /// Releases the renderer's resources. Later drawing creates them again.
  release(): void {
    this.object.geometry.dispose();
    this.object.material.dispose();
    this.bar.geometry.dispose();
    this.bar.material.dispose();
    this.table.dispose();
    this.lights.dispose();
    this.scene.environment = null;
    this.surroundings.release();
  }

  private get box(): Box3 {
    return this.object.geometry.boundingBox!;
  }
}

/// Turns the file's axes so that this one points up.
export function rotationTo(up: UpAxis): Matrix4 {
  const [roll, pitch, yaw] = uprightRotation[up].map(MathUtils.degToRad) as [number, number, number];
  return new Matrix4().makeRotationFromEuler(new Euler(roll, pitch, yaw, "ZYX"));
}
