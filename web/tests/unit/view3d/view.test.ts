// SPDX-License-Identifier: Apache-2.0
// A browser that cannot draw: happy-dom has no WebGL.
import { create } from "@bufbuild/protobuf";
import { afterEach, describe, expect, it, vi } from "vitest";
import { GeometrySchema } from "../../../src/gen/phalanx/geometry_pb";
import { TickSchema } from "../../../src/gen/phalanx/tick_pb";
import { shapesOf } from "../../../src/view3d/shapes";
import { createHandView } from "../../../src/view3d/view";

afterEach(() => vi.restoreAllMocks());

describe("without WebGL", () => {
  it("says so once, and everything else does nothing and does not throw", () => {
    vi.spyOn(console, "error").mockImplementation(() => {}); // three.js complains there as well
    const troubles: string[] = [];
    const host = document.createElement("div");
    const view = createHandView(host, { onTrouble: (what) => troubles.push(what) });
    view.setGeometry(shapesOf(create(GeometrySchema, {})));
    view.show(create(TickSchema, { tick: 3n }));
    view.setTheme("light");
    view.setLost(true);
    view.setParts({ skin: true, ghost: true, arrows: true, object: true, cones: false });
    for (const preset of ["home", "palm", "thumb", "contact"] as const) view.camera(preset);
    view.zoom(2);
    view.zoom(NaN);
    view.orbit(0.1, NaN);
    expect(view.picture()).toBe("");
    expect(view.probe()).toMatchObject({ frames: 0, shown: [], ghost: [], arrows: [], lost: true });
    expect(troubles).toEqual(["no-webgl"]);
    view.dispose();
    expect(host.childElementCount).toBe(0);
  });
});
