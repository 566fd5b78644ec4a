#include <string>

#include "io/text/output_folder.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "ldso/io/trajectory_file.h"
#include "simulation/sequences/sequence_layout.h"
#include "util/whole_file.h"

namespace ldso::simulation {
namespace {

namespace fs = std::filesystem;

std::string calibration_text(const CameraCalibration& camera) {
  std::ostringstream out = number_stream();
  out << "P0: " << camera.fx << " 0 " << camera.cx << " 0 0 " << camera.fy << ' ' << camera.cy << " 0 0 0 1 0\n";
  return out.str();
}

class KittiLayout final : public SequenceLayout {
 public:
  void check(const SimulatedSequence& sequence, const fs::path& folder) const override {
    if (sequence.calibration().camera.model != CameraModelKind::kPinhole)
      throw Error("KITTI layout", "its images are those of a pinhole camera", "choose --lens pinhole");
    if (real_path(folder).parent_path().filename() != "sequences") {
      throw Error(folder.string(), "is no place for a sequence of KITTI: the poses lie in ../../poses",
                  "give -o ROOT/sequences/NAME");
    }
  }
  fs::path image_folder() const override { return "image_0"; }
  std::string frame_name(const SimulatedSequence& /*sequence*/, int index) const override { return numbered(index, 6); }
  std::vector<std::string> names(const fs::path& folder) const override {
    return {"image_0/", "calib.txt", "times.txt", "../../poses/" + real_path(folder).filename().string() + ".txt"};
  }

  void write(const fs::path& folder, const SimulatedSequence& sequence, const SequenceRecipe& /*recipe*/,
             int frames) const override {
    std::ostringstream times = number_stream();
    Trajectory relative;
    const SE3d T_first_world = sequence.T_world_camera(0).inverse();
    for (int i = 0; i < frames; ++i) {
      times << sequence.timestamp(i) << '\n';
      relative.push_back({sequence.timestamp(i), T_first_world * sequence.T_world_camera(i)});
    }
    write_file(folder / "calib.txt", calibration_text(sequence.calibration().camera));
    write_file(folder / "times.txt", times.str());
    const fs::path path = real_path(folder), poses = path.parent_path().parent_path() / "poses";
    create_folder(poses);
    write_kitti_poses(poses / (path.filename().string() + ".txt"), relative);
  }
};

}  // namespace

std::unique_ptr<SequenceLayout> make_kitti_layout() { return std::make_unique<KittiLayout>(); }

}  // namespace ldso::simulation
