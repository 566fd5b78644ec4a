#include "calibration/lens/lens_calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/lens/disk_bias.h"
#include "calibration/lens/first_lens.h"
#include "calibration/lens/lens_adjustment.h"
#include "ldso/error.h"
#include "util/median.h"

namespace ldso {
namespace {

constexpr std::size_t kLeastViews = 3;
/// Points are wrong that are off by more than so many times the usual distance, and at least by so much [px].
constexpr double kWrongTimes = 6, kWrongPixels = 0.5;
/// A view with more wrong points than this share is wrong itself.
constexpr double kWrongShare = 0.25;
/// Rounds of refusing what is wrong and of moving centroids of disks.
constexpr int kRounds = 4;

/// Views with what is still used of them, beside the estimate that is made from them.
struct Work {
  std::vector<const BoardView*> sources;
  std::vector<ObservedView> views;
  LensAndPoses estimate;

  void remove(std::size_t view) {
    const auto at = static_cast<std::ptrdiff_t>(view);
    sources.erase(sources.begin() + at);
    views.erase(views.begin() + at);
    estimate.poses.erase(estimate.poses.begin() + at);
  }
};

ObservedView observed(const BoardView& view, const std::vector<Eigen::Vector2d>& board) {
  ObservedView result;
  for (const SeenPoint& point : view.points) {
    const Eigen::Vector2d& on_board = board[static_cast<std::size_t>(point.id)];
    result.board.emplace_back(on_board.x(), on_board.y(), 0);
    result.pixels.push_back(point.pixel);
  }
  return result;
}

[[noreturn]] void refuse_few(const std::string& where, std::size_t count) {
  throw Error(where,
              "the board is well seen in " + std::to_string(count) + " images, and no lens can be told from those",
              "take 15 or more, with the board tilted in several directions and everywhere in the image");
}

Work begin(const std::vector<BoardView>& views, const Board& board, LensKind kind, int width, int height,
           const std::string& where, std::vector<std::string>& refused) {
  const std::vector<Eigen::Vector2d> points = board_points(board);
  std::vector<ObservedView> all;
  for (const BoardView& view : views) all.push_back(observed(view, points));
  const auto first = all.size() < kLeastViews ? std::nullopt : first_lens(all, kind, width, height);
  if (!first) refuse_few(where, all.size());
  Work work;
  work.estimate = *first;
  const Lens lens = first->lens();
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto pose = board_pose(all[i], lens.model());
    const bool fits = pose && [&] {
      const auto residuals = residuals_of(all[i], lens, *pose);
      return std::all_of(residuals.begin(), residuals.end(), [](const auto& r) { return r.allFinite(); });
    }();
    if (!fits) {
      refused.push_back(views[i].name);
      continue;
    }
    work.sources.push_back(&views[i]);
    work.views.push_back(all[i]);
    work.estimate.poses.push_back(*pose);
  }
  if (work.views.size() < kLeastViews) refuse_few(where, work.views.size());
  return work;
}

/// From the median, which what is wrong hardly moves.
double usual_distance(const Work& work) {
  std::vector<double> distances;
  const Lens lens = work.estimate.lens();
  for (std::size_t i = 0; i < work.views.size(); ++i) {
    for (const auto& r : residuals_of(work.views[i], lens, work.estimate.poses[i])) distances.push_back(r.norm());
  }
  return upper_median(distances) / 1.1774;  // The median of a Rayleigh distribution for a deviation of one.
}

/// Points that are off farther than `most` [px] leave the view; returns how many.
int remove_wrong(const std::vector<Eigen::Vector2d>& residuals, double most, ObservedView& view) {
  ObservedView kept;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (residuals[i].norm() > most) continue;
    kept.board.push_back(view.board[i]);
    kept.pixels.push_back(view.pixels[i]);
  }
  const auto removed = static_cast<int>(view.board.size() - kept.board.size());
  view = kept;
  return removed;
}

/// Whether anything was refused.
bool refuse_wrong(Work& work, LensCalibration& result) {
  const double most = std::max(kWrongPixels, kWrongTimes * usual_distance(work));
  bool any = false;
  for (std::size_t i = work.views.size(); i-- > 0;) {
    const std::vector<Eigen::Vector2d> residuals =
        residuals_of(work.views[i], work.estimate.lens(), work.estimate.poses[i]);
    const auto wrong = static_cast<double>(
        std::count_if(residuals.begin(), residuals.end(), [&](const auto& r) { return r.norm() > most; }));
    if (wrong == 0) continue;
    any = true;
    if (wrong > kWrongShare * static_cast<double>(residuals.size())) {
      result.refused_views.push_back(work.sources[i]->name);
      work.remove(i);
    } else {
      result.refused_points += remove_wrong(residuals, most, work.views[i]);
    }
  }
  return any;
}

void adjust_and_refuse(Work& work, LensCalibration& result, const std::string& where) {
  for (int round = 0; round < kRounds; ++round) {
    adjust_lens(work.views, {}, work.estimate);
    if (!refuse_wrong(work, result)) return;
    if (work.views.size() < kLeastViews) refuse_few(where, work.views.size());
  }
  adjust_lens(work.views, {}, work.estimate);
}

/// A lens shows the centroid of a disk beside its centre.
void adjust_disks(const Board& board, Work& work) {
  if (board.kind != BoardKind::kCircles) return;
  for (int round = 0; round < kRounds; ++round) {
    const double radius = disk_radius(work.sources, board, work.estimate);
    const Lens lens = work.estimate.lens();
    for (std::size_t i = 0; i < work.views.size(); ++i)
      move_to_centres(*work.sources[i], board, radius, lens, work.estimate.poses[i], work.views[i]);
    adjust_lens(work.views, {}, work.estimate);
  }
}

/// Whether a fisheye's radius grows as far as the corners of the image. Rays beyond 90 degrees count as well, which
/// CameraModel::unproject() does not give.
bool grows_to_corners(const CameraCalibration& camera) {
  const Eigen::Vector2d far(std::max(camera.cx, camera.width - 1 - camera.cx) / camera.fx,
                            std::max(camera.cy, camera.height - 1 - camera.cy) / camera.fy);
  double radius = 0;
  for (double theta = 0.005; theta < M_PI && radius < far.norm(); theta += 0.005) {
    double factor = 1, power = 1;
    for (const double k : camera.distortion) factor += k * (power *= theta * theta);
    if (theta * factor <= radius) return false;
    radius = theta * factor;
  }
  return radius >= far.norm();
}

/// Along the border, where distortion is largest, no pixel may lie beyond what the lens shows.
bool sees_border(const CameraModel& camera) {
  if (camera.calibration().model == CameraModelKind::kFov) return true;
  if (camera.calibration().model == CameraModelKind::kKannalaBrandt) return grows_to_corners(camera.calibration());
  constexpr int kSteps = 32;
  const int width = camera.calibration().width, height = camera.calibration().height;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = (width - 1.0) * i / kSteps, y = (height - 1.0) * i / kSteps;
    for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(x, 0), Eigen::Vector2d(x, height - 1), Eigen::Vector2d(0, y),
                                         Eigen::Vector2d(width - 1, y)}) {
      if (!camera.unproject(pixel)) return false;
    }
  }
  return true;
}

void describe_views(const Work& work, LensCalibration& result) {
  const Lens lens = work.estimate.lens();
  double all = 0;
  for (std::size_t i = 0; i < work.views.size(); ++i) {
    CalibratedView view{work.sources[i]->frame, work.sources[i]->name, work.estimate.poses[i], {}, 0};
    const std::vector<Eigen::Vector2d> residuals = residuals_of(work.views[i], lens, view.pose);
    double sum = 0;
    for (std::size_t k = 0; k < residuals.size(); ++k) {
      view.points.push_back({work.views[i].pixels[k], residuals[k]});
      sum += residuals[k].squaredNorm();
    }
    view.rms = std::sqrt(sum / static_cast<double>(view.points.size()));
    all += sum;
    result.views.push_back(view);
  }
  result.rms = std::sqrt(all / result.point_count());
}

/// What is off by so much of the image is no calibration, whatever the reason.
void refuse_nonsense(const LensCalibration& result, const std::string& where) {
  constexpr double kMostRms = 0.01;
  const double most = kMostRms * std::max(result.camera.width, result.camera.height);
  if (result.rms < most) return;
  throw Error(
      where,
      "no " + lens_name(result.kind) + " lens explains the board: its points would be off by " +
          std::to_string(std::lround(result.rms)) + " px",
      "check the numbers and the order of --board, and that it is flat; take 15 or more sharp views, tilted and "
      "everywhere in the image");
}

/// From the residuals themselves: what they are, whatever noise there was.
void set_deviations(const Work& work, LensCalibration& result) {
  const auto covariance = lens_covariance(work.views, work.estimate);
  if (!covariance) return;
  const double unknowns =
      static_cast<double>(work.estimate.parameters.size()) + 6.0 * static_cast<double>(work.views.size());
  const double freedom = std::max(1.0, 2.0 * result.point_count() - unknowns);
  const double variance = result.rms * result.rms * result.point_count() / freedom;
  result.deviations = (variance * covariance->diagonal()).cwiseSqrt();
}

/// The Bayesian information criterion: the lower, the better a model explains the points for its parameters. Of
/// `seen` points those that a model refused count as if they were off by `wrong` [px]: few are explained easily.
double criterion(const LensCalibration& lens, int seen, double wrong) {
  const int count = lens.point_count();
  const double cost = lens.rms * lens.rms * count + wrong * wrong * (seen - count);
  const double n = 2.0 * seen;
  return n * std::log(cost / n) + std::log(n) * static_cast<double>(lens.parameters.size());
}

}  // namespace

int LensCalibration::point_count() const {
  std::size_t count = 0;
  for (const CalibratedView& view : views) count += view.points.size();
  return static_cast<int>(count);
}

LensCalibration calibrate_lens(const std::vector<BoardView>& views, const Board& board, LensKind kind, int width,
                               int height, const std::string& where) {
  LensCalibration result;
  result.kind = kind;
  Work work = begin(views, board, kind, width, height, where, result.refused_views);
  adjust_and_refuse(work, result, where);
  adjust_disks(board, work);
  const Lens lens = work.estimate.lens();
  result.parameters = work.estimate.parameters;
  result.camera = lens.model().calibration();
  result.sees_whole_image = sees_border(lens.model());
  describe_views(work, result);
  refuse_nonsense(result, where);
  set_deviations(work, result);
  return result;
}

LensCalibration calibrate_best_lens(const std::vector<BoardView>& views, const Board& board, int width, int height,
                                    const std::string& where, std::vector<LensCalibration>* others) {
  std::vector<LensCalibration> all;
  std::string reason;
  for (const LensKind kind : kLensKinds) {
    try {
      all.push_back(calibrate_lens(views, board, kind, width, height, where));
    } catch (const Error& error) {
      reason = error.what();  // Of one model; another one may fit.
    }
  }
  if (all.empty()) throw Error(reason);
  const auto finest =
      std::min_element(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.rms < b.rms; });
  int seen = 0;
  for (const BoardView& view : views) seen += static_cast<int>(view.points.size());
  const LensCalibration* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const LensCalibration& lens : all) {
    const double now = criterion(lens, seen, kWrongTimes * finest->rms);
    if (!lens.sees_whole_image || lens.deviations.size() == 0 || !(now < least)) continue;
    best = &lens;
    least = now;
  }
  if (!best)
    throw Error(where, "no lens model is determined by these views",
                "tilt the board in several directions, by 20 to 45 degrees");
  if (others) *others = all;
  return *best;
}

}  // namespace ldso
