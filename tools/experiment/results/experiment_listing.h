#pragma once
// experiment.json: which jobs an experiment is made of, also those that have no folder yet.

#include <filesystem>
#include <string>
#include <vector>

namespace ldso {

struct ExperimentListing {
  std::string title;              ///< May be empty.
  std::vector<std::string> jobs;  ///< Ids in the order in which they are run.
};

/// Writes experiment.json into the folder, which is created. Throws Error if that fails.
void write_listing(const std::filesystem::path& experiment, const ExperimentListing& listing);

/// Throws Error if the folder holds no experiment or the file is damaged.
ExperimentListing read_listing(const std::filesystem::path& experiment);

/// A word of a command line as a POSIX shell takes it literally.
std::string shell_quoted(const std::string& word);
/// All of them, separated by blanks.
std::string shell_quoted(const std::vector<std::string>& words);

}  // namespace ldso
