#!/usr/bin/env python3
"""Seeds for the fuzzers, from the malformed bodies and the OpenAPI document's examples.
make_corpus.py FOLDER writes FOLDER/{render_request,sweep_request,headers,...}/..."""

import base64
import json
import pathlib
import shutil
import struct
import sys
import zlib

root = pathlib.Path(__file__).resolve().parents[2]
out = pathlib.Path(sys.argv[1])
examples = []


def find_examples(node):
    if isinstance(node, dict):
        for key, value in node.items():
            if key == "examples" and isinstance(value, dict):
                examples.extend(e["value"] for e in value.values() if "value" in e)
            elif key == "example":
                examples.append(value)
            else:
                find_examples(value)
    elif isinstance(node, list):
        for value in node:
            find_examples(value)


find_examples(json.loads((root / "api/openapi.json").read_text()))
requests = [e for e in examples if isinstance(e, dict) and "material" in e]
sweeps = [e for e in examples if isinstance(e, dict) and "base" in e]
sweeps += [{"base": request, "axes": axes} for request in requests for axes in (
    {"absorption": [0, 0.5, 1]},
    {"absorption": {"from": 0, "to": 1, "count": 3}, "scattering": [0.2, 0.4]},
    {"roughness": [0, 1], "absorbers": []})]
sweeps += [{"base": request, "absorbers": ["red-glass", {"wavelengths_nm": [400, 700],
                                                         "values": [1, 2]}]}
           for request in requests]

header_lines = [
    "Accept: image/png;q=0.5, image/x-exr, */*;q=0.1",
    'Accept: image/tiff;level="a,b;q=1";q=1',
    "Range: bytes=0-99", "Range: bytes=-5", "Range: bytes=10-", "Range: bytes=5-1,7-9",
    "Range: bytes=18446744073709551615-",
    "Prefer: respond-async, wait=10", 'Prefer: wait="3"; x=1', "Prefer: wait=99999999999",
    'If-None-Match: "abc", W/"some"', "If-None-Match: *",
    "Idempotency-Key: 8e03978e-40d5-43dd-bc93-6894a57f9324",
    "Last-Event-ID: 17", "Last-Event-ID: -1",
    "Content-Length: 12", "Content-Length: 12\nContent-Length: 12",
    "Transfer-Encoding: chunked", "Transfer-Encoding: chunked\nContent-Length: 3",
    "Content-Type: application/json; charset=utf-8",
    "Method: POST\nHost: localhost:8080\nOrigin: http://localhost:8080",
    "Method: POST\nHost: [::1]:8080\nOrigin: https://evil.example",
    "Method: POST\nHost: 127.0.0.1\nSec-Fetch-Site: cross-site",
    "Method: GET\nHost: render.example:8080\nAuthorization: Bearer 0123456789abcdef",
]


# Of a connection: a byte that says how it is cut, then what comes.
host = b"Host: localhost\r\n"
chunked = b"POST /a HTTP/1.1\r\n" + host + b"Transfer-Encoding: chunked\r\n\r\n"
messages = [
    b"GET /a?b=c%20d HTTP/1.1\r\n" + host + b"\r\n",
    b"GET http://localhost:80/a HTTP/1.1\r\n" + host + b"Connection: close\r\n\r\n",
    b"OPTIONS * HTTP/1.1\r\n" + host + b"\r\n",
    b"CONNECT a.example:443 HTTP/1.1\r\n" + host + b"\r\n",
    b"POST /a HTTP/1.0\r\nContent-Length: 2\r\n\r\n{}\r\nGET /b HTTP/1.0\r\n\r\n",
    b"POST /a HTTP/1.1\r\n" + host + b"Content-Length: 6\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\nX",
    chunked + b"2\r\n{}\r\n0\r\n\r\nGET /b HTTP/1.1\r\n" + host + b"\r\n",
    chunked + b"2;a=b;c=\"d;e\"\r\n{}\r\n0\r\nT: x\r\n\r\n",
    chunked + b"02 ; a\r\n{}\r\n00\r\n\r\n",
    chunked + b"0x2\r\n{}\r\n0\r\n\r\n",
    b"GET /a HTTP/1.1\r\n" + host + b"X-A : b\r\nX-B: c\r\n d\r\n\r\n",
    b"GET /a HTTP/1.1\r\n" + host + b"X-A: \xc3\xa4\t\"b\"\r\nX-A:\r\n\r\n",
]


def write(name, seeds):
    folder = out / name
    folder.mkdir(parents=True, exist_ok=True)
    for number, seed in enumerate(seeds):
        (folder / f"seed-{number:03}").write_bytes(seed)


corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
box = "".join("v %g %g %g\n" % c for c in corners) + "".join(
    "f %d %d %d %d\n" % tuple(i + 1 for i in q) for q in quads)
ply_head = ("ply\nformat %s 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 6\nproperty list uchar int vertex_indices\nend_header\n")
ply_ascii = ply_head % "ascii" + "".join("%g %g %g\n" % c for c in corners) + "".join(
    "4 %d %d %d %d\n" % q for q in quads)
ply_binary = (ply_head % "binary_little_endian").encode() + b"".join(
    struct.pack("<3f", *c) for c in corners) + b"".join(struct.pack("<B4i", 4, *q) for q in quads)
smooth_box = "vn 1 1 1\nvn nan 0 -1\n" + box.replace("f 1 3 4 2", "f 1//1 3/1/2 4//-1 2")
smooth_ply = ply_head.replace("z\n", "z\nproperty float nx\nproperty float ny\nproperty float nz\n") % "ascii" + "".join(
    "%g %g %g 1 0 0.5\n" % c for c in corners) + "".join("4 %d %d %d %d\n" % q for q in quads)
meshes = [box.encode(), b"\xef\xbb\xbf# a box\r\n" + box.encode(), ply_ascii.encode(), ply_binary,
          (box + box.replace("f 1", "f -8")).encode(), smooth_box.encode(), smooth_ply.encode()]
triangles = [(q[0], q[i], q[i + 1]) for q in quads for i in (1, 2)]
meshes.append(b"solid".ljust(80) + struct.pack("<I", len(triangles)) + b"".join(
    struct.pack("<3f", 0, 0, 0) + b"".join(struct.pack("<3f", *corners[v]) for v in t) + b"\0\0"
    for t in triangles))
meshes.append(("solid box\n" + "".join(
    "facet normal 0 0 0\nouter loop\n" + "".join("vertex %g %g %g\n" % corners[v] for v in t)
    + "endloop\nendfacet\n" for t in triangles) + "endsolid box\n").encode())
buffer = b"".join(struct.pack("<3f", *c) for c in corners) + b"".join(
    struct.pack("<3H", *t) for t in triangles) + struct.pack("<H6x3f", 0, -1, -1, -1)
views = [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72},
         {"buffer": 0, "byteOffset": 168, "byteLength": 2}, {"buffer": 0, "byteOffset": 176, "byteLength": 12}]
gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1], "rotation": [0, 0, 0, 1], "scale": [1, 2, -1]},
                  {"mesh": 0, "translation": [0, 0, 1]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3",
                       "sparse": {"count": 1, "indices": {"bufferView": 2, "componentType": 5123},
                                  "values": {"bufferView": 3}}},
                      {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}],
        "bufferViews": views, "buffers": [{"byteLength": len(buffer)}]}


def glb(document, binary):
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


embedded = dict(gltf, buffers=[{"byteLength": len(buffer), "uri": "data:application/octet-stream;base64,"
                                + base64.b64encode(buffer).decode()}])
meshes += [glb(gltf, buffer), json.dumps(embedded).encode()]
meshes += [glb(dict(gltf, meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "mode": mode}]}]), buffer)
           for mode in (5, 6)]


def exr(channels, attributes=b""):
    attribute = lambda name, kind, value: name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value
    listed = b"".join(c + b"\0" + struct.pack("<iBxxxii", 2, 0, 1, 1) for c in channels) + b"\0"
    window = struct.pack("<4i", 0, 0, 1, 0)
    head = (b"\x76\x2f\x31\x01\x02\0\0\0" + attribute(b"channels", b"chlist", listed)
            + attribute(b"compression", b"compression", b"\0") + attribute(b"dataWindow", b"box2i", window)
            + attribute(b"displayWindow", b"box2i", window) + attribute(b"lineOrder", b"lineOrder", b"\0")
            + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
            + attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0))
            + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + attributes + b"\0")
    line = struct.pack("<2f", 1, 2) * len(channels)
    return head + struct.pack("<Q", len(head) + 8) + struct.pack("<2i", 0, len(line)) + line


def png(color, row):
    chunk = lambda name, data: (struct.pack(">I", len(data)) + name + data
                                + struct.pack(">I", zlib.crc32(name + data)))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, color, 0, 0, 0))
            + chunk(b"gAMA", struct.pack(">I", 45455)) + chunk(b"cICP", b"\x0c\x0d\0\x01")
            + chunk(b"IDAT", zlib.compress(b"\0" + row)) + chunk(b"IEND", b""))


hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\nPRIMARIES=.64 .33 .3 .6 .15 .06 .3127 .329\n\n"
pictures = [exr([b"B", b"G", b"R"]), exr([b"A", b"Y"]), png(2, b"\x80" * 3), png(6, b"\x80" * 4),
            hdr + b"-Y 1 +X 2\n" + b"\x80" * 8, hdr + b"+X 2 -Y 1\n" + b"\x80" * 8,
            hdr + b"-Y 1 +X 8\n\x02\x02\0\x08" + b"\x88\x80" * 4]
answer_head = lambda kind, size: b"TLCREAD1" + struct.pack("<IIQ", kind, 0, size)
mesh_answer = (struct.pack("<5Q", 4, 4, 0, 0, 1) + struct.pack("<Q12d", 4, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1)
               + struct.pack("<Q12I", 4, 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3)
               + struct.pack("<Q3d", 1, 0, 0, 1) + struct.pack("<Q12I", 4, *[0] * 12))
answers = [answer_head(1, len(mesh_answer)) + mesh_answer, answer_head(2, 4) + b"why?"]

lines = [json.loads(line) for line in (root / "tests/api/malformed.jsonl").open()]
bodies = [bytes.fromhex(line["hex"]) if "hex" in line else line["body"].encode() for line in lines]
# Of the bodies that are far too long, the shorter ones do.
bodies = [body for body in bodies if len(body) < 4096]
as_bytes = lambda documents: [json.dumps(d, separators=(",", ":")).encode() for d in documents]
shutil.rmtree(out, ignore_errors=True)
write("render_request", as_bytes(requests) + bodies)
write("sweep_request", as_bytes(sweeps) + [b'{"base":' + body + b"}" for body in bodies[::4]])
write("headers", [line.encode() for line in header_lines])
write("mesh", meshes)
write("light", pictures)
write("answer", answers)
write("messages", [bytes([step]) + m + n for step in (0, 4) for m in messages for n in (b"", messages[0])])
