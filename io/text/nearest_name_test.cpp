#include "io/text/nearest_name.h"

#include <gtest/gtest.h>

namespace ldso {
namespace {

TEST(NearestName, FindsTheFewestEdits) {
  const std::vector<std::string> names{"candidates", "corner_cell", "corner_radius", "seed"};
  EXPECT_EQ(nearest_name("candidate", names), "candidates");
  EXPECT_EQ(nearest_name("cornercell", names), "corner_cell");
  EXPECT_EQ(nearest_name("corner_raduis", names), "corner_radius");
  EXPECT_EQ(nearest_name("seeds", names), "seed");
}

TEST(NearestName, OfNoNamesIsEmpty) { EXPECT_EQ(nearest_name("a", {}), ""); }

TEST(NearestName, TakesNoTimeForEndlessWords) {
  // A hundred million characters: compared as a whole they would take minutes.
  EXPECT_EQ(nearest_name(std::string(100'000'000, 'a'), {"aaaa", "b"}), "aaaa");
}

}  // namespace
}  // namespace ldso
