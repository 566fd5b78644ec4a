#include "ldso/results_folder.h"

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ldso/error.h"
#include "output/run_results.h"
#include "viewer/live_run.h"

namespace ldso {

/// May be heard from several threads.
class WarningList {
 public:
  void add(const std::string& text) {
    const std::lock_guard lock(mutex_);
    warnings_.push_back(text);
  }
  std::vector<std::string> all() const {
    const std::lock_guard lock(mutex_);
    return warnings_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> warnings_;
};

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Frames of which there is nothing but what became of them.
class ForeignFrames final : public Dataset {
 public:
  explicit ForeignFrames(Calibration calibration) : calibration_(std::move(calibration)) {}

  int size() const override { return 0; }
  RawFrame read(int index) const override {
    throw Error("frame " + std::to_string(index), "its image was not kept", "give the sequence to ResultsFolder");
  }
  double timestamp(int) const override { return 0; }
  const Calibration& calibration() const override { return calibration_; }
  std::optional<Trajectory> ground_truth() const override { return std::nullopt; }
  std::string format_name() const override { return "frames of a program"; }
  const std::vector<std::string>& warnings() const override { return warnings_; }

 private:
  Calibration calibration_;
  std::vector<std::string> warnings_;
};

LiveRunOptions recorder_options(const ResultsFolderOptions& options) {
  LiveRunOptions recorder;
  recorder.name = options.name.empty() ? options.sequence.string() : options.name;
  recorder.has_control = false;
  return recorder;
}

OutputFolder prepare(const fs::path& folder, const ResultsFolderOptions& options) {
  if (!options.sequence.empty()) refuse_output_in_input(folder, options.sequence, {});
  return prepare_output_folder(folder);
}

}  // namespace

struct ResultsFolder::Impl {
  Impl(const fs::path& folder, const ResultsFolderOptions& given)
      : options(given), out(prepare(folder, given)), recorder(std::make_shared<LiveRun>(recorder_options(given))) {
    summary.sequence_path = given.sequence;
    summary.dataset_options = given.dataset_options;
  }

  ResultsFolderOptions options;
  OutputFolder out;
  RunSummary summary;
  std::shared_ptr<LiveRun> recorder;
  std::shared_ptr<WarningList> warnings = std::make_shared<WarningList>();
  std::unique_ptr<const Dataset> own;
  const Dataset* dataset = nullptr;
  Clock::time_point start = Clock::now();
};

ResultsFolder::ResultsFolder(const fs::path& folder, const Calibration& calibration, const Settings& settings,
                             const ResultsFolderOptions& options)
    : impl_(std::make_unique<Impl>(folder, options)) {
  impl_->own = std::make_unique<ForeignFrames>(calibration);
  impl_->dataset = impl_->own.get();
  impl_->options.loop_pictures = false;
  impl_->summary.settings = settings;
}

ResultsFolder::ResultsFolder(const fs::path& folder, const Dataset& dataset, const Settings& settings,
                             const ResultsFolderOptions& options)
    : impl_(std::make_unique<Impl>(folder, options)) {
  impl_->dataset = &dataset;
  impl_->summary.settings = settings;
}

ResultsFolder::~ResultsFolder() = default;

std::shared_ptr<RunObserver> ResultsFolder::observer() const { return impl_->recorder->observer(); }

LogSink ResultsFolder::log() const {
  return [warnings = impl_->warnings, recorder = impl_->recorder, also = impl_->options.log](LogLevel level,
                                                                                             const std::string& text) {
    if (level == LogLevel::kWarning) warnings->add(text);
    recorder->log(level, text);
    if (also) also(level, text);
  };
}

void ResultsFolder::write(SlamResult result) {
  SequenceRun run;
  run.calibration = impl_->dataset->calibration();
  run.seconds = std::chrono::duration<double>(Clock::now() - impl_->start).count();
  run.result = std::move(result);
  write(std::move(run));
}

void ResultsFolder::write(SequenceRun run) {
  RunSummary& summary = impl_->summary;
  summary.run = std::move(run);
  impl_->recorder->finish();
  summary.recording = impl_->recorder->recording();
  summary.frame_costs = impl_->recorder->frame_costs();
  summary.warnings = impl_->warnings->all();
  const ResultsFolderOptions& options = impl_->options;
  const std::vector<std::string> problems =
      write_run_results(impl_->out, summary, *impl_->dataset, {options.kitti, options.loop_pictures, options.report});
  if (!problems.empty()) throw Error(impl_->out.path().string(), "results are missing", problems.front());
}

}  // namespace ldso
