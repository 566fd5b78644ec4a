#include "experiment/plan/experiment_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using Texts = std::vector<std::string>;

ExperimentPlan small_plan() {
  ExperimentPlan plan;
  PlanSequence sequence;
  sequence.name = "a";
  sequence.dataset = "d";
  sequence.path = "/data/a";
  plan.sequences.push_back(sequence);
  sequence.name = "b";
  sequence.path = "/data/b";
  sequence.playback.start = 10;
  sequence.playback.end = 50;
  plan.sequences.push_back(sequence);
  plan.variants = {{"corners", "corners", true, {}}, {"few_no_loops", "random", false, {"selection.candidates=300"}}};
  plan.directions = {false, true};
  plan.repetitions = 2;
  return plan;
}

Texts ids(const std::vector<ExperimentJob>& jobs) {
  Texts result;
  for (const ExperimentJob& job : jobs) result.push_back(job.id);
  return result;
}

const ExperimentJob& job_of(const std::vector<ExperimentJob>& jobs, const std::string& id) {
  for (const ExperimentJob& job : jobs) {
    if (job.id == id) return job;
  }
  throw Error("no job " + id);
}

TEST(ExperimentPlan, JobsComeRepetitionByRepetition) {
  const Texts all = ids(plan_jobs(small_plan(), "/out"));
  ASSERT_EQ(all.size(), 16u);
  EXPECT_EQ(Texts(all.begin(), all.begin() + 6),
            (Texts{"a/corners/forward_0", "a/corners/backward_0", "a/few_no_loops/forward_0",
                   "a/few_no_loops/backward_0", "b/corners/forward_0", "b/corners/backward_0"}));
  EXPECT_EQ(all[8], "a/corners/forward_1");
}

TEST(ExperimentPlan, ArgumentsSayEverything) {
  ExperimentPlan plan = small_plan();
  plan.threads = 3;
  plan.sequences[1].playback.stride = 2;
  plan.sequences[1].playback.fps = 12.5;
  plan.sequences[1].playback.calibration_file = "/data/camera.txt";
  plan.sequences[1].config = "/data/c.yaml";
  plan.sequences[1].settings = {"window.iterations=4"};
  const auto jobs = plan_jobs(plan, "/out/x/../y");
  EXPECT_EQ(job_of(jobs, "a/corners/forward_0").arguments,
            (Texts{"run", "/data/a", "-o", "/out/y/jobs/a/corners/forward_0", "--threads", "3", "--set",
                   "selection.strategy=corners"}));
  EXPECT_EQ(job_of(jobs, "b/few_no_loops/backward_0").arguments, (Texts{"run",
                                                                        "/data/b",
                                                                        "-o",
                                                                        "/out/y/jobs/b/few_no_loops/backward_0",
                                                                        "--start",
                                                                        "10",
                                                                        "--end=50",
                                                                        "--stride",
                                                                        "2",
                                                                        "--reverse",
                                                                        "--calib",
                                                                        "/data/camera.txt",
                                                                        "--fps",
                                                                        "12.5",
                                                                        "--no-loops",
                                                                        "--threads",
                                                                        "3",
                                                                        "--config",
                                                                        "/data/c.yaml",
                                                                        "--set",
                                                                        "selection.strategy=random",
                                                                        "--set",
                                                                        "window.iterations=4",
                                                                        "--set",
                                                                        "selection.candidates=300"}));
  const ExperimentJob job = job_of(jobs, "b/few_no_loops/backward_1");
  EXPECT_EQ(job.sequence, "b");
  EXPECT_EQ(job.dataset, "d");
  EXPECT_EQ(job.strategy, "random");
  EXPECT_FALSE(job.loops);
  EXPECT_TRUE(job.reverse);
  EXPECT_EQ(job.repetition, 1);
}

bool contains(const ExperimentJob& job, const Texts& wanted) {
  return std::search(job.arguments.begin(), job.arguments.end(), wanted.begin(), wanted.end()) != job.arguments.end();
}

TEST(ExperimentPlan, RepetitionsDifferInTheFramesOrTheSeedOrNot) {
  ExperimentPlan plan = small_plan();
  auto jobs = plan_jobs(plan, "/out");
  EXPECT_TRUE(contains(job_of(jobs, "a/corners/forward_1"), {"--start", "1"}));
  EXPECT_TRUE(contains(job_of(jobs, "a/corners/backward_1"), {"--end=-1", "--reverse"}));
  EXPECT_FALSE(contains(job_of(jobs, "a/corners/backward_1"), {"--start"}));
  EXPECT_TRUE(contains(job_of(jobs, "b/corners/forward_1"), {"--start", "11", "--end=50"}));
  EXPECT_TRUE(contains(job_of(jobs, "b/corners/backward_1"), {"--start", "10", "--end=49", "--reverse"}));
  plan.sequences[1].playback.end = -5;
  EXPECT_TRUE(contains(job_of(plan_jobs(plan, "/out"), "b/corners/backward_1"), {"--end=-6"}));
  plan.sequences[1].playback.end = 1;
  EXPECT_TRUE(contains(job_of(plan_jobs(plan, "/out"), "b/corners/backward_1"), {"--end=1"}));

  plan.vary = Vary::kSeed;
  jobs = plan_jobs(plan, "/out");
  EXPECT_TRUE(contains(job_of(jobs, "a/corners/forward_1"), {"--set", "selection.seed=2"}));
  EXPECT_FALSE(contains(job_of(jobs, "a/corners/forward_1"), {"--start"}));
  plan.vary = Vary::kNone;
  jobs = plan_jobs(plan, "/out");
  Texts first = job_of(jobs, "a/corners/forward_0").arguments, second = job_of(jobs, "a/corners/forward_1").arguments;
  first[3] = second[3] = "";
  EXPECT_EQ(first, second);
}

TEST(ExperimentPlan, JobsAreSelectedByPatterns) {
  const auto jobs = plan_jobs(small_plan(), "/out");
  EXPECT_EQ(select_jobs(jobs, {}).size(), 16u);
  EXPECT_EQ(select_jobs(jobs, {"corners"}).size(), 8u);
  EXPECT_EQ(select_jobs(jobs, {"a/*_0"}).size(), 4u);
  EXPECT_EQ(select_jobs(jobs, {"?/corners/forward_0"}).size(), 2u);
  EXPECT_EQ(select_jobs(jobs, {"a/corners/forward_0", "a/corners/*"}).size(), 4u);
  EXPECT_THROW(select_jobs(jobs, {"a/*", "c/*"}), Error);
}

TEST(ExperimentPlan, AllThatIsMissingIsNamedAtOnce) {
  const fs::path folder = fs::path(testing::TempDir()) / "ldso_experiment_plan";
  fs::remove_all(folder);
  fs::create_directories(folder / "good" / "images");
  fs::create_directories(folder / "half");
  std::ofstream(folder / "good" / "times.txt") << "0\n";
  ExperimentPlan plan;
  for (const char* name : {"good", "half", "absent"}) {
    PlanSequence sequence;
    sequence.name = name;
    sequence.dataset = "mono";
    sequence.path = folder / name;
    sequence.needs = {"images.zip|images", "times.txt"};
    sequence.download = "https://example.org";
    plan.sequences.push_back(sequence);
  }
  plan.sequences[0].ground_truth = folder / "truth.txt";
  auto incomplete = find_incomplete(plan);
  ASSERT_EQ(incomplete.size(), 3u);
  EXPECT_EQ(incomplete[0].missing, Texts{(folder / "truth.txt").string()});
  EXPECT_EQ(incomplete[1].missing,
            (Texts{(folder / "half/images.zip or images").string(), (folder / "half/times.txt").string()}));
  EXPECT_EQ(incomplete[2].missing.size(), 1u);
  const std::string text = describe_incomplete(incomplete, 3);
  EXPECT_NE(text.find("3 of 3 sequences"), std::string::npos) << text;
  EXPECT_NE(text.find("half: " + (folder / "half/times.txt").string()), std::string::npos) << text;
  EXPECT_EQ(text.find("https://example.org"), text.rfind("https://example.org")) << "said once";

  ExperimentPlan rootless = plan;
  for (PlanSequence& sequence : rootless.sequences) sequence.path.clear();
  const std::string hint = describe_incomplete(find_incomplete(rootless), 3);
  EXPECT_NE(hint.find("--root mono=FOLDER"), std::string::npos) << hint;
  EXPECT_EQ(hint.find("--root mono=FOLDER"), hint.rfind("--root mono=FOLDER")) << "said once";

  plan.sequences[0].ground_truth.reset();
  incomplete = find_incomplete(plan);
  ASSERT_EQ(incomplete.size(), 2u);
  remove_sequences(plan, incomplete);
  ASSERT_EQ(plan.sequences.size(), 1u);
  EXPECT_EQ(plan.sequences[0].name, "good");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace ldso
