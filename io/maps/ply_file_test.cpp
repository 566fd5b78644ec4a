#include "ldso/io/ply_file.h"

#include <gtest/gtest.h>

#include <limits>

#include "io/datasets/test_sequences.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

TEST(PlyFile, IsReadAsWritten) {
  const TemporaryFolder folder;
  std::vector<PlyPoint> points;
  for (int i = 0; i < 300; ++i) {
    const auto f = static_cast<float>(i);
    points.push_back({f, -f / 3, 1e6F * f, static_cast<std::uint8_t>(i), 1e-5F * f});
    if (i % 3 == 0) points.back().color = Rgb{1, 2, static_cast<std::uint8_t>(i)};
  }
  write_ply(folder / "map.ply", points);
  const std::vector<PlyPoint> read = read_ply(folder / "map.ply");
  ASSERT_EQ(read.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(read[i].x, points[i].x);
    EXPECT_EQ(read[i].y, points[i].y);
    EXPECT_EQ(read[i].z, points[i].z);
    EXPECT_EQ(read[i].intensity, points[i].intensity);
    EXPECT_EQ(read[i].color, points[i].color);
    EXPECT_EQ(read[i].idepth_stddev, points[i].idepth_stddev);
  }
}

TEST(PlyFile, HasTheBytesThatTheFormatAsksFor) {
  const TemporaryFolder folder;
  write_ply(folder / "map.ply", {{1.0F, 2.0F, 3.0F, 7, 0.5F}});
  const std::string bytes = read_file(folder / "map.ply");
  EXPECT_TRUE(bytes.starts_with("ply\nformat binary_little_endian 1.0\n"));
  EXPECT_NE(bytes.find("element vertex 1\nproperty float x\n"), std::string::npos);
  const std::string expected("\x00\x00\x80\x3f\x00\x00\x00\x40\x00\x00\x40\x40\x07\x07\x07\x07\x00\x00\x00\x3f", 20);
  EXPECT_TRUE(bytes.ends_with("end_header\n" + expected));
}

TEST(PlyFile, EmptyCloudIsAFileToo) {
  const TemporaryFolder folder;
  write_ply(folder / "map.ply", {});
  EXPECT_TRUE(read_ply(folder / "map.ply").empty());
}

TEST(PlyFile, DamagedFilesAreErrors) {
  const TemporaryFolder folder;
  write_ply(folder / "map.ply", {{}, {}});
  std::filesystem::resize_file(folder / "map.ply", std::filesystem::file_size(folder / "map.ply") - 1);
  EXPECT_NE(error_of([&] { read_ply(folder / "map.ply"); }).find("cut off"), std::string::npos);
  write_text(folder / "other.ply", "ply\nformat ascii 1.0\n");
  EXPECT_NE(error_of([&] { read_ply(folder / "other.ply"); }).find("other.ply"), std::string::npos);
  EXPECT_NE(error_of([&] { write_ply(folder / "no/map.ply", {}); }).find("cannot be written"), std::string::npos);
}

TEST(PlyFile, ClaimsOfItsHeaderAreNotBelieved) {
  const TemporaryFolder folder;
  const auto error_for = [&](const std::string& count) {
    write_ply(folder / "map.ply", {{}});
    std::string bytes = read_file(folder / "map.ply");
    bytes.replace(bytes.find("vertex 1") + 7, 1, count);
    write_text(folder / "map.ply", bytes);
    return error_of([&] { read_ply(folder / "map.ply"); });
  };
  for (const char* count : {"1000000000000", "1e300", "-1", "nan", "0.5"})
    EXPECT_NE(error_for(count).find("announced number"), std::string::npos) << count;
}

TEST(PlyFile, PointsThatAreNotFiniteAreErrors) {
  const TemporaryFolder folder;
  PlyPoint point;
  point.idepth_stddev = std::numeric_limits<float>::quiet_NaN();
  write_ply(folder / "map.ply", {{}, point});
  EXPECT_NE(error_of([&] { read_ply(folder / "map.ply"); }).find("not finite"), std::string::npos);
}

}  // namespace
}  // namespace ldso
