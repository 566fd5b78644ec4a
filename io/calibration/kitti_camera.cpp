#include <algorithm>
#include <map>
#include <string>

#include "io/calibration/foreign_camera.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"

namespace ldso {
namespace {

/// Of the first camera, which every such file has.
constexpr const char* kFirst = "P_rect_00:";

/// "P_rect_02:"
std::string line_name(const char* kind, int camera) {
  return std::string(kind) + "_rect_0" + std::to_string(camera) + ":";
}

const TextLine* find_line(const TextFile& file, const std::string& name) {
  const auto found = std::find_if(file.lines().begin(), file.lines().end(),
                                  [&](const TextLine& line) { return line.fields.front() == name; });
  return found == file.lines().end() ? nullptr : &*found;
}

}  // namespace

bool is_kitti_calibration(const std::filesystem::path& path) { return find_line(TextFile(path), kFirst) != nullptr; }

/// Of the raw data's rectified images, which all cameras share but for where they are.
ForeignCamera read_kitti_camera(const std::filesystem::path& path, int camera) {
  const TextFile file(path);
  int cameras = 1;
  while (find_line(file, line_name("P", cameras)) != nullptr) ++cameras;
  check_camera(camera, cameras, path.string());
  const std::string size_name = line_name("S", camera);
  const TextLine* size = find_line(file, size_name);
  if (size == nullptr) throw Error(path.string(), "has no line " + size_name, "expected KITTI's calib_cam_to_cam.txt");
  const TextLine& P = *find_line(file, line_name("P", camera));
  if (P.fields.size() != 13) file.fail(P, "has no 12 numbers", "expected a 3x4 projection matrix");
  ForeignCamera result;
  result.kind = "KITTI raw, rectified camera " + std::to_string(camera);
  result.where = path.string() + ":" + std::to_string(P.number);
  set_size(result.camera, file.finite_number(*size, 1), file.finite_number(*size, 2), result.where);
  set_intrinsics(result.camera, file.finite_number(P, 1), file.finite_number(P, 6), file.finite_number(P, 3),
                 file.finite_number(P, 7), result.where);
  return result;
}

}  // namespace ldso
