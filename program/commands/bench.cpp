#include <algorithm>
#include <cstdint>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands/commands.h"
#include "ldso/error.h"
#include "ldso/io/settings_file.h"
#include "ldso/sequence_run.h"
#include "results/versions.h"
#include "simulation/sequences/sequence_writer.h"
#include "terminal/option_checks.h"
#include "util/format_text.h"
#include "util/thread_pool.h"

namespace ldso {
namespace {

struct BenchArguments {
  int frames = 300, threads = 2, runs = 3;
  std::vector<std::string> set;
};

/// Rendered once and kept as a camera would give them, so that nothing but the system itself is timed.
class KeptFrames final : public FrameSource {
 public:
  KeptFrames(const simulation::SimulatedSequence& sequence, ThreadPool& pool) : calibration_(sequence.calibration()) {
    for (int i = 0; i < sequence.size(); ++i) {
      RawFrame frame = sequence.render(i, &pool);
      frame.id = i;
      frames_.push_back(std::move(frame));
    }
  }

  int size() const override { return static_cast<int>(frames_.size()); }
  RawFrame read(int index) const override { return frames_.at(static_cast<std::size_t>(index)); }
  double timestamp(int index) const override { return frames_.at(static_cast<std::size_t>(index)).timestamp; }
  const Calibration& calibration() const override { return calibration_; }

 private:
  Calibration calibration_;
  std::vector<RawFrame> frames_;
};

Settings bench_settings(const BenchArguments& a) {
  Settings settings;
  set_settings(settings, a.set);
  settings.threads = a.threads;
  settings.validate();
  return settings;
}

double mean_ms(const SlamResult& result, const std::string& stage) {
  const auto found = result.stage_times.find(stage);
  return found == result.stage_times.end() || found->second.calls == 0
             ? 0.0
             : found->second.total_ms / static_cast<double>(found->second.calls);
}

void run_bench(const BenchArguments& a) {
  const Settings settings = bench_settings(a);
  simulation::SequenceRecipe recipe;
  recipe.world = "room";
  recipe.frames = a.frames;
  ThreadPool pool(a.threads);
  const KeptFrames frames(simulation::make_sequence(recipe, &pool), pool);
  std::vector<double> rates;
  SequenceRun run;
  for (int i = 0; i < a.runs; ++i) {
    run = run_sequence(frames, settings);
    if (!run.error.empty()) throw Error("the built-in sequence", run.error, "this should not happen: please report it");
    rates.push_back(frames.size() / run.seconds);
  }
  std::sort(rates.begin(), rates.end());
  const PinholeIntrinsics& camera = run.result.camera;
  std::cout << format_text("ldso %s: %.1f frames/s (%.1f to %.1f in %d runs) on the built-in room, %d frames of ",
                           project_version().c_str(), rates[rates.size() / 2], rates.front(), rates.back(), a.runs,
                           frames.size())
            << format_text("%dx%d, %d threads; tracking %.1f ms, a keyframe %.1f ms\n", camera.width, camera.height,
                           a.threads, mean_ms(run.result, "track"), mean_ms(run.result, "keyframe"));
}

}  // namespace

void add_bench_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("bench", "How fast is this machine? Frames per second on a built-in sequence");
  const auto arguments = std::make_shared<BenchArguments>();
  command->add_option("--frames", arguments->frames, "Of the sequence")
      ->check(CLI::Range(50, 923))
      ->capture_default_str();
  command->add_option("--runs", arguments->runs, "Of which the middle one counts")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "Threads that work on a frame")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command->add_option("--set", arguments->set, "One setting, e.g. preset=fast; can be repeated")
      ->type_name("KEY=VALUE");
  command->callback([arguments] { run_bench(*arguments); });
}

}  // namespace ldso
