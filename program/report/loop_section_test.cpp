#include "report/loop_section.h"

#include <gtest/gtest.h>

namespace ldso {
namespace {

LoopRecord accepted(std::int64_t id) {
  LoopRecord loop;
  loop.keyframe_id = id;
  loop.accepted = true;
  loop.inliers = 70;
  return loop;
}

LoopRecord refused(const std::string& reason) {
  LoopRecord loop;
  loop.reason = reason;
  return loop;
}

TEST(LoopSection, ShownLoopsAreSpreadOverTheAcceptedOnes) {
  std::vector<LoopRecord> loops;
  for (int i = 0; i < 20; ++i) loops.push_back(i % 2 == 0 ? accepted(i) : refused("no"));
  EXPECT_EQ(loops_to_show(loops, 10).size(), 10u);
  EXPECT_EQ(loops_to_show(loops, 100).size(), 10u);
  const std::vector<std::size_t> two = loops_to_show(loops, 2);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0], 4u);  // of 0, 2, ..., 18: in the middle of each half
  EXPECT_EQ(two[1], 14u);
  EXPECT_TRUE(loops_to_show({}, 6).empty());
}

TEST(LoopSection, RefusalsAreCountedByTheirReason) {
  const std::vector<LoopRecord> loops = {refused("inliers: 3 (at least 15)"), refused("drift"),
                                         refused("inliers: 7 (at least 15)"), accepted(4)};
  const std::string table = refusal_table(loops);
  const std::size_t inliers = table.find("<td>2</td><td class=\"left\">inliers: 3 (at least 15)</td>");
  const std::size_t drift = table.find("<td>1</td><td class=\"left\">drift</td>");
  ASSERT_NE(inliers, std::string::npos) << table;
  ASSERT_NE(drift, std::string::npos) << table;
  EXPECT_LT(inliers, drift);
}

TEST(LoopSection, SaysWhatThereIs) {
  EXPECT_NE(loop_section({}, {}).find("No pair of keyframes"), std::string::npos);
  const std::vector<LoopRecord> loops = {accepted(41), refused("<b>no</b>")};
  const std::string html = loop_section(loops, {{{"a & b", {1, 2, 3}}}, {"no picture of <x>"}});
  EXPECT_NE(html.find("2 pairs of keyframes looked like one place; 1 were found to be one, 1 were refused."),
            std::string::npos);
  EXPECT_NE(html.find("<td>41</td>"), std::string::npos);
  EXPECT_NE(html.find("src=\"data:image/jpeg;base64,AQID\""), std::string::npos);
  EXPECT_NE(html.find("a &amp; b"), std::string::npos);
  EXPECT_NE(html.find("no picture of &lt;x&gt;"), std::string::npos);
  EXPECT_EQ(html.find("<b>"), std::string::npos);
}

}  // namespace
}  // namespace ldso
