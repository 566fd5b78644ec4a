#include "experiment/summary/published.h"

#include <algorithm>
#include <cmath>

#include "experiment/test_results.h"
#include "ldso/error.h"

namespace ldso {
namespace {

class Published : public FolderTest {
 protected:
  std::string error_of_reading(const std::string& text) {
    write(folder_ / "others.yaml", text);
    try {
      read_published(folder_ / "others.yaml");
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(Published, BuiltInHoldsThePapersTables) {
  const auto all = built_in_published();
  const auto find = [&](const std::string& system, const std::string& figure) {
    return *std::find_if(all.begin(), all.end(),
                         [&](const auto& p) { return p.system == system && p.figure == figure; });
  };
  EXPECT_EQ(find("LDSO", "ate").value_of("00"), 9.322);
  EXPECT_EQ(find("LDSO", "ate").value_of("kitti_07"), 2.96);
  EXPECT_EQ(find("DSO", "ate").value_of("08"), 120.17);
  EXPECT_TRUE(std::isinf(*find("ORB-SLAM2", "ate").value_of("01")));
  EXPECT_EQ(find("LDSO", "ate").value_of("11"), std::nullopt);
  EXPECT_EQ(find("LDSO", "selection").value_of("random"), 2.7);
  for (const PublishedResults& results : all) EXPECT_GT(results.source.size(), 20u) << results.system;
}

TEST_F(Published, NamesMayHaveMoreWordsButNoOtherLetters) {
  PublishedResults results;
  results.values = {{"MH_01", 1.0}, {"0", 2.0}};
  EXPECT_EQ(results.value_of("MH_01_easy"), 1.0);
  EXPECT_EQ(results.value_of("euroc_MH_01"), 1.0);
  EXPECT_EQ(results.value_of("MH_011"), std::nullopt);
  EXPECT_EQ(results.value_of("10"), std::nullopt);
}

TEST_F(Published, ExcerptsAreOtherSequences) {
  const PublishedResults results = built_in_published().front();
  EXPECT_EQ(results.dataset, "kitti");
  EXPECT_TRUE(results.value_of("00", 4541).has_value());
  EXPECT_TRUE(results.value_of("kitti_00", 4535).has_value());
  EXPECT_FALSE(results.value_of("00", 1018).has_value());
  EXPECT_FALSE(results.value_of("kitti_00", 200).has_value());
  for (const auto& [name, value] : results.values) EXPECT_TRUE(results.frames.contains(name)) << name;
}

TEST_F(Published, ErrorsNameFileAndLine) {
  const std::string sound =
      "- system: A\n  source: B\n  dataset: kitti\n  figure: ate\n  unit: m\n  values: {x: 1, y: failed}\n";
  EXPECT_EQ(error_of_reading(sound), "");
  EXPECT_NE(error_of_reading(sound + "  colour: red\n").find("others.yaml:7: unknown member colour"),
            std::string::npos);
  EXPECT_NE(error_of_reading("- system: A\n").find("is missing"), std::string::npos);
  EXPECT_NE(error_of_reading(sound + "- 3\n").find("others.yaml:7"), std::string::npos);
  EXPECT_NE(error_of_reading("- system: [\n").find("others.yaml:"), std::string::npos);
  std::string bad_number = sound;
  bad_number.replace(bad_number.find("x: 1"), 4, "x: p");
  EXPECT_NE(error_of_reading(bad_number).find("others.yaml:6"), std::string::npos);
}

}  // namespace
}  // namespace ldso
