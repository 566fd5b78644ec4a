// Other systems' trajectories, and what established evaluation tools say of them. The files are not part of this
// project: LDSO_DATA names the folder that holds trajectories/results.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>

#include "evaluation/trajectory_evaluation.h"
#include "evaluation/trajectory_source.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

std::optional<fs::path> results_folder() {
  const char* data = std::getenv("LDSO_DATA");
  if (data == nullptr) return std::nullopt;
  fs::path folder = fs::path(data) / "trajectories" / "results";
  if (!fs::exists(folder)) return std::nullopt;
  return folder;
}

#define SKIP_WITHOUT_DATA()                                                                                       \
  if (!results_folder()) {                                                                                        \
    GTEST_SKIP() << "the trajectories with known values are not here: set LDSO_DATA to the folder that contains " \
                    "trajectories/results";                                                                       \
  }

EvaluationResult evaluate(const std::string& estimate, const std::string& truth, AlignmentMode mode) {
  const LoadedTrajectory a = load_trajectory(*results_folder() / estimate);
  const LoadedTrajectory b = load_trajectory(*results_folder() / truth);
  EvaluationOptions options;
  options.alignment = mode;
  options.pair_by_index = !a.has_times;
  return evaluate_trajectory(a.poses, b.poses, options);
}

/// Six decimals are given; half a unit of the last is what may differ.
void expect_statistics(const Statistics& s, double rmse, double mean, double median, double max) {
  constexpr double kTolerance = 6e-7;
  EXPECT_NEAR(s.rmse, rmse, kTolerance);
  EXPECT_NEAR(s.mean, mean, kTolerance);
  EXPECT_NEAR(s.median, median, kTolerance);
  EXPECT_NEAR(s.max, max, kTolerance);
}

struct KnownApe {
  const char *estimate, *truth;
  AlignmentMode mode;
  std::size_t pairs;
  double rmse, mean, median, max;
};

constexpr const char* kKitti = "KITTI_00_gt.txt";
constexpr const char* kDesk = "fr2_desk_groundtruth.txt";
constexpr KnownApe kKnownApes[] = {
    {"KITTI_00_ORB.txt", kKitti, AlignmentMode::kSe3, 4541, 1.303450, 1.156997, 1.065625, 3.587949},
    {"KITTI_00_ORB.txt", kKitti, AlignmentMode::kSim3, 4541, 0.937709, 0.872693, 0.844691, 2.693500},
    {"KITTI_00_ORB.txt", kKitti, AlignmentMode::kScale, 4541, 7.380186, 6.633521, 6.349553, 13.109253},
    {"KITTI_00_SPTAM.txt", kKitti, AlignmentMode::kSim3, 4541, 3.635294, 3.357306, 3.479864, 7.291831},
    {"fr2_desk_ORB.txt", kDesk, AlignmentMode::kSe3, 2174, 0.008119, 0.007492, 0.007415, 0.024300},
    {"fr2_desk_ORB.txt", kDesk, AlignmentMode::kSim3, 2174, 0.006123, 0.005586, 0.005305, 0.021477},
    {"fr2_desk_ORB_kf_mono.txt", kDesk, AlignmentMode::kSe3, 118, 0.939049, 0.916991, 0.921213, 1.411524},
    {"fr2_desk_ORB_kf_mono.txt", kDesk, AlignmentMode::kSim3, 118, 0.007729, 0.007104, 0.007100, 0.015689},
};

TEST(KnownValues, AbsoluteError) {
  SKIP_WITHOUT_DATA();
  for (const KnownApe& known : kKnownApes) {
    SCOPED_TRACE(std::string(known.estimate) + " " + to_string(known.mode));
    const EvaluationResult result = evaluate(known.estimate, known.truth, known.mode);
    EXPECT_EQ(result.pairs.size(), known.pairs);
    expect_statistics(result.absolute, known.rmse, known.mean, known.median, known.max);
  }
}

TEST(KnownValues, RelativeError) {
  SKIP_WITHOUT_DATA();
  const EvaluationResult result = evaluate("KITTI_00_ORB.txt", kKitti, AlignmentMode::kSim3);
  expect_statistics(*result.relative_translation, 0.027822, 0.018953, 0.014376, 0.304400);
  expect_statistics(*result.relative_rotation_deg, 0.114974, 0.059583, 0.041074, 2.196615);
}

struct KnownTumMono {
  const char* sequence;
  std::size_t poses;
  double e_rmse, e_align, e_r, e_s, start_rmse, end_rmse, e_t;
};

constexpr KnownTumMono kKnownTumMono[] = {
    {"01", 786, 0.313780, 0.926058, 3.527372, 0.977878, 0.006418, 0.006643, 0.900266},
    {"29", 1775, 0.220845, 5.507981, 3.894257, 1.062005, 0.007323, 0.007070, 0.463240},
};

TEST(KnownValues, TumMonoErrors) {
  SKIP_WITHOUT_DATA();
  for (const KnownTumMono& known : kKnownTumMono) {
    SCOPED_TRACE(known.sequence);
    const std::string stem = "tum_mono/sequence_" + std::string(known.sequence);
    const EvaluationResult result =
        evaluate(stem + "_estimate.txt", stem + "_groundtruthSync.txt", AlignmentMode::kSim3);
    EXPECT_EQ(result.estimate_poses, known.poses);
    ASSERT_TRUE(result.tum_mono.has_value());
    const TumMonoError& e = *result.tum_mono;
    constexpr double kTolerance = 6e-7;
    EXPECT_NEAR(e.e_rmse, known.e_rmse, kTolerance);
    EXPECT_NEAR(e.e_align, known.e_align, kTolerance);
    EXPECT_NEAR(e.e_rotation_deg, known.e_r, kTolerance);
    EXPECT_NEAR(e.e_scale, known.e_s, kTolerance);
    EXPECT_NEAR(e.start_rmse, known.start_rmse, kTolerance);
    EXPECT_NEAR(e.end_rmse, known.end_rmse, kTolerance);
    EXPECT_NEAR(e.e_translation, known.e_t, kTolerance);
  }
}

}  // namespace
}  // namespace ldso
