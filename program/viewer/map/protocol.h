#pragma once

// The messages between a run and the pages that show it: plain records and their little-endian bytes. The format is
// documented in docs/viewer.md and read by web/src/protocol.ts; whoever changes one changes all three and kVersion.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ldso/calibration.h"
#include "ldso/observer.h"
#include "ldso/records.h"
#include "ldso/rgb.h"
#include "ldso/sim3.h"
#include "util/bytes.h"

namespace ldso::protocol {

inline constexpr std::uint32_t kVersion = 1;

enum class MessageType : std::uint16_t {
  kHello = 1,      ///< Begins a map: what was there before is void.
  kKeyframe = 2,   ///< A keyframe that left the window, with its points: final but for its corrected pose.
  kPoses = 3,      ///< Corrected poses of keyframes: new or changed.
  kFrames = 4,     ///< Frames in a row; one that was there before is replaced.
  kLoops = 5,      ///< Loops that were closed.
  kLog = 6,        ///< What the run says in words.
  kTruth = 7,      ///< The ground truth's trajectory.
  kAlignment = 8,  ///< Where the ground truth lies in the map.
  kStatus = 9,     ///< How far the run is.
  kWindow = 10,    ///< The sliding window as it is now.
  kImage = 11,     ///< The current image with the points in it.
};

enum class Mode : std::uint8_t { kRun = 0, kReplay = 1 };
enum class RunState : std::uint8_t { kRunning = 0, kPaused = 1, kFinished = 2 };

/// What a page asks for.
enum class Command : std::uint8_t { kPause = 1, kContinue = 2, kStep = 3 };

struct Hello {
  std::uint64_t run_id = 0;  ///< Differs between runs.
  std::uint32_t epoch = 0;   ///< Counts how often this run began anew.
  Mode mode = Mode::kRun;
  bool has_control = false;  ///< Whether commands are of use.
  PinholeIntrinsics camera;
  std::string name;            ///< Of the sequence.
  double metres_per_unit = 0;  ///< By a length that was given; 0: nobody knows.
};

/// A keyframe with its points in its own coordinates, so that a changed pose moves them.
struct Keyframe {
  std::int64_t id = 0;
  double timestamp = 0;
  SE3d T_world_camera;  ///< Of the odometry.
  std::vector<Eigen::Vector3f> points;
  std::vector<float> depth_stddev;  ///< Of the inverse depth, relative to it.
  std::vector<std::uint8_t> intensity;
  std::vector<std::uint8_t> is_corner;  ///< 0 or 1.
  std::vector<std::int64_t> links;      ///< Keyframes that see the same points.
  int segment = 0;                      ///< Of the run: the map was lost between two of them (KeyframeUpdate).
  std::vector<Rgb> colors = {};         ///< Of the points, if the images have colour and were read again; else empty.
};

/// Points without a usable depth are left out.
Keyframe to_keyframe(std::int64_t id, const SE3d& T_world_camera, std::span<const MapPoint> points,
                     const PinholeIntrinsics& camera, const ReadoutMotion& readout = ReadoutMotion::Zero());

struct Poses {
  std::int64_t at_frame = -1;  ///< Newest frame when they were known.
  Sim3d correction;            ///< From the odometry's world, for keyframes without a pose of their own here.
  std::vector<KeyframePose> poses;
};

struct Loop {
  std::int64_t keyframe_id = 0, candidate_id = 0;
  std::int64_t at_frame = -1;  ///< Newest frame when it was closed.
  std::int32_t inliers = 0;
  float score = 0;
};

struct LogLine {
  std::int64_t at_frame = -1;
  bool is_warning = false;
  std::string text;
};

struct Status {
  RunState state = RunState::kRunning;
  std::uint32_t done = 0, count = 0;  ///< Frames.
  std::uint32_t viewers = 0;
  std::uint32_t loop_candidates = 0;
  float memory_mb = 0;  ///< Of the program, now.
  float frames_per_s = 0;
  std::uint32_t dropped = 0;  ///< Frames of a live run that came too fast.
  bool operator==(const Status&) const = default;
};

struct Alignment {
  Sim3d S_world_truth;  ///< Maps the ground truth into the map.
  double ate_rmse = 0;  ///< In the ground truth's unit.
  std::uint32_t pairs = 0;
};

/// A view as it is sent.
struct CompressedImage {
  std::int64_t frame_id = 0;
  int width = 0, height = 0;  ///< To which the pixels belong; the JPEG may be smaller.
  std::vector<std::uint8_t> jpeg;
};

Bytes encode(const Hello& hello);
Bytes encode(const Keyframe& keyframe);
Bytes encode(const Poses& poses);
Bytes encode(std::span<const FrameEvent> frames);
Bytes encode(std::span<const Loop> loops);
Bytes encode(std::span<const LogLine> lines);
Bytes encode_truth(std::span<const Eigen::Vector3d> positions);
Bytes encode(const Alignment& alignment);
Bytes encode(const Status& status);
Bytes encode_window(const LiveView& view, const Sim3d& correction);
Bytes encode_image(const CompressedImage& image, std::span<const ViewPixel> pixels);

/// A message of a stream, not yet decoded.
struct Message {
  MessageType type{};
  std::span<const std::uint8_t> payload;
};

/// With its header. The message must be one that split() has found.
std::span<const std::uint8_t> whole(const Message& message);

/// Cuts a stream into its messages; `name` is what errors call it. Throws Error if it is none.
std::vector<Message> split(std::span<const std::uint8_t> stream, const std::string& name);

/// Of a hello. Throws Error if it is damaged (the camera is no camera) or of another version.
Hello decode_hello(std::span<const std::uint8_t> payload, const std::string& name);

/// Of a keyframe, of corrected poses. They throw Error if the payload is cut off, or if a pose, scale
/// or point in it is none.
Keyframe decode_keyframe(std::span<const std::uint8_t> payload, const std::string& name);
Poses decode_poses(std::span<const std::uint8_t> payload, const std::string& name);

/// A page's command; nothing if it is none.
std::optional<Command> decode_command(std::span<const std::uint8_t> bytes);

}  // namespace ldso::protocol
