#include "util/disjoint_sets.h"

#include <gtest/gtest.h>

namespace ldso {
namespace {

TEST(DisjointSets, WhatIsJoinedHangsTogetherAndNothingElse) {
  DisjointSets sets(6);
  sets.join(0, 3);
  sets.join(4, 5);
  sets.join(3, 5);
  EXPECT_EQ(sets.find(0), sets.find(4));
  EXPECT_NE(sets.find(0), sets.find(1));
  EXPECT_NE(sets.find(1), sets.find(2));
  sets.join(5, 0);
  EXPECT_EQ(sets.find(3), sets.find(4));
}

}  // namespace
}  // namespace ldso
