// SPDX-License-Identifier: Apache-2.0
// The requests of a page to the station.
import { create } from "@bufbuild/protobuf";
import {
  CalibrateSchema,
  LoadSceneSchema,
  OpenDigitSchema,
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
  type Calibrate,
  type HandSource,
} from "../gen/phalanx/cockpit_pb";
import type { Opening } from "../gen/phalanx/tick_pb";
import type { Answer, Connection } from "./connection";

/// A key and its value as in a scene file. An empty value restores the scene's own.
export type Change = readonly [key: string, value: string];

/// Time that the socket has to confirm a stop before the stop is sent by HTTP, too [ms].
const kStopPatienceMs = 300;

/// A step of a calibration; what is left out is 0 or empty.
export type CalibrateRequest = Partial<Omit<Calibrate, "$typeName" | "$unknown">>;

export class Host {
  constructor(
    private readonly connection: Connection,
    private readonly fallback: () => Promise<boolean>,
  ) {}

  /// Sends a stop by the socket. If the socket is down or does not confirm it soon, sends it by HTTP as well.
  /// @param patienceMs  time that the socket has [ms]
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

  /// @param dragging  later values of the same keys follow; the log has the last one
  set(changes: readonly Change[], dragging = false): Promise<Answer> {
    const setting = changes.map(([key, value]) => create(SettingSchema, { key, value }));
    return this.connection.ask({ case: "set", value: create(SetSchema, { setting, dragging }) });
  }

  /// @param stops  of the displayed State
  resume(stops: bigint): Promise<Answer> {
    return this.connection.ask({ case: "resume", value: create(ResumeSchema, { stops }) });
  }

  /// @param faultTime  of the displayed fault; 0: none, a new try of a station is requested
  reset(faultTime: number): Promise<Answer> {
    return this.connection.ask({ case: "reset", value: create(ResetSchema, { faultTime }) });
  }

  /// Asks to open a digit that began inside the object. @param seen  as the person saw it
  openDigit(seen: Opening): Promise<Answer> {
    const { digit, way, running } = seen;
    return this.connection.ask({ case: "open", value: create(OpenDigitSchema, { digit, way, running }) });
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

  calibrate(request: CalibrateRequest): Promise<Answer> {
    return this.connection.ask({ case: "calibrate", value: create(CalibrateSchema, request) });
  }
}
