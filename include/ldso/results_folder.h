#pragma once

// The folder that `ldso run -o` leaves, written by a program of one's own: `ldso view`, `ldso export` and `ldso eval`
// take it, and report.html shows the run.
//
//   ldso::ResultsFolder results("out", calibration, settings);
//   ldso::Slam slam(calibration, settings, results.log(), results.observer());
//   for (...) slam.process(image, timestamp);
//   results.write(slam.finish());

#include <filesystem>
#include <memory>

#include "ldso/io/dataset.h"
#include "ldso/log.h"
#include "ldso/observer.h"
#include "ldso/sequence_run.h"
#include "ldso/settings.h"
#include "ldso/slam.h"

namespace ldso {

struct ResultsFolderOptions {
  std::string name = {};  ///< Of what was run, for the viewer and the report.
  LogSink log = {};       ///< Hears what log() hears.
  /// Where the images are, and how they were played: `ldso export` reads them again.
  std::filesystem::path sequence = {};
  DatasetOptions dataset_options = {};
  bool kitti = false;          ///< Also trajectory_kitti.txt.
  bool loop_pictures = false;  ///< Also loops/*.png, if there is a dataset.
  bool report = true;          ///< report.html.
};

/// One for each run.
class ResultsFolder {
 public:
  /// For frames that the program has from anywhere. Creates the folder. It may hold other files: those are never
  /// touched. Throws Error if it cannot be written, or if a file of somebody else has the name of a result.
  ResultsFolder(const std::filesystem::path& folder, const Calibration& calibration, const Settings& settings,
                const ResultsFolderOptions& options = {});
  /// For a sequence, which must outlive this: it is evaluated against its ground truth, and its images are read again
  /// for the pictures of loops. Throws Error likewise, and if the folder is that of the sequence.
  ResultsFolder(const std::filesystem::path& folder, const Dataset& dataset, const Settings& settings,
                const ResultsFolderOptions& options = {});
  ~ResultsFolder();
  ResultsFolder(const ResultsFolder&) = delete;
  ResultsFolder& operator=(const ResultsFolder&) = delete;

  /// Both are to be given to the run. The observer records it; the log keeps the warnings. They may outlive this.
  std::shared_ptr<RunObserver> observer() const;
  LogSink log() const;

  /// Once, at the end: the files that docs/input-output.md lists. The time of a run of frames one by one is that since
  /// this was made. Throws Error if a file cannot be written; the others are.
  void write(SlamResult result);
  void write(SequenceRun run);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ldso
