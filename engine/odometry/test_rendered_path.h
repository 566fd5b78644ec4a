#pragma once

// A fixture for tests along the same path through the synthetic scene.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "odometry/test_synthetic_scene.h"

namespace ldso::test {

/// The scene and the first frames of the path, rendered once for all tests of a suite.
template <int kCount>
class RenderedPathTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<SyntheticScene>();
    frames_ = render_path(*scene_, kCount);
  }
  static void TearDownTestSuite() {
    frames_.clear();
    scene_.reset();
  }

  static inline std::unique_ptr<SyntheticScene> scene_;
  static inline std::vector<std::shared_ptr<const PreparedFrame>> frames_;
};

}  // namespace ldso::test
