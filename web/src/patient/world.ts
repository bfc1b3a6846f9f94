// SPDX-License-Identifier: Apache-2.0
// Sky, hills and water. All of it is calculated for each direction of sight, so that the water mirrors what the sky shows.
import { BackSide, Color, Mesh, PlaneGeometry, ShaderMaterial, SphereGeometry, Vector3, type IUniform } from "three";

/// Colours of a time of day, as displayed.
interface Hour {
  readonly zenith: string;
  readonly middle: string;
  readonly horizon: string;
  readonly sun: string;
  readonly mist: string;
  readonly far: string; // hills
  readonly near: string;
  readonly deep: string; // water that is seen from above
  readonly height: number; // of the sun [rad]
}
const kHours: readonly Hour[] = [
  { zenith: "#6d9cc6", middle: "#b3cfdc", horizon: "#ffe2c0", sun: "#ffd49a", mist: "#f3dfcf", far: "#a9bccb", near: "#557c83", deep: "#2a6577", height: 0.16 },
  { zenith: "#4a8fc4", middle: "#9bcbe2", horizon: "#e9f4ee", sun: "#fff0c8", mist: "#dcebea", far: "#9fbfcd", near: "#4c8079", deep: "#1f6b82", height: 0.34 },
  { zenith: "#4d5e98", middle: "#c39ab0", horizon: "#ffc793", sun: "#ffb877", mist: "#f2c3a8", far: "#a48fb0", near: "#5c5f82", deep: "#2f4f7a", height: 0.12 },
];
const kNight: Hour = { zenith: "#05090d", middle: "#0a1218", horizon: "#16242e", sun: "#22333f", mist: "#131f28", far: "#101a22", near: "#0b141b", deep: "#07131b", height: 0.1 };

const kReach = 400; // of sky and water
const kSunAzimuth = 0.32; // [rad] right of straight ahead

const common = `
uniform float time;
uniform vec3 zenith; uniform vec3 middle; uniform vec3 horizon; uniform vec3 sun; uniform vec3 mist; uniform vec3 far; uniform vec3 near;
uniform vec3 towards;

float hash(vec2 p) { p = fract(p * vec2(123.34, 456.21)); p += dot(p, p + 45.32); return fract(p.x * p.y); }
float noise(vec2 p) {
  vec2 i = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(hash(i), hash(i + vec2(1, 0)), f.x), mix(hash(i + vec2(0, 1)), hash(i + vec2(1, 1)), f.x), f.y);
}
float ridge(float a, float k) {
  float s = k * 17.3;
  return 0.5 * sin(a * (2.1 + 0.7 * k) + s) + 0.28 * sin(a * (5.3 + k) + 1.7 * s) + 0.14 * sin(a * (11.0 + 2.0 * k) + 2.3 * s) + 0.05 * sin(a * 29.0 + 3.1 * s);
}
vec3 heaven(vec3 d, bool clouds) {
  float h = max(d.y, 0.0);
  vec3 c = mix(horizon, middle, smoothstep(0.0, 0.24, h));
  c = mix(c, zenith, smoothstep(0.12, 0.72, h));
  float s = max(dot(d, towards), 0.0);
  c = mix(c, sun, 0.55 * pow(s, 10.0) + 0.35 * pow(s, 90.0));
  c = mix(c, vec3(1.0, 0.985, 0.94), 0.92 * smoothstep(0.9985, 0.9993, s));
  if (clouds && d.y > 0.01) {
    vec2 p = d.xz / (d.y + 0.16) * 0.9 + vec2(0.008 * time, 0.0);
    float n = 0.55 * noise(p * vec2(0.9, 2.2)) + 0.3 * noise(p * vec2(2.1, 5.0) + 7.0) + 0.15 * noise(p * vec2(4.7, 11.0) + 3.0);
    c = mix(c, mix(vec3(1.0), sun, 0.35), 0.62 * smoothstep(0.48, 0.86, n) * smoothstep(0.01, 0.16, d.y) * smoothstep(0.95, 0.35, d.y));
  }
  float a = atan(d.x, -d.z);
  for (int i = 0; i < 4; ++i) {
    float k = float(i);
    float top = 0.115 - 0.022 * k + (0.062 - 0.011 * k) * ridge(a, k);
    float edge = 0.0012 + 0.0006 * k;
    vec3 hill = mix(far, near, k / 3.0);
    hill = mix(hill, sun, 0.20 * pow(s, 6.0));
    hill = mix(mist, hill, smoothstep(-0.01, top + 0.012, d.y));
    c = mix(c, hill, smoothstep(top + edge, top - edge, d.y));
  }
  return c;
}
float grain(vec2 p) { return (hash(p) - 0.5) / 160.0; }
`;

const skyVertex = `
varying vec3 along;
void main() {
  along = position;
  vec4 at = projectionMatrix * vec4(mat3(modelViewMatrix) * position, 1.0);
  gl_Position = at.xyww;
}`;
const skyFragment = `
varying vec3 along;
${common}
void main() { gl_FragColor = vec4(heaven(normalize(along), true) + grain(gl_FragCoord.xy), 1.0); }`;

const waterVertex = `
varying vec3 at;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  at = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;
const waterFragment = `
varying vec3 at;
uniform vec3 deep;
uniform float travel;
uniform float half_width;
uniform float swell;
uniform float plain;
${common}
float slope_x; float slope_z;
void wave(vec2 p, vec2 k, float speed, float height) {
  float c = height * cos(dot(p, k) + speed * time);
  slope_x += k.x * c; slope_z += k.y * c;
}
void main() {
  vec3 sight = at - cameraPosition;
  float distance = length(sight);
  vec3 v = sight / distance;
  vec2 p = vec2(at.x, at.z - travel);
  p += 0.35 * vec2(sin(0.37 * p.y + 0.3 * time), sin(0.41 * p.x));
  slope_x = 0.0; slope_z = 0.0;
  float broad = swell / (1.0 + 0.0016 * distance * distance);
  float fine = swell * exp(-distance / 13.0);
  wave(p, vec2(0.5, 1.1), 0.7, 0.020 * broad);
  wave(p, vec2(-0.9, 1.6), 0.9, 0.014 * broad);
  wave(p, vec2(1.9, 2.9), 1.3, 0.0080 * fine);
  wave(p, vec2(-2.7, 3.7), 1.6, 0.0060 * fine);
  wave(p, vec2(4.3, 5.9), 2.1, 0.0032 * fine);
  wave(p, vec2(-6.7, 7.3), 2.4, 0.0022 * fine);
  vec3 n = normalize(vec3(-slope_x, 1.0, -slope_z));
  vec3 r = reflect(v, n);
  r.y = abs(r.y) + 0.004;
  vec3 sky = heaven(normalize(r), false);
  if (half_width > 0.0) {
    float reach = (half_width - sign(r.x) * at.x) / max(abs(r.x), 0.02);
    float hit = at.z + r.z * reach - travel;
    float crown = 1.25 + 1.5 * noise(vec2(0.42 * hit, 3.0 + sign(r.x))) + 0.9 * noise(vec2(1.7 * hit, 9.0));
    float covered = smoothstep(crown + 0.25, crown - 0.25, r.y * reach) * smoothstep(95.0, 20.0, distance + reach);
    sky = mix(sky, mix(near * 0.62, mist, smoothstep(10.0, 90.0, distance + reach)), 0.72 * covered);
  }
  float grazing = pow(1.0 - max(dot(-v, n), 0.0), 4.0);
  vec3 c = mix(deep, sky, clamp(0.16 + 0.95 * grazing, 0.0, 1.0));
  c += sun * 0.55 * pow(max(dot(normalize(r), towards), 0.0), 220.0);
  c = mix(c, mix(mist, horizon, 0.25), smoothstep(45.0, 170.0, distance) * 0.85);
  c = mix(c, deep, plain);
  gl_FragColor = vec4(c + grain(gl_FragCoord.xy), 1.0);
}`;

/// What is displayed as the style sheet writes it, since these shaders write the screen's own values.
const shown = (colour: string) => {
  const value = new Color().setStyle(colour, "");
  return new Vector3(value.r, value.g, value.b);
};
const kColours = ["zenith", "middle", "horizon", "sun", "mist", "far", "near", "deep"] as const;
const mixed = (one: number, other: number, share: number) => one + (other - one) * share;

export class World {
  readonly sky: Mesh;
  readonly water: Mesh;
  /// As the three.js lights and its fog take them.
  readonly mist = new Color();
  readonly sunColour = new Color();
  readonly towards = new Vector3(); // the sun
  private readonly uniforms: Record<string, IUniform> = {};
  private set = "";

  /// @param halfWidth  of a river between banks with trees, which the water mirrors; 0: a lake
  constructor(halfWidth = 0) {
    for (const name of kColours) this.uniforms[name] = { value: new Vector3() };
    Object.assign(this.uniforms, {
      time: { value: 0 }, travel: { value: 0 }, towards: { value: this.towards }, half_width: { value: halfWidth }, swell: { value: 1 }, plain: { value: 0 },
    });
    const { uniforms } = this;
    this.sky = new Mesh(new SphereGeometry(1, 24, 16), new ShaderMaterial({ uniforms, vertexShader: skyVertex, fragmentShader: skyFragment, side: BackSide, depthWrite: false, depthTest: false }));
    this.sky.frustumCulled = false;
    this.sky.renderOrder = -2;
    this.water = new Mesh(
      new PlaneGeometry(2 * kReach, 2 * kReach).rotateX(-Math.PI / 2),
      new ShaderMaterial({ uniforms, vertexShader: waterVertex, fragmentShader: waterFragment, depthWrite: false }),
    );
    this.water.renderOrder = 1; // after the banks, whose lower parts it covers
    this.setDay(0, false);
  }

  /// @param day  0 early morning .. 1 evening  @param contrast  a dark plain ground
  setDay(day: number, contrast: boolean): void {
    const set = `${day.toFixed(3)} ${contrast}`;
    if (set === this.set) return;
    this.set = set;
    const place = Math.min(1, Math.max(0, day)) * (kHours.length - 1);
    const first = Math.min(kHours.length - 2, Math.floor(place));
    const share = place - first;
    const [one, other] = contrast ? [kNight, kNight] : [kHours[first]!, kHours[first + 1]!];
    for (const name of kColours) (this.uniforms[name]!.value as Vector3).lerpVectors(shown(one[name]), shown(other[name]), share);
    const height = mixed(one.height, other.height, share);
    this.towards.set(Math.sin(kSunAzimuth) * Math.cos(height), Math.sin(height), -Math.cos(kSunAzimuth) * Math.cos(height));
    this.mist.set(one.mist).lerp(new Color(other.mist), share);
    this.sunColour.set(one.sun).lerp(new Color(other.sun), share);
    this.uniforms["plain"]!.value = contrast ? 0.7 : 0;
  }

  /// @param time  of the waves and clouds [s]  @param travel  how far the water has flowed towards the camera [m]  @param swell  0: a mirror
  move(time: number, travel: number, swell: number): void {
    this.uniforms["time"]!.value = time;
    this.uniforms["travel"]!.value = travel;
    this.uniforms["swell"]!.value = swell;
  }

  dispose(): void {
    for (const { geometry, material } of [this.sky, this.water]) {
      geometry.dispose();
      (material as ShaderMaterial).dispose();
    }
  }
}
