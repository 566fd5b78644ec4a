#include "mapping/matching/loop_detector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace ldso {
namespace {

constexpr int kPlaces = 12;
constexpr int kWordsOfPlace = 20;
constexpr int kWords = (kPlaces + 200) * kWordsOfPlace;

/// An image of a place: `shared` of its words and so many of its own.
BowVector image_of(int place, int shared = kWordsOfPlace, int own = 0) {
  BowVector words;
  const float weight = 1.0f / static_cast<float>(kWordsOfPlace);
  for (int i = 0; i < shared; ++i) words.emplace_back(place * kWordsOfPlace + i, weight);
  for (int i = shared; i < kWordsOfPlace; ++i) words.emplace_back((kPlaces + own) * kWordsOfPlace + i, weight);
  return words;
}

/// A map that grows by keyframes which are linked with the next three.
class LoopDetectorTest : public testing::Test {
 protected:
  LoopDetectorTest() {
    settings_.detection.min_gap = 8;
    settings_.detection.excluded_hops = 2;
    settings_.detection.max_results = 30;
    settings_.max_candidates = 3;
    settings_.detection.min_score = 0.05;
    settings_.detection.relative_score = 0;
  }

  std::vector<LoopCandidate> add(LoopDetector& detector, const BowVector& words, std::vector<int> also_linked_to = {}) {
    KeyframeUpdate update;
    update.frame_id = map_.size();
    for (int k = 1; k <= 3; ++k) also_linked_to.push_back(map_.size() + k);
    for (const int other : also_linked_to) update.constraints.push_back({other, SE3d(), Matrix7d::Identity()});
    map_.add(update, {});
    std::vector<LoopCandidate> candidates = detector.detect(map_, words);
    detector.add(map_.size() - 1, words);
    return candidates;
  }

  LoopSettings settings_;
  KeyframeMap map_;
};

TEST_F(LoopDetectorTest, NothingWhereNothingIsSeenAgain) {
  LoopDetector detector(kWords, settings_);
  for (int i = 0; i < kPlaces; ++i) EXPECT_TRUE(add(detector, image_of(i)).empty()) << i;
}

TEST_F(LoopDetectorTest, FindsThePlaceSeenBefore) {
  LoopDetector detector(kWords, settings_);
  for (int i = 0; i < kPlaces; ++i) add(detector, image_of(i));
  for (int i = 0; i < kPlaces; ++i) {
    const std::vector<LoopCandidate> found = add(detector, image_of(i, 15, i));
    ASSERT_EQ(found.size(), 1u) << i;
    EXPECT_EQ(found[0].index, i);
    EXPECT_NEAR(found[0].score, 0.75, 1e-5);
    EXPECT_NEAR(found[0].group, 0.75, 1e-5);
  }
}

TEST_F(LoopDetectorTest, KeyframesOfOneWindowAreOnePlaceNamedByTheBest) {
  LoopDetector detector(kWords, settings_);
  // Keyframes 0..2 show place 0, the middle one best.
  add(detector, image_of(0, 10, 0));
  add(detector, image_of(0, 18, 1));
  add(detector, image_of(0, 12, 2));
  for (int i = 1; i < kPlaces; ++i) add(detector, image_of(i));
  const std::vector<LoopCandidate> found = add(detector, image_of(0));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].index, 1);
  EXPECT_NEAR(found[0].score, 0.9, 1e-5);
  EXPECT_NEAR(found[0].group, 0.9 + 0.5 + 0.6, 1e-5);
}

TEST_F(LoopDetectorTest, APlaceThatManyConfirmComesBeforeASingleKeyframe) {
  LoopDetector detector(kWords, settings_);
  add(detector, image_of(0, 16, 0));
  for (int i = 1; i < kPlaces; ++i) add(detector, image_of(i));
  for (int i = 0; i < 3; ++i) add(detector, image_of(0, 12, 10 + i));
  for (int i = 1; i < kPlaces; ++i) add(detector, image_of(i));
  const std::vector<LoopCandidate> found = add(detector, image_of(0));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_GE(found[0].index, kPlaces);
  EXPECT_LT(found[0].index, kPlaces + 3);
  EXPECT_NEAR(found[0].group, 3 * 0.6, 1e-5);
  EXPECT_EQ(found[1].index, 0);
  EXPECT_GT(found[1].score, found[0].score);
}

TEST_F(LoopDetectorTest, NotTheRecentPast) {
  LoopDetector detector(kWords, settings_);
  for (int i = 0; i < 30; ++i) {
    const std::vector<LoopCandidate> found = add(detector, image_of(0));
    EXPECT_EQ(found.empty(), i < settings_.detection.min_gap) << i;
    for (const LoopCandidate& candidate : found) EXPECT_LE(candidate.index, i - settings_.detection.min_gap);
  }
}

TEST_F(LoopDetectorTest, NotWhatTheWindowLinks) {
  settings_.detection.min_gap = 1;
  LoopDetector detector(kWords, settings_);
  for (int i = 0; i < 20; ++i) {
    const std::vector<int> around = [&] {
      const std::vector<LoopCandidate> found = add(detector, image_of(0));
      std::vector<int> indices;
      for (const LoopCandidate& candidate : found) indices.push_back(candidate.index);
      return indices;
    }();
    // Two steps over links to the three before.
    for (const int index : around) EXPECT_LT(index, i - 6);
    EXPECT_EQ(around.empty(), i < 7) << i;
  }
}

/// A keyframe may stay in the window for long: what shared it is no loop, however old it is.
TEST_F(LoopDetectorTest, NotWhatSharedAWindowLongAgo) {
  LoopDetector detector(kWords, settings_);
  add(detector, image_of(0), {20});
  for (int i = 1; i < 20; ++i) add(detector, image_of(1 + i % 3));
  EXPECT_TRUE(add(detector, image_of(0)).empty());
}

TEST_F(LoopDetectorTest, NoMoreThanAsked) {
  settings_.max_candidates = 2;
  LoopDetector detector(kWords, settings_);
  for (int lap = 0; lap < 5; ++lap) {
    for (int i = 0; i < kPlaces; ++i) {
      const auto found = add(detector, image_of(i));
      EXPECT_EQ(found.size(), static_cast<std::size_t>(std::min(lap, 2)));
    }
  }
}

TEST_F(LoopDetectorTest, WeakOnesDoNotCount) {
  settings_.detection.min_score = 0.3;
  LoopDetector detector(kWords, settings_);
  add(detector, image_of(0));
  for (int i = 1; i < kPlaces; ++i) add(detector, image_of(i));
  EXPECT_TRUE(add(detector, image_of(0, 5, 1)).empty());  // 0.25
  EXPECT_EQ(add(detector, image_of(0, 7, 2)).size(), 1u);
}

TEST_F(LoopDetectorTest, WeakerThanTheKeyframeBeforeDoesNotCount) {
  settings_.detection.relative_score = 0.8;
  LoopDetector detector(kWords, settings_);
  add(detector, image_of(0, 10, 1));
  for (int i = 1; i < kPlaces; ++i) add(detector, image_of(i));
  // Nothing in common with the one before: half is enough.
  EXPECT_EQ(add(detector, image_of(0)).size(), 1u);
  // As before: it had to be 0.8.
  EXPECT_TRUE(add(detector, image_of(0)).empty());
}

TEST_F(LoopDetectorTest, EveryKeyframeCanBeFoundLater) {
  LoopDetector detector(kWords, settings_);
  // What found something, what found nothing and an empty image.
  for (int i = 0; i < kPlaces; ++i) add(detector, image_of(i));
  for (int i = 0; i < kPlaces; ++i) add(detector, image_of(i));
  EXPECT_TRUE(add(detector, {}).empty());
  for (int i = 0; i < kPlaces; ++i) {
    const auto found = add(detector, image_of(i));
    ASSERT_EQ(found.size(), 2u);
    std::vector<int> indices = {found[0].index, found[1].index};
    std::sort(indices.begin(), indices.end());
    EXPECT_EQ(indices, std::vector<int>({i, i + kPlaces}));
  }
}

}  // namespace
}  // namespace ldso
