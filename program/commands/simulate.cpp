#include "commands/commands.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "ldso/error.h"
#include "simulation/sequences/sequence_writer.h"
#include "terminal/option_checks.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using simulation::SequenceRecipe;
using simulation::SimulatedSequence;

struct SimulateArguments {
  SequenceRecipe recipe;
  simulation::WriteOptions write;
  fs::path output;
  std::string size, camera, trajectory, times, layout = "tum-mono", truth = "all";
  int threads = 2;
  bool linear = false, no_vignette = false, constant_exposure = false, hide_exposure = false, no_calibration = false;
  double noise = 1;
};

void add_scene_options(CLI::App& command, SimulateArguments& a) {
  command
      .add_option("world", a.recipe.world,
                  "room, window_room (slowly at a window first), wall (one plane), corridor, street (a block driven "
                  "round) or eight (two blocks)")
      ->check(CLI::IsMember({"room", "window_room", "wall", "corridor", "street", "eight"}))
      ->required();
  command.add_option("-o,--output", a.output, "Folder to write the sequence to")->required();
  command.add_option("--seed", a.recipe.seed, "Another seed is another world and another way")->capture_default_str();
  command.add_option("--frames", a.recipe.frames, "At most this many frames (0: the whole way)")
      ->check(number_from_zero());
  command.add_option("--fps", a.recipe.fps, "Frames per second (default: street 10, corridor 20, room and wall 30)")
      ->check(positive_number());
  command
      .add_option("--style", a.recipe.style,
                  "Rooms: weak (texture), wallpaper (that repeats) or dark; streets: open (half of the image sky)")
      ->check(CLI::IsMember({"weak", "wallpaper", "dark", "open"}));
  command
      .add_option("--motion", a.recipe.motion,
                  "Before the wall: sideways (default), forward, turning, standing, orbit or slow (at first)")
      ->check(CLI::IsMember({"sideways", "forward", "turning", "standing", "orbit", "slow"}));
  command
      .add_option("--tag", a.recipe.tag,
                  "Rooms: an AprilTag on a wall, e.g. 36h11:3:0.4 (side of its black square in metres)")
      ->type_name("FAMILY:ID:METRES");
  command.add_option("--scale", a.recipe.scale, "Size of the street circuit; indoors the part of the way walked")
      ->check(positive_number());
  command.add_option("--speed", a.recipe.speed, "Speed on streets [m/s]")
      ->check(positive_number())
      ->capture_default_str();
  command
      .add_option("--models", a.recipe.models,
                  "Streets: houses, cars and signs repeat, so many models of each (0: all differ)")
      ->check(number_from_zero());
  command.add_option("--trajectory", a.trajectory, "Build streets along these camera poses (TUM or KITTI format)")
      ->check(CLI::ExistingFile);
  command.add_option("--times", a.times, "Times of KITTI poses [s], one a line (default: number / fps)")
      ->check(CLI::ExistingFile);
}

void add_camera_options(CLI::App& command, SimulateArguments& a) {
  command
      .add_option("--lens", a.recipe.lens, "Lens model (default: street pinhole, room and wall radtan, corridor fov)")
      ->check(CLI::IsMember({"pinhole", "radtan", "fov", "kannala-brandt"}));
  command.add_option("--camera", a.camera, "Use the camera of this camera.txt")->check(CLI::ExistingFile);
  command.add_option("--size", a.size, "Image size WIDTHxHEIGHT; the intrinsics are scaled");
  command.add_flag("--linear", a.linear, "Linear response");
  command.add_flag("--no-vignette", a.no_vignette, "No vignette");
  command.add_flag("--no-calibration", a.no_calibration, "Do not tell response and vignette");
  command.add_option("--exposure", a.recipe.sensor.exposure_ms, "Mean exposure time [ms]")
      ->check(positive_number())
      ->capture_default_str();
  command.add_flag("--constant-exposure", a.constant_exposure, "No exposure changes");
  command.add_flag("--hide-exposure", a.hide_exposure, "Leave the exposure times out of times.txt");
  command.add_option("--noise", a.noise, "Noise, as a factor of the usual; 0: none")
      ->check(number_from_zero())
      ->capture_default_str();
  command.add_flag("--motion-blur", a.recipe.sensor.motion_blur, "Blur by the motion during the exposure");
  command.add_option("--rolling-shutter", a.recipe.sensor.rolling_shutter_ms, "Time from first to last row [ms]")
      ->check(number_from_zero());
}

void add_layout_options(CLI::App& command, SimulateArguments& a) {
  command.add_option("--layout", a.layout, "Of which benchmark the folder looks; kitti: give -o ROOT/sequences/NAME")
      ->check(CLI::IsMember({"tum-mono", "euroc", "kitti"}))
      ->capture_default_str();
  command.add_option("--truth", a.truth, "Ground truth of all frames, or at the start and the end alone (tum-mono)")
      ->check(CLI::IsMember({"all", "ends"}))
      ->capture_default_str();
  command.add_flag("--depth", a.write.depth, "Also write depth maps (16-bit PNG, unit in world.yaml)");
  command.add_flag("--zip", a.write.zip, "Write images.zip instead of a folder (tum-mono)");
}

void resolve(SimulateArguments& a) {
  if (a.layout == "euroc") a.write.layout = simulation::LayoutKind::kEuroc;
  if (a.layout == "kitti") a.write.layout = simulation::LayoutKind::kKitti;
  a.write.truth_at_ends = a.truth == "ends";
  if (!a.size.empty()) {
    char rest = 0;
    if (std::sscanf(a.size.c_str(), "%dx%d%c", &a.recipe.width, &a.recipe.height, &rest) != 2 || a.recipe.width < 16 ||
        a.recipe.height < 16 || a.recipe.width > 16384 || a.recipe.height > 16384) {
      throw Error("--size " + a.size, "is no image size", "write it as 640x480, sides within 16..16384");
    }
  }
  if (!a.camera.empty()) a.recipe.camera = a.camera;
  if (!a.trajectory.empty()) a.recipe.trajectory = a.trajectory;
  if (!a.times.empty()) a.recipe.times = a.times;
  simulation::SensorOptions& sensor = a.recipe.sensor;
  sensor.response = !a.linear;
  sensor.vignette = !a.no_vignette;
  sensor.exposure_changes = !a.constant_exposure;
  sensor.read_noise *= a.noise;
  sensor.shot_noise *= a.noise * a.noise;
  a.recipe.provide_calibration = !a.no_calibration;
  a.recipe.provide_exposure = !a.hide_exposure;
}

void run(SimulateArguments a) {
  resolve(a);
  ThreadPool pool(a.threads);
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  const SimulatedSequence sequence = simulation::make_sequence(a.recipe, &pool);
  const double ready = seconds();
  std::cout << sequence.name() << " (seed " << a.recipe.seed << "): " << sequence.size() << " frames, "
            << sequence.path_length() << " m; world built in " << ready << " s" << std::endl;
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  const auto progress = [&](int done) {
    if (terminal) {
      std::cout << "\r" << done << " / " << sequence.size() << " frames, " << done / (seconds() - ready)
                << " frames/s   " << std::flush;
    }
    return true;
  };
  const int frames = simulation::write_sequence(sequence, a.recipe, a.output, a.write, pool, progress);
  std::cout << (terminal ? "\r" : "") << frames << " frames written to " << a.output.string() << ", "
            << frames / (seconds() - ready) << " frames/s" << std::endl;
}

}  // namespace

void add_simulate_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("simulate", "Render a sequence with exact ground truth, in the layout of a benchmark");
  const auto arguments = std::make_shared<SimulateArguments>();
  add_scene_options(*command, *arguments);
  add_camera_options(*command, *arguments);
  add_layout_options(*command, *arguments);
  command->add_option("--threads", arguments->threads, "Threads; the result does not depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command->callback([arguments] { run(*arguments); });
}

}  // namespace ldso
