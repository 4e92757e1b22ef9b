#!/usr/bin/env python3
"""Seeds for the fuzzers, from the malformed bodies and the OpenAPI document's examples.
make_corpus.py FOLDER writes FOLDER/{render_request,sweep_request,headers,messages}/..."""

import json
import pathlib
import shutil
import sys

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


lines = [json.loads(line) for line in (root / "tests/api/malformed.jsonl").open()]
bodies = [bytes.fromhex(line["hex"]) if "hex" in line else line["body"].encode() for line in lines]
# Of the bodies that are far too long, the shorter ones do.
bodies = [body for body in bodies if len(body) < 4096]
as_bytes = lambda documents: [json.dumps(d, separators=(",", ":")).encode() for d in documents]
shutil.rmtree(out, ignore_errors=True)
write("render_request", as_bytes(requests) + bodies)
write("sweep_request", as_bytes(sweeps) + [b'{"base":' + body + b"}" for body in bodies[::4]])
write("headers", [line.encode() for line in header_lines])
write("messages", [bytes([step]) + m + n for step in (0, 4) for m in messages for n in (b"", messages[0])])
