#include "ldso/io/pcd_file.h"

#include <string>

#include "util/bytes.h"
#include "util/whole_file.h"

namespace ldso {

void write_pcd(const std::filesystem::path& path, const std::vector<PlyPoint>& points) {
  const std::string count = std::to_string(points.size());
  ByteWriter out;
  out.reserve(256 + 20 * points.size());
  out.put_text(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity idepth_stddev\n"
      "SIZE 4 4 4 4 4\nTYPE F F F F F\nCOUNT 1 1 1 1 1\nWIDTH ");
  out.put_text(count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n");
  for (const PlyPoint& point : points) {
    for (const float value : {point.x, point.y, point.z, static_cast<float>(point.intensity), point.idepth_stddev})
      out.put(value);
  }
  write_file(path, {reinterpret_cast<const char*>(out.bytes().data()), out.size()});
}

}  // namespace ldso
