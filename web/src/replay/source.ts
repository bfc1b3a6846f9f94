// SPDX-License-Identifier: Apache-2.0
// The bytes of a recording: a file of this computer, or one that the station lists. Parts of it are read, never the whole.

export interface Source {
  readonly name: string;
  size(): Promise<bigint>;
  /// @throws SourceError
  read(offset: bigint, length: bigint): Promise<Uint8Array>;
}

/// gone: there is no answer; busy: ask again; refused: this page may not read it; missing: there is no such file; changed: a file of this
/// computer is not what it was; other: another answer, such as that of another version.
export type SourceTrouble = "gone" | "busy" | "refused" | "missing" | "changed" | "other";

export class SourceError extends Error {
  constructor(
    readonly trouble: SourceTrouble,
    detail: string,
  ) {
    super(detail);
  }
}

export function fileSource(file: File): Source {
  return {
    name: file.name,
    size: () => Promise.resolve(BigInt(file.size)),
    read: async (offset, length) => {
      const part = file.slice(Number(offset), Number(offset + length));
      try {
        return new Uint8Array(await part.arrayBuffer());
      } catch (reason) {
        throw new SourceError("changed", String(reason));
      }
    },
  };
}

const kReadMs = 20_000;
const kLargestPart = 1n << 24n; // [bytes], as in src/serve/recording_files.h
const kForbidden = 403;
const kNotFound = 404;
const kPartial = 206;
const kUnavailable = 503;

export type Fetch = (address: string, options: RequestInit) => Promise<Response>;

/// @throws SourceError if the answer is not good
export async function ask(get: Fetch, address: string, options: RequestInit): Promise<Response> {
  let response: Response;
  try {
    response = await get(address, { signal: AbortSignal.timeout(kReadMs), ...options });
  } catch (reason) {
    throw new SourceError("gone", String(reason));
  }
  const detail = `${address}: ${response.status}`;
  if (response.status === kForbidden) throw new SourceError("refused", detail);
  if (response.status === kNotFound) throw new SourceError("missing", detail);
  if (response.status === kUnavailable) throw new SourceError("busy", detail);
  if (!response.ok) throw new SourceError("other", detail);
  return response;
}

/// A recording of the station's list, read by HTTP ranges.
/// @param until  as it was when it had so many bytes, for one that is being written; absent: a finished one
export function stationSource(name: string, get: Fetch = (address, options) => fetch(address, options), until?: bigint): Source {
  const address = `recordings/${encodeURIComponent(name)}${until === undefined ? "" : `?until=${until}`}`;
  async function part(offset: bigint, length: bigint): Promise<{ bytes: Uint8Array; size: bigint }> {
    const response = await ask(get, address, { headers: { Range: `bytes=${offset}-${offset + length - 1n}` }, cache: "no-store" });
    const size = /\/(\d+)$/.exec(response.headers.get("Content-Range") ?? "")?.[1];
    if (response.status !== kPartial || size === undefined) throw new SourceError("other", `${address}: no range of bytes`);
    let bytes: Uint8Array;
    try {
      bytes = new Uint8Array(await response.arrayBuffer());
    } catch (reason) {
      throw new SourceError("gone", String(reason));
    }
    if (BigInt(bytes.length) !== length) throw new SourceError("other", `${address}: ${bytes.length} of ${length} bytes`);
    return { bytes, size: BigInt(size) };
  }
  /// Reads in parts that the station gives in one answer.
  async function parts(offset: bigint, length: bigint): Promise<Uint8Array> {
    if (length <= kLargestPart) return length === 0n ? new Uint8Array() : (await part(offset, length)).bytes;
    const all = new Uint8Array(Number(length));
    for (let at = 0n; at < length; at += kLargestPart) {
      const rest = length - at;
      all.set((await part(offset + at, rest < kLargestPart ? rest : kLargestPart)).bytes, Number(at));
    }
    return all;
  }
  return {
    name,
    size: async () => (await part(0n, 1n)).size,
    read: parts,
  };
}
