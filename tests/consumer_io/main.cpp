// How a program uses ldso's files without its SLAM: a calibration and a sequence in, a trajectory and a cloud out.
//
//   consumer FOLDER   makes a small sequence there, and reads it

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/dataset.h"
#include "ldso/io/ply_file.h"
#include "ldso/io/trajectory_file.h"

namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 3;
constexpr int kWidth = 32;
constexpr int kHeight = 24;

// Images as PGM: a title, then the grey levels. The frame's number is the level of all its pixels.
void make_sequence(const fs::path& folder) {
  fs::create_directories(folder / "images");
  std::ofstream(folder / "camera.txt") << "Pinhole 30 30 15.5 11.5 0\n32 24\nnone\n32 24\n";
  std::ofstream times(folder / "times.txt");
  for (int i = 0; i < kFrames; ++i) {
    const std::string name = "0000" + std::to_string(i);
    std::ofstream(folder / "images" / (name + ".pgm"), std::ios::binary)
        << "P5\n"
        << kWidth << " " << kHeight << "\n255\n"
        << std::string(kWidth * kHeight, static_cast<char>(i + 1));
    times << name << " " << 0.1 * i << "\n";
  }
}

bool is_as_it_was(const fs::path& folder) {
  const ldso::Calibration calibration = ldso::read_camera_calibration(folder / "camera.txt");
  const auto dataset = ldso::open_dataset(folder);
  std::printf("%s, %s, %d frames\n", dataset->format_name().c_str(), calibration.description.c_str(), dataset->size());
  if (calibration.camera.fx != 30 || dataset->size() != kFrames) return false;
  const ldso::RawFrame frame = dataset->read(kFrames - 1);

  const ldso::Trajectory trajectory{{dataset->timestamp(1), ldso::SE3d(ldso::SO3d(), {1, 2, 3})}};
  ldso::write_tum_trajectory(folder / "trajectory.txt", trajectory);
  ldso::write_ply(folder / "cloud.ply", {{1, 2, 3, 200, 0.5f}});
  const ldso::Trajectory poses = ldso::read_tum_trajectory(folder / "trajectory.txt");
  const auto points = ldso::read_ply(folder / "cloud.ply");
  return frame.grey(0, 0) == kFrames && poses.size() == 1 && poses[0].T_world_camera.translation().z() == 3 &&
         points.size() == 1 && points[0].intensity == 200;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    make_sequence(argv[1]);
    return is_as_it_was(argv[1]) ? 0 : 1;
  } catch (const ldso::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
