// SPDX-License-Identifier: Apache-2.0

/// Numbers of scenes' names, so that a history of numbers holds them.
export class SceneNumbers {
  readonly names: string[] = [];

  /// @returns NaN if there is no name
  of(name: string | undefined): number {
    if (!name) return NaN;
    const known = this.names.indexOf(name);
    return known >= 0 ? known : this.names.push(name) - 1;
  }
}
