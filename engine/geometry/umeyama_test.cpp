#include "geometry/umeyama.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>

#include "ldso/error.h"

namespace ldso {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points random_points(int count, const Eigen::Vector3d& spread, unsigned seed = 5) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Points points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d p(normal(generator), normal(generator), normal(generator));
    points.emplace_back(spread.cwiseProduct(p) + Eigen::Vector3d(20, -3, 7));
  }
  return points;
}

Points transform(const Sim3d& S, const Points& points, double noise = 0) {
  std::mt19937 generator(11);
  std::normal_distribution<double> normal(0, 1);
  Points result;
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d e(normal(generator), normal(generator), normal(generator));
    result.emplace_back(S * p + noise * e);
  }
  return result;
}

double squared_error(const Sim3d& S, const Points& from, const Points& to) {
  double sum = 0;
  for (std::size_t i = 0; i < from.size(); ++i) sum += (to[i] - S * from[i]).squaredNorm();
  return sum;
}

double distance(const Sim3d& a, const Sim3d& b) { return (a.matrix() - b.matrix()).norm(); }

std::string error_of(const Points& from, const Points& to, AlignmentMode mode) {
  try {
    umeyama(from, to, mode);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

const SO3d kRotation = SO3d::exp(Eigen::Vector3d(0.7, -2.1, 1.3));
const Eigen::Vector3d kTranslation(10, -20, 5);

TEST(UmeyamaTest, RecoversExactTransformations) {
  const Points from = random_points(50, {3, 2, 1});
  const Sim3d similarity(kRotation, kTranslation, 0.37);
  EXPECT_LT(distance(umeyama(from, transform(similarity, from), AlignmentMode::kSim3), similarity), 1e-12);
  const Sim3d rigid(kRotation, kTranslation, 1);
  const Sim3d estimate = umeyama(from, transform(rigid, from), AlignmentMode::kSe3);
  EXPECT_LT(distance(estimate, rigid), 1e-12);
  EXPECT_EQ(estimate.scale(), 1);
}

TEST(UmeyamaTest, NoneIsTheIdentity) {
  EXPECT_EQ(
      distance(umeyama(random_points(5, {1, 1, 1}), random_points(5, {1, 1, 1}, 6), AlignmentMode::kNone), Sim3d()), 0);
  EXPECT_EQ(distance(umeyama({}, {}, AlignmentMode::kNone), Sim3d()), 0);
}

TEST(UmeyamaTest, PlanarPointsAreEnough) {
  const Points from = random_points(50, {3, 2, 0});
  const Sim3d truth(kRotation, kTranslation, 2.5);
  EXPECT_LT(distance(umeyama(from, transform(truth, from), AlignmentMode::kSim3), truth), 1e-11);
}

TEST(UmeyamaTest, ThreePointsAreEnough) {
  const Points from{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Sim3d truth(kRotation, kTranslation, 2.5);
  EXPECT_LT(distance(umeyama(from, transform(truth, from), AlignmentMode::kSim3), truth), 1e-13);
}

// The least squares are checked for what they are: no small change of the result may lower the sum.
TEST(UmeyamaTest, ResultIsTheMinimum) {
  const Points from = random_points(60, {3, 2, 1});
  const Points to = transform(Sim3d(kRotation, kTranslation, 1.8), from, 0.5);
  for (const AlignmentMode mode : {AlignmentMode::kSe3, AlignmentMode::kSim3}) {
    const Sim3d best = umeyama(from, to, mode);
    const double least = squared_error(best, from, to);
    for (int i = 0; i < (mode == AlignmentMode::kSe3 ? 6 : 7); ++i) {
      for (const double step : {-1e-4, 1e-4}) {
        const Sim3d::Tangent x = step * Sim3d::Tangent::Unit(i);
        EXPECT_GT(squared_error(Sim3d::exp(x) * best, from, to), least) << i;
      }
    }
  }
}

// Without the correction of the sign the best orthogonal matrix here is a reflection.
TEST(UmeyamaTest, MirroredPointsStillGiveARotation) {
  const Points from = random_points(60, {3, 2, 1});
  Points to = from;
  for (Eigen::Vector3d& p : to) p.z() = -p.z();
  const Sim3d S = umeyama(from, to, AlignmentMode::kSim3);
  EXPECT_NEAR(S.rotation_matrix().determinant(), 1, 1e-12);
  EXPECT_GT(S.scale(), 0);
  EXPECT_LT(S.scale(), 1);
  const double least = squared_error(S, from, to);
  for (int i = 0; i < 7; ++i) {
    for (const double step : {-1e-3, 1e-3}) {
      EXPECT_GT(squared_error(Sim3d::exp(step * Sim3d::Tangent::Unit(i)) * S, from, to), least) << i;
    }
  }
}

// The mirrored triangles of the paper's example, which is solved there in the plane: in space they match exactly.
TEST(UmeyamaTest, MirroredTrianglesMatchInSpace) {
  const Points from{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
  const Points to{{0, 0, 0}, {-1, 0, 0}, {0, 2, 0}};
  const Sim3d S = umeyama(from, to, AlignmentMode::kSim3);
  EXPECT_NEAR(squared_error(S, from, to), 0, 1e-24);
  EXPECT_NEAR(S.scale(), 1, 1e-12);
  EXPECT_LT((S.rotation_matrix() - Eigen::Vector3d(-1, 1, -1).asDiagonal().toDenseMatrix()).norm(), 1e-12);
}

TEST(UmeyamaTest, ScaleOnlyIsTheScaleOfTheSimilarity) {
  const Points from = random_points(60, {3, 2, 1});
  const Points to = transform(Sim3d(kRotation, kTranslation, 1.8), from, 0.5);
  const Sim3d S = umeyama(from, to, AlignmentMode::kScale);
  EXPECT_EQ(S.scale(), umeyama(from, to, AlignmentMode::kSim3).scale());
  EXPECT_TRUE(S.rotation_matrix().isIdentity(0));
  EXPECT_TRUE(S.translation().isZero(0));
}

TEST(UmeyamaTest, FarFromTheOrigin) {
  Points from = random_points(50, {3, 2, 1});
  for (Eigen::Vector3d& p : from) p += Eigen::Vector3d(458000, 5428000, 110);  // as map projections have it
  const Sim3d truth(kRotation, kTranslation, 1);
  const Points to = transform(truth, from);
  const Sim3d S = umeyama(from, to, AlignmentMode::kSim3);
  EXPECT_NEAR(S.scale(), 1, 1e-8);
  EXPECT_LT(squared_error(S, from, to), 50 * 1e-16);
}

TEST(UmeyamaTest, DegenerateInputIsAnErrorThatSaysWhy) {
  const Points good = random_points(10, {3, 2, 1});
  EXPECT_NE(error_of(good, random_points(9, {1, 1, 1}), AlignmentMode::kSe3).find("10 and 9"), std::string::npos);
  EXPECT_NE(error_of({}, {}, AlignmentMode::kSim3).find("only 0 pairs"), std::string::npos);
  Points line, still;
  for (int i = 0; i < 10; ++i) {
    line.emplace_back(1 + 0.3 * i, 2 - 0.1 * i, 0.7 * i);
    still.emplace_back(0.1, 0.2, 0.3);
  }
  EXPECT_NE(error_of(line, line, AlignmentMode::kSe3).find("on a line"), std::string::npos);
  EXPECT_NE(error_of(line, transform(Sim3d(kRotation, kTranslation, 2), line), AlignmentMode::kSim3).find("on a line"),
            std::string::npos);
  EXPECT_NE(error_of(still, good, AlignmentMode::kSim3).find("the same"), std::string::npos);
  EXPECT_NE(error_of(good, still, AlignmentMode::kScale).find("the same"), std::string::npos);
  Points broken = good;
  broken[4].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error_of(good, broken, AlignmentMode::kSim3).find("position 4 of the second set"), std::string::npos);
  EXPECT_EQ(error_of(line, line, AlignmentMode::kScale), "no error");
}

}  // namespace
}  // namespace ldso
