#pragma once
// The folder that a run writes. Other tools rely on the names.

#include <filesystem>
#include <string>
#include <vector>

#include "io/text/output_folder.h"
#include "results/run_report.h"

namespace ldso {

inline constexpr const char* kRunJson = "run.json";
inline constexpr const char* kCheckpointName = "checkpoint.json";  ///< What run.json will be if the run is cut off.
inline constexpr const char* kCameraName = "camera.txt";           ///< The calibration that a run corrected.

/// The folder of a run's results, created if there is none. What an earlier run wrote there is ldso's, also of versions
/// that kept no list: these left a run.json that tells what belongs to it.
OutputFolder open_run_folder(const std::filesystem::path& folder);

/// The same, and ready to be written: throws Error if it cannot be, or if a file of somebody else has the name of a
/// result. Removes run.json of an earlier run: as long as it is missing, the files in the folder are not those of one
/// finished run.
OutputFolder prepare_output_folder(const std::filesystem::path& folder);

/// Throws Error if the results of a run would come to lie among what it reads: in the folder of the sequence (of a
/// video: where that lies), in a folder that is a part of the sequence, or beside one of the other input files.
void refuse_output_in_input(const std::filesystem::path& folder, const std::filesystem::path& sequence,
                            const std::vector<std::filesystem::path>& files);

/// trajectory.txt, keyframes.txt and map.ply; trajectory_kitti.txt if wanted; trajectory.svg if the run was evaluated.
/// Files of an earlier run that this one does not write are removed. One that cannot be written costs itself only:
/// returns what the errors say.
std::vector<std::string> write_run_files(OutputFolder& out, const RunSummary& summary, bool kitti);

/// checkpoint.json, after the other files of a run that goes on.
void write_checkpoint_json(OutputFolder& out, const RunSummary& summary, const Dataset& dataset);

/// run.json, last and all at once: where it is, everything else is complete. Removes the checkpoint.
void write_run_json(OutputFolder& out, const RunSummary& summary, const Dataset& dataset);

}  // namespace ldso
