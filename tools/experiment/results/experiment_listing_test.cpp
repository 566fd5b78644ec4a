#include "experiment/results/experiment_listing.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

TEST(ExperimentListing, IsReadBack) {
  const fs::path folder = fs::path(testing::TempDir()) / "ldso_listing" / "of one";
  write_listing(folder, {"a \"title\"", {"a/b/forward_0", "c"}});
  const ExperimentListing listing = read_listing(folder);
  EXPECT_EQ(listing.title, "a \"title\"");
  EXPECT_EQ(listing.jobs, (std::vector<std::string>{"a/b/forward_0", "c"}));
  write_file(folder / "experiment.json", "{\"title\": 3");
  EXPECT_THROW(read_listing(folder), Error);
  fs::remove_all(folder.parent_path());
  EXPECT_THROW(read_listing(folder), Error);
}

/// What a shell makes of it.
std::string printed_by_shell(const std::string& word) {
  std::FILE* pipe = popen(("printf %s " + shell_quoted(word)).c_str(), "r");
  std::string text;
  for (int c = 0; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  pclose(pipe);
  return text;
}

TEST(ShellQuoted, IsTakenLiterally) {
  for (const std::string word :
       {"plain", "a b", "it's", "$HOME `ls` \"x\" \\ *", "a=b", "~/x", "#no", "--end=-3", "new\nline"})
    EXPECT_EQ(printed_by_shell(word), word);
  EXPECT_EQ(shell_quoted("selection.strategy=corners"), "selection.strategy=corners");
  EXPECT_EQ(shell_quoted(""), "''");
  EXPECT_EQ(shell_quoted(std::vector<std::string>{"run", "my data", "-o", "x"}), "run 'my data' -o x");
}

}  // namespace
}  // namespace ldso
