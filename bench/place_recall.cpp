// How well do scores of place recognition tell the same place from another? Precision and recall over all pairs of
// frames of a sequence with ground truth, for the built-in vocabulary or given ones, without any geometric check.
//
//   place_recall SEQUENCE [--vocabulary FILE]... [--picture curve.svg] [options; --help lists them]
//
// A pair is true if the cameras were near each other and looked the same way, false if they were far apart or looked
// elsewhere; pairs in between count as neither, as do pairs that are near in time.

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "evaluation/association.h"
#include "evaluation/svg_chart.h"
#include "image/frame_preprocessor.h"
#include "io/dataset.h"
#include "ldso/error.h"
#include "odometry/selection/point_selector.h"
#include "place/default_vocabulary.h"
#include "place/orb_descriptor.h"
#include "place/vocabulary_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path sequence;
  std::vector<fs::path> vocabularies;
  fs::path picture;
  int stride = 10, gap = 100, features = 500;
  double true_distance = 0.3, true_angle = 20, false_distance = 1.5, false_angle = 60;
};

struct View {
  int frame = 0;
  SE3d T_world_camera;
  std::vector<Feature> features;
};

struct Pair {
  float score = 0;
  bool same_place = false;
};

struct Result {
  std::vector<Pair> pairs;  ///< True and false ones, best score first.
  int queries = 0;          ///< Views with an earlier one of the same place.
  int best_is_true = 0;     ///< Of these, those whose best candidate is a true one.
  int best_is_false = 0;
};

std::vector<Feature> describe_frame(const ImagePyramid& pyramid, int features) {
  constexpr int kPixelsPerCorner = 3;
  std::vector<Eigen::Vector2f> corners;
  for (const SelectedPixel& pixel : make_point_selector({})->select(pyramid, 0, kPixelsPerCorner * features)) {
    if (pixel.is_corner) corners.emplace_back(static_cast<float>(pixel.x), static_cast<float>(pixel.y));
  }
  return describe(pyramid.levels[0], corners).features;
}

std::vector<View> read_views(const Options& options) {
  DatasetOptions dataset_options;
  dataset_options.stride = options.stride;
  const auto dataset = open_dataset(options.sequence, dataset_options);
  const auto truth = dataset->ground_truth();
  if (!truth) throw Error(options.sequence.string(), "has no ground truth", "take a sequence that has");
  Trajectory times;
  for (int i = 0; i < dataset->size(); ++i) times.push_back({dataset->timestamp(i), SE3d()});
  const FramePreprocessor preprocessor(dataset->calibration(), {});
  std::vector<View> views;
  for (const PosePair& pair : associate_by_time(times, *truth, 0.03)) {
    const int i = static_cast<int>(pair.estimate);
    const PreparedFrame frame = preprocessor.process(dataset->read(i));
    views.push_back(
        {i * options.stride, (*truth)[pair.truth].T_world_camera, describe_frame(frame.pyramid, options.features)});
  }
  return views;
}

enum class Relation { kSame, kOther, kUnclear };

Relation relation(const View& a, const View& b, const Options& options) {
  const double distance = (a.T_world_camera.translation() - b.T_world_camera.translation()).norm();
  const double angle =
      (a.T_world_camera.rotation().inverse() * b.T_world_camera.rotation()).log().norm() * 180 / std::numbers::pi;
  if (distance < options.true_distance && angle < options.true_angle) return Relation::kSame;
  if (distance > options.false_distance || angle > options.false_angle) return Relation::kOther;
  return Relation::kUnclear;
}

Result compare_all(const std::vector<View>& views, const Vocabulary& vocabulary, const Options& options) {
  std::vector<BowVector> vectors;
  for (const View& view : views) vectors.push_back(vocabulary.transform(view.features));
  Result result;
  for (std::size_t i = 0; i < views.size(); ++i) {
    float best = 0;
    Relation best_relation = Relation::kUnclear;
    bool was_here = false;
    for (std::size_t j = 0; j < i && views[j].frame + options.gap < views[i].frame; ++j) {
      const float s = score(vectors[i], vectors[j]);
      const Relation r = relation(views[i], views[j], options);
      was_here = was_here || r == Relation::kSame;
      if (r != Relation::kUnclear) result.pairs.push_back({s, r == Relation::kSame});
      if (s <= best) continue;
      best = s;
      best_relation = r;
    }
    if (!was_here) continue;
    ++result.queries;
    result.best_is_true += best_relation == Relation::kSame;
    result.best_is_false += best_relation == Relation::kOther;
  }
  // Of equal scores the false ones first: no credit for ties.
  std::sort(result.pairs.begin(), result.pairs.end(), [](const Pair& a, const Pair& b) {
    return a.score != b.score ? a.score > b.score : a.same_place < b.same_place;
  });
  return result;
}

/// (recall, precision) after each pair, best score first.
Polyline curve(const Result& result) {
  const auto total = static_cast<double>(
      std::count_if(result.pairs.begin(), result.pairs.end(), [](const Pair& pair) { return pair.same_place; }));
  Polyline points;
  double right = 0;
  for (std::size_t i = 0; i < result.pairs.size() && total > 0; ++i) {
    right += result.pairs[i].same_place;
    points.emplace_back(right / total, right / static_cast<double>(i + 1));
  }
  return points;
}

/// The greatest recall at which the precision is still `precision`.
double recall_at(const Polyline& points, double precision) {
  double recall = 0;
  for (const Eigen::Vector2d& point : points) {
    if (point.y() >= precision) recall = std::max(recall, point.x());
  }
  return recall;
}

/// Area below the curve: the mean precision at the true pairs.
double average_precision(const Polyline& points) {
  double area = 0, recall = 0;
  for (const Eigen::Vector2d& point : points) {
    area += (point.x() - recall) * point.y();
    recall = point.x();
  }
  return area;
}

double mean_score(const Result& result, bool same_place) {
  double sum = 0, count = 0;
  for (const Pair& pair : result.pairs) {
    if (pair.same_place != same_place) continue;
    sum += static_cast<double>(pair.score);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

void print(const std::string& name, const Result& result, const Polyline& points) {
  const auto same = std::count_if(result.pairs.begin(), result.pairs.end(), [](const Pair& p) { return p.same_place; });
  std::printf("%s\n  pairs: %td true (mean score %.4f), %td false (%.4f)\n", name.c_str(), same,
              mean_score(result, true), static_cast<std::ptrdiff_t>(result.pairs.size()) - same,
              mean_score(result, false));
  std::printf("  recall at precision 100 %%: %.1f %%, 99 %%: %.1f %%, 90 %%: %.1f %%; average precision %.3f\n",
              100 * recall_at(points, 1), 100 * recall_at(points, 0.99), 100 * recall_at(points, 0.9),
              average_precision(points));
  std::printf("  of %d views at a place seen before the best candidate is true for %d, false for %d\n", result.queries,
              result.best_is_true, result.best_is_false);
}

void draw(const fs::path& path, const std::vector<Polyline>& curves, const std::vector<std::string>& names) {
  const std::vector<std::string> colours{"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#8c564b"};
  SvgChart chart({60, 20, 520, 400}, {0, 1}, {0, 1.02});
  chart.add_axes("recall", "precision");
  std::string labels;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::string& colour = colours[i % colours.size()];
    chart.add_line(curves[i], {.colour = colour, .dash = {}});
    labels += svg_text(75, 400 - 16 * static_cast<double>(i), names[i], 12, "start", "fill=\"" + colour + "\"");
  }
  std::ofstream file(path, std::ios::binary);
  file << R"(<svg xmlns="http://www.w3.org/2000/svg" width="620" height="480" font-family="sans-serif">)"
       << R"(<rect width="620" height="480" fill="white"/>)" << chart.svg() << labels << "</svg>\n";
  file.close();
  if (!file) throw Error(path.string(), "cannot be written", "check that the folder exists");
}

void run(const Options& options) {
  const std::vector<View> views = read_views(options);
  std::printf("%zu views\n", views.size());
  std::vector<Polyline> curves;
  std::vector<std::string> names;
  const auto add = [&](const std::string& name, const Vocabulary& vocabulary) {
    const Result result = compare_all(views, vocabulary, options);
    curves.push_back(curve(result));
    names.push_back(name);
    print(name, result, curves.back());
  };
  if (options.vocabularies.empty()) add("built-in vocabulary", default_vocabulary());
  for (const fs::path& path : options.vocabularies) add(path.filename().string(), read_vocabulary(path));
  if (!options.picture.empty()) draw(options.picture, curves, names);
}

}  // namespace
}  // namespace ldso

int main(int argc, char** argv) {
  CLI::App app("Precision and recall of place recognition on a sequence with ground truth", "place_recall");
  ldso::Options options;
  app.add_option("sequence", options.sequence, "Sequence with ground truth")->required();
  app.add_option("--vocabulary", options.vocabularies, "Vocabulary file; can be repeated (default: built in)");
  app.add_option("--picture", options.picture, "Draw the curves into this SVG file");
  app.add_option("--stride", options.stride, "Use every n-th frame")->capture_default_str();
  app.add_option("--gap", options.gap, "Pairs nearer in time than so many frames do not count")->capture_default_str();
  app.add_option("--features", options.features, "Corners of a frame, at most")->capture_default_str();
  app.add_option("--true-distance", options.true_distance, "A true pair is nearer than this [m]")
      ->capture_default_str();
  app.add_option("--true-angle", options.true_angle, "... and turned by less than this [deg]")->capture_default_str();
  app.add_option("--false-distance", options.false_distance, "A false pair is farther apart than this [m]")
      ->capture_default_str();
  app.add_option("--false-angle", options.false_angle, "... or turned by more than this [deg]")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    ldso::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
