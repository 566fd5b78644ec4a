#include "keyframe_run.h"

#include <algorithm>
#include <ctime>
#include <memory>
#include <utility>

#include "evaluation/trajectory_evaluation.h"
#include "geometry/rolling_shutter.h"
#include "image/frame_preprocessor.h"
#include "ldso/error.h"
#include "mapping/loop_closer.h"
#include "odometry/odometry.h"
#include "place/default_vocabulary.h"
#include "place/vocabulary_file.h"
#include "util/thread_pool.h"

namespace ldso {
namespace {

/// Keyframes before and after one that tell its scale.
constexpr std::ptrdiff_t kScaleKeyframes = 10;

/// Of this thread, which other programs on the machine do not change as they do the wall's clock [ms].
double processor_ms() {
  std::timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// What takes the odometry's keyframes.
class Recorder {
 public:
  explicit Recorder(const LoopSettings& settings, KeyframeRun& run)
      : settings_(settings), vocabulary_(read(settings)), closer_(vocabulary_, settings), run_(run) {}

  void add(const FinishedKeyframe& finished) {
    const KeyframeUpdate& update = finished.update;
    const Image<Texel>& image = finished.frame->pyramid.levels.front();
    const double start = processor_ms();
    KeyframeFeatures features =
        build_features(image, finished.corners, update.points, *vocabulary_, settings_.matching);
    take_out_readout(finished.update.camera, update.readout, features.features);
    describe_ms_ += processor_ms() - start;
    RunKeyframe keyframe;
    keyframe.frame_id = update.frame_id;
    keyframe.segment = update.segment;
    keyframe.timestamp = update.timestamp;
    keyframe.T_world_camera = update.T_world_camera;
    keyframe.features = features.features;
    run_.keyframes.push_back(std::move(keyframe));
    run_.camera = finished.update.camera;
    const CurrentImage current{image, update.readout};
    const double described = processor_ms();
    closer_.add(update, std::move(features), finished.update.camera, &current);
    close_ms_ += processor_ms() - described;
  }

  void finish() {
    closer_.finish();
    const auto n = static_cast<double>(std::max<std::size_t>(1, run_.keyframes.size()));
    run_.describe_ms = describe_ms_ / n;
    run_.close_ms = close_ms_ / n;
    run_.records = closer_.loops();
    const std::vector<KeyframePose> poses = closer_.poses();
    for (int i = 0; i < closer_.map().size(); ++i) {
      run_.keyframes[i].S_world_camera = poses[i].S_world_keyframe;
      for (const Neighbour& neighbour : closer_.map()[i].neighbours) {
        run_.keyframes[i].neighbours.push_back(neighbour.index);
      }
      std::sort(run_.keyframes[i].neighbours.begin(), run_.keyframes[i].neighbours.end());
    }
  }

 private:
  static std::shared_ptr<const Vocabulary> read(const LoopSettings& settings) {
    return std::make_shared<const Vocabulary>(settings.vocabulary.empty() ? default_vocabulary()
                                                                          : read_vocabulary(settings.vocabulary));
  }

  LoopSettings settings_;
  std::shared_ptr<const Vocabulary> vocabulary_;
  LoopCloser closer_;
  KeyframeRun& run_;
  double describe_ms_ = 0, close_ms_ = 0;
};

double readout_of(const Calibration& calibration, const PinholeIntrinsics& rectified) {
  const CameraCalibration& camera = calibration.camera;
  return camera.readout_ms == 0 ? 0 : 1e-3 * camera.readout_ms * covered_rows(*make_camera_model(camera), rectified);
}

void process(const Dataset& dataset, const Settings& settings, KeyframeRun& run) {
  const FramePreprocessor preprocessor(dataset.calibration(), settings.photometry);
  ThreadPool pool(settings.threads);
  Odometry odometry(preprocessor.output_camera(), readout_of(dataset.calibration(), preprocessor.output_camera()),
                    preprocessor.photometrically_calibrated(), settings, pool);
  Recorder recorder(settings.loops, run);
  for (int i = 0; i < dataset.size(); ++i) {
    const auto frame = std::make_shared<const PreparedFrame>(preprocessor.process(dataset.read(i)));
    for (const FinishedKeyframe& keyframe : odometry.process(frame).finished) recorder.add(keyframe);
  }
  for (const FinishedKeyframe& keyframe : odometry.window_keyframes()) recorder.add(keyframe);
  recorder.finish();
}

/// Odometry's or corrected poses of the keyframes.
Trajectory trajectory_of(const KeyframeRun& run, bool corrected) {
  Trajectory trajectory;
  for (const RunKeyframe& keyframe : run.keyframes) {
    const Sim3d& S = keyframe.S_world_camera;
    trajectory.push_back(
        {keyframe.timestamp, corrected ? SE3d(S.rotation(), S.translation()) : keyframe.T_world_camera});
  }
  return trajectory;
}

/// Metres in a map unit about a keyframe, by alignment of the poses around it.
double scale_about(const Trajectory& odometry, const Trajectory& truth, const PosePairs& pairs, std::size_t index) {
  const auto nearest =
      std::find_if(pairs.begin(), pairs.end(), [&](const auto& pair) { return pair.estimate >= index; });
  const auto begin = nearest - std::min(kScaleKeyframes, std::distance(pairs.begin(), nearest));
  const auto end = nearest + std::min(kScaleKeyframes + 1, std::distance(nearest, pairs.end()));
  try {
    return align_pairs(odometry, truth, PosePairs(begin, end), AlignmentMode::kSim3).scale();
  } catch (const Error&) {
    return align_pairs(odometry, truth, pairs, AlignmentMode::kSim3).scale();  // The camera stood still.
  }
}

void compare(const Trajectory& truth, double max_time_difference, KeyframeRun& run) {
  const Trajectory odometry = trajectory_of(run, false);
  PosePairs pairs = associate_by_time(odometry, truth, max_time_difference);
  std::sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.estimate < b.estimate; });
  for (const PosePair& pair : pairs) run.keyframes[pair.estimate].T_truth_camera = truth[pair.truth].T_world_camera;
  for (std::size_t i = 0; i < run.keyframes.size(); ++i) {
    RunKeyframe& keyframe = run.keyframes[i];
    keyframe.truth_per_unit = scale_about(odometry, truth, pairs, i);
    const double idepth = median_idepth(keyframe.features);
    keyframe.depth = idepth > 0 ? keyframe.truth_per_unit / idepth : 0;
  }
  EvaluationOptions options;
  options.max_time_difference = max_time_difference;
  run.ate_before = evaluate_trajectory(odometry, truth, options).absolute.rmse;
  run.ate_after = evaluate_trajectory(trajectory_of(run, true), truth, options).absolute.rmse;
}

}  // namespace

KeyframeRun run_keyframes(const KeyframeRunOptions& options) {
  DatasetOptions dataset_options;
  dataset_options.reverse = options.reverse;
  dataset_options.start = options.start;
  dataset_options.stride = options.stride;
  const auto dataset = open_dataset(options.sequence, dataset_options);
  const auto truth = options.truth.empty() ? dataset->ground_truth() : read_tum_trajectory(options.truth);
  if (!truth) throw Error(options.sequence.string(), "has no ground truth", "take a sequence that has");
  KeyframeRun run;
  process(*dataset, options.settings, run);
  if (run.keyframes.size() < 3) throw Error(options.sequence.string(), "gives no keyframes", "take another sequence");
  compare(*truth, options.max_time_difference, run);
  return run;
}

}  // namespace ldso
