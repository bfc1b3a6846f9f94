// SPDX-License-Identifier: Apache-2.0
// Screenshots for people, and pixels for tests.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { projectFolder } from "./program";

export const screenshotFolder = process.env["PHALANX_SCREENSHOTS"] ?? join(projectFolder, "build/screenshots");

export async function shoot(page: Page, name: string): Promise<void> {
  mkdirSync(screenshotFolder, { recursive: true });
  await page.screenshot({ path: join(screenshotFolder, `${name}.png`) });
}

/// Share of the pixels that differ visibly between two PNGs of one size, 0 .. 1. Decoded by the browser, in an empty page.
export async function differing(page: Page, first: Buffer, second: Buffer): Promise<number> {
  const helper = await page.context().newPage();
  try {
    return await helper.evaluate(
      async ([a, b]) => {
        const pixels = async (png: string) => {
          const image = new Image();
          image.src = `data:image/png;base64,${png}`;
          await image.decode();
          const canvas = new OffscreenCanvas(image.width, image.height).getContext("2d")!;
          canvas.drawImage(image, 0, 0);
          return canvas.getImageData(0, 0, image.width, image.height).data;
        };
        const [one, other] = [await pixels(a!), await pixels(b!)];
        if (one.length !== other.length) throw new Error("pictures of different sizes");
        let count = 0;
        for (let i = 0; i < one.length; i += 4) {
          const change = Math.abs(one[i]! - other[i]!) + Math.abs(one[i + 1]! - other[i + 1]!) + Math.abs(one[i + 2]! - other[i + 2]!);
          if (change > 24) ++count;
        }
        return (4 * count) / one.length;
      },
      [first.toString("base64"), second.toString("base64")],
    );
  } finally {
    await helper.close();
  }
}

/// How high the curves of a plot reach: pixels between the lowest and the highest coloured one, as a share of the canvas, 0 .. 1.
/// Axes, grid and letters are grey.
export function curveHeight(page: Page, plot: string): Promise<number> {
  return page.evaluate((title) => {
    const box = [...document.querySelectorAll("figure")].find((figure) => figure.querySelector("figcaption strong")?.textContent?.startsWith(title));
    const canvas = box?.querySelector("canvas");
    if (!canvas || canvas.height === 0) return 0;
    const { data, width, height } = canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height);
    let [top, bottom] = [height, -1];
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x) {
        const i = 4 * (y * width + x);
        const [r, g, b] = [data[i]!, data[i + 1]!, data[i + 2]!];
        if (data[i + 3]! < 128 || Math.max(r, g, b) - Math.min(r, g, b) < 70) continue;
        top = Math.min(top, y);
        bottom = Math.max(bottom, y);
      }
    }
    return bottom < 0 ? 0 : (bottom - top) / height;
  }, plot);
}
