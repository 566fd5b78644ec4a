#pragma once
// Where the images of a model show the points of the map. The odometry is direct and matches nothing: what it says of
// where a point is seen is a prediction. Here the surroundings of each point, as its keyframe shows them, are looked
// for around that prediction, so that observations are measured and their distance from it is an error of reprojection.

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "image/frame_preprocessor.h"
#include "imagery/placed_map.h"
#include "ldso/records.h"
#include "ldso/rgb.h"
#include "mapping/map/patch.h"
#include "util/thread_pool.h"

namespace ldso {

/// An image to cut patches from, or to look for them in.
struct TrackedImage {
  std::int64_t id = 0;
  SE3d T_world_camera;
  ReadoutMotion motion = ReadoutMotion::Zero();  ///< Of a rolling shutter that is still in the image.
  Image<Rgb> image;                              ///< Rectified.
};

/// A point of the map in an image.
struct Sighting {
  std::size_t point = 0;
  Eigen::Vector2d predicted = Eigen::Vector2d::Zero();  ///< By pose and depth, all rows read at once.
  Eigen::Vector2d seen = Eigen::Vector2d::Zero();       ///< Where it was found.
};

class PointTracks {
 public:
  /// `camera`: of the images. Keeps a reference to the map.
  PointTracks(const PlacedMap& placed, const PinholeIntrinsics& camera);

  /// Positions in the world and grey levels of the points that are certain enough; sightings count them so.
  const std::vector<Eigen::Vector3d>& positions() const { return positions_; }
  const std::vector<std::uint8_t>& intensities() const { return intensities_; }

  /// Takes patches and colours of the points of keyframe `index` out of its image. Keyframes without stay unseen.
  void add_keyframe(std::size_t index, const TrackedImage& image);

  /// Nothing where the keyframe's image was not given.
  const std::vector<std::optional<Rgb>>& colors() const { return colors_; }

  /// The points that the image shows, of the keyframes whose window was there at that time.
  std::vector<Sighting> find(const TrackedImage& image);

 private:
  struct Candidate;
  struct Point {
    std::size_t keyframe = 0;
    Eigen::Vector3d in_host = Eigen::Vector3d::Zero();  ///< In the keyframe's unit.
    Eigen::Vector2d centre =
        Eigen::Vector2d::Zero();  ///< Of the patch, in the keyframe's image with all rows read at once.
    Patch patch;
  };
  PreparedFrame prepare(const TrackedImage& image) const;
  std::vector<Candidate> candidates(const TrackedImage& image) const;
  std::optional<Eigen::Vector2d> look_for(const Candidate& candidate, const TrackedImage& image,
                                          const Image<Texel>& texels) const;

  PlacedMap placed_;
  PinholeIntrinsics camera_;
  FramePreprocessor preprocessor_;
  std::vector<FrameSpan> spans_;
  std::vector<std::size_t> first_point_;  ///< By keyframe, and one more for the end.
  std::vector<Point> points_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<std::uint8_t> intensities_;
  std::vector<std::optional<Rgb>> colors_;
  ThreadPool pool_;
};

}  // namespace ldso
