#!/usr/bin/env bash
# node_test.sh PROGRAM SEQUENCE WORK NODE PUBLISHER: the node of ROS 1 beside roscore, on a rendered sequence that is
# published as a camera would: its trajectory is that of `ldso run`.
LDSO=$1 SEQUENCE=$2 WORK=$3/ros1 NODE=$4 PUBLISHER=$5
rm -rf "$WORK" && mkdir -p "$WORK/plain"
source "$(dirname "${BASH_SOURCE[0]}")/../../../tests/test_tools.sh"
if ! command -v roscore >/dev/null; then
  echo "skipped: roscore is not installed (python3-roslaunch)"
  exit 77
fi

# Cameras in ROS say nothing of exposures, response and vignette.
ln -s "$(realpath "$SEQUENCE/images")" "$WORK/plain/images"
cp "$SEQUENCE/camera.txt" "$WORK/plain/"
awk '!/^#/ && NF { print $1, $2 }' "$SEQUENCE/times.txt" >"$WORK/plain/times.txt"
frames=$(wc -l <"$WORK/plain/times.txt")
expect_exit 0 run "$WORK/plain" -o "$WORK/program" --no-report --set selection.candidates=1800

# A roscore of this test alone, on a port that is free.
port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI=http://127.0.0.1:$port ROS_IP=127.0.0.1 ROS_HOME=$WORK/ros ROS_LOG_DIR=$WORK/ros/log
unset ROS_HOSTNAME
pids=()
end_all() { for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done; }
trap end_all EXIT
roscore -p "$port" >"$WORK/roscore.log" 2>&1 &
pids+=($!)
# Waits by asking again and again, for at most a minute.
python3 - "$port" <<'PY' || { cat "$WORK/roscore.log"; fail "roscore does not answer"; }
import sys, time, xmlrpc.client
end = time.monotonic() + 60
while True:
    try:
        xmlrpc.client.ServerProxy(f"http://127.0.0.1:{sys.argv[1]}").getPid("/test")
        break
    except OSError:
        if time.monotonic() > end:
            sys.exit(1)
        time.sleep(0.1)
PY

# All images are processed, whatever time it takes.
"$NODE" __name:=ldso _image_topic:=/camera/image_raw _queue_size:=0 _map_period:=0.5 _results:="$WORK/node" \
  _selection/candidates:=1800 >"$WORK/node.log" 2>&1 &
node=$!
pids+=("$node")
"$PUBLISHER" "$WORK/plain" "$WORK/path.txt" >"$WORK/published" || { cat "$WORK/node.log"; fail "the publisher failed"; }
kill -INT "$node"
wait "$node" || { cat "$WORK/node.log"; fail "the node failed"; }

# The same map to the last bit, in the same files; times are others.
positions() { awk '!/^#/ && NF { $1 = ""; print }' "$1/trajectory.txt"; }
[[ $(poses "$WORK/program/trajectory.txt") -gt $((frames / 2)) ]] || fail "the program has hardly any pose"
diff <(positions "$WORK/program") <(positions "$WORK/node") >"$WORK/diff" || fail "the trajectory is another one"
expect_exit 0 export "$WORK/node" --format ply

# What was published: a pose for each frame from the map's begin on, the whole path, points, transformations.
read -r _ count _ points _ transforms <"$WORK/published"
expect_exit 0 eval "$WORK/path.txt" "$WORK/node/trajectory.txt"
expect_true "poses are published" "$frames / 3 < $count <= $frames and $transforms == $count"
expect_true "points are published" "$points > 500"

# A parameter that makes no sense is refused by its name.
if "$NODE" __name:=other _queue_size:=-1 >"$WORK/log" 2>&1; then fail "a queue of -1 images was taken"; fi
expect_output "parameter 'queue_size'.*-1"
if "$NODE" __name:=third _selection/candidates:=many >"$WORK/log" 2>&1; then fail "many candidates were taken"; fi
expect_output 'selection.candidates'
