// SPDX-License-Identifier: Apache-2.0
// A WebSocket client for binary messages (RFC 6455): Node has none before version 22.
import { randomBytes } from "node:crypto";
import { request, type IncomingMessage } from "node:http";
import type { Socket } from "node:net";

const [kContinued, kBinary, kClose, kPing, kPong] = [0x0, 0x2, 0x8, 0x9, 0xa];

/// A frame as a client sends it: final, masked.
function frame(opcode: number, payload: Uint8Array): Buffer {
  const long = payload.length >= 126;
  if (payload.length > 0xffff) throw new Error(`a message of ${payload.length} bytes is too long for this client`);
  const head = Buffer.from([0x80 | opcode, 0x80 | (long ? 126 : payload.length), ...(long ? [payload.length >> 8, payload.length & 0xff] : [])]);
  const mask = randomBytes(4);
  return Buffer.concat([head, mask, Buffer.from(payload.map((byte, i) => byte ^ mask[i % 4]!))]);
}

export class WebSocketClient {
  private bytes = Buffer.alloc(0);
  private parts: Buffer[] = []; // of a message in several frames

  /// @param page  the address of the page whose stream it is
  static connect(page: string, received: (message: Buffer) => void): Promise<WebSocketClient> {
    return new Promise((done, failed) => {
      const asked = request(new URL("stream", page), {
        headers: {
          Connection: "Upgrade", Upgrade: "websocket", Origin: new URL(page).origin, "Sec-WebSocket-Version": "13",
          "Sec-WebSocket-Key": randomBytes(16).toString("base64"),
        },
      });
      asked.on("upgrade", (_: IncomingMessage, socket: Socket, head: Buffer) => done(new WebSocketClient(socket, head, received)));
      asked.on("response", (answer) => failed(new Error(`${page}stream: ${answer.statusCode}`)));
      asked.on("error", failed);
      asked.end();
    });
  }

  private constructor(private readonly socket: Socket, head: Buffer, private readonly received: (message: Buffer) => void) {
    socket.on("error", () => {});
    socket.on("data", (data) => this.take(data));
    if (head.length > 0) this.take(head);
  }

  get open(): boolean {
    return this.socket.writable;
  }

  send(message: Uint8Array): void {
    this.socket.write(frame(kBinary, message));
  }

  close(): void {
    this.socket.end(frame(kClose, Buffer.from([0x03, 0xe8]))); // 1000: normal
  }

  private take(data: Buffer): void {
    this.bytes = Buffer.concat([this.bytes, data]);
    for (;;) {
      if (this.bytes.length < 2) return;
      const [first, second] = [this.bytes[0]!, this.bytes[1]! & 0x7f];
      const head = second === 126 ? 4 : second === 127 ? 10 : 2;
      if (this.bytes.length < head) return;
      const length = second === 126 ? this.bytes.readUInt16BE(2) : second === 127 ? Number(this.bytes.readBigUInt64BE(2)) : second;
      if (this.bytes.length < head + length) return;
      const payload = this.bytes.subarray(head, head + length);
      this.bytes = this.bytes.subarray(head + length);
      this.takeFrame((first & 0x80) !== 0, first & 0xf, payload);
    }
  }

  private takeFrame(final: boolean, opcode: number, payload: Buffer): void {
    if (opcode === kPing) this.socket.write(frame(kPong, payload));
    if (opcode === kClose) this.socket.end();
    if (opcode !== kBinary && opcode !== kContinued) return;
    this.parts.push(payload);
    if (!final) return;
    const message = Buffer.concat(this.parts);
    this.parts = [];
    this.received(message);
  }
}
