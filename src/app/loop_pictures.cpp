#include "app/loop_pictures.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>
#include <regex>
#include <system_error>

#include "image/frame_preprocessor.h"
#include "io/match_picture.h"
#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "loops";

/// The rectified image as people like to see it: linear intensities look dark on a screen.
Image<float> displayed_image(const Dataset& dataset, const FramePreprocessor& preprocessor, std::int64_t frame_id) {
  const std::string name = "frame " + std::to_string(frame_id);
  if (frame_id < 0 || frame_id >= dataset.size()) throw Error(name, "is not in the sequence", "play it as in the run");
  const PreparedFrame frame = preprocessor.process(dataset.read(static_cast<int>(frame_id)));
  const Image<Texel>& texels = frame.pyramid.levels.front();
  Image<float> image(texels.width(), texels.height());
  const bool linear = preprocessor.photometrically_calibrated();
  for (std::size_t i = 0; i < image.size(); ++i) {
    const float intensity = texels.data()[i].intensity;
    image.data()[i] = linear ? std::sqrt(255 * std::max(intensity, 0.F)) : intensity;
  }
  return image;
}

void write_picture(const fs::path& path, const LoopRecord& loop, const Dataset& dataset,
                   const FramePreprocessor& preprocessor) {
  const Image<float> candidate = displayed_image(dataset, preprocessor, loop.candidate_id);
  const Image<float> keyframe = displayed_image(dataset, preprocessor, loop.keyframe_id);
  std::vector<PictureMatch> matches;
  matches.reserve(loop.matches.size());
  for (const LoopMatchPixels& match : loop.matches) {
    matches.push_back({{match.u_candidate, match.v_candidate}, {match.u, match.v}});
  }
  const Image<Rgb> picture = draw_matches(candidate.view(), keyframe.view(), matches, loop_caption(loop));
  write_png(path, picture.view());
}

}  // namespace

std::string loop_caption(const LoopRecord& loop) {
  char text[256];
  std::snprintf(text, sizeof(text),
                "candidate %lld (left), keyframe %lld (right): %d inliers, %d with depth; scale %.4f +- %.4f, "
                "rotation %.2f deg",
                static_cast<long long>(loop.candidate_id), static_cast<long long>(loop.keyframe_id), loop.inliers,
                loop.depth_inliers, loop.S_keyframe_candidate.scale(),
                loop.S_keyframe_candidate.scale() * loop.log_scale_stddev,
                loop.S_keyframe_candidate.rotation().log().norm() * 180 / std::numbers::pi);
  return text;
}

void remove_loop_pictures(const fs::path& folder) {
  static const std::regex kName(R"(\d+_\d+\.png)");
  std::error_code ignored;
  std::vector<fs::path> pictures;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / kFolder, ignored)) {
    if (std::regex_match(entry.path().filename().string(), kName)) pictures.push_back(entry.path());
  }
  for (const fs::path& picture : pictures) fs::remove(picture, ignored);
  if (fs::is_directory(folder / kFolder, ignored) && fs::is_empty(folder / kFolder, ignored)) {
    fs::remove(folder / kFolder, ignored);
  }
}

std::vector<std::string> write_loop_pictures(const fs::path& folder, std::span<const LoopRecord> loops,
                                             const Dataset& dataset, const Calibration& calibration,
                                             const PhotometrySettings& photometry) {
  std::vector<std::string> warnings;
  const FramePreprocessor preprocessor(calibration, photometry);
  for (const LoopRecord& loop : loops) {
    if (!loop.accepted) continue;
    const std::string name = std::to_string(loop.keyframe_id) + "_" + std::to_string(loop.candidate_id) + ".png";
    try {
      fs::create_directories(folder / kFolder);
      write_picture(folder / kFolder / name, loop, dataset, preprocessor);
    } catch (const std::exception& error) {
      warnings.push_back("no picture of the loop from frame " + std::to_string(loop.keyframe_id) + " to frame " +
                         std::to_string(loop.candidate_id) + ": " + error.what());
    }
  }
  return warnings;
}

}  // namespace ldso
