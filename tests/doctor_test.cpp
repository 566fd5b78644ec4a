// The doctor on rendered sequences: each fault is made and found, and of what is not wrong nothing is said.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "doctor/diagnosis.h"
#include "rendered_dataset.h"

namespace ldso {
namespace {

using simulation::SequenceRecipe;
using test::RenderedDataset;

SequenceRecipe recipe_of(const std::string& world, int frames) {
  SequenceRecipe recipe;
  recipe.world = world;
  recipe.frames = frames;
  recipe.width = world == "street" ? 613 : 320;
  recipe.height = world == "street" ? 185 : 240;
  recipe.texel_scale = 2;
  return recipe;
}

/// Of all tests that damage it.
const RenderedDataset& room() {
  static const RenderedDataset dataset(recipe_of("room", 150));
  return dataset;
}

std::vector<std::string> ids_of(const Diagnosis& diagnosis, Severity least) {
  std::vector<std::string> ids;
  for (const Finding& finding : diagnosis.findings) {
    if (finding.severity >= least) ids.push_back(finding.id);
  }
  return ids;
}

bool has(const Diagnosis& diagnosis, const std::string& id) {
  const std::vector<std::string> ids = ids_of(diagnosis, Severity::kNote);
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

/// The fault is found among the images and times; a run of them is not needed for it.
void expect_found(const std::string& id, const std::function<void(RenderedDataset&)>& damage) {
  RenderedDataset dataset = room();
  damage(dataset);
  const Diagnosis diagnosis = examine(dataset, "damaged", 0);
  EXPECT_TRUE(has(diagnosis, id)) << diagnosis_text(diagnosis) << diagnosis_json(diagnosis)["figures"].dump(1);
}

void for_pixels(RenderedDataset& dataset, const std::function<float(float, int, int, int)>& change) {
  for (std::size_t i = 0; i < dataset.frames.size(); ++i) {
    Image<float>& grey = dataset.frames[i].grey;
    for (int y = 0; y < grey.height(); ++y) {
      for (int x = 0; x < grey.width(); ++x)
        grey(x, y) = std::clamp(std::round(change(grey(x, y), x, y, static_cast<int>(i))), 0.F, 255.F);
    }
  }
}

/// Mean over a square, as out of focus or by motion along x.
void blur(Image<float>& grey, int half_x, int half_y) {
  const Image<float> sharp = grey;
  for (int y = 0; y < grey.height(); ++y) {
    for (int x = 0; x < grey.width(); ++x) {
      float sum = 0;
      for (int dy = -half_y; dy <= half_y; ++dy) {
        for (int dx = -half_x; dx <= half_x; ++dx)
          sum += sharp(std::clamp(x + dx, 0, grey.width() - 1), std::clamp(y + dy, 0, grey.height() - 1));
      }
      grey(x, y) = std::round(sum / static_cast<float>((2 * half_x + 1) * (2 * half_y + 1)));
    }
  }
}

class CleanSequences : public testing::TestWithParam<std::string> {};

TEST_P(CleanSequences, HaveNoFinding) {
  const RenderedDataset dataset(recipe_of(GetParam(), 150));
  const Diagnosis diagnosis = examine(dataset, GetParam(), 150);
  EXPECT_TRUE(ids_of(diagnosis, Severity::kWarning).empty())
      << diagnosis_text(diagnosis) << diagnosis_json(diagnosis)["figures"].dump(1);
  EXPECT_EQ(exit_code_of(diagnosis), 0);
}

INSTANTIATE_TEST_SUITE_P(Worlds, CleanSequences, testing::Values("room", "corridor", "street"),
                         [](const auto& world) { return world.param; });

TEST(Doctor, FindsTimesThatDoNotGrowAndGaps) {
  expect_found("times.order", [](RenderedDataset& d) { std::swap(d.frames[40].timestamp, d.frames[41].timestamp); });
  expect_found("times.gaps", [](RenderedDataset& d) { d.frames.erase(d.frames.begin() + 50, d.frames.begin() + 90); });
  expect_found("times.rate", [](RenderedDataset& d) {
    for (RawFrame& frame : d.frames) frame.timestamp *= 10;
  });
}

TEST(Doctor, FindsBadLight) {
  expect_found("images.dark",
               [](RenderedDataset& d) { for_pixels(d, [](float v, int, int, int) { return 0.1F * v; }); });
  expect_found("images.black", [](RenderedDataset& d) {
    for_pixels(d, [](float v, int, int, int i) { return i < 12 ? 0.05F * v : v; });
  });
  expect_found("images.overexposed",
               [](RenderedDataset& d) { for_pixels(d, [](float v, int, int, int) { return 2.5F * v; }); });
  expect_found("images.contrast",
               [](RenderedDataset& d) { for_pixels(d, [](float v, int, int, int) { return 150 + 0.1F * v; }); });
  expect_found("images.levels", [](RenderedDataset& d) {
    for_pixels(d, [](float v, int, int, int) { return 16 * std::floor(v / 16); });
  });
  expect_found("images.brightness", [](RenderedDataset& d) {
    for_pixels(d, [](float v, int, int, int i) { return i % 5 == 0 ? 0.7F * v : v; });
  });
}

TEST(Doctor, FindsBlurAndWantOfTexture) {
  expect_found("images.soft", [](RenderedDataset& d) {
    for (RawFrame& frame : d.frames) blur(frame.grey, 3, 3);
  });
  expect_found("images.blurred", [](RenderedDataset& d) {
    for (std::size_t i = 0; i < d.frames.size(); i += 5) blur(d.frames[i].grey, 9, 0);
  });
  expect_found("images.texture",
               [](RenderedDataset& d) { for_pixels(d, [](float v, int, int, int) { return 0.04F * v + 100; }); });
}

TEST(Doctor, FindsRepeatedImagesAndFastMotion) {
  expect_found("images.repeated", [](RenderedDataset& d) {
    for (std::size_t i = 1; i < d.frames.size(); i += 5) d.frames[i].grey = d.frames[i - 1].grey;
  });
  expect_found("motion.fast", [](RenderedDataset& d) {
    for (std::size_t i = 0; 12 * i < d.frames.size(); ++i) d.frames[i].grey = d.frames[12 * i].grey;
    d.frames.resize(d.frames.size() / 12);
  });
}

TEST(Doctor, FindsWhatStaysInTheImage) {
  expect_found("images.overlay", [](RenderedDataset& d) {
    for_pixels(d, [](float v, int x, int y, int) {
      const bool is_text = y >= 20 && y < 34 && x >= 200 && x < 290 && (x / 4 + y / 7) % 2 == 0;
      return is_text ? 250.F : v;
    });
  });
  expect_found("images.bars", [](RenderedDataset& d) {
    for_pixels(d, [](float v, int, int y, int) { return y < 24 || y >= 216 ? 0.F : v; });
  });
  expect_found("images.round", [](RenderedDataset& d) {
    for_pixels(d,
               [](float v, int x, int y, int) { return std::hypot(x - 160, y - 120) > 118 ? 4.F : std::max(v, 30.F); });
  });
}

TEST(Doctor, ProposesAMaskOfWhatIsDrawnOverTheImages) {
  RenderedDataset dataset = room();
  for_pixels(dataset, [](float v, int x, int y, int) {
    return y >= 20 && y < 34 && x >= 200 && x < 290 && (x / 4 + y / 7) % 2 == 0 ? 250.F : v;
  });
  const Image<std::uint8_t> mask = examine(dataset, "text", 0).mask;
  ASSERT_FALSE(mask.empty());
  EXPECT_NE(mask(202, 22), 0);
  EXPECT_NE(mask(286, 30), 0);
  EXPECT_EQ(mask(100, 120), 0);
  EXPECT_TRUE(examine(room(), "room", 0).mask.empty());
}

TEST(Doctor, FindsFramesThatCannotBeUsed) {
  expect_found("images.unreadable", [](RenderedDataset& d) { d.frames[30].grey = Image<float>(64, 48); });
}

void expect_found_by_trial(const std::string& id, const Dataset& dataset) {
  const Diagnosis diagnosis = examine(dataset, id, 300);
  EXPECT_TRUE(has(diagnosis, id)) << diagnosis_text(diagnosis) << diagnosis_json(diagnosis)["figures"].dump(1);
}

TEST(Doctor, FindsACameraThatOnlyTurnsOrStands) {
  SequenceRecipe recipe = recipe_of("wall", 100);
  for (const char* motion : {"turning", "standing"}) {
    recipe.motion = motion;
    expect_found_by_trial("motion.no_start", RenderedDataset(recipe));
  }
}

/// What the images say of a calibration takes their full size.
SequenceRecipe large_room() {
  SequenceRecipe recipe = recipe_of("room", 250);
  recipe.width = 640;
  recipe.height = 480;
  recipe.texel_scale = 1;
  return recipe;
}

TEST(Doctor, FindsAWrongCalibration) {
  RenderedDataset dataset(large_room());
  dataset.camera.camera.fx *= 1.06;
  dataset.camera.camera.fy *= 1.06;
  expect_found_by_trial("calibration.contradicted", dataset);
}

TEST(Doctor, FindsARollingShutter) {
  SequenceRecipe recipe = large_room();
  recipe.sensor.rolling_shutter_ms = 30;
  expect_found_by_trial("shutter.rolling", RenderedDataset(recipe));
}

TEST(Doctor, SaysWhyASequenceCannotBeOpened) {
  const Diagnosis diagnosis = unopened("folder", "folder: there is no calibration of the camera; write one");
  EXPECT_EQ(exit_code_of(diagnosis), 1);
  EXPECT_NE(diagnosis_text(diagnosis).find("there is no calibration"), std::string::npos);
}

}  // namespace
}  // namespace ldso
