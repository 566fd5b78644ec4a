#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "io/text/output_folder.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "simulation/sequences/sequence_layout.h"
#include "util/whole_file.h"

namespace ldso::simulation {
namespace {

namespace fs = std::filesystem;

/// The benchmark's times are those of the wall clock.
constexpr std::int64_t kEpoch = 1403636579000000000;

std::int64_t nanoseconds(double t) { return kEpoch + std::llround(t * 1e9); }

/// About that of the benchmark's camera 0: it looks along the body's x axis, turned by a right angle about it.
SE3d T_body_camera() { return {SO3d::exp({0.0041, 0.0148, 1.5559}), {-0.0216, -0.0647, 0.0098}}; }

const char* distortion_model(const CameraCalibration& camera) {
  switch (camera.model) {
    case CameraModelKind::kPinhole:
      return "none";
    case CameraModelKind::kRadTan:
      return "radial-tangential";
    case CameraModelKind::kKannalaBrandt:
      return "equidistant";
    case CameraModelKind::kFov:
    case CameraModelKind::kDoubleSphere:
    case CameraModelKind::kEucm:
      break;
  }
  throw Error("EuRoC layout", std::string("it has no name for the camera model ") + model_name(camera.model),
              "choose --lens pinhole, radtan or kannala-brandt");
}

std::string sensor_text(const SimulatedSequence& sequence) {
  const CameraCalibration& camera = sequence.calibration().camera;
  std::ostringstream out = number_stream();
  out << "sensor_type: camera\ncomment: simulated\n\n# Of the camera in the frame of the body.\nT_BS:\n"
      << "  cols: 4\n  rows: 4\n  data: [";
  const Eigen::Matrix4d T = T_body_camera().matrix();
  for (int i = 0; i < 16; ++i) out << (i > 0 ? ", " : "") << T(i / 4, i % 4);
  out << "]\n\nrate_hz: " << sequence.options().fps << "\nresolution: [" << camera.width << ", " << camera.height
      << "]\ncamera_model: pinhole\nintrinsics: [" << camera.fx << ", " << camera.fy << ", " << camera.cx << ", "
      << camera.cy << "]\ndistortion_model: " << distortion_model(camera) << "\ndistortion_coefficients: [";
  for (int i = 0; i < 4; ++i) out << (i > 0 ? ", " : "") << camera.distortion[i];
  out << "]\n";
  return out.str();
}

/// In the world, from the neighbouring frames [m/s].
Eigen::Vector3d velocity(const SimulatedSequence& sequence, int index, int frames) {
  const int before = std::max(index - 1, 0), after = std::min(index + 1, frames - 1);
  if (before == after) return Eigen::Vector3d::Zero();
  const auto body = [&](int i) { return (sequence.T_world_camera(i) * T_body_camera().inverse()).translation(); };
  return (body(after) - body(before)) / (sequence.timestamp(after) - sequence.timestamp(before));
}

std::string truth_text(const SimulatedSequence& sequence, int frames) {
  std::ostringstream out = number_stream();
  out << "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
         "v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], b_w_RS_S_y [rad s^-1], "
         "b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], b_a_RS_S_z [m s^-2]\n";
  for (int i = 0; i < frames; ++i) {
    const SE3d T_world_body = sequence.T_world_camera(i) * T_body_camera().inverse();
    const Eigen::Vector3d& p = T_world_body.translation();
    const Eigen::Vector3d v = velocity(sequence, i, frames);
    const Eigen::Quaterniond q(T_world_body.rotation().matrix());
    out << nanoseconds(sequence.timestamp(i));
    for (const double value : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), v.x(), v.y(), v.z()})
      out << ',' << value;
    out << ",0,0,0,0,0,0\n";
  }
  return out.str();
}

class EurocLayout final : public SequenceLayout {
 public:
  void check(const SimulatedSequence& sequence, const fs::path& /*folder*/) const override {
    distortion_model(sequence.calibration().camera);
  }
  fs::path image_folder() const override { return "mav0/cam0/data"; }
  std::string frame_name(const SimulatedSequence& sequence, int index) const override {
    return std::to_string(nanoseconds(sequence.timestamp(index)));
  }
  std::vector<std::string> names(const fs::path& /*folder*/) const override { return {"mav0/"}; }

  void write(const fs::path& folder, const SimulatedSequence& sequence, const SequenceRecipe& /*recipe*/,
             int frames) const override {
    const fs::path mav = folder / "mav0";
    std::string data = "#timestamp [ns],filename\n";
    for (int i = 0; i < frames; ++i) {
      const std::string name = frame_name(sequence, i);
      data.append(name).append(",").append(name).append(".png\n");
    }
    write_file(mav / "cam0" / "data.csv", data);
    write_file(mav / "cam0" / "sensor.yaml", sensor_text(sequence));
    create_folder(mav / "state_groundtruth_estimate0");
    write_file(mav / "state_groundtruth_estimate0" / "data.csv", truth_text(sequence, frames));
  }
};

}  // namespace

std::unique_ptr<SequenceLayout> make_euroc_layout() { return std::make_unique<EurocLayout>(); }

}  // namespace ldso::simulation
