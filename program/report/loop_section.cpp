#include "report/loop_section.h"

#include <algorithm>
#include <map>
#include <numbers>

#include "report/html.h"
#include "util/base64.h"
#include "util/format_text.h"

namespace ldso {
namespace {

using html::Cell;

constexpr std::size_t kMostRows = 300;

std::vector<Cell> loop_row(const LoopRecord& loop) {
  const double scale = loop.S_keyframe_candidate.scale();
  const double degrees = loop.S_keyframe_candidate.rotation().log().norm() * 180 / std::numbers::pi;
  return {{std::to_string(loop.keyframe_id)},
          {std::to_string(loop.candidate_id)},
          {std::to_string(loop.inliers)},
          {std::to_string(loop.depth_inliers)},
          {format_text("%.0f %%", 100 * loop.covered_cells)},
          {format_text("%.4f ± %.4f", scale, scale * loop.log_scale_stddev)},
          {format_text("%.2f", degrees)},
          {format_text("%.2f", loop.drift_chi2)},
          {format_text("%.2f", loop.graph_weight)}};
}

std::string loop_table(std::span<const LoopRecord> loops, std::size_t accepted) {
  std::vector<std::vector<Cell>> rows;
  for (const LoopRecord& loop : loops) {
    if (loop.accepted && rows.size() < kMostRows) rows.push_back(loop_row(loop));
  }
  std::string html = html::table({"keyframe", "earlier keyframe", "inliers", "with depth", "image covered", "scale",
                                  "rotation [°]", "drift χ²", "weight"},
                                 rows, {});
  if (accepted > kMostRows)
    html += html::element("p", format_text("The first %zu of %zu.", rows.size(), accepted), "note");
  html +=
      html::element("p",
                    "Scale and rotation: from the earlier keyframe to the later one. Drift χ²: squared distance from "
                    "the odometry in its standard deviations. Weight: what the pose graph left the loop of its pull; "
                    "near 0, it was overruled.",
                    "note");
  return accepted > 12 ? html::details(format_text("All %zu loops", accepted), html) : html;
}

std::string picture_list(const LoopPictures& pictures) {
  std::string html;
  for (const LoopPicture& picture : pictures.pictures) {
    html += "<figure><img alt=\"" + html::escape(picture.caption) + "\" src=\"data:image/jpeg;base64," +
            base64(picture.jpeg) + "\">" + html::element("figcaption", picture.caption) + "</figure>\n";
  }
  if (!html.empty()) html = "<div class=\"pictures\">\n" + html + "</div>\n";
  for (const std::string& problem : pictures.problems) html += html::element("p", problem, "warning");
  return html;
}

}  // namespace

std::vector<std::size_t> loops_to_show(std::span<const LoopRecord> loops, std::size_t most) {
  std::vector<std::size_t> accepted;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (loops[i].accepted) accepted.push_back(i);
  }
  if (accepted.size() <= most) return accepted;
  std::vector<std::size_t> shown;
  for (std::size_t k = 0; k < most; ++k) shown.push_back(accepted[(2 * k + 1) * accepted.size() / (2 * most)]);
  return shown;
}

std::string refusal_table(std::span<const LoopRecord> loops) {
  struct Reason {
    std::string example;
    std::size_t count = 0;
  };
  std::map<std::string, Reason> reasons;
  for (const LoopRecord& loop : loops) {
    if (loop.accepted) continue;
    Reason& reason = reasons[without_numbers(loop.reason)];
    if (reason.count++ == 0) reason.example = loop.reason;
  }
  std::vector<Reason> sorted;
  for (const auto& [key, reason] : reasons) sorted.push_back(reason);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Reason& a, const Reason& b) { return a.count > b.count; });
  std::vector<std::vector<Cell>> rows;
  for (const Reason& reason : sorted) rows.push_back({{std::to_string(reason.count)}, {reason.example}});
  return html::table({"pairs", "reason (figures: of the first of them)"}, rows, {1});
}

std::string loop_section(std::span<const LoopRecord> loops, const LoopPictures& pictures) {
  if (loops.empty()) return html::element("p", "No pair of keyframes looked like one place.");
  const auto accepted = static_cast<std::size_t>(
      std::count_if(loops.begin(), loops.end(), [](const LoopRecord& loop) { return loop.accepted; }));
  const std::size_t refused = loops.size() - accepted;
  std::string html =
      html::element("p", format_text("%zu pairs of keyframes looked like one place; %zu were found to be "
                                     "one, %zu were refused.",
                                     loops.size(), accepted, refused));
  if (accepted > 0) html += loop_table(loops, accepted) + picture_list(pictures);
  if (refused > 0) html += html::details(format_text("Why %zu were refused", refused), refusal_table(loops));
  return html;
}

}  // namespace ldso
