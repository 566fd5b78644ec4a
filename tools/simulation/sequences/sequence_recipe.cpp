#include "simulation/sequences/sequence_recipe.h"

#include <algorithm>
#include <cmath>

#include "io/images/april_tag.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/trajectory_file.h"
#include "simulation/rendering/noise.h"
#include "simulation/worlds/corridor_world.h"
#include "simulation/worlds/room_world.h"
#include "simulation/worlds/street/street_world.h"
#include "simulation/worlds/wall_world.h"
#include "simulation/worlds/window_room_world.h"

namespace ldso::simulation {
namespace {

/// What is usual for a world.
struct Habit {
  const char* lens;
  double fps;
};

bool is_street(const std::string& world) { return world == "street" || world == "eight"; }
bool is_room(const std::string& world) { return world == "room" || world == "window_room"; }

Habit habit_of(const std::string& world) {
  if (is_room(world) || world == "wall") return {"radtan", 30};
  if (world == "corridor") return {"fov", 20};
  if (is_street(world)) return {"pinhole", 10};
  throw Error("simulate", "there is no world '" + world + "'",
              "choose room, window_room, wall, corridor, street or eight");
}

RoomStyle room_style_of(const std::string& name) {
  if (name == "weak") return RoomStyle::kWeak;
  if (name == "wallpaper") return RoomStyle::kWallpaper;
  if (name == "dark") return RoomStyle::kDark;
  return RoomStyle::kUsual;
}

CameraCalibration scaled(CameraCalibration camera, int width, int height) {
  if (width <= 0 || height <= 0) return camera;
  const double sx = static_cast<double>(width) / camera.width, sy = static_cast<double>(height) / camera.height;
  camera.fx *= sx;
  camera.fy *= sy;
  camera.cx = (camera.cx + 0.5) * sx - 0.5;
  camera.cy = (camera.cy + 0.5) * sy - 0.5;
  camera.width = width;
  camera.height = height;
  return camera;
}

CameraCalibration preset_camera(const std::string& lens, bool street) {
  if (lens == "pinhole" && street) {
    return {CameraModelKind::kPinhole, 1226, 370, 707.0912, 707.0912, 601.8873, 183.1104, {}};
  }
  CameraCalibration camera;
  camera.width = street ? 1226 : 640;
  camera.height = street ? 370 : 480;
  camera.cx = 0.5 * camera.width - 2.3;
  camera.cy = 0.5 * camera.height + 3.1;
  double f = 0;
  if (lens == "pinhole") {
    camera.model = CameraModelKind::kPinhole;
    f = 440;
  } else if (lens == "radtan") {
    camera.model = CameraModelKind::kRadTan;
    camera.distortion = {-0.27, 0.072, 0.0004, -0.0003};
    f = 425;
  } else if (lens == "fov") {
    camera.model = CameraModelKind::kFov;
    camera.distortion = {0.92, 0, 0, 0};
    f = 340;
  } else if (lens == "kannala-brandt") {
    camera.model = CameraModelKind::kKannalaBrandt;
    camera.distortion = {-0.012, 0.018, -0.016, 0.004};
    f = 330;
  } else {
    throw Error("simulate", "there is no lens '" + lens + "'", "choose pinhole, radtan, fov or kannala-brandt");
  }
  camera.fx = camera.fy = f * camera.width / 640.0;
  return camera;
}

/// A time for each pose of a file with one pose a line.
std::vector<double> times_at(const std::filesystem::path& path, double fps) {
  std::vector<double> times(TextFile(path).lines().size());
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<double>(i) / fps;
  return times;
}

Trajectory read_trajectory(const SequenceRecipe& recipe, double fps) {
  const std::filesystem::path& path = *recipe.trajectory;
  switch (detect_trajectory_format(path)) {
    case TrajectoryFormat::kTum:
      return read_tum_trajectory(path);
    case TrajectoryFormat::kKitti:
      return read_kitti_poses(path, recipe.times ? read_times(*recipe.times) : times_at(path, fps));
    case TrajectoryFormat::kEuroc:
      break;
  }
  throw Error(path.string(), "is EuRoC ground truth, whose poses are not the camera's",
              "convert it to the TUM format, camera-to-world");
}

void check(const SequenceRecipe& recipe) {
  const auto demand = [](bool good, const char* what, const char* remedy) {
    if (!good) throw Error("simulate", what, remedy);
  };
  const bool room_style = room_style_of(recipe.style) != RoomStyle::kUsual;
  demand(recipe.style.empty() || (room_style && is_room(recipe.world)) ||
             (recipe.style == "open" && is_street(recipe.world)),
         "the world has no such style", "choose weak, wallpaper or dark for rooms, open for streets");
  demand(recipe.motion.empty() || recipe.world == "wall", "only the wall has a choice of motions",
         "leave --motion out or choose the world 'wall'");
  demand(recipe.tag.empty() || is_room(recipe.world), "only rooms have tags",
         "leave --tag out or choose the world 'room'");
  demand(recipe.frames >= 0, "the number of frames is negative", "give --frames 0 or more");
  demand(recipe.fps >= 0, "the frame rate is negative", "give --fps above 0");
  demand(recipe.scale > 0 && recipe.scale <= 10, "the scale is out of range", "give --scale within 0..10");
  demand(recipe.speed > 0, "the speed is not positive", "give --speed above 0");
  demand(recipe.models >= 0, "the number of models is negative", "give --models 0 or more");
  demand(recipe.texel_scale > 0, "the texel scale is not positive", "give a value above 0");
  demand(recipe.sensor.exposure_ms > 0, "the exposure time is not positive", "give --exposure above 0");
  demand(recipe.sensor.rolling_shutter_ms >= 0, "the readout time is negative", "give --rolling-shutter 0 or more");
  demand(recipe.sensor.read_noise >= 0 && recipe.sensor.shot_noise >= 0, "the noise is negative", "give 0 or more");
}

World make_streets(const SequenceRecipe& recipe, const Trajectory& trajectory, ThreadPool* pool) {
  StreetOptions options;
  options.seed = recipe.seed;
  options.texel_scale = recipe.texel_scale;
  options.size_scale = recipe.scale;
  options.speed = recipe.speed;
  options.models = recipe.models;
  options.open = recipe.style == "open";
  options.figure_of_eight = recipe.world == "eight";
  return trajectory.empty() ? make_street_world(options, pool) : make_street_world_along(trajectory, options, pool);
}

World make_world(const SequenceRecipe& recipe, const Trajectory& trajectory, ThreadPool* pool) {
  if (is_street(recipe.world)) return make_streets(recipe, trajectory, pool);
  const double path_scale = std::min(recipe.scale, 1.0);
  if (recipe.world == "wall") {
    const WallMotion motion = wall_motion_of(recipe.motion.empty() ? "sideways" : recipe.motion);
    return make_wall_world({recipe.seed, recipe.texel_scale, path_scale, motion}, pool);
  }
  RoomOptions options;
  options.seed = recipe.seed;
  options.texel_scale = recipe.texel_scale;
  options.path_scale = path_scale;
  options.style = room_style_of(recipe.style);
  if (!recipe.tag.empty()) {
    const AprilTag tag = parse_april_tag(recipe.tag, "--tag");
    options.tag = {draw_april_tag(tag.family, tag.id), tag.metres};
  }
  if (recipe.world == "room") return make_room_world(options, pool);
  if (recipe.world == "window_room") return make_window_room_world(options, pool);
  return make_corridor_world(options, pool);
}

}  // namespace

SimulatedSequence make_sequence(const SequenceRecipe& recipe, ThreadPool* pool) {
  check(recipe);
  const Habit habit = habit_of(recipe.world);
  const bool street = is_street(recipe.world);
  if (recipe.trajectory && recipe.world != "street") {
    throw Error("simulate", "a trajectory can be driven through streets only", "choose the world 'street'");
  }
  SequenceOptions options;
  options.fps = recipe.fps > 0 ? recipe.fps : habit.fps;
  options.frames = recipe.frames;
  options.sensor = recipe.sensor;
  options.sensor.seed = hash_of(recipe.seed, 0x5e2502);
  options.provide_calibration = recipe.provide_calibration;
  options.provide_exposure = recipe.provide_exposure;
  if (recipe.camera) {
    const Calibration calibration = read_camera_calibration(*recipe.camera);
    options.camera = scaled(calibration.camera, recipe.width, recipe.height);
    options.rectification = calibration.rectification;
  } else {
    const std::string lens = recipe.lens.empty() ? habit.lens : recipe.lens;
    options.camera = scaled(preset_camera(lens, street), recipe.width, recipe.height);
  }
  Trajectory trajectory;
  if (recipe.trajectory) {
    trajectory = read_trajectory(recipe, options.fps);
    for (const StampedPose& pose : trajectory) options.timestamps.push_back(pose.timestamp);
  }
  return SimulatedSequence(make_world(recipe, trajectory, pool), options);
}

}  // namespace ldso::simulation
