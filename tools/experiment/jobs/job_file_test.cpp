#include "experiment/jobs/job_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

class JobFile : public testing::Test {
 protected:
  void SetUp() override { fs::remove_all(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  std::string error_of_reading() const {
    try {
      read_job(folder_);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_ =
      fs::path(testing::TempDir()) / "ldso_job_file" / testing::UnitTest::GetInstance()->current_test_info()->name();
};

ExperimentJob some_job() {
  ExperimentJob job;
  job.id = "MH_01/corners_no_loops/backward_3";
  job.sequence = "MH_01";
  job.dataset = "euroc";
  job.path = "data/MH 01";
  job.variant = "corners_no_loops";
  job.strategy = "corners";
  job.loops = false;
  job.reverse = true;
  job.repetition = 3;
  job.metric = JobMetric::kTumMono;
  job.ground_truth = "truth \"of\" \xc3\xa4.txt";
  job.arguments = {"run", "data/MH 01", "-o", "out", "--reverse"};
  return job;
}

TEST_F(JobFile, ReadsWhatWasWritten) {
  const ExperimentJob job = some_job();
  write_job(folder_, job);
  const ExperimentJob read = read_job(folder_);
  EXPECT_EQ(read.id, job.id);
  EXPECT_EQ(read.sequence, job.sequence);
  EXPECT_EQ(read.dataset, job.dataset);
  EXPECT_EQ(read.path, job.path);
  EXPECT_EQ(read.variant, job.variant);
  EXPECT_EQ(read.strategy, job.strategy);
  EXPECT_EQ(read.loops, job.loops);
  EXPECT_EQ(read.reverse, job.reverse);
  EXPECT_EQ(read.repetition, job.repetition);
  EXPECT_EQ(read.metric, job.metric);
  EXPECT_EQ(read.ground_truth, job.ground_truth);
  EXPECT_EQ(read.arguments, job.arguments);
}

TEST_F(JobFile, GroundTruthMayBeTheSequencesOwn) {
  ExperimentJob job = some_job();
  job.ground_truth.reset();
  write_job(folder_, job);
  EXPECT_FALSE(read_job(folder_).ground_truth.has_value());
}

TEST_F(JobFile, ErrorsNameTheFileAndTheMember) {
  EXPECT_NE(error_of_reading().find("job.json"), std::string::npos);  // There is none.
  write_job(folder_, some_job());
  std::string text = read_file(folder_ / "job.json");
  std::ofstream(folder_ / "job.json") << text.substr(0, text.size() / 2);
  EXPECT_NE(error_of_reading().find("job.json: is not the description of a job"), std::string::npos);
  text.replace(text.find("\"variant\""), 9, "\"variance\"");
  std::ofstream(folder_ / "job.json") << text;
  EXPECT_NE(error_of_reading().find("'variant' not found"), std::string::npos);
}

TEST_F(JobFile, MetricsHaveNames) {
  EXPECT_EQ(parse_job_metric("ate"), JobMetric::kAte);
  EXPECT_EQ(parse_job_metric("tum_mono"), JobMetric::kTumMono);
  EXPECT_THROW(parse_job_metric("rpe"), Error);
}

}  // namespace
}  // namespace ldso
