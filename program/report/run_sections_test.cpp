#include "report/run_sections.h"

#include <gtest/gtest.h>

#include <string>

namespace ldso {
namespace {

TEST(RunSections, MapsOfTheirOwnAreListed) {
  RunSummary summary;
  EXPECT_EQ(warning_lists(summary).find("Maps of their own"), std::string::npos);
  RunSegment segment;
  segment.posed = {310, 311, 390};
  segment.points.resize(7);
  summary.segments.push_back(segment);
  const std::string html = warning_lists(summary);
  EXPECT_NE(html.find("Maps of their own"), std::string::npos);
  EXPECT_NE(html.find("<td>310</td><td>390</td><td>3</td><td>7</td>"), std::string::npos) << html;
  EXPECT_NE(html.find("trajectory_segment_2.txt, map_segment_2.ply"), std::string::npos) << html;
}

}  // namespace
}  // namespace ldso
