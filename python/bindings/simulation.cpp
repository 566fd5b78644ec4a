// Rendered worlds in which everything is known.

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/frame.h"
#include "bindings/trajectory.h"
#include "ldso/error.h"
#include "simulation/sequences/sequence_writer.h"
#include "simulation/sequences/simulated_sequence.h"
#include "util/thread_pool.h"

namespace ldso::python {

namespace py = pybind11;
using py::literals::operator""_a;
using simulation::SequenceRecipe;
using simulation::SimulatedSequence;

namespace {

/// A world with the threads that render it.
struct World {
  SequenceRecipe recipe;
  std::unique_ptr<ThreadPool> pool;
  std::optional<SimulatedSequence> sequence;
  mutable std::mutex mutex{};  ///< The threads have one task at a time.

  int checked(int index) const {
    if (index < 0) index += sequence->size();
    if (index < 0 || index >= sequence->size()) throw py::index_error("frame " + std::to_string(index));
    return index;
  }
};

template <class T>
void take_option(py::dict& given, const char* name, T& to) {
  if (!given.contains(name)) return;
  to = given[name].cast<T>();
  given.attr("pop")(name);
}

/// Of the camera: what is not as usual.
void take_sensor(py::dict& given, SequenceRecipe& recipe) {
  simulation::SensorOptions& sensor = recipe.sensor;
  double noise = 1;
  take_option(given, "noise", noise);
  sensor.read_noise *= noise;
  sensor.shot_noise *= noise * noise;
  take_option(given, "response", sensor.response);
  take_option(given, "vignette", sensor.vignette);
  take_option(given, "exposure_changes", sensor.exposure_changes);
  take_option(given, "exposure_ms", sensor.exposure_ms);
  take_option(given, "motion_blur", sensor.motion_blur);
  take_option(given, "rolling_shutter_ms", sensor.rolling_shutter_ms);
  take_option(given, "tell_calibration", recipe.provide_calibration);
  take_option(given, "tell_exposure", recipe.provide_exposure);
}

SequenceRecipe recipe_from(const std::string& world, const py::kwargs& kwargs) {
  py::dict given(kwargs.attr("copy")());
  SequenceRecipe recipe;
  recipe.world = world;
  std::pair<int, int> size{0, 0};
  take_option(given, "size", size);
  recipe.width = size.first;
  recipe.height = size.second;
  take_option(given, "seed", recipe.seed);
  take_option(given, "frames", recipe.frames);
  take_option(given, "fps", recipe.fps);
  take_option(given, "style", recipe.style);
  take_option(given, "motion", recipe.motion);
  take_option(given, "scale", recipe.scale);
  take_option(given, "speed", recipe.speed);
  take_option(given, "models", recipe.models);
  take_option(given, "lens", recipe.lens);
  take_option(given, "camera", recipe.camera);
  take_option(given, "trajectory", recipe.trajectory);
  take_option(given, "times", recipe.times);
  take_sensor(given, recipe);
  for (const auto& [name, value] : given) {
    throw Error("simulate", "there is no option " + std::string(py::str(name)),
                "see help(ldso.simulate); the names are those of `ldso simulate`");
  }
  return recipe;
}

std::unique_ptr<World> simulate(const std::string& name, int threads, const py::kwargs& options) {
  auto world = std::make_unique<World>();
  world->recipe = recipe_from(name, options);
  world->pool = std::make_unique<ThreadPool>(threads);
  const py::gil_scoped_release no_gil;
  world->sequence.emplace(simulation::make_sequence(world->recipe, world->pool.get()));
  return world;
}

/// What is rendered without the interpreter's lock.
template <class Render>
auto render_with(const World& world, int index, Render render) {
  index = world.checked(index);
  const py::gil_scoped_release no_gil;
  const std::lock_guard lock(world.mutex);
  return render(*world.sequence, index, world.pool.get());
}

Frame rendered_frame(const World& world, int index) {
  return to_frame(render_with(world, index,
                              [](const auto& sequence, int i, ThreadPool* pool) { return sequence.render(i, pool); }));
}

py::array_t<float> rendered_depth(const World& world, int index) {
  return to_array(
      render_with(world, index, [](const auto& sequence, int i, ThreadPool* pool) { return sequence.depth(i, pool); }));
}

NumberedTrajectory world_truth(const World& world) {
  NumberedTrajectory truth;
  for (int i = 0; i < world.sequence->size(); ++i) {
    truth.poses.push_back({world.sequence->timestamp(i), world.sequence->T_world_camera(i)});
    truth.frame_ids.push_back(i);
  }
  return truth;
}

int write_world(const World& world, const std::filesystem::path& folder, const std::string& layout, bool write_depth) {
  simulation::WriteOptions options;
  options.depth = write_depth;
  if (layout == "euroc") {
    options.layout = simulation::LayoutKind::kEuroc;
  } else if (layout == "kitti") {
    options.layout = simulation::LayoutKind::kKitti;
  } else if (layout != "tum-mono") {
    throw Error("layout " + layout, "there is no such layout", "take tum-mono, euroc or kitti");
  }
  const py::gil_scoped_release no_gil;
  const std::lock_guard lock(world.mutex);
  return simulation::write_sequence(*world.sequence, world.recipe, folder, options, *world.pool,
                                    [](int) { return true; });
}

}  // namespace

void bind_simulation(py::module_& module) {
  py::class_<World>(module, "SimulatedSequence",
                    "A camera carried through a rendered world, with everything about it known: len(), [index] for its "
                    "frames. Frames can be asked for in any order and come out the same.")
      .def("__len__", [](const World& w) { return w.sequence->size(); })
      .def("__getitem__", &rendered_frame, "The image as the camera would give it: a Frame.")
      .def("depth", &rendered_depth, "index"_a,
           "Exact z of each pixel of the raw image [m]: float32 of shape (height, width); 0: sky.")
      .def(
          "T_world_camera",
          [](const World& w, int index) { return to_array(w.sequence->T_world_camera(w.checked(index))); }, "index"_a,
          "Exact pose: (4, 4), camera to world [m].")
      .def_property_readonly("ground_truth", &world_truth, "Exact poses of all frames: a Trajectory.")
      .def_property_readonly("calibration", [](const World& w) { return w.sequence->calibration(); })
      .def_property_readonly(
          "path_length", [](const World& w) { return w.sequence->path_length(); }, "[m]")
      .def("write", &write_world, "folder"_a, "layout"_a = "tum-mono", "depth"_a = false,
           "Write it as a sequence; layout: tum-mono, euroc or kitti. Returns the number of frames.")
      .def("__repr__", [](const World& w) {
        return "<ldso.SimulatedSequence " + w.recipe.world + ", " + std::to_string(w.sequence->size()) + " frames>";
      });
  module.def(
      "simulate", &simulate, "world"_a = "room", py::kw_only(), "threads"_a = 2,
      "Build a world: room, window_room, wall, corridor, street or eight. Keywords, as of `ldso simulate`: seed, "
      "frames, size=(width, height), fps, style, motion, scale, speed, models, lens, camera, trajectory, times; of "
      "the sensor: noise, response, vignette, exposure_changes, exposure_ms, motion_blur, rolling_shutter_ms, "
      "tell_calibration, tell_exposure.");
}

}  // namespace ldso::python
