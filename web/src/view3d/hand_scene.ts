// SPDX-License-Identifier: Apache-2.0
// The content of the picture: hand, ghost, object, contacts, table and lights. It does not use the canvas.
import { Box3, BufferGeometry, Color, Mesh, Scene, Vector3 } from "three";
import type { WebGLRenderer } from "three";
import type { Tick } from "../gen/phalanx/tick_pb";
import { digitForces } from "../state/channels";
import { strings } from "../strings";
import { digitColours, themes } from "../theme";
import type { ThemeName } from "../theme";
import type { Sight } from "./camera_presets";
import { ContactFocus } from "./contact_focus";
import { ContactMarks, marksOf, pointsOf } from "./contact_marks";
import type { Mark, PointMark } from "./contact_marks";
import type { ForceLabel } from "./force_labels";
import { forceScale, isAtLimit, shareOf, type ForceScale } from "./force_scale";
import type { Press } from "./hand_material";
import { HandPair } from "./hand_pair";
import { objectShape } from "./hand_shape";
import type { ShownParts } from "./hand_view";
import { Lights } from "./lights";
import { ObjectMaterial, type Touch } from "./object_material";
import { MotionExtent } from "./motion_extent";
import type { QualitySettings } from "./quality";
import { kPalm, kSegments, kSegmentsPerDigit } from "./segments";
import type { Shapes } from "./shapes";
import { kUsualTone, skinTones, type SkinToneName } from "./skin_tones";
import { Surroundings } from "./surroundings";
import { Table } from "./table";
import type { Underside } from "./underside";

const kLeastFigure = 0.05; // [N] a smaller force has none
const kTouchRadius = 0.011; // of the colour on the object around a contact [m]

export class HandScene {
  readonly scene = new Scene();
  readonly over = new Scene(); // drawn over it, with a depth of its own
  readonly lights = new Lights();
  readonly hands = new HandPair();
  readonly marks = new ContactMarks();
  private readonly table = new Table();
  private readonly surroundings = new Surroundings();
  private readonly background = new Color();
  private readonly objectMaterial = new ObjectMaterial();
  private object: Mesh<BufferGeometry, ObjectMaterial> | null = null;
  private surfaces: { touched: BufferGeometry; smooth: BufferGeometry; underside: Underside | null } | null = null; // of the object
  private smooth = true;
  private tone: SkinToneName = kUsualTone;
  private scale = forceScale(Infinity);
  private parts: ShownParts = { skin: true, ghost: true, arrows: true, object: true, cones: false };
  private theme: ThemeName = "dark";
  private lost = false;
  private whole = true; // the newest tick had a whole hand
  private left = false;
  private contacts: readonly Mark[] = [];
  private points: readonly PointMark[] = [];
  private forces: readonly number[] = []; // of each digit [N]
  private covered = new Box3(); // by the shadow
  private reached = new Box3(); // by the hand so far
  private readonly focus = new ContactFocus();
  private readonly motion = new MotionExtent();
  private followed: Vector3 | null = null; // place of the contact that a camera follows

  constructor() {
    this.scene.background = this.background;
    this.scene.add(this.lights.group, this.table.group, this.hands.shownGroup, this.marks.solid);
    this.over.add(this.hands.ghostGroup, this.marks.cones, this.marks.faint);
    this.setTheme(this.theme);
  }

  setGeometry(shapes: Shapes): void {
    this.left = shapes.left;
    this.hands.setGeometry(shapes);
    this.dropObject();
    const touched = objectShape(shapes.object);
    if (touched) {
      this.surfaces = { touched, smooth: objectShape(shapes.objectDisplay) ?? touched, underside: shapes.underside };
      this.object = new Mesh(this.smooth ? this.surfaces.smooth : touched, this.objectMaterial);
      this.object.castShadow = this.object.receiveShadow = true;
      this.scene.add(this.object);
      this.objectMaterial.setGrain(touched.boundingBox!);
    }
    this.covered.makeEmpty();
    this.reached.makeEmpty();
    this.focus.forget();
    this.motion.forget();
    this.standTable();
    this.contacts = [];
    this.points = [];
    this.paint();
  }

  /// @param now  [s]  @returns false, and the hand stays where it was and is grey, if the tick's is not whole
  show(tick: Tick, now = 0): boolean {
    this.whole = this.hands.pose(tick.gdpPose, tick.hcpPose);
    if (this.whole) {
      this.contacts = marksOf(tick);
      this.points = pointsOf(tick);
      this.forces = digitForces(tick);
      this.coverHand();
      this.motion.add(this.hands.corners(), now);
    }
    this.paint();
    return this.whole;
  }

  /// The picture is old.
  get dead(): boolean {
    return this.lost || !this.whole;
  }

  setParts(parts: ShownParts): void {
    this.parts = parts;
    this.hands.useSkin(parts.skin);
    this.paint();
  }

  setLost(lost: boolean): void {
    this.lost = lost;
    this.paint();
  }

  /// Kind of the object, as scenes name it; empty: not known.
  setObjectKind(kind: string): void {
    this.objectMaterial.setKind(kind);
  }

  /// @param felt  of each digit: its force can be felt
  setForces(scale: ForceScale, felt: readonly boolean[]): void {
    this.scale = scale;
    this.marks.setForces(scale, felt);
    this.paint();
  }

  /// Figures at the arrows' tips: each segment's force, and the words of a digit at its limit at the strongest of its arrows.
  labels(): ForceLabel[] {
    if (!this.marks.solid.visible) return [];
    return this.contacts.filter(({ force }) => force >= kLeastFigure).map((mark) => {
      const digit = Math.floor(mark.segment / kSegmentsPerDigit);
      const strongest = this.contacts.every(({ segment, force }) => Math.floor(segment / kSegmentsPerDigit) !== digit || force <= mark.force);
      const felt = this.marks.isFelt(mark.segment);
      const atLimit = mark.segment !== kPalm && felt && strongest && isAtLimit(this.scale, this.forces[digit] ?? 0);
      const figure = `${mark.force.toFixed(1)} ${strings.units.newton}`;
      return { text: atLimit ? strings.atLimitOf(figure) : figure, tip: this.marks.tipOf(mark), felt };
    });
  }

  setSkinTone(tone: SkinToneName): void {
    this.tone = tone;
    this.paint();
  }

  setTheme(name: ThemeName): void {
    this.theme = name;
    const theme = themes[name];
    this.background.set(theme.background);
    this.table.setTheme(theme, name === "dark");
    this.lights.setTheme(name === "dark");
    this.scene.environmentIntensity = this.lights.intensity;
    this.marks.setColours({ digits: digitColours[name], palm: theme.arrow, around: theme.background, unfelt: theme.quiet });
    this.hands.setGhostColour(theme.ghost);
    this.objectMaterial.setSky(theme.sky, theme.table);
    this.paint();
  }

  /// @param renderer  which draws it; null: no surroundings
  setQuality(settings: QualitySettings, renderer: WebGLRenderer | null): void {
    this.lights.setShadow(settings.shadow);
    this.objectMaterial.setRich(settings.rich);
    this.hands.setDetail(settings.rich);
    this.hands.setGhostDetail(settings.ghost);
    this.table.setGrain(settings.grain);
    this.smooth = settings.smooth;
    if (this.object && this.surfaces) this.object.geometry = this.smooth ? this.surfaces.smooth : this.surfaces.touched;
    this.scene.environment = settings.rich && renderer ? this.surroundings.texture(renderer) : null;
    this.lights.setSurrounded(this.scene.environment !== null);
  }

  sight(): Sight {
    return {
      hand: this.motion.points(),
      object: cornersOf(this.surfaces?.touched.boundingBox ?? null),
      palm: this.hands.palm(),
      left: this.left,
      contact: this.followed ?? this.grip(),
    };
  }

  /// Chooses the contact that a camera follows. Once a frame. @param step  since the last frame [s]
  follow(step: number): void {
    const at = this.focus.update(this.dead ? [] : this.contacts, Math.min(step, 0.1));
    this.followed = at && new Vector3(...at);
  }

  /// Between the tips of thumb and index.
  private grip(): Vector3 | null {
    const thumb = this.hands.middleOf(2);
    const index = this.hands.middleOf(5);
    return thumb && index ? thumb.add(index).multiplyScalar(0.5) : null;
  }

  /// Releases the renderer's resources of the scene, so that the renderer can be deleted. Later drawing creates them again.
  release(): void {
    this.surfaces?.touched.dispose();
    this.surfaces?.smooth.dispose();
    this.hands.release();
    this.marks.dispose();
    this.table.dispose();
    this.scene.environment = null;
    this.surroundings.release();
    this.lights.dispose();
    this.objectMaterial.dispose();
  }

  dispose(): void {
    this.release();
    this.dropObject();
    this.hands.dispose();
  }

  /// Colours and visibility, all from what is known: there is no order in which to call the rest.
  private paint(): void {
    const theme = themes[this.theme];
    const { dead } = this;
    const contacts = dead ? [] : this.contacts;
    if (dead) this.hands.paintLost(theme.lost);
    else this.hands.paint(skinTones[this.tone], this.pressing(contacts));
    this.hands.ghostGroup.visible = this.parts.ghost && !dead;
    this.marks.show(contacts, dead ? [] : this.points);
    this.marks.visible = this.parts.arrows && !dead;
    this.marks.cones.visible = this.parts.cones && !dead;
    if (this.object) this.object.visible = this.parts.object;
    this.objectMaterial.setTouches(this.pressing(contacts.filter((mark) => mark.touching)), kTouchRadius);
    this.objectMaterial.setFingers(this.hands.capsules());
  }

  /// The shadow's box and what the hand has reached grow with the hand, and do not shrink: a map that changes its scale with every tick
  /// would flicker, and a table that follows the hand would be none.
  private coverHand(): void {
    const hand = new Box3().setFromPoints(this.hands.corners());
    const object = this.surfaces?.touched ?? null;
    if (!this.reached.containsBox(hand)) {
      this.reached.union(hand.clone().expandByScalar(0.01));
      const foot = object?.boundingBox?.min.z ?? Infinity;
      if (this.reached.min.z < Math.min(foot, this.table.height) || !object) this.standTable();
    }
    this.table.castHand(this.hands.capsules(kSegments));
    if (this.covered.isEmpty() && object) this.covered.copy(object.boundingBox!);
    if (this.covered.containsBox(hand)) return;
    this.covered.union(hand).expandByScalar(0.01);
    this.lights.cover(this.covered);
  }

  private standTable(): void {
    this.table.standUnder(this.surfaces?.touched.boundingBox ?? null, this.surfaces?.underside ?? null, this.reached);
  }

  /// A force that is not felt gives no colour.
  private pressing(marks: readonly Mark[]): (Press & Touch)[] {
    return marks.map(({ segment, point, force }) => ({ segment, point, share: this.marks.isFelt(segment) ? shareOf(this.scale, force) : 0 }));
  }

  private dropObject(): void {
    this.object?.removeFromParent();
    this.surfaces?.touched.dispose();
    this.surfaces?.smooth.dispose();
    this.object = this.surfaces = null;
  }
}

function cornersOf(box: Box3 | null): Vector3[] {
  if (!box || box.isEmpty()) return [];
  const { min, max } = box;
  return Array.from({ length: 8 }, (_, i) => new Vector3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z));
}
