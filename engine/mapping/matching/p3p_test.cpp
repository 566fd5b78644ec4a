#include "mapping/matching/p3p.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace ldso {
namespace {

using Eigen::Vector3d;
using Triple = std::array<Vector3d, 3>;

double distance(const SE3d& a, const SE3d& b) {
  return (a.matrix() - b.matrix()).norm() / (1 + b.translation().norm());
}

double nearest(const P3pSolutions& solutions, const SE3d& truth) {
  double best = std::numeric_limits<double>::infinity();
  for (const SE3d& pose : solutions) best = std::min(best, distance(pose, truth));
  return best;
}

/// A camera somewhere, and three points in front of it.
struct Problem {
  SE3d T_camera_points;
  Triple bearings, points;
};

Problem random_problem(std::mt19937& generator) {
  std::uniform_real_distribution<double> u(-1, 1);
  Problem problem;
  SE3d::Tangent x;
  for (int i = 0; i < 6; ++i) x[i] = 3 * u(generator);
  problem.T_camera_points = SE3d::exp(x);
  for (int i = 0; i < 3; ++i) {
    const double depth = 4 + 3.5 * u(generator);
    const Vector3d p = depth * Vector3d(0.7 * u(generator), 0.5 * u(generator), 1);
    problem.bearings[i] = p * (1.5 + u(generator));  // of any length
    problem.points[i] = problem.T_camera_points.inverse() * p;
  }
  return problem;
}

double largest_angle(const SE3d& pose, const Triple& bearings, const Triple& points) {
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    const Vector3d p = pose * points[i];
    const double angle = std::atan2(p.cross(bearings[i]).norm(), p.dot(bearings[i]));
    largest = std::max(largest, angle);
  }
  return largest;
}

TEST(P3pTest, FindsTheTruePoseOfRandomProblems) {
  std::mt19937 generator(1);
  constexpr int kProblems = 20000;
  int found = 0;
  for (int k = 0; k < kProblems; ++k) {
    const Problem problem = random_problem(generator);
    found += nearest(solve_p3p(problem.bearings, problem.points), problem.T_camera_points) < 1e-5 ? 1 : 0;
  }
  RecordProperty("found", found);
  EXPECT_GE(found, kProblems - 4) << "of " << kProblems;
}

TEST(P3pTest, EverySolutionIsOne) {
  std::mt19937 generator(2);
  int several = 0;
  for (int k = 0; k < 5000; ++k) {
    const Problem problem = random_problem(generator);
    const P3pSolutions solutions = solve_p3p(problem.bearings, problem.points);
    several += solutions.count > 1 ? 1 : 0;
    for (const SE3d& pose : solutions) {
      EXPECT_LT(largest_angle(pose, problem.bearings, problem.points), 1e-6);
    }
  }
  EXPECT_GT(several, 1000);
}

TEST(P3pTest, SizeOfTheSceneDoesNotMatter) {
  std::mt19937 generator(3);
  for (const double size : {1e-6, 1e6}) {
    for (int k = 0; k < 200; ++k) {
      Problem problem = random_problem(generator);
      for (Vector3d& p : problem.points) p *= size;
      problem.T_camera_points.translation() *= size;
      const P3pSolutions solutions = solve_p3p(problem.bearings, problem.points);
      double best = 1;
      for (const SE3d& pose : solutions) {
        const double rotation = (pose.rotation_matrix() - problem.T_camera_points.rotation_matrix()).norm();
        const double shift = (pose.translation() - problem.T_camera_points.translation()).norm() / size;
        best = std::min(best, rotation + shift);
      }
      EXPECT_LT(best, 1e-5) << size;
    }
  }
}

// Fischler and Bolles, RANSAC (CACM 1981): above the centre of an equilateral triangle there are four poses. Side
// 2 sqrt(3), distances of the true pose (4, 4, 4); the others have one leg of length 1.
TEST(P3pTest, FourPosesOfFischlerAndBolles) {
  const double c = 20.0 / 32.0;  // the cosine of their example
  const double side = 2 * std::sqrt(3.0);
  const double radius = side / std::sqrt(3.0);
  const double height = std::sqrt(16 - radius * radius);
  Triple points, bearings;
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * M_PI * i / 3;
    points[i] = Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0);
    bearings[i] = points[i] + Vector3d(0, 0, height);
  }
  ASSERT_NEAR(bearings[0].normalized().dot(bearings[1].normalized()), c, 1e-12);
  const P3pSolutions solutions = solve_p3p(bearings, points);
  ASSERT_EQ(solutions.count, 4);
  int equal = 0, short_legs = 0;
  for (const SE3d& pose : solutions) {
    EXPECT_LT(largest_angle(pose, bearings, points), 1e-9);
    Vector3d legs;
    for (int i = 0; i < 3; ++i) legs[i] = (pose * points[i]).norm();
    std::sort(legs.begin(), legs.end());
    equal += (legs - Vector3d(4, 4, 4)).norm() < 1e-9 ? 1 : 0;
    short_legs += (legs - Vector3d(1, 4, 4)).norm() < 1e-9 ? 1 : 0;
  }
  EXPECT_EQ(equal, 1);
  EXPECT_EQ(short_legs, 3);
}

TEST(P3pTest, ThinTriangles) {
  std::mt19937 generator(4);
  int found = 0;
  for (int k = 0; k < 1000; ++k) {
    Problem problem = random_problem(generator);
    // Two of the points a hundred times nearer to each other than to the third.
    problem.points[2] = problem.points[1] + 0.01 * (problem.points[2] - problem.points[1]);
    for (int i = 0; i < 3; ++i) problem.bearings[i] = problem.T_camera_points * problem.points[i];
    found += nearest(solve_p3p(problem.bearings, problem.points), problem.T_camera_points) < 1e-4 ? 1 : 0;
  }
  EXPECT_GE(found, 990);
}

TEST(P3pTest, DegenerateInputHasNoSolution) {
  std::mt19937 generator(5);
  const Problem good = random_problem(generator);
  ASSERT_GT(solve_p3p(good.bearings, good.points).count, 0);

  Problem collinear = good;
  collinear.points[2] = 0.3 * collinear.points[0] + 0.7 * collinear.points[1];
  for (int i = 0; i < 3; ++i) collinear.bearings[i] = collinear.T_camera_points * collinear.points[i];
  EXPECT_EQ(solve_p3p(collinear.bearings, collinear.points).count, 0);

  Problem coincident = good;
  coincident.points[1] = coincident.points[0];
  EXPECT_EQ(solve_p3p(coincident.bearings, coincident.points).count, 0);

  Problem same_bearing = good;
  same_bearing.bearings[1] = 2 * same_bearing.bearings[0];
  EXPECT_EQ(solve_p3p(same_bearing.bearings, same_bearing.points).count, 0);

  Triple zeros;
  zeros.fill(Vector3d::Zero());
  EXPECT_EQ(solve_p3p(zeros, good.points).count, 0);
  EXPECT_EQ(solve_p3p(good.bearings, zeros).count, 0);
}

TEST(P3pTest, NumbersThatAreNotFiniteHaveNoSolution) {
  std::mt19937 generator(6);
  const Problem good = random_problem(generator);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (int i = 0; i < 3; ++i) {
      Problem problem = good;
      problem.points[i].y() = bad;
      EXPECT_EQ(solve_p3p(problem.bearings, problem.points).count, 0);
      problem = good;
      problem.bearings[i].x() = bad;
      EXPECT_EQ(solve_p3p(problem.bearings, problem.points).count, 0);
    }
  }
}

}  // namespace
}  // namespace ldso
