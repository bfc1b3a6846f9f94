// SPDX-License-Identifier: Apache-2.0
import type { Shapes } from "../view3d/shapes";

const kRetryMs = 1000;

/// Fetches the shapes of the newest revision, one at a time, and again if it failed.
export class GeometryLoader {
  private wanted: number | undefined;
  private have: number | undefined;
  private busy = false;
  private era = 0; // of the station

  constructor(
    private readonly fetch: (revision: number) => Promise<Shapes>,
    private readonly loaded: (geometry: Shapes, revision: number) => void,
  ) {}

  want(revision: number): void {
    this.wanted = revision;
    void this.go();
  }

  /// Drops the loaded geometry, which may be another station's.
  forget(): void {
    ++this.era;
    this.have = undefined;
    this.wanted = undefined;
  }

  private async go(): Promise<void> {
    if (this.busy) return;
    this.busy = true;
    while (this.wanted !== undefined && this.wanted !== this.have) {
      const revision = this.wanted;
      const era = this.era;
      const outdated = () => this.wanted !== revision || this.era !== era;
      try {
        const geometry = await this.fetch(revision);
        if (outdated()) continue;
        this.have = revision;
        this.loaded(geometry, revision);
      } catch {
        if (outdated()) continue; // it is no longer shown
        await new Promise((resolve) => setTimeout(resolve, kRetryMs));
      }
    }
    this.busy = false;
  }
}
