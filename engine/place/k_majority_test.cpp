#include "place/k_majority.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "place/test_descriptors.h"

namespace ldso {
namespace {

using place_test::flip_bits;
using place_test::random_descriptor;

struct Groups {
  std::vector<OrbDescriptor> centers, descriptors;
};

/// `count` descriptors about each of `groups` random centres.
Groups make_groups(int groups, int count, int noise_bits) {
  std::mt19937_64 random(11);
  Groups result;
  for (int i = 0; i < groups; ++i) result.centers.push_back(random_descriptor(random));
  for (int i = 0; i < groups * count; ++i)
    result.descriptors.push_back(flip_bits(result.centers[i % groups], noise_bits, random));
  return result;
}

TEST(KMajority, FindsTheCentersOfGroups) {
  const Groups groups = make_groups(8, 101, 3);
  const Clusters clusters = cluster_descriptors(groups.descriptors, 8, 20, 1, nullptr);
  ASSERT_EQ(clusters.centers.size(), 8u);
  std::set<int> found;
  for (int i = 0; i < 8; ++i) {
    const OrbDescriptor& center = clusters.centers[clusters.cluster_of[i]];
    EXPECT_EQ(center, groups.centers[i]) << "the votes of 101 members remove the noise";
    found.insert(clusters.cluster_of[i]);
  }
  EXPECT_EQ(found.size(), 8u);
  for (std::size_t i = 0; i < groups.descriptors.size(); ++i)
    EXPECT_EQ(clusters.cluster_of[i], clusters.cluster_of[i % 8]);
}

TEST(KMajority, DoesNotDependOnThreads) {
  const Groups groups = make_groups(30, 300, 60);
  const Clusters alone = cluster_descriptors(groups.descriptors, 10, 3, 3, nullptr);
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    const Clusters shared = cluster_descriptors(groups.descriptors, 10, 3, 3, &pool);
    EXPECT_EQ(shared.centers, alone.centers);
    EXPECT_EQ(shared.cluster_of, alone.cluster_of);
  }
  EXPECT_NE(cluster_descriptors(groups.descriptors, 10, 3, 4, nullptr).centers, alone.centers);
}

TEST(KMajority, FewerDifferentDescriptorsThanClusters) {
  std::mt19937_64 random(2);
  const OrbDescriptor a = random_descriptor(random), b = random_descriptor(random);
  const Clusters two = cluster_descriptors(std::vector{a, b, a, a, b}, 10, 5, 1, nullptr);
  ASSERT_EQ(two.centers.size(), 2u);
  EXPECT_EQ(two.centers[two.cluster_of[0]], a);
  EXPECT_EQ(two.centers[two.cluster_of[1]], b);
  EXPECT_EQ(two.cluster_of[0], two.cluster_of[2]);
  EXPECT_EQ(cluster_descriptors(std::vector{a, a}, 10, 5, 1, nullptr).centers.size(), 1u);
  EXPECT_TRUE(cluster_descriptors({}, 10, 5, 1, nullptr).centers.empty());
}

TEST(KMajority, EveryClusterHasMembersAndEveryDescriptorItsNearestCenter) {
  std::mt19937_64 random(4);
  std::vector<OrbDescriptor> descriptors;
  for (int i = 0; i < 3000; ++i) descriptors.push_back(flip_bits({}, 40, random));
  const Clusters clusters = cluster_descriptors(descriptors, 200, 8, 1, nullptr);
  std::vector<int> members(clusters.centers.size(), 0);
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    ++members[clusters.cluster_of[i]];
    for (const OrbDescriptor& center : clusters.centers) {
      EXPECT_LE(hamming_distance(descriptors[i], clusters.centers[clusters.cluster_of[i]]),
                hamming_distance(descriptors[i], center));
    }
  }
  EXPECT_GT(*std::min_element(members.begin(), members.end()), 0);
}

}  // namespace
}  // namespace ldso
