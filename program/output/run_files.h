#pragma once
// The folder that a run writes. Other tools rely on the names.

#include <filesystem>

#include "results/run_report.h"

namespace ldso {

inline constexpr const char* kRunJson = "run.json";

/// Creates the folder of the results if there is none. Throws Error if that is impossible.
void make_output_folder(const std::filesystem::path& folder);

/// Creates the folder and tries to write into it. Throws Error if that is impossible: better before a long run. Removes
/// run.json of an earlier run: as long as it is missing, the files in the folder are not those of one finished run.
void prepare_output_folder(const std::filesystem::path& folder);

/// trajectory.txt, keyframes.txt and map.ply; trajectory_kitti.txt if wanted; trajectory.svg if the run was evaluated.
/// Files of an earlier run that this one does not write are removed.
void write_run_files(const std::filesystem::path& folder, const RunSummary& summary, bool kitti);

/// run.json, last and all at once: where it is, everything else is complete.
void write_run_json(const std::filesystem::path& folder, const RunSummary& summary, const Dataset& dataset);

}  // namespace ldso
