// SPDX-License-Identifier: Apache-2.0
// The axis of a mesh file that points up. In a scene that is z.

export const upAxes = ["x", "y", "z"] as const;
export type UpAxis = (typeof upAxes)[number];

/// Roll, pitch and yaw [deg] that turn the axis up, as objects[].rotation_deg: R = Rz(yaw) Ry(pitch) Rx(roll).
export const uprightRotation: Readonly<Record<UpAxis, readonly [number, number, number]>> = { x: [0, -90, 0], y: [90, 0, 0], z: [0, 0, 0] };

/// The axis by the file's format. Only .glb states one; the import leaves the axes as they are in the file.
export function usualUpAxis(fileName: string): UpAxis {
  return /\.glb$/i.test(fileName) ? "y" : "z";
}
