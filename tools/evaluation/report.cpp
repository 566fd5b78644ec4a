#include "evaluation/report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/text/json_text.h"
#include "ldso/error.h"
#include "util/format_text.h"

namespace ldso {
namespace {

using Json = nlohmann::ordered_json;

std::string statistics_row(const char* name, const Statistics& s) {
  return format_text("%-22s %11.6f %11.6f %11.6f %11.6f %11.6f %11.6f\n", name, s.rmse, s.mean, s.median, s.stddev,
                     s.min, s.max);
}

std::string tum_mono_rows(const TumMonoError& e) {
  return format_text("%-22s %11.6f m   (over all poses; start %zu, end %zu pairs)\n", "TUM-mono e_align", e.e_align,
                     e.start_pairs, e.end_pairs) +
         format_text("%-22s %11.6f m\n", "TUM-mono e_rmse", e.e_rmse) +
         format_text("%-22s %11.6f m\n", "TUM-mono e_t", e.e_translation) +
         format_text("%-22s %11.6f deg\n", "TUM-mono e_r", e.e_rotation_deg) +
         format_text("%-22s %11.6f\n", "TUM-mono e_s", e.e_scale) +
         format_text("%-22s %11.6f m\n", "TUM-mono start rmse", e.start_rmse) +
         format_text("%-22s %11.6f m\n", "TUM-mono end rmse", e.end_rmse);
}

std::string scale_rows(const EvaluationResult& result) {
  if (!result.scale_drift) return "";
  return format_text("%-22s %11.6f     (last third / first third of the path: %.6f)\n", "scale drift",
                     result.scale_drift->drift, result.scale_drift->ratio);
}

std::string kitti_rows(const KittiDrift& drift) {
  return format_text("%-22s %11.6f %%   (%zu paths of 100..800 m)\n", "KITTI t_rel", drift.translation_percent,
                     drift.segments) +
         format_text("%-22s %11.6f deg/m\n", "KITTI r_rel", drift.rotation_deg_per_m);
}

std::string kitti_length_rows(const KittiDrift& drift) {
  std::string rows;
  for (std::size_t i = 0; i < kKittiLengths.size(); ++i) {
    if (!std::isfinite(drift.translation_percent_of_length[i])) continue;
    rows += format_text("KITTI %3.0f m            %11.6f %%   %11.6f deg/m\n", kKittiLengths[i],
                        drift.translation_percent_of_length[i], drift.rotation_deg_per_m_of_length[i]);
  }
  return rows;
}

std::string relative_rows(const EvaluationResult& result) {
  if (!result.relative_translation) return "";
  return statistics_row("RPE translation [m]", *result.relative_translation) +
         statistics_row("RPE rotation [deg]", *result.relative_rotation_deg);
}

std::string absolute_rows(const EvaluationResult& result) {
  std::string rows =
      format_text("%-22s %11s %11s %11s %11s %11s %11s\n", "", "rmse", "mean", "median", "std", "min", "max");
  rows += statistics_row("ATE [m]", result.absolute) + relative_rows(result);
  // Where the path is known in pieces only, its length means nothing.
  if (!result.tum_mono) rows += format_text("%-22s %11.6f %%\n", "ATE of path", result.ate_percent_of_path());
  return rows;
}

Json json_of(const Statistics& s) {
  return {{"count", s.count}, {"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median},
          {"std", s.stddev},  {"min", s.min},   {"max", s.max}};
}

Json json_of(const Sim3d& S) {
  const Eigen::Quaterniond& q = S.rotation().quaternion();
  const Eigen::Vector3d& t = S.translation();
  return {
      {"scale", S.scale()}, {"rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}}, {"translation", {t.x(), t.y(), t.z()}}};
}

Json json_of(const ScaleDrift& s) {
  return {{"drift", s.drift}, {"ratio", s.ratio}, {"first_scale", s.first_scale}, {"last_scale", s.last_scale}};
}

Json json_of(const KittiDrift& k) {
  Json lengths = Json::array();
  for (std::size_t i = 0; i < kKittiLengths.size(); ++i) {
    if (!std::isfinite(k.translation_percent_of_length[i])) continue;
    lengths.push_back({{"length_m", kKittiLengths[i]},
                       {"t_rel_percent", k.translation_percent_of_length[i]},
                       {"r_rel_deg_per_m", k.rotation_deg_per_m_of_length[i]}});
  }
  return {{"t_rel_percent", k.translation_percent},
          {"r_rel_deg_per_m", k.rotation_deg_per_m},
          {"segments", k.segments},
          {"by_length", lengths}};
}

Json json_of(const TumMonoError& e) {
  return {
      {"e_align", e.e_align},    {"e_rmse", e.e_rmse},         {"e_t", e.e_translation}, {"e_r_deg", e.e_rotation_deg},
      {"e_s", e.e_scale},        {"start_rmse", e.start_rmse}, {"end_rmse", e.end_rmse}, {"start_pairs", e.start_pairs},
      {"end_pairs", e.end_pairs}};
}

template <class T>
Json json_or_null(const std::optional<T>& value) {
  return value ? json_of(*value) : Json(nullptr);
}

}  // namespace

ReportMetric parse_report_metric(const std::string& name) {
  if (name == "all") return ReportMetric::kAll;
  if (name == "ate") return ReportMetric::kAte;
  if (name == "tum-mono") return ReportMetric::kTumMono;
  if (name == "kitti") return ReportMetric::kKitti;
  throw Error("metric " + name, "there is no such metric", "allowed are all, ate, tum-mono and kitti");
}

void require_metric(const EvaluationResult& result, ReportMetric metric) {
  if (metric == ReportMetric::kTumMono && !result.truth_of_both_ends) {
    throw Error("metric tum-mono", "the ground truth has no start and end segment with a gap between them",
                "use --metric ate for ground truth of the whole way");
  }
  if (metric == ReportMetric::kTumMono && !result.tum_mono) {
    throw Error("metric tum-mono",
                "the estimate has fewer than 3 poses with ground truth in one of the two segments, start and end",
                "it has to reach both ends of the sequence");
  }
  if (metric == ReportMetric::kKitti && !result.kitti_drift) {
    throw Error("metric kitti",
                result.truth_of_both_ends ? "the ground truth is of both ends only"
                                          : "the path is shorter than the shortest sub-path, 100 m",
                "use --metric " + std::string(result.truth_of_both_ends ? "tum-mono" : "ate"));
  }
}

std::string result_table(const EvaluationResult& result, ReportMetric metric) {
  const bool all = metric == ReportMetric::kAll;
  std::string table;
  table += format_text("%-22s %11zu     (of %zu estimated and %zu true poses)\n", "pairs", result.pairs.size(),
                       result.estimate_poses, result.truth_poses);
  table += format_text("%-22s %11.6f m\n", "path", result.path_length);
  table += format_text("%-22s %11s     (scale %.6f)\n", "alignment", to_string(result.alignment).c_str(),
                       result.S_truth_estimate.scale());
  if (all || metric == ReportMetric::kAte) table += absolute_rows(result);
  if (all) table += scale_rows(result);
  if ((all || metric == ReportMetric::kKitti) && result.kitti_drift) table += kitti_rows(*result.kitti_drift);
  if (metric == ReportMetric::kKitti && result.kitti_drift) table += kitti_length_rows(*result.kitti_drift);
  if ((all || metric == ReportMetric::kTumMono) && result.tum_mono) table += tum_mono_rows(*result.tum_mono);
  return table;
}

std::string result_json(const EvaluationResult& result) {
  const Json json = {{"pairs", result.pairs.size()},
                     {"estimate_poses", result.estimate_poses},
                     {"truth_poses", result.truth_poses},
                     {"path_length_m", result.path_length},
                     {"alignment", to_string(result.alignment)},
                     {"S_truth_estimate", json_of(result.S_truth_estimate)},
                     {"ate_m", json_of(result.absolute)},
                     {"ate_percent_of_path", result.ate_percent_of_path()},
                     {"rpe_delta", result.relative_options.delta},
                     {"rpe_all_pairs", result.relative_options.all_pairs},
                     {"rpe_translation_m", json_or_null(result.relative_translation)},
                     {"rpe_rotation_deg", json_or_null(result.relative_rotation_deg)},
                     {"scale_drift", json_or_null(result.scale_drift)},
                     {"kitti_drift", json_or_null(result.kitti_drift)},
                     {"tum_mono", json_or_null(result.tum_mono)}};
  return json_text(json, 2) + "\n";
}

}  // namespace ldso
