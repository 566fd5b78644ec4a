#include "results/loop_pictures.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>
#include <regex>
#include <system_error>
#include <utility>

#include "image/frame_preprocessor.h"
#include "io/images/match_picture.h"
#include "ldso/error.h"
#include "util/format_text.h"
#include "viewer/map/shrink.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr int kAnyWidth = 1 << 20;
constexpr int kMostReportWidth = 640;  ///< Of each of both images.
constexpr int kJpegQuality = 72;

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

/// Both images at their own size, or smaller so that none is wider than `most_width`.
Image<Rgb> draw_picture(const LoopRecord& loop, const Dataset& dataset, const FramePreprocessor& preprocessor,
                        const std::string& caption, int most_width = kAnyWidth) {
  const Image<float> candidate = displayed_image(dataset, preprocessor, loop.candidate_id);
  const Image<float> keyframe = displayed_image(dataset, preprocessor, loop.keyframe_id);
  const Image<float> left = shrink(candidate.view(), most_width), right = shrink(keyframe.view(), most_width);
  const float scale = static_cast<float>(left.width()) / static_cast<float>(candidate.width());
  std::vector<PictureMatch> matches;
  matches.reserve(loop.matches.size());
  for (const LoopMatchPixels& match : loop.matches) {
    matches.push_back({{scale * match.u_candidate, scale * match.v_candidate}, {scale * match.u, scale * match.v}});
  }
  return draw_matches(left.view(), right.view(), matches, caption);
}

std::string missing_picture(const LoopRecord& loop, const std::exception& error) {
  return "no picture of the loop from frame " + std::to_string(loop.keyframe_id) + " to frame " +
         std::to_string(loop.candidate_id) + ": " + error.what();
}

}  // namespace

std::string loop_caption(const LoopRecord& loop) {
  return format_text(
      "candidate %lld (left), keyframe %lld (right): %d inliers, %d with depth; scale %.4f +- %.4f, "
      "rotation %.2f deg",
      static_cast<long long>(loop.candidate_id), static_cast<long long>(loop.keyframe_id), loop.inliers,
      loop.depth_inliers, loop.S_keyframe_candidate.scale(), loop.S_keyframe_candidate.scale() * loop.log_scale_stddev,
      loop.S_keyframe_candidate.rotation().log().norm() * 180 / std::numbers::pi);
}

void remove_loop_pictures(const fs::path& folder) {
  static const std::regex kName(R"(\d+_\d+\.png)");
  std::error_code ignored;
  std::vector<fs::path> pictures;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / kLoopPictureFolder, ignored)) {
    if (std::regex_match(entry.path().filename().string(), kName)) pictures.push_back(entry.path());
  }
  for (const fs::path& picture : pictures) fs::remove(picture, ignored);
}

std::vector<std::string> write_loop_pictures(const fs::path& folder, std::span<const LoopRecord> loops,
                                             const Dataset& dataset, const Calibration& calibration,
                                             const PhotometrySettings& photometry) {
  std::vector<std::string> warnings;
  if (dataset.size() == 0) return {"no pictures of loops: the images of a camera are not kept"};
  const FramePreprocessor preprocessor(calibration, photometry);
  for (const LoopRecord& loop : loops) {
    if (!loop.accepted) continue;
    const std::string name = std::to_string(loop.keyframe_id) + "_" + std::to_string(loop.candidate_id) + ".png";
    try {
      fs::create_directories(folder / kLoopPictureFolder);
      write_png(folder / kLoopPictureFolder / name,
                draw_picture(loop, dataset, preprocessor, loop_caption(loop)).view());
    } catch (const std::exception& error) {
      warnings.push_back(missing_picture(loop, error));
    }
  }
  return warnings;
}

LoopPictures make_loop_pictures(std::span<const LoopRecord> loops, std::span<const std::size_t> shown,
                                const Dataset& dataset, const Calibration& calibration,
                                const PhotometrySettings& photometry, std::size_t most_bytes) {
  LoopPictures made;
  if (shown.empty()) return made;
  const FramePreprocessor preprocessor(calibration, photometry);
  std::size_t bytes = 0;
  for (const std::size_t index : shown) {
    const LoopRecord& loop = loops[index];
    try {
      const Image<Rgb> picture = draw_picture(loop, dataset, preprocessor, "", kMostReportWidth);
      LoopPicture small{loop_caption(loop), encode_jpeg(picture.view(), kJpegQuality)};
      bytes += small.jpeg.size();
      if (bytes > most_bytes) break;
      made.pictures.push_back(std::move(small));
    } catch (const std::exception& error) {
      made.problems.push_back(missing_picture(loop, error));
    }
  }
  return made;
}

}  // namespace ldso
