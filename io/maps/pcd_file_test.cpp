#include "ldso/io/pcd_file.h"

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"
#include "io/images/image_file.h"
#include "util/bytes.h"

namespace ldso {
namespace {

TEST(PcdFile, HasTheBytesThatTheFormatAsksFor) {
  const TemporaryFolder folder;
  write_pcd(folder / "map.pcd", {{1, -2, 3.5F, 200, 0.25F}, {4, 5, 6, 7, 8}});
  const std::string header =
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity idepth_stddev\n"
      "SIZE 4 4 4 4 4\nTYPE F F F F F\nCOUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n"
      "DATA binary\n";
  const Bytes bytes = read_bytes(folder / "map.pcd");
  ByteReader in(bytes, "map.pcd");
  EXPECT_EQ(in.get_text(header.size()), header);
  for (const float wanted : {1.0F, -2.0F, 3.5F, 200.0F, 0.25F, 4.0F, 5.0F, 6.0F, 7.0F, 8.0F})
    EXPECT_EQ(in.get<float>(), wanted);
  EXPECT_EQ(in.left(), 0u);
}

}  // namespace
}  // namespace ldso
