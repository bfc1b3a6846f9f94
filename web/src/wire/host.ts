// SPDX-License-Identifier: Apache-2.0
// What a page may ask of the station, by name.
import { create } from "@bufbuild/protobuf";
import {
  CalibrateSchema,
  LoadSceneSchema,
  ReleaseControlSchema,
  ResetSchema,
  ResumeSchema,
  SetNameSchema,
  SetSchema,
  SetSourceSchema,
  SettingSchema,
  SlidersSchema,
  StopSchema,
  TakeControlSchema,
  type Calibrate_Step,
  type HandSource,
} from "../gen/phalanx/cockpit_pb";
import type { Answer, Connection } from "./connection";

/// A key and its value as it would stand in a scene file; an empty value goes back to the scene's own.
export type Change = readonly [key: string, value: string];

/// How long the socket may take to confirm a stop before it is said by HTTP too [ms].
const kStopPatienceMs = 300;

export class Host {
  constructor(
    private readonly connection: Connection,
    private readonly fallback: () => Promise<boolean>,
  ) {}

  /// Says it by the socket and, where that is down or does not confirm it soon, by HTTP as well.
  /// @param patience  how long the socket has [ms]
  /// @returns whether the station confirmed it
  async stop(patienceMs = kStopPatienceMs): Promise<boolean> {
    const bySocket = this.connection.ask({ case: "stop", value: create(StopSchema) });
    const patience = new Promise<null>((resolve) => setTimeout(() => resolve(null), patienceMs));
    if ((await Promise.race([bySocket, patience]))?.ok) return true;
    return await Promise.any(
      [this.fallback(), bySocket.then((answer) => answer.ok)].map(async (said) => {
        if (!(await said)) throw new Error("not confirmed");
        return true;
      }),
    ).catch(() => false);
  }

  /// @param dragging  later values of the same keys follow: the log takes the last one
  set(changes: readonly Change[], dragging = false): Promise<Answer> {
    const setting = changes.map(([key, value]) => create(SettingSchema, { key, value }));
    return this.connection.ask({ case: "set", value: create(SetSchema, { setting, dragging }) });
  }

  /// @param stops  of the State that the person sees
  resume(stops: bigint): Promise<Answer> {
    return this.connection.ask({ case: "resume", value: create(ResumeSchema, { stops }) });
  }

  /// @param faultTime  of the fault that the person sees; 0: there is none, a new try is wanted
  reset(faultTime: number): Promise<Answer> {
    return this.connection.ask({ case: "reset", value: create(ResetSchema, { faultTime }) });
  }

  loadScene(name: string): Promise<Answer> {
    return this.connection.ask({ case: "scene", value: create(LoadSceneSchema, { name }) });
  }

  takeControl(): Promise<Answer> {
    return this.connection.ask({ case: "take", value: create(TakeControlSchema) });
  }

  releaseControl(): Promise<Answer> {
    return this.connection.ask({ case: "release", value: create(ReleaseControlSchema) });
  }

  setSource(source: HandSource): Promise<Answer> {
    return this.connection.ask({ case: "source", value: create(SetSourceSchema, { source }) });
  }

  sliders(angle: readonly number[]): boolean {
    return this.connection.tell({ case: "sliders", value: create(SlidersSchema, { angle: [...angle] }) });
  }

  setName(name: string): Promise<Answer> {
    return this.connection.ask({ case: "name", value: create(SetNameSchema, { name }) });
  }

  calibrate(step: Calibrate_Step, pose = 0): Promise<Answer> {
    return this.connection.ask({ case: "calibrate", value: create(CalibrateSchema, { step, pose }) });
  }
}
