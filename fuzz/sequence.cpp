// Whole sequences in a folder, whatever their layout. The input is the folder: each file begins with a line `@ name`.

#include <fstream>

#include "fuzz_target.h"
#include "ldso/io/dataset.h"

using namespace ldso;

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = "@ ";
constexpr std::size_t kMostFiles = 24;
constexpr int kMostFrames = 4;

bool is_harmless(std::string_view name) {
  return !name.empty() && name.size() < 64 && name.front() != '/' && name.find("..") == std::string_view::npos &&
         name.find('\0') == std::string_view::npos;
}

void write_part(const fs::path& folder, std::string_view name, std::string_view content) {
  if (!is_harmless(name)) return;
  std::error_code error;
  const fs::path path = folder / name;
  fs::create_directories(path.parent_path(), error);
  std::ofstream(path, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
}

/// Writes the files that the input is made of.
void unpack(const fs::path& folder, std::string_view input) {
  fs::create_directories(folder);
  for (std::size_t file = 0; file < kMostFiles && input.starts_with(kMark); ++file) {
    const std::size_t end = std::min(input.find("\n@ "), input.size());
    const auto [name, content] = fuzz::split_line(input.substr(kMark.size(), end - kMark.size()));
    write_part(folder, name, content);
    input.remove_prefix(std::min(end + 1, input.size()));
  }
}

void check(const Dataset& dataset) {
  const CameraCalibration& c = dataset.calibration().camera;
  fuzz::expect(dataset.size() > 0 && c.width > 0 && c.height > 0, "a sequence has frames, its camera a size");
  fuzz::expect(fuzz::all_finite({c.fx, c.fy, c.cx, c.cy}) && c.fx > 0 && c.fy > 0, "its camera is finite");
  for (int i = 0; i < std::min(dataset.size(), kMostFrames); ++i) {
    fuzz::expect(std::isfinite(dataset.timestamp(i)), "times are finite");
    fuzz::accepted([&] { return dataset.read(i).grey.width(); });
  }
  if (const auto truth = dataset.ground_truth()) {
    for (const StampedPose& pose : *truth)
      fuzz::expect(pose.T_world_camera.matrix().allFinite(), "the ground truth is finite");
  }
}

}  // namespace

LDSO_FUZZ_TARGET(sequence) {
  const fs::path top = fuzz::scratch_folder() / "dataset";
  const fs::path folder = top / "sequences" / "00";
  unpack(folder, input);
  fuzz::accepted([&] {
    const auto dataset = open_dataset(folder);
    check(*dataset);
    return dataset->size();
  });
  fs::remove_all(top);
}
