#include "commands/commands.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "commands/training_images.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"
#include "odometry/selection/point_selector.h"
#include "place/default_vocabulary.h"
#include "place/orb_descriptor.h"
#include "place/vocabulary_file.h"
#include "place/vocabulary_trainer.h"
#include "terminal/option_checks.h"
#include "terminal/progress_bar.h"
#include "util/format_text.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

struct TrainArguments {
  std::vector<fs::path> inputs;
  fs::path output;
  TrainingOptions training;
  int features_per_image = 500, stride = 1, threads = 2;
  bool quiet = false;
};

struct ConvertArguments {
  fs::path input, output;
};

void add_train_options(CLI::App& command, TrainArguments& a) {
  command.add_option("images", a.inputs, "Sequences, folders of images or image files")->required();
  command.add_option("-o,--output", a.output, "Vocabulary file to write")->required();
  command.add_option("--branching", a.training.branching, "Children of a node")
      ->check(CLI::Range(2, 255))
      ->capture_default_str();
  command.add_option("--depth", a.training.depth, "Levels; at most branching^depth words")
      ->check(CLI::Range(1, Vocabulary::kMaxDepth))
      ->capture_default_str();
  command
      .add_option("--least-descriptors", a.training.least_descriptors,
                  "A node of fewer training descriptors is a word, however deep")
      ->check(CLI::Range(2, 1 << 30))
      ->capture_default_str();
  command.add_option("--seed", a.training.seed, "Of the random choices")->capture_default_str();
  command.add_option("--features-per-image", a.features_per_image, "Corners described in an image, at most")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command.add_option("--stride", a.stride, "Use every n-th image of a sequence or folder")
      ->check(positive_number())
      ->capture_default_str();
  command.add_option("--threads", a.threads, "Threads; the result does not depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command.add_flag("--quiet", a.quiet, "Print warnings only");
}

/// The corners that the odometry would choose, described.
std::vector<OrbDescriptor> describe_corners(const ImagePyramid& pyramid, int features) {
  constexpr int kPixelsPerCorner = 3;  // Of the selected pixels the third part is corners.
  const auto selector = make_point_selector(SelectionSettings{});
  std::vector<Eigen::Vector2f> corners;
  for (const SelectedPixel& pixel : selector->select(pyramid, 0, kPixelsPerCorner * features)) {
    if (pixel.is_corner) corners.emplace_back(static_cast<float>(pixel.x), static_cast<float>(pixel.y));
  }
  std::vector<OrbDescriptor> descriptors;
  for (const Feature& feature : describe(pyramid.levels[0], corners).features)
    descriptors.push_back(feature.descriptor);
  return descriptors;
}

/// An unreadable image is left out with a warning.
std::vector<std::vector<OrbDescriptor>> describe_all(const TrainArguments& a, const TrainingImages& images,
                                                     ThreadPool& pool, ProgressBar& bar) {
  std::vector<std::vector<OrbDescriptor>> descriptors(static_cast<std::size_t>(images.size()));
  std::vector<std::string> problems(descriptors.size());
  const int batch = 4 * pool.threads();
  for (int first = 0; first < images.size(); first += batch) {
    const int count = std::min(batch, images.size() - first);
    pool.run(count, [&](int chunk) {
      const int index = first + chunk;
      try {
        descriptors[index] = describe_corners(images.read(index), a.features_per_image);
      } catch (const Error& error) {
        problems[index] = error.what();
      }
    });
    for (int i = first; i < first + count; ++i) {
      if (!problems[i].empty()) bar.message(LogLevel::kWarning, "an image is left out: " + problems[i]);
    }
    const int done = first + count;
    bar.update(done, images.size(), "image " + std::to_string(done) + "/" + std::to_string(images.size()));
  }
  std::erase_if(descriptors, [](const auto& image) { return image.empty(); });
  return descriptors;
}

/// Found out before minutes of training.
void check_output(const fs::path& output) {
  std::error_code error;
  const fs::path folder = output.has_parent_path() ? output.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error))
    throw Error(output.string(), "the folder of the output does not exist", "create it first");
  if (fs::is_directory(output, error)) throw Error(output.string(), "is a folder", "name a file for the vocabulary");
  refuse_other_file(output, {kVocabularyMagic}, "a vocabulary of ldso");
}

Vocabulary train(const TrainArguments& a) {
  ThreadPool pool(a.threads);
  const TrainingImages images(a.inputs, a.stride);
  std::vector<std::vector<OrbDescriptor>> descriptors;
  {
    ProgressBar bar(a.quiet);
    for (const std::string& warning : images.warnings()) bar.message(LogLevel::kWarning, warning);
    descriptors = describe_all(a, images, pool, bar);
  }
  TrainingOptions options = a.training;
  options.origin = "ldso vocab train --branching " + std::to_string(options.branching) + " --depth " +
                   std::to_string(options.depth) + " --least-descriptors " + std::to_string(options.least_descriptors) +
                   " --features-per-image " + std::to_string(a.features_per_image) + " --seed " +
                   std::to_string(options.seed);
  ProgressBar bar(a.quiet, 10);
  return train_vocabulary(descriptors, options, pool, [&bar](double done) {
    const int percent = static_cast<int>(100 * done);
    bar.update(percent, 100, "training: " + std::to_string(percent) + " %");
  });
}

std::string description(const Vocabulary& vocabulary) {
  std::size_t weightless = 0;
  float least = vocabulary.weight(0), greatest = least;
  for (WordId word = 0; word < vocabulary.word_count(); ++word) {
    weightless += vocabulary.weight(word) <= 0;
    least = std::min(least, vocabulary.weight(word));
    greatest = std::max(greatest, vocabulary.weight(word));
  }
  const std::string text = format_text(
      "words         %zu (%zu without weight)\nnodes         %zu, at most %d children\ndepth         %d\n"
      "weights       %.3f .. %.3f\n",
      vocabulary.word_count(), weightless, vocabulary.node_count(), vocabulary.branching(), vocabulary.depth(),
      static_cast<double>(least), static_cast<double>(greatest));
  return text + ("origin        " + (vocabulary.origin().empty() ? "not told" : vocabulary.origin()) + "\n");
}

void run_train(const TrainArguments& a) {
  check_output(a.output);
  const Vocabulary vocabulary = train(a);
  write_vocabulary(a.output, vocabulary);
  if (!a.quiet) std::cout << "vocabulary    " << a.output.string() << "\n" << description(vocabulary);
}

void run_info(const std::optional<fs::path>& path) {
  const auto start = std::chrono::steady_clock::now();
  const Vocabulary vocabulary = path ? read_vocabulary(*path) : default_vocabulary();
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
  std::cout << "vocabulary    " << (path ? path->string() : "(built in)") << "\n" << description(vocabulary);
  std::cout << format_text("loaded in     %.1f ms\n", elapsed.count());
}

void run_convert(const ConvertArguments& a) {
  check_output(a.output);
  write_vocabulary(a.output, read_vocabulary(a.input));
}

}  // namespace

void add_vocab_command(CLI::App& app) {
  CLI::App* vocab = app.add_subcommand("vocab", "Train, convert or describe a vocabulary for place recognition");
  vocab->require_subcommand(1);

  CLI::App* train_command = vocab->add_subcommand("train", "Make a vocabulary of any images");
  const auto train_arguments = std::make_shared<TrainArguments>();
  add_train_options(*train_command, *train_arguments);
  train_command->callback([train_arguments] { run_train(*train_arguments); });

  CLI::App* info_command = vocab->add_subcommand("info", "What is in a vocabulary");
  const auto info_path = std::make_shared<std::optional<fs::path>>();
  info_command->add_option("file", *info_path, "Vocabulary of ldso, DBoW2 (text) or DBoW3 (binary); without: built in");
  info_command->callback([info_path] { run_info(*info_path); });

  CLI::App* convert_command = vocab->add_subcommand("convert", "Write a vocabulary of DBoW2 or DBoW3 in own format");
  const auto convert_arguments = std::make_shared<ConvertArguments>();
  convert_command->add_option("file", convert_arguments->input, "DBoW2 (text) or DBoW3 (binary)")->required();
  convert_command->add_option("-o,--output", convert_arguments->output, "Vocabulary file to write")->required();
  convert_command->callback([convert_arguments] { run_convert(*convert_arguments); });
}

}  // namespace ldso
