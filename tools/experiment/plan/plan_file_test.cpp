#include "experiment/plan/plan_file.h"

#include <gtest/gtest.h>

#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using Texts = std::vector<std::string>;

constexpr const char* kPlan = R"(title: All there is
strategies: [corners, random]
loops: [on, off]
directions: [forward, backward]
repetitions: 3
vary: seed
threads: 1
jobs: 2
settings:
  window: {iterations: 4}
  selection.candidates: 900
datasets:
  tum:
    root: data/tum
    download: https://example.org/tum
    metric: tum_mono
    needs: [images|images.zip, "../{name}.txt"]
    sequences:
      - s_01
      - {name: s_02, path: other/s2, start: 5, end: 100, stride: 2, fps: 12.5}
  kitti:
    root: /data/kitti
    path: sequences/{name}
    settings: {window.iterations: 5}
    sequences:
      - name: "00"
        calib: ../calib_{name}.txt
        ground_truth: truth.txt
        end: -4
        metric: ate
)";

ExperimentPlan parsed(const std::string& text, const Texts& roots = {}) {
  return parse_plan(text, "plan.yaml", "/plans", parse_roots(roots));
}

std::string error_of(const std::string& text, const Texts& roots = {}) {
  try {
    parsed(text, roots);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(PlanFile, EveryKeyIsRead) {
  const ExperimentPlan plan = parsed(kPlan);
  EXPECT_EQ(plan.title, "All there is");
  EXPECT_EQ(plan.directions, (std::vector<bool>{false, true}));
  EXPECT_EQ(plan.repetitions, 3);
  EXPECT_EQ(plan.vary, Vary::kSeed);
  EXPECT_EQ(plan.threads, 1);
  EXPECT_EQ(plan.jobs, 2);
  Texts variants;
  for (const PlanVariant& variant : plan.variants) variants.push_back(variant.name);
  EXPECT_EQ(variants, (Texts{"corners", "corners_no_loops", "random", "random_no_loops"}));
  EXPECT_FALSE(plan.variants[3].loops);
  EXPECT_EQ(plan.variants[3].strategy, "random");

  ASSERT_EQ(plan.sequences.size(), 3u);
  const PlanSequence &first = plan.sequences[0], &second = plan.sequences[1], &kitti = plan.sequences[2];
  EXPECT_EQ(first.path, "/plans/data/tum/s_01");
  EXPECT_EQ(first.dataset, "tum");
  EXPECT_EQ(first.metric, JobMetric::kTumMono);
  EXPECT_EQ(first.download, "https://example.org/tum");
  EXPECT_EQ(first.needs, (Texts{"images|images.zip", "../s_01.txt"}));
  EXPECT_EQ(first.settings, (Texts{"window.iterations=4", "selection.candidates=900"}));
  EXPECT_EQ(second.path, "/plans/data/tum/other/s2");
  EXPECT_EQ(second.playback.start, 5);
  EXPECT_EQ(second.playback.end, 100);
  EXPECT_EQ(second.playback.stride, 2);
  EXPECT_EQ(second.playback.fps, 12.5);
  EXPECT_EQ(kitti.path, "/data/kitti/sequences/00");
  EXPECT_EQ(kitti.playback.calibration_file, "/data/kitti/sequences/calib_00.txt");
  EXPECT_EQ(kitti.ground_truth, "/data/kitti/sequences/00/truth.txt");
  EXPECT_EQ(kitti.playback.end, -4);
  EXPECT_EQ(kitti.metric, JobMetric::kAte);
  EXPECT_EQ(kitti.settings.back(), "window.iterations=5") << "the dataset's own come last and win";
}

constexpr const char* kShort = "datasets: {tum: {root: /d, sequences: [a]}}\n";

TEST(PlanFile, Defaults) {
  const ExperimentPlan plan = parsed(kShort);
  ASSERT_EQ(plan.variants.size(), 1u);
  EXPECT_EQ(plan.variants[0].name, "corners");
  EXPECT_EQ(plan.directions, std::vector<bool>{false});
  EXPECT_EQ(plan.repetitions, 1);
  EXPECT_EQ(plan.vary, Vary::kStart);
  EXPECT_EQ(plan.sequences[0].path, "/d/a");
  EXPECT_EQ(plan.sequences[0].metric, JobMetric::kAte);
}

TEST(PlanFile, VariantsOneByOne) {
  const ExperimentPlan plan = parsed(std::string(kShort) +
                                     "variants:\n  - {strategy: gradient, loops: off}\n"
                                     "  - {name: few, settings: {selection.candidates: 300}}\n");
  ASSERT_EQ(plan.variants.size(), 2u);
  EXPECT_EQ(plan.variants[0].name, "gradient_no_loops");
  EXPECT_EQ(plan.variants[1].name, "few");
  EXPECT_EQ(plan.variants[1].strategy, "corners");
  EXPECT_TRUE(plan.variants[1].loops);
  EXPECT_EQ(plan.variants[1].settings, Texts{"selection.candidates=300"});
}

TEST(PlanFile, RootsOfTheCommandLineWin) {
  EXPECT_EQ(parsed(kShort, {"/elsewhere/"}).sequences[0].path, "/elsewhere/a");
  EXPECT_EQ(parsed(kShort, {"near"}).sequences[0].path, fs::current_path() / "near" / "a");
  const ExperimentPlan plan = parsed(kPlan, {"kitti=/x=y"});
  EXPECT_EQ(plan.sequences[0].path, "/plans/data/tum/s_01");
  EXPECT_EQ(plan.sequences[2].path, "/x=y/sequences/00");
  EXPECT_NE(error_of(kPlan, {"/x"}).find("--root tum=/x"), std::string::npos);
  EXPECT_NE(error_of(kPlan, {"kity=/x"}).find("did you mean 'kitti'?"), std::string::npos);
  EXPECT_THROW(parse_roots({"a=/x", "a=/y"}), Error);
  EXPECT_THROW(parse_roots({"/x", "/y"}), Error);
  EXPECT_THROW(parse_roots({"a="}), Error);
  EXPECT_EQ(parse_roots({"/data/a=b"}).only, "/data/a=b");
}

TEST(PlanFile, WithoutARootThePathIsUnknown) {
  const ExperimentPlan plan = parsed("datasets: {tum: {sequences: [a]}, k: {root: /k, sequences: [b]}}");
  EXPECT_TRUE(plan.sequences[0].path.empty());
  EXPECT_EQ(plan.sequences[1].path, "/k/b");
  EXPECT_EQ(parsed("root: r\ndatasets: {tum: {sequences: [a]}}").sequences[0].path, "/plans/r/a");
}

struct BadPlan {
  const char* text;
  const char* where;
  const char* remedy;
};

TEST(PlanFile, MistakesAreNamedWithTheirLine) {
  const std::vector<BadPlan> bad{
      {"repetitons: 3\n", "plan.yaml:2: unknown key 'repetitons'", "did you mean 'repetitions'?"},
      {"\n\nrepetitions: many\n", "plan.yaml:4: 'repetitions' is 'many'", "a whole number from 1 to 100000"},
      {"repetitions: 0\n", "plan.yaml:2: 'repetitions' is '0'", "from 1 to 100000"},
      {"repetitions: [1]\n", "plan.yaml:2: 'repetitions' has no single value", "`repetitions: value`"},
      {"strategies: [corners,\n  gradients]\n", "plan.yaml:3: 'strategies' is 'gradients'", "did you mean gradient?"},
      {"strategies: []\n", "plan.yaml:2: 'strategies' is empty", "at least one"},
      {"strategies: [corners, corners]\n", "plan.yaml:2", "twice"},
      {"loops: maybe\n", "plan.yaml:2: 'loops' is 'maybe'", "on or off"},
      {"loops: on\nvariants: [{strategy: random}]\n", "plan.yaml:2: 'loops' stands beside 'variants'", "remove it"},
      {"directions: sideways\n", "plan.yaml:2: 'directions' is 'sideways'", "forward or backward"},
      {"vary: weather\n", "plan.yaml:2: 'vary' is 'weather'", "start, seed or none"},
      {"settings: {windw.iterations: 3}\n", "plan.yaml:2", "did you mean 'window.iterations'?"},
      {"settings:\n  window:\n    iterations: few\n", "plan.yaml:4", "a whole number"},
      {"settings: {loops.enabled: off}\n", "plan.yaml:2: 'loops.enabled' is no setting", "the plan's key 'loops'"},
      {"settings: {window.iterations: -3}\n", "plan.yaml:2: setting window.iterations", "1 to 100"},
      {"config: nowhere.yaml\n", "plan.yaml:2: 'config' names /plans/nowhere.yaml", "check the path"},
      {"vary: none\nvary: none\n", "plan.yaml:3: 'vary' is set twice", "remove one"},
      {"threads: [\n", "plan.yaml:", "YAML is expected"},
  };
  for (const BadPlan& plan : bad) {
    const std::string error = error_of(std::string(kShort) + plan.text);
    EXPECT_NE(error.find(plan.where), std::string::npos) << plan.text << "-> " << error;
    EXPECT_NE(error.find(plan.remedy), std::string::npos) << plan.text << "-> " << error;
  }
}

TEST(PlanFile, MistakesInDatasetsAreNamedWithTheirLine) {
  const std::vector<BadPlan> bad{
      {"title: x\n", "plan.yaml:1: 'the plan' has no datasets", "sequences"},
      {"- a\n- b\n", "plan.yaml:1", "docs/experiments.md"},
      {"", "plan.yaml:1", "docs/experiments.md"},
      {"datasets:\n  tum: {root: /d}\n", "plan.yaml:2: 'tum' has no sequences", "sequences: [NAME, ..]"},
      {"datasets:\n  tum:\n    root: /d\n    sequence: [a]\n", "plan.yaml:4: unknown key", "'sequences'?"},
      {"datasets: {tum: {root: /d, sequences: [a, b,\n  a]}}\n", "plan.yaml:2: 'sequences' lists 'a' twice", "remove"},
      {"datasets: {tum: {root: /d, sequences: [../a]}}\n", "plan.yaml:1: 'sequences' is '../a'", "make a name"},
      {"datasets: {tum: {root: /d, sequences: [{start: 3}]}}\n", "without a name", "`name: NAME`"},
      {"datasets: {tum: {root: /d, sequences: [{name: a, strat: 3}]}}\n", "unknown key 'strat'", "'start'?"},
      {"datasets: {tum: {root: /d, fps: -1, sequences: [a]}}\n", "'fps' is '-1'", "above 0"},
      {"datasets: {tum: {root: /d, end: 0, sequences: [a]}}\n", "'end' leaves no frame", "count from 1"},
      {"settings: &a {b: *a}\ndatasets: {d: {sequences: [s]}}\n", "contains itself", "without aliases"},
      {"repetitions: 2000000000\ndatasets: {tum: {sequences: [a]}}\n", "'repetitions' is '2000000000'", "to 100000"},
      {"repetitions: 60000\ndatasets: {tum: {sequences: [a, b]}}\n", "more than 100000 jobs", "fewer"},
      {"datasets: {tum: {root: /d, metric: rmse, sequences: [a]}}\n", "'metric' is 'rmse'", "ate or tum_mono"},
  };
  for (const BadPlan& plan : bad) {
    const std::string error = error_of(plan.text);
    EXPECT_NE(error.find(plan.where), std::string::npos) << plan.text << "-> " << error;
    EXPECT_NE(error.find(plan.remedy), std::string::npos) << plan.text << "-> " << error;
  }
}

}  // namespace
}  // namespace ldso
