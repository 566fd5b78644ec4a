#include "io/datasets/test_sequences.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <zip.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "io/images/image_file.h"
#include "ldso/error.h"

namespace ldso {

namespace fs = std::filesystem;

namespace {

std::string numbered(const char* format, int index) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, index);
  return buffer;
}

std::string tum_truth(int count) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (int i = 0; i < count; ++i) text += std::to_string(0.1 * i) + numbered(" %d 0 0 0 0 0 1\n", i);
  return text;
}

std::string tum_mono_times(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += numbered("%05d ", i) + std::to_string(0.1 * i) + " 2.5\n";
  return text;
}

cv::Mat test_picture(int index) {
  const Image<float> frame = test_frame(index);
  cv::Mat image(kTestHeight, kTestWidth, CV_8UC3);
  for (int y = 0; y < kTestHeight; ++y) {
    for (int x = 0; x < kTestWidth; ++x)
      image.at<cv::Vec3b>(y, x) = cv::Vec3b::all(cv::saturate_cast<uchar>(frame(x, y)));
  }
  return image;
}

/// The bytes of a number, the highest first.
std::string big_endian(std::uint64_t value, int count) {
  std::string bytes;
  for (int i = count - 1; i >= 0; --i) bytes += static_cast<char>(value >> (8 * i));
  return bytes;
}

/// An element of Matroska: its name, which knows its own length, and what it holds.
std::string ebml(std::uint32_t name, const std::string& content) {
  const int length = name > 0xffffff ? 4 : name > 0xffff ? 3 : name > 0xff ? 2 : 1;
  return big_endian(name, length) + big_endian(0x0100000000000000ULL | content.size(), 8) + content;
}

std::string ebml(std::uint32_t name, int number) {
  return ebml(name, big_endian(static_cast<std::uint64_t>(number), 4));
}

std::string jpeg_bytes(int index) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", test_picture(index), bytes);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  static std::atomic<int> counter{0};
  path_ = fs::temp_directory_path() / ("ldso_io_test_" + std::to_string(getpid()) + "_" + std::to_string(counter++));
  fs::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code error;
  fs::remove_all(path_, error);
}

Image<float> test_frame(int index) {
  Image<float> image(kTestWidth, kTestHeight);
  for (int y = 0; y < kTestHeight; ++y) {
    for (int x = 0; x < kTestWidth; ++x) image(x, y) = static_cast<float>(10 * index + x + y);
  }
  return image;
}

void write_text(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream stream(path, std::ios::binary);
  stream << text;
  ASSERT_TRUE(stream.good()) << path;
}

void write_frame(const fs::path& path, int index) {
  fs::create_directories(path.parent_path());
  const Image<float> frame = test_frame(index);
  write_grey_png(path, frame.view());
}

fs::path make_tum_mono(const fs::path& folder, int count) {
  for (int i = 0; i < count; ++i) write_frame(folder / "images" / numbered("%05d.png", i), i);
  write_text(folder / "times.txt", tum_mono_times(count));
  write_text(folder / "camera.txt", kTestCamera);
  write_text(folder / "groundtruth.txt", tum_truth(count));
  return folder;
}

fs::path make_tum_mono_zip(const fs::path& folder, int count) {
  make_tum_mono(folder, count);
  int error = 0;
  zip_t* archive = zip_open((folder / "images.zip").c_str(), ZIP_CREATE, &error);
  for (int i = 0; i < count; ++i) {
    const std::string name = numbered("%05d.png", i);
    const fs::path file = folder / "images" / name;
    zip_source_t* source = zip_source_file(archive, file.c_str(), 0, -1);
    EXPECT_GE(zip_file_add(archive, ("images/" + name).c_str(), source, ZIP_FL_OVERWRITE), 0);
  }
  EXPECT_EQ(zip_close(archive), 0);
  fs::remove_all(folder / "images");
  return folder;
}

fs::path make_kitti(const fs::path& folder, int count) {
  fs::path sequence = folder / "sequences" / "07";
  std::string times;
  std::string poses;
  for (int i = 0; i < count; ++i) {
    write_frame(sequence / "image_0" / numbered("%06d.png", i), i);
    times += std::to_string(0.1 * i) + "\n";
    poses += numbered("1 0 0 %d 0 1 0 0 0 0 1 0\n", i);
  }
  write_text(sequence / "times.txt", times);
  write_text(sequence / "calib.txt", "P0: 40 0 15.5 0 0 41 11.5 0 0 0 1 0\nP2: 40 0 15.5 20 0 41 11.5 0 0 0 1 0\n");
  write_text(folder / "poses" / "07.txt", poses);
  return sequence;
}

fs::path make_euroc(const fs::path& folder, int count) {
  const fs::path mav = folder / "mav0";
  std::string frames = "#timestamp [ns],filename\n";
  // The body stands so that the camera, whose T_BS turns by 90 degrees about z and shifts by y = 1, is at x = i.
  std::string truth = "#timestamp, p_RS_R_x [m], ...\n";
  for (int i = 0; i < count; ++i) {
    const std::string time = std::to_string(std::int64_t{1403715273000000000} + std::int64_t{100000000} * i);
    frames.append(time).append(",").append(time).append(".png\r\n");
    truth.append(time).append(numbered(",%d,-1,0,1,0,0,0,0,0,0\n", i));
    write_frame(mav / "cam0" / "data" / (time + ".png"), i);
  }
  write_text(mav / "cam0" / "data.csv", frames);
  write_text(mav / "state_groundtruth_estimate0" / "data.csv", truth);
  write_text(mav / "cam0" / "sensor.yaml",
             "%YAML:1.0\n# sensor\nT_BS:\n  cols: 4\n  rows: 4\n  data: [0.0, -1.0, 0.0, 0.0,\n"
             "  1.0, 0.0, 0.0, 1.0,\n  0.0, 0.0, 1.0, 0.0,\n  0.0, 0.0, 0.0, 1.0]\n"
             "resolution: [32, 24]\ncamera_model: pinhole\nintrinsics: [40, 41, 15.5, 11.5] #fu, fv, cu, cv\n"
             "distortion_model: radial-tangential\ndistortion_coefficients: [-0.28, 0.07, 0.0002, 1.7e-05]\n");
  return folder;
}

fs::path make_tum_rgbd(const fs::path& folder, int count) {
  std::string list = "# color images\n# timestamp filename\n";
  for (int i = 0; i < count; ++i) {
    const std::string name = numbered("rgb/%d.png", i);
    write_frame(folder / name, i);
    list += std::to_string(0.1 * i) + " " + name + "\n";
  }
  write_text(folder / "rgb.txt", list);
  write_text(folder / "camera.txt", kTestCamera);
  write_text(folder / "groundtruth.txt", tum_truth(count));
  return folder;
}

fs::path make_image_folder(const fs::path& folder, int count) {
  for (int i = 0; i < count; ++i) write_frame(folder / numbered("shot%d.png", i), i);
  write_text(folder / "camera.txt", kTestCamera);
  return folder;
}

fs::path make_video(const fs::path& folder, int count) {
  fs::path file = folder / "drive.avi";
  cv::VideoWriter writer(file.string(), cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10.0,
                         cv::Size(kTestWidth, kTestHeight));
  EXPECT_TRUE(writer.isOpened());
  for (int i = 0; i < count; ++i) writer.write(test_picture(i));
  writer.release();
  write_text(folder / "camera.txt", kTestCamera);
  return file;
}

fs::path make_matroska(const fs::path& folder, const std::vector<int>& times_ms) {
  const std::string unknown_size = "\x01\xff\xff\xff\xff\xff\xff\xff";
  std::string text = ebml(0x1A45DFA3, ebml(0x4286, 1) + ebml(0x42F7, 1) + ebml(0x42F2, 4) + ebml(0x42F3, 8) +
                                          ebml(0x4282, "matroska") + ebml(0x4287, 4) + ebml(0x4285, 2));
  text += big_endian(0x18538067, 4) + unknown_size;                                                 // Segment
  text += ebml(0x1549A966, ebml(0x2AD7B1, 1000000) + ebml(0x4D80, "ldso") + ebml(0x5741, "ldso"));  // Unit: 1 ms
  const std::string track = ebml(0xD7, 1) + ebml(0x73C5, 1) + ebml(0x83, 1) + ebml(0x86, "V_MJPEG") +
                            ebml(0xE0, ebml(0xB0, kTestWidth) + ebml(0xBA, kTestHeight));
  text += ebml(0x1654AE6B, ebml(0xAE, track));
  text += big_endian(0x1F43B675, 4) + unknown_size + ebml(0xE7, 0);  // Cluster
  for (std::size_t i = 0; i < times_ms.size(); ++i) {
    const std::string time = big_endian(static_cast<std::uint64_t>(times_ms[i]), 2);
    text += ebml(0xA3, "\x81" + time + "\x80" + jpeg_bytes(static_cast<int>(i)));
  }
  write_text(folder / "stream.mkv", text);
  write_text(folder / "camera.txt", kTestCamera);
  return folder / "stream.mkv";
}

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "an ldso::Error was expected";
  return "";
}

}  // namespace ldso
