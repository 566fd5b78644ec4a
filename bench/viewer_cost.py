#!/usr/bin/env python3
"""What a viewer costs the run that it watches: viewer_cost.py [-n PAIRS] PROGRAM SEQUENCE [-- options of `ldso run`]

Runs a sequence in turn unwatched and with one viewer connected from the first frame to the last, which takes all that
is sent as fast as it comes and draws nothing (a browser on the same machine would cost what drawing costs). Prints the
frames per second of every run and the ratio of each pair; wants a machine that does nothing else."""

import argparse
import base64
import json
import os
import pathlib
import re
import socket
import statistics
import subprocess
import sys
import tempfile
import time

CONTINUE = b"\x02"  # docs/viewer.md
BINARY, PONG = 0x82, 0x8A  # first bytes of WebSocket frames
SIGN_OF_LIFE = 5  # [s]


def frames_per_second(out):
    run = json.loads((out / "run.json").read_text())
    return run["counts"]["frames"] / run["timing"]["wall_s"]


def connect(port):
    viewer = socket.create_connection(("127.0.0.1", port))
    key = base64.b64encode(os.urandom(16)).decode()
    viewer.sendall(("GET /stream HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                    f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n").encode())
    viewer.recv(1)  # it may speak as soon as the server has answered
    return viewer


def say(viewer, kind, payload=b""):
    mask = bytes(4)
    viewer.sendall(bytes([kind, 0x80 | len(payload)]) + mask + payload)


def watch(process):
    """Connects to the printed address and reads until the program ends; returns the bytes that came."""
    for line in process.stdout:
        if address := re.search(r"http://127\.0\.0\.1:(\d+)/", line):
            break
    else:
        sys.exit("the program ended without an address; was it built without the viewer?")
    viewer = connect(int(address.group(1)))
    say(viewer, BINARY, CONTINUE)
    received, spoke = 0, time.monotonic()
    while data := viewer.recv(1 << 20):
        received += len(data)
        if time.monotonic() - spoke > SIGN_OF_LIFE:
            say(viewer, PONG)
            spoke = time.monotonic()
    return received


def run(program, sequence, out, options, watched):
    """Frames per second, and bytes that were sent."""
    command = [program, "run", sequence, "-o", str(out), "--no-report", *options]
    if not watched:
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return frames_per_second(out), 0
    command += ["--view=127.0.0.1:0", "--view-paused", "--view-exit"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, bufsize=1) as process:
        received = watch(process)
        process.stdout.read()
    if process.returncode:
        sys.exit(f"{' '.join(command)}: exit code {process.returncode}")
    return frames_per_second(out), received


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-n", "--pairs", type=int, default=5)
    parser.add_argument("program")
    parser.add_argument("sequence")
    parser.add_argument("options", nargs="*", help="of `ldso run`")
    arguments = parser.parse_args()

    ratios = []
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        for pair in range(arguments.pairs):
            figures = {}
            for watched in (False, True) if pair % 2 == 0 else (True, False):
                figures[watched] = run(arguments.program, arguments.sequence, out / "run", arguments.options, watched)
            (alone, _), (with_viewer, received) = figures[False], figures[True]
            ratios.append(with_viewer / alone)
            print(f"unwatched {alone:6.1f} frames/s, watched {with_viewer:6.1f}, ratio {ratios[-1]:.3f}, "
                  f"{received / 1e6:.1f} MB sent", flush=True)
    print(f"median ratio {statistics.median(ratios):.3f}")


if __name__ == "__main__":
    main()
