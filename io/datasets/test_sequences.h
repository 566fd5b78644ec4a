#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ldso/image.h"

namespace ldso {

// Small sequences in every format for the tests of this room. Frame i is 32x24, its pixel (x, y) is 10 * i + x + y.

/// A folder that is removed at the end of the test.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline constexpr int kTestWidth = 32;
inline constexpr int kTestHeight = 24;
inline constexpr const char* kTestCamera = "Pinhole 40 41 15.5 11.5 0\n32 24\nnone\n32 24\n";

Image<float> test_frame(int index);

/// Writes text, making the folders above it.
void write_text(const std::filesystem::path& path, const std::string& text);
void write_frame(const std::filesystem::path& path, int index);

// Each makes a sequence of `count` frames at i / 10 s and returns the path to be opened. Those with ground truth have
// the camera at x = i (pose i at the time of frame i).
std::filesystem::path make_tum_mono(const std::filesystem::path& folder, int count);
std::filesystem::path make_tum_mono_zip(const std::filesystem::path& folder, int count);
std::filesystem::path make_kitti(const std::filesystem::path& folder, int count);
std::filesystem::path make_euroc(const std::filesystem::path& folder, int count);
std::filesystem::path make_tum_rgbd(const std::filesystem::path& folder, int count);
std::filesystem::path make_image_folder(const std::filesystem::path& folder, int count);
std::filesystem::path make_video(const std::filesystem::path& folder, int count);
/// A Matroska stream, as a program writes it into a pipe: without duration, index and rate, with frame i at
/// times_ms[i].
std::filesystem::path make_matroska(const std::filesystem::path& folder, const std::vector<int>& times_ms);

/// What the ldso::Error says that `action` throws; a failed expectation if it throws none.
std::string error_of(const std::function<void()>& action);

}  // namespace ldso
