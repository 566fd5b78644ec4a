#include "sequence/camera_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "image/working_size.h"
#include "sequence/camera_trials.h"
#include "util/format_text.h"
#include "util/log.h"

namespace ldso {
namespace {

/// Of the longer side of the image, from a field of view of 115 to 35 degrees, the most usual first.
constexpr std::array<double, 7> kFocalShares{0.88, 0.69, 1.13, 0.54, 1.5, 0.42, 0.32};
/// Shorter ones are tried with barrel distortion as well: nearly straight lines are rare in wide lenses. The
/// coefficient is such that it moves the corners by a share of their distance from the middle; a lens that folds the
/// corners over would leave a part of the image alone, which is explained better than the whole.
constexpr double kDistortedShare = 1.0;
constexpr double kMostBarrel = -0.2;
constexpr double kBarrelInCorner = -0.25;
/// Around what the metadata say: videos show a part of what photos do.
constexpr std::array<double, 3> kMetadataFactors{1, 1.2, 0.85};
/// A wide-angle lens (FOV model).
constexpr double kWideFocalShare = 0.5;
constexpr double kWideOmega = 0.9;

/// So many of the best go on from one round of refinement to the next.
constexpr std::array<std::size_t, 4> kRounds{4, 3, 2, 1};
/// A focal length that the windows want to change by a smaller share is near enough: self-calibration does the rest.
constexpr double kNearEnough = 0.004;
/// Coefficients that differ by less are the same.
constexpr double kSameDistortion = 0.01;
/// Another focal length, by this share, with residuals that are larger by less than that one leaves a doubt.
constexpr double kOtherFocal = 0.06;
constexpr double kSameResidual = 0.015;
/// Or by less than so many standard deviations of that difference, from how it varies along the sequence.
constexpr double kUncertain = 2;
/// A calibration that somebody gave is only left for another camera if its residuals are larger by this (logarithm):
/// distortion that was left out makes them larger by 70-90 %, while weak images can be explained better by up to 17 %
/// with a wrong lens.
constexpr double kFarBetter = 0.3;

/// What is known of a camera when its lens is not: images of this size, from that shutter.
Calibration without_lens(Calibration calibration) {
  CameraCalibration& camera = calibration.camera;
  camera.model = CameraModelKind::kPinhole;
  camera.distortion = {};
  camera.cx = 0.5 * (camera.width - 1);
  camera.cy = 0.5 * (camera.height - 1);
  calibration.source = CameraSource::kNone;
  return calibration;
}

Calibration with_focal_length(Calibration camera, double focal) {
  camera.camera.fx = camera.camera.fy = focal;
  return camera;
}

Calibration with_distortion(Calibration camera, CameraModelKind model, double coefficient) {
  camera.camera.model = model;
  camera.camera.distortion = {coefficient};
  if (camera.rectification.mode == RectificationMode::kNone) camera.rectification.mode = RectificationMode::kCrop;
  return camera;
}

double barrel(const Calibration& calibration) {
  const CameraCalibration& camera = calibration.camera;
  const double corner = std::hypot(camera.cx, camera.cy) / camera.fx;
  return std::max(kMostBarrel, kBarrelInCorner / (corner * corner));
}

/// The nearest one of the same family that the windows of `trial` point to and that points back; nothing if none does.
const CameraTrial* opposite(const std::vector<CameraTrial>& trials, const CameraTrial& trial) {
  const CameraTrial* nearest = nullptr;
  for (const CameraTrial& other : trials) {
    const double distance = other.log_focal() - trial.log_focal();
    if (other.family != trial.family || distance * trial.step() <= 0 || other.step() * trial.step() >= 0) continue;
    if (nearest == nullptr || std::abs(distance) < std::abs(nearest->log_focal() - trial.log_focal())) nearest = &other;
  }
  return nearest;
}

/// What is to be tried after `trial`: between two that point at each other in proportion to how far they say it is, or
/// else what the windows say.
Calibration next_camera(const std::vector<CameraTrial>& trials, const CameraTrial& trial) {
  const CameraTrial* other = opposite(trials, trial);
  if (other == nullptr) return trial.findings.better;
  const double share = trial.step() / (trial.step() - other->step());
  return with_focal_length(trial.findings.better,
                           std::exp(trial.log_focal() + share * (other->log_focal() - trial.log_focal())));
}

/// Whether its windows want it to stay as it is, or nearly so.
bool is_settled(const CameraTrial& trial) {
  const double bend = trial.findings.better.camera.distortion[0] - trial.camera.camera.distortion[0];
  return trial.step() == 0 || (std::abs(trial.step()) < kNearEnough && std::abs(bend) < kSameDistortion);
}

/// By what share the residuals of `other` have to be larger than those of `best` to be so for certain.
double certain_change(const CameraTrial& best, const CameraTrial& other) {
  const FitChange change = compare_fits(best.findings.fits, other.findings.fits);
  return std::max(kSameResidual, change.is_known ? kUncertain * change.stddev : 0);
}

class Finder {
 public:
  /// `guess`: for the images as `source` hands them out.
  Finder(const FrameSource& source, Calibration guess, const Settings& settings, const LogSink& log,
         const std::atomic<bool>* stop)
      : guess_(std::move(guess)), log_(log), runs_(source, settings, stop) {}

  CameraFinding find() {
    int family = 0;
    for (const Calibration& camera : possible_cameras(guess_)) add(camera, family_of(camera, family++));
    for (const std::size_t count : kRounds) refine(count);
    if (trials_.empty()) return {guess_, "there was no map with any of the cameras that were tried"};
    const CameraTrial& best = trials_.front();
    return {best.step() == 0 ? best.camera : best.findings.better, doubt()};
  }

  /// What find() found beside `given`, tried on the same frames.
  std::optional<OtherCamera> find_beside(const Calibration& given) {
    runs_.see_all_frames();
    const CameraTrial reference = runs_.run(given, 0);
    log_to(log_, LogLevel::kInfo, "looking for the camera: as given: " + describe(reference));
    if (!reference.has_map()) return {};
    CameraFinding found = find();
    if (runs_.is_stopped() || trials_.empty()) return {};
    const double change = residual_change(trials_.front(), reference);
    const std::string reason = std::isinf(change)
                                   ? std::string("with the calibration that was given there is hardly a map")
                                   : format_text("residuals with the calibration that was given are larger by %.0f %%",
                                                 100 * std::expm1(change));
    log_to(log_, LogLevel::kInfo, "looking for the camera: " + (change > 0 ? reason : "none is better"));
    if (!found.doubt.empty() || change < kFarBetter) return {};
    return OtherCamera{std::move(found.calibration), reason};
  }

 private:
  /// Pinholes are one family: between two of them there may be the right one. So are those with distortion.
  static int family_of(const Calibration& camera, int number) {
    if (camera.camera.model == CameraModelKind::kPinhole) return -1;
    return camera.camera.model == CameraModelKind::kRadTan ? -2 : number;
  }

  void add(const Calibration& camera, int family) {
    if (runs_.is_stopped()) return;
    CameraTrial trial = runs_.run(camera, family);
    if (runs_.is_stopped()) return;
    log_to(log_, LogLevel::kInfo, "looking for the camera: " + describe(trial));
    if (!trial.has_map()) return;
    // In the order of their residuals. That is none for all of them, since not all share windows: each goes before the
    // first one that it is better than.
    const auto worse = std::find_if(trials_.begin(), trials_.end(),
                                    [&](const CameraTrial& other) { return residual_change(other, trial) < 0; });
    trials_.insert(worse, std::move(trial));
  }

  void refine(std::size_t count) {
    std::vector<CameraTrial> best(trials_.begin(),
                                  trials_.begin() + static_cast<std::ptrdiff_t>(std::min(count, trials_.size())));
    for (const CameraTrial& trial : best) {
      if (is_settled(trial)) continue;
      const Calibration next = next_camera(trials_, trial);
      if (!was_tried(next)) add(next, trial.family);
    }
  }

  /// Or one that is hardly different.
  bool was_tried(const Calibration& camera) const {
    return std::any_of(trials_.begin(), trials_.end(), [&](const CameraTrial& trial) {
      return std::abs(trial.log_focal() - std::log(camera.camera.fx)) < kNearEnough &&
             std::abs(trial.camera.camera.distortion[0] - camera.camera.distortion[0]) < kSameDistortion;
    });
  }

  std::string doubt() const {
    const CameraTrial& best = trials_.front();
    for (const CameraTrial& other : trials_) {
      const bool is_other = std::abs(other.log_focal() - best.log_focal()) > kOtherFocal;
      // What its own windows want to change is no alternative, but on its way to one.
      if (!is_other || !is_settled(other) || residual_change(best, other) > certain_change(best, other)) continue;
      return format_text("focal lengths of %.0f and of %.0f px explain the images equally well", best.camera.camera.fx,
                         other.camera.camera.fx);
    }
    return {};
  }

  Calibration guess_;
  const LogSink& log_;
  CameraTrials runs_;
  std::vector<CameraTrial> trials_;  ///< The best first.
};

}  // namespace

std::vector<Calibration> possible_cameras(const Calibration& guess) {
  std::vector<Calibration> cameras;
  if (guess.source == CameraSource::kMetadata) {
    for (const double factor : kMetadataFactors) cameras.push_back(with_focal_length(guess, factor * guess.camera.fx));
    return cameras;
  }
  const double longer = std::max(guess.camera.width, guess.camera.height);
  for (const double share : kFocalShares) {
    const Calibration straight = with_focal_length(guess, share * longer);
    cameras.push_back(straight);
    if (share < kDistortedShare)
      cameras.push_back(with_distortion(straight, CameraModelKind::kRadTan, barrel(straight)));
  }
  cameras.push_back(
      with_distortion(with_focal_length(guess, kWideFocalShare * longer), CameraModelKind::kFov, kWideOmega));
  return cameras;
}

CameraFinding find_camera(const FrameSource& source, const Settings& settings, const LogSink& log,
                          const std::atomic<bool>* stop) {
  return Finder(source, with_longest_side(source.calibration(), settings.longest_side), settings, log, stop).find();
}

std::optional<OtherCamera> find_other_camera(const FrameSource& source, const Calibration& given,
                                             const Settings& settings, const LogSink& log,
                                             const std::atomic<bool>* stop) {
  return Finder(source, without_lens(given), settings, log, stop).find_beside(given);
}

}  // namespace ldso
