#include <algorithm>
#include <iomanip>
#include <string>

#include "io/images/image_file.h"
#include "io/text/text_file.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/trajectory_file.h"
#include "simulation/sequences/sequence_layout.h"
#include "util/whole_file.h"

namespace ldso::simulation {
namespace {

namespace fs = std::filesystem;

/// Share of the frames at each end that have a pose.
constexpr double kTruthShare = 0.15;

void write_photometry(const fs::path& folder, const PhotometricCalibration& photometric) {
  if (photometric.inverse_response) {
    std::ostringstream out = number_stream();
    for (int i = 0; i < 256; ++i) out << (i > 0 ? " " : "") << (*photometric.inverse_response)[i];
    out << '\n';
    write_file(folder / "pcalib.txt", out.str());
  }
  if (!photometric.vignette.empty()) {
    Image<float> scaled = photometric.vignette;
    std::for_each(scaled.data(), scaled.data() + scaled.size(), [](float& v) { v *= 255; });
    write_grey16_png(folder / "vignette.png", scaled.view());
  }
}

Trajectory truth_of(const SimulatedSequence& sequence, int begin, int end) {
  Trajectory trajectory;
  for (int i = begin; i < end; ++i) trajectory.push_back({sequence.timestamp(i), sequence.T_world_camera(i)});
  return trajectory;
}

/// As the benchmark writes it: `nan` for each number of a pose that is not known.
void write_truth_at_ends(const fs::path& path, const SimulatedSequence& sequence, int frames) {
  const int known = std::clamp(static_cast<int>(kTruthShare * frames), std::min(3, frames), frames);
  std::ostringstream out = number_stream();
  for (int i = 0; i < frames; ++i) {
    out << std::fixed << std::setprecision(9) << sequence.timestamp(i) << std::defaultfloat << std::setprecision(12);
    if (i >= known && i < frames - known) {
      out << " nan nan nan nan nan nan nan\n";
      continue;
    }
    const SE3d T = sequence.T_world_camera(i);
    const Eigen::Quaterniond q(T.rotation().matrix());
    for (int k = 0; k < 3; ++k) out << ' ' << T.translation()[k];
    out << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << ' ' << q.w() << '\n';
  }
  write_file(path, out.str());
}

class TumMonoLayout final : public SequenceLayout {
 public:
  explicit TumMonoLayout(bool truth_at_ends) : truth_at_ends_(truth_at_ends) {}

  void check(const SimulatedSequence& /*sequence*/, const fs::path& /*folder*/) const override {}
  fs::path image_folder() const override { return "images"; }
  std::string frame_name(const SimulatedSequence& /*sequence*/, int index) const override { return numbered(index, 5); }
  std::vector<std::string> names(const fs::path& /*folder*/) const override {
    return {"images/",    "images.zip",   "camera.txt",      "times.txt",
            "pcalib.txt", "vignette.png", "groundtruth.txt", "groundtruthSync.txt"};
  }

  void write(const fs::path& folder, const SimulatedSequence& sequence, const SequenceRecipe& recipe,
             int frames) const override {
    write_file(folder / "camera.txt", camera_file_text(sequence.calibration()));
    write_photometry(folder, sequence.calibration().photometric);
    std::ostringstream times = number_stream();
    times << std::fixed << std::setprecision(9);
    for (int i = 0; i < frames; ++i) {
      times << frame_name(sequence, i) << ' ' << sequence.timestamp(i);
      if (recipe.provide_exposure) times << ' ' << sequence.exposure_ms(i);
      times << '\n';
    }
    write_file(folder / "times.txt", times.str());
    if (truth_at_ends_) {
      write_truth_at_ends(folder / "groundtruthSync.txt", sequence, frames);
    } else {
      write_tum_trajectory(folder / "groundtruth.txt", truth_of(sequence, 0, frames));
    }
  }

 private:
  bool truth_at_ends_;
};

}  // namespace

std::unique_ptr<SequenceLayout> make_tum_mono_layout(bool truth_at_ends) {
  return std::make_unique<TumMonoLayout>(truth_at_ends);
}

}  // namespace ldso::simulation
