"""viewer_attack.py URL: bad clients of a viewer whose run waits at its first frame (--view-paused).

Every kind of bad client once; then the run goes on in steps, and they come again with each of them; then it is
continued, and they come until the viewer is gone. The exit code is 0 if each was refused or held every time.
"""
import random
import socket
import struct
import sys
import time
import urllib.parse

ADDRESS = urllib.parse.urlsplit(sys.argv[1])
TOKEN = "?" + ADDRESS.query if ADDRESS.query else ""
CONTINUE, STEP = b"\x02", b"\x03"
ROUNDS, STEPS = 1, 20
KEY = "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
UPGRADE = "Connection: Upgrade\r\nUpgrade: websocket\r\n" + KEY
PATIENCE_S = 60
NOISE = random.Random(1)


class Gone(Exception):
    """The viewer listens no more: the run has ended."""


def connect():
    try:
        return socket.create_connection((ADDRESS.hostname, ADDRESS.port), PATIENCE_S)
    except ConnectionError as error:
        raise Gone from error


def send(client, data):
    try:
        client.sendall(data)
    except ConnectionError:
        pass  # It has been refused already.


def receive(client, end=b"\0no end\0"):
    """What comes until `end` is in it or the server closes; that it does neither is a failure."""
    data = b""
    while end not in data:
        try:
            part = client.recv(65536)
        except ConnectionError:
            break
        if not part:
            break
        data += part
    return data


def ask(data):
    """The status of the answer, 0 if the connection was closed without one."""
    with connect() as client:
        send(client, data)
        words = receive(client, b"\r\n\r\n").split(b" ")
    return int(words[1]) if len(words) > 1 else 0


def request(target, host=ADDRESS.netloc, method="GET", more="Connection: close\r\n"):
    return f"{method} {target} HTTP/1.1\r\nHost: {host}\r\n{more}\r\n".encode()


def open_stream():
    client = connect()
    send(client, request("/stream" + TOKEN, more=UPGRADE))
    head = receive(client, b"\r\n\r\n")
    if not head:
        raise Gone
    assert b" 101 " in head, head
    return client


def frame(payload, first_byte=0x82, announced=None):
    length = len(payload) if announced is None else announced
    if length < 126:
        head = struct.pack(">BB", first_byte, 0x80 | length)
    elif length < 65536:
        head = struct.pack(">BBH", first_byte, 0xFE, length)
    else:
        head = struct.pack(">BBQ", first_byte, 0xFF, length)
    return head + b"\0\0\0\0" + payload


# What is asked, and the statuses that are right. 0: closed without an answer.
REQUESTS = {
    "nonsense": (b"nonsense\r\n\r\n", {400}),
    "bytes": (NOISE.randbytes(4000) + b"\r\n\r\n", {0, 400, 431}),
    "TLS": (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + b"\xff" * 200, {0, 400}),
    "an endless header": (b"GET / HTTP/1.1\r\nX: " + b"x" * 1000000, {0, 431}),
    "a body": (request("/", method="POST", more="Content-Length: 1000000000\r\n") + b"x" * 100000, {0, 413}),
    "a path upwards": (request("/../../../../etc/passwd" + TOKEN), {404}),
    "an encoded path upwards": (request("/%2e%2e/%2e%2e/etc/passwd" + TOKEN), {404}),
    "a path that begins twice": (request("//etc/passwd" + TOKEN), {404}),
    "another site's page": (request("/stream" + TOKEN, more=UPGRADE + "Origin: http://evil.example\r\n"), {403}),
    "no key": (request("/stream" + TOKEN, more="Connection: Upgrade\r\nUpgrade: websocket\r\n"), {0, 400, 426}),
}
if TOKEN:
    REQUESTS["no token"] = (request("/stream", more=UPGRADE), {403})
    REQUESTS["a wrong token"] = (request("/stream?token=" + "0" * 32, more=UPGRADE), {403})
    REQUESTS["a page without a token"] = (request("/"), {403})
else:
    REQUESTS["a name that is not ours"] = (request("/", host="evil.example"), {403})

# What comes in the stream and ends it.
FRAMES = {
    "a huge frame": frame(b"x" * 300000),
    "2^62 bytes announced": frame(b"x" * 10, announced=1 << 62),
    "no mask": b"\x82\x01\x02",
    "a reserved code": frame(b"", first_byte=0x8B),
    "reserved bits": frame(b"\x02", first_byte=0xF2),
    "a long ping": frame(b"x" * 200, first_byte=0x89),
    "an unknown command": frame(b"\x63"),
    "bytes": NOISE.randbytes(5000),
}


def expect(name, status, right):
    if status == 0 and 0 not in right:
        connect().close()  # That the run has ended is the only excuse.
    assert status in right, f"{name}: the answer is {status}"


def attack():
    for name, (data, right) in REQUESTS.items():
        expect(name, ask(data), right)
    for data in FRAMES.values():
        with open_stream() as client:
            send(client, data)
            receive(client)
    crowd = [connect() for _ in range(50)]
    for client in crowd:
        send(client, b"GET / HTTP/1.1\r\nHost:")  # and not a byte more
    answer = receive(crowd[-1], b"\r\n\r\n")
    expect("one connection too many", int(answer[9:12] or 0), {503})
    for client in crowd:
        client.close()
    end = time.monotonic() + PATIENCE_S
    while (status := ask(request("/" + TOKEN))) == 503 and time.monotonic() < end:
        time.sleep(0.01)
    expect("a good request after all that", status, {200})


attack()
with open_stream() as page:
    send(page, frame(STEP))
    receive(page, b"LDSO")  # A page that from here on reads nothing more.
    for _ in range(ROUNDS):
        send(page, STEPS * frame(STEP))
        attack()
    send(page, frame(CONTINUE))
    try:
        while True:
            attack()
    except Gone:
        pass
