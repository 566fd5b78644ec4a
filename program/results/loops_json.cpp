#include "results/loops_json.h"

#include <algorithm>

namespace ldso {
namespace {

using Json = nlohmann::ordered_json;

Json similarity_json(const Sim3d& S) {
  const Eigen::Quaterniond& q = S.rotation().quaternion();
  const Eigen::Vector3d& t = S.translation();
  return {
      {"translation", {t.x(), t.y(), t.z()}}, {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}, {"scale", S.scale()}};
}

Json loop_json(const LoopRecord& loop) {
  Json json = {{"keyframe", loop.keyframe_id}, {"candidate", loop.candidate_id}, {"accepted", loop.accepted}};
  if (!loop.accepted) json["reason"] = loop.reason;
  json["score"] = loop.score;
  json["descriptor_matches"] = loop.descriptor_matches;
  json["pnp_inliers"] = loop.pnp_inliers;
  json["points_in_view"] = loop.points_in_view;
  json["points_seen"] = loop.points_seen;
  json["inliers"] = loop.inliers;
  json["inliers_with_depth"] = loop.inliers_with_depth;
  json["depth_inliers"] = loop.depth_inliers;
  json["covered_cells"] = loop.covered_cells;
  json["patch_inliers"] = loop.patch_inliers;
  if (loop.inliers > 0) json["S_keyframe_candidate"] = similarity_json(loop.S_keyframe_candidate);
  json["translation_stddev"] = loop.translation_stddev;
  json["rotation_stddev_rad"] = loop.rotation_stddev;
  json["log_scale_stddev"] = loop.log_scale_stddev;
  json["drift_chi2"] = loop.drift_chi2;
  if (loop.accepted) json["graph_weight"] = loop.graph_weight;
  return json;
}

}  // namespace

Json loops_json(const std::vector<LoopRecord>& loops) {
  Json accepted = Json::array(), refused = Json::array();
  for (const LoopRecord& loop : loops) (loop.accepted ? accepted : refused).push_back(loop_json(loop));
  return {{"accepted", std::move(accepted)}, {"refused", std::move(refused)}};
}

}  // namespace ldso
