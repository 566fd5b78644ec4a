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

}  // namespace
}  // namespace ldso
