#!/usr/bin/env python3
"""make_bag.py FOLDER OUTPUT [--topic NAME]: writes a sequence (images/, times.txt, camera.txt with a pinhole or RadTan
camera) as a bag that ROS would play: OUTPUT is *.bag (ROS 1, chunks packed by bzip2), *.mcap or *.db3 (ROS 2). PNG
and JPEG become compressed images, PGM and PPM raw ones; beside them stands a camera_info."""

import argparse
import bz2
import pathlib
import sqlite3
import struct

BEGIN = 1_700_000_000
PER_CHUNK = 8


class Writer:
    """Values one after the other, packed (ROS 1) or aligned (CDR)."""

    def __init__(self, is_cdr):
        self.is_cdr = is_cdr
        self.bytes = bytearray()

    def number(self, kind, *values):
        size = struct.calcsize("<" + kind)
        for value in values:
            if self.is_cdr:
                self.bytes += bytes(-len(self.bytes) % size)
            self.bytes += struct.pack("<" + kind, value)
        return self

    def blob(self, data):
        self.number("I", len(data))
        self.bytes += data
        return self

    def text(self, text):
        return self.blob(text.encode() + (b"\0" if self.is_cdr else b""))

    def message(self):
        return (b"\0\1\0\0" if self.is_cdr else b"") + bytes(self.bytes)


def header(is_cdr, stamp):
    writer = Writer(is_cdr)
    if not is_cdr:
        writer.number("I", 0)
    return writer.number("I", stamp // 10**9, stamp % 10**9).text("camera")


def image(is_cdr, stamp, path):
    data = path.read_bytes()
    writer = header(is_cdr, stamp)
    if path.suffix not in (".pgm", ".ppm"):
        kind = "png" if path.suffix == ".png" else "jpeg"
        return "sensor_msgs/CompressedImage", writer.text(kind).blob(data).message()
    kind, width, height, largest, pixels = data.split(maxsplit=4)
    assert largest == b"255" and kind in (b"P5", b"P6")
    width, height, depth = int(width), int(height), 1 if kind == b"P5" else 3
    pixels = data[len(data) - width * height * depth:]
    writer.number("I", height, width).text("mono8" if depth == 1 else "rgb8")
    return "sensor_msgs/Image", writer.number("B", 0).number("I", width * depth).blob(pixels).message()


def camera_info(is_cdr, stamp, path):
    lines = [line.split() for line in path.read_text().splitlines() if line.strip() and line[0] != "#"]
    numbers = [float(v) for v in lines[0] if v[0] not in "PR"]
    width, height = map(int, lines[1])
    fx, fy, cx, cy, *lens = numbers
    if cx < 1 and cy < 1:
        fx, fy, cx, cy = fx * width, fy * height, cx * width - 0.5, cy * height - 0.5
    lens = (lens if lines[0][0] == "RadTan" else []) + [0.0] * 5
    writer = header(is_cdr, stamp).number("I", height, width).text("plumb_bob").number("I", 5)
    writer.number("d", *lens[:5])
    writer.number("d", fx, 0, cx, 0, fy, cy, 0, 0, 1)
    writer.number("d", 1, 0, 0, 0, 1, 0, 0, 0, 1)
    writer.number("d", fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0)
    return "sensor_msgs/CameraInfo", writer.number("I", 0, 0, 0, 0, 0, 0).number("B", 0).message()


def messages_of(folder, topic, is_cdr):
    """(topic, type, time [ns], bytes), each image recorded 20 ms after it was taken."""
    files = sorted((folder / "images").iterdir())
    lines = [line.split() for line in (folder / "times.txt").read_text().splitlines()]
    times = [float(line[1]) for line in lines if line and line[0][0] != "#"]
    for file, time in zip(files, times):
        stamp = BEGIN * 10**9 + round(time * 1e9)
        info, content = camera_info(is_cdr, stamp, folder / "camera.txt")
        yield topic.rsplit("/", 1)[0] + "/camera_info", info, stamp + 10**7, content
        kind, content = image(is_cdr, stamp, file)
        yield topic + ("/compressed" if "Compressed" in kind else ""), kind, stamp + 2 * 10**7, content


def record(fields, data):
    head = b"".join(struct.pack("<I", len(name) + 1 + len(value)) + name.encode() + b"=" + value
                    for name, value in fields.items())
    return struct.pack("<I", len(head)) + head + struct.pack("<I", len(data)) + data


def u32(value):
    return struct.pack("<I", value)


def chunks_of(messages):
    chunk = []
    for message in messages:
        chunk.append(message)
        if len(chunk) == PER_CHUNK:
            yield chunk
            chunk = []
    if chunk:
        yield chunk


def write_ros1(path, messages):
    numbers, connections, body, count = {}, b"", b"", 0
    for chunk in chunks_of(messages):
        records, index = b"", {}
        for topic, kind, time, content in chunk:
            if topic not in numbers:
                numbers[topic] = len(numbers)
                definition = {"topic": topic.encode(), "type": kind.encode(), "md5sum": b"*",
                              "message_definition": b""}
                fields = b"".join(u32(len(k) + 1 + len(v)) + k.encode() + b"=" + v for k, v in definition.items())
                connection = record({"op": b"\7", "conn": u32(numbers[topic]), "topic": topic.encode()}, fields)
                connections += connection
                records += connection
            stamp = struct.pack("<II", time // 10**9, time % 10**9)
            index.setdefault(numbers[topic], []).append(stamp + u32(len(records)))
            records += record({"op": b"\2", "conn": u32(numbers[topic]), "time": stamp}, content)
        body += record({"op": b"\5", "compression": b"bz2", "size": u32(len(records))}, bz2.compress(records, 1))
        for number, entries in index.items():
            body += record({"op": b"\4", "ver": u32(1), "conn": u32(number), "count": u32(len(entries))},
                           b"".join(entries))
        count += 1
    start = b"#ROSBAG V2.0\n"
    fields = {"op": b"\3", "index_pos": bytes(8), "conn_count": u32(len(numbers)), "chunk_count": u32(count)}
    padding = b" " * (4096 - len(record(fields, b"")))
    fields["index_pos"] = struct.pack("<Q", len(start) + 4096 + len(body))
    head = record(fields, padding)
    path.write_bytes(start + head + body + connections)


def mcap_text(text):
    return u32(len(text)) + text.encode()


def mcap_record(op, content):
    return struct.pack("<BQ", op, len(content)) + content


def write_mcap(path, messages):
    numbers, body = {}, b""
    for chunk in chunks_of(messages):
        records, index = b"", {}
        for topic, kind, time, content in chunk:
            if topic not in numbers:
                number = numbers[topic] = len(numbers) + 1
                kind = kind.replace("/", "/msg/")
                records += mcap_record(3, struct.pack("<H", number) + mcap_text(kind) + mcap_text("ros2msg") + u32(0))
                records += mcap_record(4, struct.pack("<HH", number, number) + mcap_text(topic) + mcap_text("cdr") + u32(0))
            index.setdefault(numbers[topic], []).append(struct.pack("<QQ", time, len(records)))
            records += mcap_record(5, struct.pack("<HIQQ", numbers[topic], 0, time, time) + content)
        body += mcap_record(6, struct.pack("<QQQI", 0, 0, len(records), 0) + mcap_text("") + struct.pack("<Q", len(records))
                            + records)
        for number, entries in index.items():
            data = b"".join(entries)
            body += mcap_record(7, struct.pack("<HI", number, len(data)) + data)
    magic = b"\x89MCAP0\r\n"
    end = mcap_record(15, bytes(4)) + mcap_record(2, bytes(20))
    path.write_bytes(magic + mcap_record(1, mcap_text("ros2") + mcap_text("make_bag.py")) + body + end + magic)


def write_sqlite(path, messages):
    database = sqlite3.connect(path)
    database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
                     "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
    database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
                     "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    numbers = {}
    for topic, kind, time, content in messages:
        if topic not in numbers:
            numbers[topic] = len(numbers) + 1
            database.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')",
                             (numbers[topic], topic, kind.replace("/", "/msg/")))
        database.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                         (numbers[topic], time, content))
    database.commit()
    database.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--topic", default="/camera/image_raw")
    arguments = parser.parse_args()
    messages = messages_of(arguments.folder, arguments.topic, arguments.output.suffix != ".bag")
    {".bag": write_ros1, ".mcap": write_mcap, ".db3": write_sqlite}[arguments.output.suffix](arguments.output, messages)


if __name__ == "__main__":
    main()
