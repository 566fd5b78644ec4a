#include "experiment/results/results_file.h"

#include "experiment/test_results.h"
#include "ldso/error.h"

namespace ldso {
namespace {

class ResultsFile : public FolderTest {
 protected:
  std::string error_of_reading(const std::string& name, const std::string& text) {
    write(folder_ / name, text);
    try {
      read_results(folder_ / name);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

std::vector<JobResult> some_results() {
  JobResult a = finished_result(test_job("MH_01", "corners", 3, true), 0.1 + 0.2);
  a.odometry_errors.ate = 1.0 / 3;
  a.errors.e_s = 1.02;
  a.run.frames = 2000;
  a.run.frames_per_s = 31.25;
  a.stages["keyframe/select"] = {4, 10};
  JobResult b = failed_result(test_job("MH_01", "corners_no_loops", 0), "lost, \"quoted\"\nat frame 7");
  b.job.metric = JobMetric::kTumMono;
  return {a, b, pending_result(test_job("V1_01", "random", 1))};
}

void expect_same(const std::vector<JobResult>& read) {
  const std::vector<JobResult> written = some_results();
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].job.id, written[i].job.id);
    EXPECT_EQ(read[i].job.dataset, written[i].job.dataset);
    EXPECT_EQ(read[i].job.sequence, written[i].job.sequence);
    EXPECT_EQ(read[i].job.variant, written[i].job.variant);
    EXPECT_EQ(read[i].job.strategy, written[i].job.strategy);
    EXPECT_EQ(read[i].job.loops, written[i].job.loops);
    EXPECT_EQ(read[i].job.reverse, written[i].job.reverse);
    EXPECT_EQ(read[i].job.repetition, written[i].job.repetition);
    EXPECT_EQ(read[i].job.metric, written[i].job.metric);
    EXPECT_EQ(read[i].state, written[i].state);
    EXPECT_EQ(read[i].reason, written[i].reason);
    EXPECT_EQ(read[i].errors, written[i].errors);  // To the last bit.
    EXPECT_EQ(read[i].odometry_errors, written[i].odometry_errors);
    EXPECT_EQ(read[i].run.frames, written[i].run.frames);
    EXPECT_EQ(read[i].run.frames_per_s, written[i].run.frames_per_s);
  }
}

TEST_F(ResultsFile, JsonReadsBack) {
  write(folder_ / "results.json", results_json(some_results()));
  const auto read = read_results(folder_ / "results.json");
  expect_same(read);
  EXPECT_EQ(read[0].stages.at("keyframe/select").calls, 4);
  EXPECT_EQ(read[0].stages.at("keyframe/select").total_ms, 10);
}

TEST_F(ResultsFile, CsvReadsBack) {
  const std::string text = results_csv(some_results());
  EXPECT_NE(text.find(",keyframe/select_ms\n"), std::string::npos);
  EXPECT_NE(text.find(",2.5\n"), std::string::npos);  // Mean of the stage.
  write(folder_ / "results.csv", text);
  expect_same(read_results(folder_ / "results.csv"));
}

TEST_F(ResultsFile, HoldsNoPaths) {
  EXPECT_EQ(results_json(some_results()).find("data/"), std::string::npos);
  EXPECT_EQ(results_csv(some_results()).find("data/"), std::string::npos);
}

TEST_F(ResultsFile, ErrorsNameFileAndRow) {
  EXPECT_NE(error_of_reading("a.csv", "id,dataset\nx\n").find("a.csv, row 2: has 1 fields"), std::string::npos);
  EXPECT_NE(error_of_reading("a.csv", "id,ate_m\nx,big\n").find("column ate_m: 'big' is not a finite number"),
            std::string::npos);
  EXPECT_NE(error_of_reading("a.csv", "id,ate_m\nx,nan\n").find("'nan' is not a finite number"), std::string::npos);
  EXPECT_NE(error_of_reading("a.csv", "id,ate_m\nx,1\n").find("a.csv, row 2"), std::string::npos);
  EXPECT_NE(error_of_reading("a.json", "[{\"id\": \"x\"}]").find("a.json, job 1"), std::string::npos);
  EXPECT_NE(error_of_reading("a.json", "[").find("a.json"), std::string::npos);
  EXPECT_NE(error_of_reading("a.txt", "").find("results.json or results.csv"), std::string::npos);
}

TEST_F(ResultsFile, ReasonsMayBeAnyBytes) {
  JobResult result = some_results()[1];
  result.reason = "b\xe4r.png";
  write(folder_ / "a.json", results_json({result}));
  EXPECT_EQ(read_results(folder_ / "a.json")[0].reason, "b\xef\xbf\xbdr.png");
}

}  // namespace
}  // namespace ldso
