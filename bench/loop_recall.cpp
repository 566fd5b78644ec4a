// Which returns to a place does loop closing miss, and where do they get lost? Runs a sequence with ground truth and
// prints the stretches in which a keyframe sees what one from before saw, the share of them that ended with an accepted
// loop, wrong loops, what became of the candidates, and of pairs of views how many corners were described, seen again
// and matched.
//
//   loop_recall SEQUENCE... [--reverse] [--truth FILE] [--set KEY=VALUE]... [options; --help lists them]
//
// Two keyframes see the same if their views overlap (view_overlap.h, at the median depth by the map in the truth's
// unit) and are turned by little, lie some seconds apart and never shared a window. Stretches longer than a few seconds
// are cut: a long way along a known place has to close several loops. Times are the processor's, not the wall's.
// Exit code 1 if an accepted loop is wrong.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "keyframe_run.h"
#include "ldso/error.h"
#include "ldso/io/settings_file.h"
#include "match_truth.h"
#include "revisits.h"

namespace ldso {
namespace {

struct Options {
  std::vector<std::filesystem::path> sequences;
  std::vector<std::string> assignments;
  KeyframeRunOptions run;
  RevisitOptions revisits;
  double radius = 4;
  bool list = false;
};

/// What became of candidates that show the same place, and of the others.
void print_fates(const KeyframeRun& run, const RevisitOptions& options) {
  std::map<std::string, std::pair<int, int>> fates;
  for (const LoopRecord& record : run.records) {
    const std::string fate = record.accepted ? "accepted" : record.reason.substr(0, record.reason.find(':'));
    const bool same = sees_same(run, index_of(run, record.candidate_id), index_of(run, record.keyframe_id), options);
    ++(same ? fates[fate].first : fates[fate].second);
  }
  std::printf("  %-50s %12s %8s\n", "candidates", "same place", "others");
  for (const auto& [fate, count] : fates) std::printf("  %-50s %12d %8d\n", fate.c_str(), count.first, count.second);
}

void print_matches(const KeyframeRun& run, const Options& options) {
  MatchCounts sum;
  for (int i = 0; i < static_cast<int>(run.keyframes.size()); ++i) {
    const auto best = best_revisited(run, i, options.revisits);
    if (best) sum += count_matches(run, *best, i, options.run.settings.loops.matching, options.radius);
  }
  const double n = std::max(1, sum.pairs);
  std::printf("  %d pairs of views: corners %.0f and %.0f; points in view %.1f, seen again %.1f, alike %.1f\n",
              sum.pairs, sum.corners_a / n, sum.corners_b / n, sum.points / n, sum.repeated / n, sum.alike / n);
  std::printf("  matches %.1f, right %.1f: precision %.2f, recall %.2f\n", sum.matches / n, sum.right / n,
              sum.precision(), sum.recall());
}

void list_records(const KeyframeRun& run, const RevisitOptions& options) {
  for (const LoopRecord& r : run.records) {
    const int a = index_of(run, r.candidate_id), b = index_of(run, r.keyframe_id);
    const auto wrong = r.inliers > 0 ? is_wrong(run, r, options) : std::optional<bool>();
    std::printf("    %5lld %5lld %s score %.3f matches %3d pnp %3d inliers %3d of depth %3d patches %3d %s %s\n",
                static_cast<long long>(r.keyframe_id), static_cast<long long>(r.candidate_id),
                sees_same(run, a, b, options) ? "same " : "other", r.score, r.descriptor_matches, r.pnp_inliers,
                r.inliers, r.depth_inliers, r.patch_inliers,
                !wrong   ? ""
                : *wrong ? "WRONG"
                         : "right",
                r.accepted ? "accepted" : r.reason.c_str());
  }
}

/// Of the run's accepted loops.
int count_wrong(const KeyframeRun& run, const RevisitOptions& options) {
  return static_cast<int>(std::count_if(run.records.begin(), run.records.end(), [&](const LoopRecord& record) {
    return record.accepted && is_wrong(run, record, options).value_or(false);
  }));
}

bool measure(const Options& options) {
  const KeyframeRun run = run_keyframes(options.run);
  const std::vector<Stretch> stretches = find_stretches(run, options.revisits);
  const auto closed = std::count_if(stretches.begin(), stretches.end(), [](const Stretch& s) { return s.closed; });
  const auto accepted =
      std::count_if(run.records.begin(), run.records.end(), [](const LoopRecord& r) { return r.accepted; });
  const int wrong = count_wrong(run, options.revisits);
  std::printf("%s%s\n", options.run.sequence.filename().string().c_str(), options.run.reverse ? " reversed" : "");
  std::printf("  %zu keyframes, %zu stretches, %td closed (%.0f %%); loops %td, wrong %d\n", run.keyframes.size(),
              stretches.size(), closed, 100.0 * closed / std::max<double>(1, stretches.size()), accepted, wrong);
  std::printf("  ATE of keyframes %.4f m, after loops %.4f m; describe %.2f ms, close %.2f ms a keyframe\n",
              run.ate_before, run.ate_after, run.describe_ms, run.close_ms);
  print_fates(run, options.revisits);
  print_matches(run, options);
  if (options.list) list_records(run, options.revisits);
  if (options.list) {
    for (const Stretch& s : stretches) {
      std::printf("    stretch %lld..%lld %s\n", static_cast<long long>(s.first_frame),
                  static_cast<long long>(s.last_frame), s.closed ? "closed" : "missed");
    }
  }
  std::fflush(stdout);
  return wrong == 0;
}

bool run(Options options) {
  set_settings(options.run.settings, options.assignments);
  bool all_right = true;
  for (const auto& sequence : options.sequences) {
    options.run.sequence = sequence;
    all_right = measure(options) && all_right;
  }
  return all_right;
}

}  // namespace
}  // namespace ldso

int main(int argc, char** argv) {
  CLI::App app("Returns to a place that loop closing finds and misses, by the truth", "loop_recall");
  ldso::Options options;
  options.run.settings.threads = 1;
  app.add_option("sequences", options.sequences, "Sequences with ground truth")->required();
  app.add_option("--truth", options.run.truth, "Another ground truth (TUM format) than the sequence's own");
  app.add_flag("--reverse", options.run.reverse, "Play from the last frame to the first");
  app.add_option("--start", options.run.start, "First frame");
  app.add_option("--set", options.assignments, "One setting, KEY=VALUE; can be repeated");
  app.add_option("--overlap", options.revisits.overlap, "Of two views of one place, at least")->capture_default_str();
  app.add_option("--angle", options.revisits.angle_deg, "Between them, at most [deg]")->capture_default_str();
  app.add_option("--seconds", options.revisits.seconds, "Between them, at least")->capture_default_str();
  app.add_option("--longest", options.revisits.longest, "Longer stretches are cut [s]")->capture_default_str();
  app.add_option("--radius", options.radius, "How far from its true place a match may lie [px]")->capture_default_str();
  app.add_flag("--list", options.list, "All candidates and stretches, too");
  CLI11_PARSE(app, argc, argv);
  try {
    return ldso::run(options) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
