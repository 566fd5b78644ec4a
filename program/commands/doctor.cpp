#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "camera/camera_stream.h"
#include "commands/commands.h"
#include "doctor/diagnosis.h"
#include "doctor/preview.h"
#include "io/images/image_file.h"
#include "io/text/json_text.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"
#include "ldso/io/dataset.h"
#include "output/run_files.h"
#include "terminal/dataset_options.h"
#include "terminal/option_checks.h"
#include "terminal/progress_bar.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

struct DoctorArguments {
  fs::path sequence;
  DatasetOptions dataset;
  int trial = 300;
  bool json = false;
  std::optional<fs::path> out;
};

constexpr const char* kJsonName = "doctor.json";
constexpr const char* kPreviewName = "preview.png";
constexpr const char* kMaskName = "mask.png";

/// The folder for the files, if they are wanted; nothing of somebody else is in the way there.
std::optional<OutputFolder> open_doctor_folder(const DoctorArguments& a) {
  if (!a.out) return std::nullopt;
  refuse_output_in_input(*a.out, a.sequence, {});
  OutputFolder out(*a.out);
  out.check({kJsonName, kPreviewName, kMaskName});
  for (const char* name : {kJsonName, kPreviewName, kMaskName}) out.remove(name);
  return out;
}

void write_preview(OutputFolder& out, const Dataset& dataset) {
  const FramePreprocessor preprocessor(dataset.calibration(), PhotometrySettings());
  const RawFrame frame = dataset.read(dataset.size() / 2);
  write_png(out.file(kPreviewName), draw_preview(frame, preprocessor).view());
}

void write_mask(OutputFolder& out, const Image<std::uint8_t>& mask) {
  if (mask.empty()) return;
  Image<float> grey(mask.width(), mask.height());
  std::copy_n(mask.data(), mask.size(), grey.data());
  write_grey_png(out.file(kMaskName), grey.view());
}

Diagnosis diagnose(const DoctorArguments& a, std::optional<OutputFolder>& out) {
  const std::string name = a.sequence.lexically_normal().string();
  std::unique_ptr<Dataset> dataset;
  try {
    dataset = open_dataset(a.sequence, a.dataset);
  } catch (const Error& error) {
    return unopened(name, error.what());
  }
  ProgressBar bar(a.json, 1000000);
  Diagnosis diagnosis = examine(*dataset, name, a.trial,
                                [&](const std::string& stage, int done, int count) { bar.update(done, count, stage); });
  if (out) {
    write_preview(*out, *dataset);
    write_mask(*out, diagnosis.mask);
  }
  return diagnosis;
}

void run_doctor(const DoctorArguments& a, int& exit_code) {
  if (camera_of(a.sequence.string()))
    throw Error(a.sequence.string(), "is a camera, which is not looked at", "record some seconds and give the file");
  std::optional<OutputFolder> out = open_doctor_folder(a);
  const Diagnosis diagnosis = diagnose(a, out);
  const std::string json = json_text(diagnosis_json(diagnosis), 2) + "\n";
  if (out) write_file(out->file(kJsonName), json);
  std::cout << (a.json ? json : diagnosis_text(diagnosis));
  exit_code = exit_code_of(diagnosis);
}

}  // namespace

void add_doctor_command(CLI::App& app, int& exit_code) {
  const auto a = std::make_shared<DoctorArguments>();
  CLI::App* command = app.add_subcommand("doctor", "Say what is wrong with a sequence, and what to do");
  command->add_option("sequence", a->sequence, "Folder, video file or ROS bag, whose format is recognized")->required();
  add_dataset_options(*command, a->dataset);
  command
      ->add_option("--trial", a->trial,
                   "Frames at the beginning that are run to judge motion, calibration and shutter (0: none)")
      ->check(number_from_zero())
      ->capture_default_str();
  command->add_flag("--json", a->json, "Findings and the figures behind them as JSON");
  command->add_option("-o,--out", a->out,
                      "Folder for doctor.json, preview.png (a frame beside itself rectified: what is straight in the "
                      "world must be straight there) and, if something is drawn over the images, mask.png for --mask");
  command->callback([a, &exit_code] { run_doctor(*a, exit_code); });
}

}  // namespace ldso
