#include "calibration/lens/view_search.h"

#include <algorithm>

#include "calibration/board/board_detector.h"
#include "calibration/lens/view_choice.h"
#include "ldso/error.h"

namespace ldso {
namespace {

/// Frames of a video that are looked at: more show the same.
constexpr int kVideoFrames = 240;

/// Where there is no frame after it, or no board in that, the board may have moved in any way.
constexpr double kUnknownMotion = 2;  // [px a frame]

/// Whether frames follow each other in time, so that two of them tell the motion.
bool is_video(const Dataset& dataset) { return dataset.format_name() == "video" || dataset.size() > kVideoFrames; }

double motion_after(const Dataset& dataset, int frame, const std::vector<SeenPoint>& points, const Board& board) {
  if (frame + 1 >= dataset.size()) return kUnknownMotion;
  const std::vector<SeenPoint> next = find_board(dataset.read(frame + 1).grey.view(), board);
  return motion_between(points, next).value_or(kUnknownMotion);
}

[[noreturn]] void refuse_blind(const std::string& name, const Board& board, int looked_at) {
  throw Error(name, "none of the " + std::to_string(looked_at) + " frames looked at shows a " + describe(board),
              "check what --board counts (chessboard: inner corners, charuco: squares, aprilgrid: tags, circles: in a "
              "row and rows), that the board has white around it, and that it is sharp and lit evenly");
}

}  // namespace

ViewSearch find_views(const Dataset& dataset, const Board& board, int most_views, const std::string& name,
                      const ViewProgress& progress) {
  const bool video = is_video(dataset);
  const int count = video ? std::min(kVideoFrames, dataset.size()) : dataset.size();
  ViewSearch search;
  std::vector<MovingView> views;
  for (int i = 0; i < count; ++i) {
    const int frame = static_cast<int>(static_cast<long long>(i) * dataset.size() / count);
    const RawFrame raw = dataset.read(frame);
    search.width = raw.grey.width();
    search.height = raw.grey.height();
    std::vector<SeenPoint> points = find_board(raw.grey.view(), board);
    ++search.looked_at;
    if (!points.empty()) {
      const double motion = video ? motion_after(dataset, frame, points, board) : 0;
      views.push_back({{frame, video ? "frame " + std::to_string(frame) : raw.name, std::move(points)}, motion});
    }
    progress(i + 1, count);
  }
  search.seen = static_cast<int>(views.size());
  if (views.empty()) refuse_blind(name, board, search.looked_at);
  search.views = choose_views(views, board, search.width, search.height, most_views);
  return search;
}

}  // namespace ldso
