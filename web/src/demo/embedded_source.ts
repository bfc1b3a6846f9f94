// SPDX-License-Identifier: Apache-2.0
// The recording that stands in the page itself: an MCAP file, compressed with gzip, as base64.
import type { Source } from "../replay/source";

/// @throws DOMException, TypeError if the text is damaged or this browser cannot decompress it
export async function embeddedSource(id = "recording"): Promise<Source> {
  const place = document.getElementById(id)!;
  const packed = Uint8Array.from(atob((place.textContent ?? "").trim()), (sign) => sign.charCodeAt(0));
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const bytes = new Uint8Array(await new Response(unpacked).arrayBuffer());
  return {
    name: place.dataset["name"] ?? "recording.mcap",
    size: () => Promise.resolve(BigInt(bytes.length)),
    read: (offset, length) => Promise.resolve(bytes.slice(Number(offset), Number(offset + length))),
  };
}
