// SPDX-License-Identifier: Apache-2.0
// happy-dom draws nothing: here a canvas writes down what was asked of it.

export interface Drawn {
  readonly what: string; // name of the method
  readonly values: readonly unknown[];
  readonly fill: string;
  readonly font: string;
}

const kLetter = 0.6; // width of a letter, as a share of its height

class Context {
  readonly drawn: Drawn[] = [];
  fillStyle = "";
  font = "10px sans-serif";
  constructor(readonly canvas: HTMLCanvasElement) {}
  measureText(text: string): { width: number } {
    return { width: kLetter * Number(/([\d.]+)px/.exec(this.font)?.[1]) * text.length };
  }
}

const contexts = new WeakMap<HTMLCanvasElement, Context>();

function contextOf(canvas: HTMLCanvasElement): unknown {
  let made = contexts.get(canvas);
  if (!made) contexts.set(canvas, (made = new Context(canvas)));
  return new Proxy(made, {
    get: (context, name) => {
      const own: unknown = Reflect.get(context, name);
      if (own !== undefined) return typeof own === "function" ? (own as () => unknown).bind(context) : own;
      return (...values: unknown[]) => void context.drawn.push({ what: String(name), values, fill: context.fillStyle, font: context.font });
    },
  });
}

class FakePath {
  moveTo(): void {}
  lineTo(): void {}
  rect(): void {}
  arc(): void {}
  bezierCurveTo(): void {}
  closePath(): void {}
  addPath(): void {}
}

/// To be given to beforeAll, which calls the answer after the last test: the files of tests share a process.
export function fakeCanvases(): () => void {
  const { getContext } = HTMLCanvasElement.prototype;
  const { Path2D } = globalThis;
  HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement) {
    return contextOf(this);
  } as unknown as typeof getContext;
  globalThis.Path2D = FakePath as unknown as typeof Path2D;
  return () => {
    HTMLCanvasElement.prototype.getContext = getContext;
    globalThis.Path2D = Path2D;
  };
}

export const drawnOn = (canvas: HTMLCanvasElement): readonly Drawn[] => contexts.get(canvas)?.drawn ?? [];
export const textsOn = (canvas: HTMLCanvasElement): readonly string[] => drawnOn(canvas).filter((one) => one.what === "fillText").map((one) => String(one.values[0]));
export const forgetDrawn = (canvas: HTMLCanvasElement): void => void contexts.get(canvas)?.drawn.splice(0);
