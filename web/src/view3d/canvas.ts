// SPDX-License-Identifier: Apache-2.0
// The WebGL canvas: creation, replacement if the quality needs another kind, loss and restoration.
import { PCFShadowMap, NeutralToneMapping, WebGLRenderer } from "three";

/// no-webgl: this browser cannot draw; context-lost: the graphics card let go and did not come back; context-restored: it did.
export type ViewTrouble = "no-webgl" | "context-lost" | "context-restored";

const kRestoreTime = 4000; // [ms] before a lost context is called gone

export class Canvas {
  private renderer: WebGLRenderer | null = null;
  private antialias = false;
  private lostTimer: ReturnType<typeof setTimeout> | undefined;
  private told = false; // a trouble that still exists has been reported

  /// @param redraw   what is on the canvas is gone
  /// @param release  the renderer goes: what it has drawn must not hold on to it
  /// @param trouble  reports to the page
  constructor(
    private readonly surface: HTMLElement,
    private readonly redraw: () => void,
    private readonly release: () => void,
    private readonly trouble: (what: ViewTrouble) => void,
  ) {}

  /// Makes a renderer of this kind. Reports the trouble and returns null if there is none.
  use(antialias: boolean): WebGLRenderer | null {
    if (this.renderer && this.antialias === antialias) return this.renderer;
    const next = create(antialias);
    if (!next) {
      if (!this.renderer && !this.told) this.trouble("no-webgl");
      this.told ||= !this.renderer;
      return this.renderer; // the one there is will do
    }
    this.discard();
    this.renderer = next;
    this.antialias = antialias;
    next.domElement.style.cssText = "display:block;width:100%;height:100%";
    next.domElement.addEventListener("webglcontextlost", this.lost);
    next.domElement.addEventListener("webglcontextrestored", this.restored);
    this.surface.replaceChildren(next.domElement);
    return next;
  }

  /// The context is there: what is drawn is seen.
  get usable(): boolean {
    return this.renderer !== null && !this.renderer.getContext().isContextLost();
  }

  dispose(): void {
    this.discard();
    this.surface.replaceChildren();
  }

  private discard(): void {
    clearTimeout(this.lostTimer);
    if (!this.renderer) return;
    this.renderer.domElement.removeEventListener("webglcontextlost", this.lost);
    this.renderer.domElement.removeEventListener("webglcontextrestored", this.restored);
    this.release();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.renderer = null;
  }

  private readonly lost = (event: Event): void => {
    event.preventDefault(); // else it is never restored
    clearTimeout(this.lostTimer);
    this.lostTimer = setTimeout(() => {
      this.told = true;
      this.trouble("context-lost");
    }, kRestoreTime);
  };

  private readonly restored = (): void => {
    clearTimeout(this.lostTimer);
    if (this.told) this.trouble("context-restored");
    this.told = false;
    this.redraw();
  };
}

function create(antialias: boolean): WebGLRenderer | null {
  try {
    const renderer = new WebGLRenderer({ antialias, stencil: true, powerPreference: "high-performance" });
    renderer.autoClear = false;
    renderer.toneMapping = NeutralToneMapping;
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = PCFShadowMap;
    renderer.shadowMap.autoUpdate = false;
    return renderer;
  } catch {
    return null;
  }
}

/// Drawn by the processor: starts at a low quality.
export function isSoftware(renderer: WebGLRenderer): boolean {
  const gl = renderer.getContext();
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name: unknown = gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  return typeof name === "string" && /swiftshader|llvmpipe|software|basic render/i.test(name);
}
