#pragma once
// Figures that others have published, to be shown beside ours: experiments/published.yaml, a copy of which is part of
// the program.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ldso {

inline constexpr double kSameFrames = 0.05;  ///< Difference allowed, relative to the published number.

/// One row (or column) of somebody's table.
struct PublishedResults {
  std::string system;   ///< "LDSO (2018)"
  std::string source;   ///< Publication and table.
  std::string dataset;  ///< As in ExperimentJob.
  std::string figure;   ///< Name of an ErrorKind, or "selection" for the time of point selection.
  std::string unit;
  std::map<std::string, std::optional<double>> values;  ///< By sequence or strategy; nothing: it failed there.
  std::map<std::string, double> frames = {};            ///< Of the sequences; may be empty.

  /// The value of a sequence, also if our name has the data set in front ("kitti_00") or more behind ("MH_01_easy").
  /// Nothing if there is none, or if our sequence has another number of `frames` by more than kSameFrames: it is an
  /// excerpt, or another sequence of that name. Infinite if the system failed.
  std::optional<double> value_of(const std::string& sequence,
                                 const std::optional<double>& frames_of_ours = std::nullopt) const;
};

/// Throws ldso::Error naming the file, and the line where that is known.
std::vector<PublishedResults> read_published(const std::filesystem::path& path);

/// What the program was built with.
std::vector<PublishedResults> built_in_published();

}  // namespace ldso
