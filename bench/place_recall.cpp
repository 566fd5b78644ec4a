// How well do scores of place recognition tell the same place from another? Precision and recall over all pairs of
// frames of a sequence with ground truth, for the built-in vocabulary or given ones, without any geometric check.
//
//   place_recall SEQUENCE [--vocabulary FILE]... [--picture curve.svg] [options; --help lists them]
//
// A pair is true if, by the true poses, both saw much of the same from about the same side: the overlap of their views
// (view_overlap.h) at the depth that most corners have, which true poses and matches with the next view tell. It is
// false if they saw nothing of the same or looked another way; pairs in between count as neither, as do pairs that are
// near in time.

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/association.h"
#include "evaluation/svg_chart.h"
#include "image/frame_preprocessor.h"
#include "ldso/error.h"
#include "ldso/io/dataset.h"
#include "odometry/selection/point_selector.h"
#include "place/default_vocabulary.h"
#include "place/orb_descriptor.h"
#include "place/vocabulary_file.h"
#include "view_overlap.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path sequence;
  std::vector<fs::path> vocabularies;
  fs::path picture;
  int stride = 10, gap = 100, features = 500;
  double true_overlap = 0.4, true_angle = 30, false_overlap = 0.05, false_angle = 90;
  double max_time_difference = 0.03;
  std::optional<double> depth;
};

struct View {
  int frame = 0;
  SE3d T_world_camera;
  std::vector<Feature> features;
  double depth = 0;  ///< Typical one [m].
};

struct Sequence {
  std::vector<View> views;
  PinholeIntrinsics camera;
  double depth = 0;  ///< Median of the views'.
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

/// Fills in the depths of all views.
void find_depths(const Options& options, Sequence& sequence) {
  std::vector<View>& views = sequence.views;
  std::vector<double> known;
  for (std::size_t i = 0; i < views.size() && !options.depth; ++i) {
    const View& other = views[i + 1 < views.size() ? i + 1 : i - 1];
    const SE3d T_other_view = other.T_world_camera.inverse() * views[i].T_world_camera;
    const auto depth = median_depth(views[i].features, other.features, T_other_view, sequence.camera);
    if (!depth) continue;
    views[i].depth = *depth;
    known.push_back(*depth);
  }
  if (known.empty() && !options.depth) {
    throw Error(options.sequence.string(), "consecutive views show no depth", "give a shorter --stride, or --depth");
  }
  std::sort(known.begin(), known.end());
  sequence.depth = options.depth ? *options.depth : known[known.size() / 2];
  for (View& view : views) view.depth = view.depth > 0 ? view.depth : sequence.depth;
}

Sequence read_sequence(const Options& options) {
  DatasetOptions dataset_options;
  dataset_options.stride = options.stride;
  const auto dataset = open_dataset(options.sequence, dataset_options);
  const auto truth = dataset->ground_truth();
  if (!truth) throw Error(options.sequence.string(), "has no ground truth", "take a sequence that has");
  Trajectory times;
  for (int i = 0; i < dataset->size(); ++i) times.push_back({dataset->timestamp(i), SE3d()});
  const FramePreprocessor preprocessor(dataset->calibration(), {});
  Sequence sequence;
  sequence.camera = preprocessor.output_camera();
  for (const PosePair& pair : associate_by_time(times, *truth, options.max_time_difference)) {
    const int i = static_cast<int>(pair.estimate);
    const PreparedFrame frame = preprocessor.process(dataset->read(i));
    sequence.views.push_back(
        {i * options.stride, (*truth)[pair.truth].T_world_camera, describe_frame(frame.pyramid, options.features)});
  }
  if (sequence.views.size() < 2) throw Error(options.sequence.string(), "has too few poses", "give a shorter --stride");
  find_depths(options, sequence);
  return sequence;
}

enum class Relation { kSame, kOther, kUnclear };

Relation relation(const View& a, const View& b, const PinholeIntrinsics& camera, const Options& options) {
  const SE3d T_b_a = b.T_world_camera.inverse() * a.T_world_camera;
  const double angle = T_b_a.rotation().log().norm() * 180 / std::numbers::pi;
  const double of_a = overlap(T_b_a, a.depth, camera), of_b = overlap(T_b_a.inverse(), b.depth, camera);
  if (std::min(of_a, of_b) >= options.true_overlap && angle <= options.true_angle) return Relation::kSame;
  if (std::max(of_a, of_b) <= options.false_overlap || angle >= options.false_angle) return Relation::kOther;
  return Relation::kUnclear;
}

Result compare_all(const Sequence& sequence, const Vocabulary& vocabulary, const Options& options) {
  const std::vector<View>& views = sequence.views;
  std::vector<BowVector> vectors;
  for (const View& view : views) vectors.push_back(vocabulary.transform(view.features));
  Result result;
  for (std::size_t i = 0; i < views.size(); ++i) {
    float best = 0;
    Relation best_relation = Relation::kUnclear;
    bool was_here = false;
    for (std::size_t j = 0; j < i && views[j].frame + options.gap < views[i].frame; ++j) {
      const float s = score(vectors[i], vectors[j]);
      const Relation r = relation(views[i], views[j], sequence.camera, options);
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
  SvgChart chart({80, 20, 520, 400}, {0, 1}, {0, 1.02});
  chart.add_axes("recall", "precision");
  std::string labels;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::string& colour = colours[i % colours.size()];
    chart.add_line(curves[i], {.colour = colour, .dash = {}});
    labels += svg_text(95, 400 - 16 * static_cast<double>(i), names[i], 12, "start", "fill=\"" + colour + "\"");
  }
  std::ofstream file(path, std::ios::binary);
  file << R"(<svg xmlns="http://www.w3.org/2000/svg" width="630" height="480" font-family="sans-serif">)"
       << R"(<rect width="630" height="480" fill="white"/>)" << chart.svg() << labels << "</svg>\n";
  file.close();
  if (!file) throw Error(path.string(), "cannot be written", "check that the folder exists");
}

void run(const Options& options) {
  const Sequence sequence = read_sequence(options);
  std::printf("%zu views, median depth %.3g m\n", sequence.views.size(), sequence.depth);
  std::vector<Polyline> curves;
  std::vector<std::string> names;
  const auto add = [&](const std::string& name, const Vocabulary& vocabulary) {
    const Result result = compare_all(sequence, vocabulary, options);
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
  app.add_option("--depth", options.depth, "Typical depth [m] (default: of each view, by triangulation)")
      ->check(CLI::PositiveNumber);
  app.add_option("--true-overlap", options.true_overlap, "The views of a true pair overlap by this share at least")
      ->capture_default_str();
  app.add_option("--true-angle", options.true_angle, "... and are turned by at most this [deg]")->capture_default_str();
  app.add_option("--false-overlap", options.false_overlap, "The views of a false pair overlap by this at most")
      ->capture_default_str();
  app.add_option("--false-angle", options.false_angle, "... or are turned by at least this [deg]")
      ->capture_default_str();
  app.add_option("--max-diff", options.max_time_difference, "Largest time difference of frame and ground truth [s]")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    ldso::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
