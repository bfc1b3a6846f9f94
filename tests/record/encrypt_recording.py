#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Encrypts an MCAP file as docs/recording.md describes it: encrypt_recording.py PLAIN.mcap OUT.mcap.enc [--frame BYTES]

It shares no code with the program, and shows that the description is enough. It needs Debian's python3-cryptography. The key is that of
tests/record/stored_recording.h.
"""
import argparse
import hashlib
import hmac
import os
import struct
import zlib

from cryptography.hazmat.primitives.ciphers.aead import AESGCM

ID = "00112233445566778899aabbccddeeff"
KEY = bytes((3 * i + 1) & 0xFF for i in range(32))


def hkdf_sha256(key: bytes, salt: bytes, info: bytes, length: int) -> bytes:
    """Derives bytes from a key (RFC 5869)."""
    secret = hmac.new(salt, key, hashlib.sha256).digest()
    out, block = b"", b""
    for number in range(1, -(-length // 32) + 1):
        block = hmac.new(secret, block + info + bytes([number]), hashlib.sha256).digest()
        out += block
    return out[:length]


def encrypted(plain: bytes, frame: int, salt: bytes) -> bytes:
    derived = hkdf_sha256(KEY, salt, f"phalanx recording 1 {ID}".encode(), 48)
    cipher = AESGCM(derived[:32])
    head = b"\x89PHXE\r\n\x1a" + struct.pack("<I", 1) + ID.encode() + salt + derived[32:]
    head += struct.pack("<I", zlib.crc32(head))
    out = head + head
    for counter, place in enumerate(range(0, len(plain), frame), 1):
        part = plain[place : place + frame]
        mark = b"PHXe" if place + frame >= len(plain) else b"PHXf"
        begin = mark + struct.pack("<IQQ", len(part), place, counter)
        body = cipher.encrypt(bytes(4) + struct.pack("<Q", counter), part, begin)
        begin += struct.pack("<I", zlib.crc32(body))
        begin += struct.pack("<I", zlib.crc32(begin))
        out += begin + body + struct.pack("<I", len(part))
    return out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("plain")
    parser.add_argument("out")
    parser.add_argument("--frame", type=int, default=4 << 20, help="content of a frame [bytes]")
    options = parser.parse_args()
    with open(options.plain, "rb") as file:
        plain = file.read()
    with open(options.out, "wb") as file:
        file.write(encrypted(plain, options.frame, os.urandom(32)))


if __name__ == "__main__":
    main()
